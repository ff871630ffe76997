"""Compares intersections of meshes at rest with other packages: ipctk, libigl, meshlib, python-fcl, if installed.

usage: intersections.py [FACES | FILE]...   (meshes as files, or numbers of faces of generated grids; default: the
frames that are stored, and 1000000)

Seconds are the least of at most three calls on all threads; a package has some minutes. Faces are compared pair by
pair. A pair that only one package reports is decided here in rational numbers: `missed` pairs intersect, `false` ones
do not.
"""
import multiprocessing
import os
import queue
import sys
import time
from fractions import Fraction
from pathlib import Path

import numpy as np

from errbound import ccd, io

ROOT = Path(__file__).resolve().parents[2]
REPEATS, LIMIT, MOST_DECIDED = 3, 60, 20_000
PATIENCE = 4 * LIMIT  # seconds for a package


def grid(faces, pierced):
    """A wavy grid. If pierced, one vertex is pushed through it."""
    side = round((faces / 2) ** 0.5)
    height = lambda x, y: np.sin(40 * x) * np.cos(33 * y) / 20  # noqa: E731
    x, y = (a.ravel() for a in np.meshgrid(*[np.arange(side + 1) / side] * 2, indexing="ij"))
    points = np.stack([x, y, height(x, y)], 1)
    corner = (np.arange(side)[:, None] * (side + 1) + np.arange(side)).ravel()
    right, across = corner + side + 1, corner + side + 2
    if pierced:  # from half the height of a hill through its other side
        x, y, cell = np.pi / 20, 2 * np.pi / 33, 1 / side
        points[round(x / cell) * (side + 1) + round(y / cell)] = x + np.pi / 40 + 3 * cell, y, 0
    return points, np.concatenate([np.stack([corner, right, across], 1), np.stack([corner, across, corner + 1], 1)])


def are_adjacent(faces, pairs):
    return (faces[pairs[:, 0], :, None] == faces[pairs[:, 1], None, :]).any((1, 2))


def by_fcl(points, faces):
    import fcl
    model = fcl.BVHModel()
    model.beginModel(len(points), len(faces))
    model.addSubModel(points, faces)
    model.endModel()
    objects = [fcl.CollisionObject(model) for _ in range(2)]
    result = fcl.CollisionResult()
    fcl.collide(*objects, fcl.CollisionRequest(num_max_contacts=2**31 - 1, enable_contact=True), result)
    pairs = np.array([(c.b1, c.b2) for c in result.contacts]).reshape(-1, 2)
    return pairs[~are_adjacent(faces, pairs)]  # it also finds each face and its neighbours


def by_igl(points, faces):
    from igl.copyleft import cgal
    _, _, pairs, *_ = cgal.remesh_self_intersections(points, faces, detect_only=True)
    return pairs


def by_meshlib(points, faces):
    from meshlib import mrmeshnumpy, mrmeshpy
    mesh = mrmeshnumpy.meshFromFacesVerts(faces, points)
    found = mrmeshpy.findSelfCollidingTriangles(mrmeshpy.MeshPart(mesh), touchIsIntersection=True)
    return np.array([(p.aFace.get(), p.bFace.get()) for p in found]).reshape(-1, 2)


def any_by_ipctk(points, faces):
    import ipctk
    mesh = ipctk.CollisionMesh(np.asfortranarray(points), ipctk.edges(faces), faces)
    return ipctk.has_intersections(mesh, np.asfortranarray(points))


def by_errbound(points, faces):
    found = ccd.intersections(points, faces, segments=False, skip_unused=True).face_face.vertices
    rows = np.sort(faces, 1).astype(np.uint64)
    key = lambda f: (f[:, 0] * len(points) + f[:, 1]) * len(points) + f[:, 2]  # noqa: E731
    keys = key(rows)
    order = np.argsort(keys)
    return np.stack([order[np.searchsorted(keys[order], key(found[:, c:c + 3].astype(np.uint64)))]
                     for c in (0, 3)], 1)


def any_by_errbound(points, faces):
    return not ccd.is_free(points, faces, skip_unused=True)


def timed(call, *arguments):
    seconds, begin = [], time.monotonic()
    while len(seconds) < REPEATS and (not seconds or time.monotonic() - begin + seconds[-1] < LIMIT):
        start = time.perf_counter()
        found = call(*arguments)
        seconds.append(time.perf_counter() - start)
    return found, min(seconds)


def answer(results, call, *arguments):
    try:
        results.put(timed(call, *arguments))
    except ImportError as e:
        results.put(str(e))


def timed_alone(call, *arguments):
    """Returns the result and seconds, or a text. Another process keeps the libraries of packages apart."""
    spawn = multiprocessing.get_context("spawn")
    results = spawn.Queue()
    process = spawn.Process(target=answer, args=(results, call, *arguments))
    process.start()
    try:
        return results.get(timeout=PATIENCE)
    except queue.Empty:
        return f"no answer in {PATIENCE} s"
    finally:
        process.terminate()


