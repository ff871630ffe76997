"""Compares first contacts of turning bodies with other packages: python-fcl, coal, drake, if installed.

usage: bodies.py [SCENE]...   (default: all of torus, bump, gears, needle, plates)

Two bodies move in steps, each with constant velocities of position and rotation. Every package decides one step after
the other, up to the first contact. coal and drake have no continuous queries of meshes: conservative advancement by
their distances, written here, stops at the distance 1e-4. drake takes convex bodies only. python-fcl has its defaults
(tolerance 1e-4 of a step, 10 samples) and runs each step in a process, since its answers depend on earlier calls.

`errbound` interpolates the quaternions of each step; `pieces` does so in 64 pieces of each step, and its times are
those of the truth: the bound of its distance from the true motion is printed. Seconds of CPU are the least of three runs (one
of python-fcl), on one thread, without building of models; errors are in steps. `missed` counts steps with a contact in
which the package reports none, `false` the reverse. Exact queries give the reasons: the pair that touches and the times
around its contact, or a distance that all pairs keep.
"""
import importlib.util
import math
import multiprocessing
import sys
import time
from pathlib import Path

import numpy as np

from errbound.bodies import Bodies

REPEATS, LIMIT, PIECES, TOLERANCE = 3, 20, 64, 1e-4
ROOT = Path(__file__).resolve().parents[2]


def load_makers():
    spec = importlib.util.spec_from_file_location("make_scenes", ROOT / "examples/bodies/make_scenes.py")
    makers = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(makers)
    return makers


make = load_makers()


# Quaternions w, x, y, z, and poses x, y, z, w, x, y, z.

def product(p, q):
    w, v = p[0] * q[0] - np.dot(p[1:], q[1:]), p[0] * q[1:] + q[0] * p[1:] + np.cross(p[1:], q[1:])
    return np.array([w, *v])


class Motion:
    """Constant velocities from pose to pose: rotation about a fixed axis, by less than half a turn."""

    def __init__(self, start, end):
        self.start, self.end = np.array(start, float), np.array(end, float)
        p, q = (pose[3:] / np.linalg.norm(pose[3:]) for pose in (self.start, self.end))
        turn = product(q, p * [1, -1, -1, -1])
        turn *= math.copysign(1, turn[0])
        length = np.linalg.norm(turn[1:])
        self.angle = 2 * math.atan2(length, turn[0])
        self.axis = turn[1:] / length if length else np.array([0, 0, 1.])
        self.q = p

    def at(self, t):
        half = self.angle * t / 2
        q = product(np.array([math.cos(half), *(math.sin(half) * self.axis)]), self.q)
        return np.array([*((1 - t) * self.start[:3] + t * self.end[:3]), *q])

    def speed(self, points):
        return self.angle * np.linalg.norm(points, axis=1).max() + np.linalg.norm(self.end[:3] - self.start[:3])


class Scene:
    def __init__(self, meshes, poses, is_convex=False):
        """poses: (2, steps + 1, 7)."""
        self.meshes = [(np.array(v, float), np.array(f, np.int64)) for v, f in meshes]
        self.steps = [tuple(Motion(p[i], p[i + 1]) for p in poses) for i in range(len(poses[0]) - 1)]
        self.is_convex = is_convex

    def speed(self, step):
        return sum(m.speed(v) for m, (v, _) in zip(step, self.meshes))


def torus(bump):
    vertices, faces = make.ring(1, .3, 100, 50)  # 10,000 faces, about the axis x
    if bump:  # one vertex stands out by more than the gap
        vertices[50 * 25] = tuple(1.002 * c for c in vertices[50 * 25])
    return vertices, faces


def tori(bump):
    """Two tori 0.001 apart: one makes a turn about its axis in 20 steps, the other turns with it."""
    def poses(offset, sign):
        return [[0, offset, 0, *make.turned(sign * (2 * math.pi * k / 20 + .01), (1, 0, 0))] for k in range(21)]
    return Scene([torus(bump), torus(False)], [poses(0, 1), poses(2.601, -1)])


def example(maker, first, second):
    meshes, scene = maker()
    bodies = {b["name"]: b for b in scene["bodies"]}
    return Scene([meshes[first], meshes[second]], [bodies[first]["poses"], bodies[second]["poses"]])


def plates():
    """Thin plates that fly through each other in one step of five, and turn a little."""
    def poses(sign):
        return [[sign * (-.25 + .1 * k), 0, 0, *make.turned(.02 * sign * k, (0, 1, 0))] for k in range(6)]
    return Scene([make.box(1e-4, .1, .1)] * 2, [poses(1), poses(-1)], True)


SCENES = {"torus": lambda: tori(False), "bump": lambda: tori(True),
          "gears": lambda: example(make.gears, "large", "small"),
          "needle": lambda: example(make.needle, "needle", "ring"), "plates": plates}


# Packages. Each returns a function of a step, which returns the time of the first contact or None.

def by_errbound(scene, threads=1):
    bodies = Bodies(scene.meshes)

    def decide(step):
        found = bodies.run([m.start for m in step], [m.end for m in step], threads=threads)
        return 0. if len(found.touching_at_start) else found.first_contact and found.first_contact[0]
    return decide


def by_pieces(scene):
    bodies = Bodies(scene.meshes)

    def decide(step, report=None):
        for k in range(PIECES):
            found = bodies.run([m.at(k / PIECES) for m in step], [m.at((k + 1) / PIECES) for m in step], threads=1)
            low = 0. if len(found.touching_at_start) else found.first_contact and found.first_contact[0]
            if low is not None:
                if report is not None:
                    report.append((k, found))
                return (k + low) / PIECES
        return None
    return decide


def fcl_answer(name, index, solver):
    """The time of the first contact in a step, or None, and seconds."""
    import fcl

    def model(vertices, faces):
        made = fcl.BVHModel()
        made.beginModel(len(vertices), len(faces))
        made.addSubModel(vertices, faces)
        made.endModel()
        return made

    def transform(pose):
        return fcl.Transform(pose[3:], pose[:3])

    scene = SCENES[name]()
    step, result = scene.steps[index], fcl.ContinuousCollisionResult()
    first, second = (fcl.CollisionObject(model(*mesh), transform(m.at(0))) for mesh, m in zip(scene.meshes, step))
    request = fcl.ContinuousCollisionRequest(ccd_motion_type=fcl.CCDMotionType.CCDM_LINEAR,
                                             ccd_solver_type=getattr(fcl.CCDSolverType, solver))
    start = time.process_time()
    fcl.continuousCollide(first, transform(step[0].at(1)), second, transform(step[1].at(1)), request, result)
    seconds = time.process_time() - start
    return result.time_of_contact if result.is_collide else None, seconds


def by_fcl(solver):
    def decide_all(name, scene, steps):
        with multiprocessing.get_context("spawn").Pool(1, maxtasksperchild=1) as pool:
            answers = pool.starmap(fcl_answer, [(name, i, solver) for i in range(len(steps))], 1)
        return [t for t, _ in answers], sum(seconds for _, seconds in answers)
    return decide_all


def advancing(scene, distance):
    """Conservative advancement: no point moves faster than the speed."""
    def decide(step):
        speed, t = scene.speed(step), 0.
        while t <= 1:
            d = distance([m.at(t) for m in step])
            if d <= TOLERANCE:
                return t
            if speed == 0:
                break
            t += d / speed
        return None
    return decide


def by_coal(scene):
    import coal

    def model(vertices, faces):
        made = coal.BVHModelOBBRSS()
        made.beginModel(len(faces), len(vertices))
        made.addVertices(vertices)
        made.addTriangles(faces.astype(np.int32))
        made.endModel()
        return made

    models, request = [model(*mesh) for mesh in scene.meshes], coal.DistanceRequest()
    request.enable_signed_distance = False

    def transform(pose):
        return coal.Transform3s(matrix(pose[3:]), pose[:3])

    def distance(poses):
        first, second = map(transform, poses)
        return coal.distance(models[0], first, models[1], second, request, coal.DistanceResult())
    return advancing(scene, distance)


def matrix(q):
    w, x, y, z = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def by_drake(scene):
    if not scene.is_convex:
        raise ValueError("convex bodies only")
    from pydrake.geometry import Convex
    from pydrake.math import RigidTransform, RotationMatrix
    from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, CoulombFriction
    from pydrake.multibody.tree import SpatialInertia
    from pydrake.systems.framework import DiagramBuilder

    builder = DiagramBuilder()
    plant, graph = AddMultibodyPlantSceneGraph(builder, time_step=0)
    bodies, ids = [], []
    for i, (vertices, _) in enumerate(scene.meshes):
        body = plant.AddRigidBody(f"body{i}", SpatialInertia.SolidSphereWithMass(1, 1))
        ids.append(plant.RegisterCollisionGeometry(body, RigidTransform(), Convex(vertices.T, "body"), "shape",
                                                   CoulombFriction(1, 1)))
        bodies.append(body)
    plant.Finalize()
    diagram = builder.Build()
    context = diagram.CreateDefaultContext()
    of_plant, of_graph = plant.GetMyContextFromRoot(context), graph.GetMyContextFromRoot(context)

    def distance(poses):
        for body, pose in zip(bodies, poses):
            plant.SetFreeBodyPose(of_plant, body, RigidTransform(RotationMatrix(matrix(pose[3:])), pose[:3]))
        query = graph.get_query_output_port().Eval(of_graph)
        return query.ComputeSignedDistancePairClosestPoints(*ids).distance
    return advancing(scene, distance)