def intersect(a, b):
    """True if two triangles, in rational numbers, share a point that is not a common vertex of both."""
    sub = lambda p, q: [x - y for x, y in zip(p, q)]  # noqa: E731
    dot = lambda p, q: sum(x * y for x, y in zip(p, q))  # noqa: E731
    cross = lambda p, q: [p[i - 2] * q[i - 1] - p[i - 1] * q[i - 2] for i in range(3)]  # noqa: E731
    common = [p for p in a if p in b]

    def on(p, t):  # p is in the triangle t
        n = cross(sub(t[1], t[0]), sub(t[2], t[0]))
        if not any(n):  # a segment or a point
            return any(not any(cross(sub(p, t[i]), sub(p, t[i - 1]))) and dot(sub(p, t[i]), sub(p, t[i - 1])) <= 0
                       for i in range(3))
        sides = [dot(n, cross(sub(t[i], t[i - 1]), sub(p, t[i - 1]))) for i in range(3)]
        return dot(n, sub(p, t[0])) == 0 and min(sides) >= 0

    def points_of(s, t):  # of the edges of s in t: at least one of them, if an edge ends or passes through there
        n = cross(sub(t[1], t[0]), sub(t[2], t[0]))
        for i in range(3):
            p, q = s[i], s[i - 1]
            u, v = dot(n, sub(p, t[0])), dot(n, sub(q, t[0]))
            if u != v:
                if u * v <= 0:
                    yield [x + (y - x) * u / (u - v) for x, y in zip(p, q)]
            elif u == 0:  # in the plane of t: the ends, the middle, and where edges cross
                yield from (p, q, [(x + y) / 2 for x, y in zip(p, q)])
                for j in range(3):
                    d, e = sub(q, p), sub(t[j], t[j - 1])
                    w, f = cross(d, e), cross(sub(t[j - 1], p), e)
                    at = [g / h for g, h in zip(f, w) if h != 0]
                    if at and 0 <= at[0] <= 1:
                        yield [x + at[0] * y for x, y in zip(p, d)]

    found = [p for s, t in ((a, b), (b, a)) for p in points_of(s, t) if on(p, s) and on(p, t)]
    if len(common) < 2:
        return any(p not in common for p in found)
    # Points on the line of a common edge belong to that edge.
    return any(any(cross(sub(p, common[0]), sub(p, common[1]))) for p in found)


def decided(points, faces, pairs):
    """The number of pairs that intersect."""
    used = {int(i) for pair in pairs for i in pair}
    triangles = {i: [[Fraction(float(x)) for x in points[v]] for v in faces[i]] for i in used}
    return sum(intersect(triangles[int(i)], triangles[int(j)]) for i, j in pairs)


def as_set(pairs):
    return {tuple(sorted(map(int, p))) for p in pairs}


def compare(name, points, faces):
    print(f"\n{name}: {len(faces):,} faces")
    ours, seconds = timed(by_errbound, points, faces)
    ours, (any_found, any_seconds) = as_set(ours), timed(any_by_errbound, points, faces)
    print(f"  {'errbound':10} all {seconds:9.4f} s, {len(ours):,} pairs; any {any_seconds:.4f} s")
    assert any_found == bool(ours)
    for peer, call in (("libigl", by_igl), ("meshlib", by_meshlib), ("fcl", by_fcl)):
        found = timed_alone(call, points, faces)
        if isinstance(found, str):
            print(f"  {peer:10} {found}")
            continue
        theirs, expected = as_set(found[0]), ours
        if peer == "fcl" and ours:
            pairs = np.array(sorted(ours))
            expected = as_set(pairs[~are_adjacent(faces, pairs)])
        line = f"  {peer:10} all {found[1]:9.4f} s, {len(theirs):,} pairs{' without a common vertex' * (peer == 'fcl')}"
        for what, differing, intersecting in (("missed", expected - theirs, True), ("false", theirs - expected, False)):
            some = sorted(differing)[:MOST_DECIDED]
            count = decided(points, faces, some)
            line += f"; {len(differing):,} {what}"
            wrong = len(some) - count if intersecting else count
            line += f" ({len(some):,} decided, {wrong} errors of errbound)" if some else ""
        print(line, flush=True)
    found = timed_alone(any_by_ipctk, points, faces)
    print(f"  {'ipctk':10} " + (found if isinstance(found, str) else
                              f"any {found[1]:9.4f} s{'' if found[0] == bool(ours) else '; another answer'}"))


def main():
    stored = Path(os.environ.get("ERRBOUND_SHARED_DATA", ROOT / ".." / "shared" / "data"))
    default = [next(iter(sorted(f.glob("*.ply"))), None) for f in (
        ROOT / "examples/scenes/cloth-over-ball", *sorted((stored / "scenes").glob("*/frames")))]
    for argument in sys.argv[1:] or [*filter(None, default), "1000000"]:
        if str(argument).isdecimal():
            for pierced in False, True:
                compare("pierced grid" if pierced else "free grid", *grid(int(argument), pierced))
        else:
            mesh = io.read_mesh(argument)
            compare(argument, np.asarray(mesh.vertices), np.asarray(mesh.faces).astype(np.int64))


if __name__ == "__main__":
    main()