def timed(package):
    """Returns a function that returns the answers to all steps, and the least seconds."""
    def decide_all(name, scene, steps):
        seconds, begin, found = [], time.monotonic(), None
        while len(seconds) < REPEATS and (not seconds or time.monotonic() - begin + seconds[-1] < LIMIT):
            decide = package(scene)
            start = time.process_time()
            found = [decide(step) for step in steps]
            seconds.append(time.process_time() - start)
        return found, min(seconds)
    return decide_all


PACKAGES = {"errbound": timed(by_errbound), "errbound, pieces": timed(by_pieces),
            "python-fcl, conservative advancement": by_fcl("CCDC_CONSERVATIVE_ADVANCEMENT"),
            "python-fcl, naive": by_fcl("CCDC_NAIVE"), "coal, advancing": timed(by_coal),
            "drake, advancing": timed(by_drake)}


def truth_of(scene):
    """Returns the steps up to the first contact, the true times, and the pair that touches."""
    decide, report, times = by_pieces(scene), [], []
    for step in scene.steps:
        times.append(decide(step, report))
        if times[-1] is not None:
            break
    return scene.steps[:len(times)], times, report


def text_of_contact(scene, report):
    piece, found = report[0]
    bodies, pairs = Bodies(scene.meshes), found.first_pairs if len(found.first_pairs) else found.touching_at_start
    for kind in ("vertex_face", "edge_edge", "vertex_edge", "vertex_vertex"):
        vertices = getattr(pairs, kind)
        if len(vertices):
            low, high = found.first_contact or (0, 0)
            return (f"{kind} {vertices[0].tolist()} of bodies {bodies.body_of(vertices[0]).tolist()} touches between "
                    f"{(piece + low) / PIECES:.17g} and {(piece + high) / PIECES:.17g} of its step")
    return ""


def text_of_gap(scene, step):
    """A distance that the bodies keep in a step, exactly, except for the deviation of its pieces."""
    bodies, pieces = Bodies(scene.meshes), 16
    for exponent in range(1, 10):
        distance = 10. ** -exponent
        if all(len(bodies.run([m.at(k / pieces) for m in step], [m.at((k + 1) / pieces) for m in step],
                              distance=distance).pairs) == 0 for k in range(pieces)):
            return f"no pair comes within {distance:.0e}"
    return ""


def deviation(scene, steps):
    """A bound of the distance of pieces from the true motion (ccd/bodies/constant_turn.hpp)."""
    return max(sum(1.0001 * (m.angle / PIECES) ** 3 / 249 * np.linalg.norm(v, axis=1).max()
                   for m, (v, _) in zip(step, scene.meshes)) for step in steps)


def compare(name):
    scene = SCENES[name]()
    steps, truth, report = truth_of(scene)
    faces = " and ".join(f"{len(f):,}" for _, f in scene.meshes)
    first = f"first contact at {len(steps) - 1 + truth[-1]:.9g}" if truth[-1] is not None else "no contact"
    print(f"\n{name}: {faces} faces, {len(steps)} steps, {first}, pieces within {deviation(scene, steps):.1e}\n")
    print("| package | seconds | contact reported | error | missed | false |\n|---|---:|---:|---:|---:|---:|")
    misses, wrong = [], {}
    for package, made in PACKAGES.items():
        try:
            found, seconds = made(name, scene, steps)
        except (ImportError, ValueError, RuntimeError) as error:
            print(f"| {package} | {str(error).splitlines()[0]} | | | | |")
            continue
        reported = next(((i, t) for i, t in enumerate(found) if t is not None), None)
        missed = sum(t is not None and f is None for t, f in zip(truth, found))
        false = sum(t is None and f is not None for t, f in zip(truth, found))
        error = f"{found[-1] - truth[-1]:+.1e}" if found[-1] is not None and truth[-1] is not None else ""
        at = f"{sum(reported):.6f}" if reported else ""
        print(f"| {package} | {seconds:.3g} | {at} | {error} | {missed} | {false} |", flush=True)
        if missed:
            misses.append(package)
        if false:
            first_false = next(i for i, (t, f) in enumerate(zip(truth, found)) if t is None and f is not None)
            wrong.setdefault(first_false, package)
    for i, package in wrong.items():
        print(f"\nfalse report of {package}: in step {i} {text_of_gap(scene, steps[i])}")
    if misses:
        print(f"\nmissed by {', '.join(misses)}: {text_of_contact(scene, report)}")


def main():
    for name in sys.argv[1:] or SCENES:
        if name not in SCENES:
            sys.exit(__doc__)
        compare(name)


if __name__ == "__main__":
    main()
