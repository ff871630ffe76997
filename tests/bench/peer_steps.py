#!/usr/bin/env python3
"""Collision-free steps of scenes, by IPC Toolkit and by ccd::advance, keeping a distance.

    peer_steps.py CCD SCENE...

CCD: the program ccd. SCENE: a folder with two PLY frames, in it or in its folder frames. The peer is
ipctk.compute_collision_free_stepsize with its own settings, where Python finds ipctk (pip install ipctk);
else ours is shown alone. Distances: 0, and 1e-12 and 1e-3 of the mean edge before the step. Times are the least
of three, all threads; the peer is ended after a minute. The last column: pairs in contact, or within the distance, on the way to
before + step * (after - before), rounded, by exact; but for those that are so at the start.
"""

import json
import multiprocessing
import pathlib
import queue
import subprocess
import sys
import tempfile
import time

import numpy

try:
    import ipctk
except ImportError:
    ipctk = None

DISTANCES = (0, 1e-12, 1e-3)  # of the mean edge
REPEATS, LIMIT = 3, 60  # seconds of one
NUMBERS = {"float": "f4", "double": "f8", "uchar": "u1", "int": "i4", "uint": "u4"}


def read_ply(path):
    """Vertices and triangles of a binary PLY with properties of vertices x y z alone."""
    data = path.read_bytes()
    header, body = data.split(b"end_header\n", 1)
    words = [line.split() for line in header.decode().splitlines()]
    order = {"binary_little_endian": "<", "binary_big_endian": ">"}[words[1][1]]
    count = {w[1]: int(w[2]) for w in words if w[0] == "element"}
    vertex = [(w[2], order + NUMBERS[w[1]]) for w in words if w[0] == "property" and w[1] != "list"]
    if [name for name, _ in vertex] != ["x", "y", "z"]:
        sys.exit(f"{path}: found properties {vertex}, expected x, y and z")
    length, index = next(w[2:4] for w in words if w[:2] == ["property", "list"])
    face = [("count", NUMBERS[length]), ("of", order + NUMBERS[index], 3)]
    vertices = numpy.frombuffer(body, vertex, count["vertex"])
    faces = numpy.frombuffer(body, face, count["face"], vertices.nbytes)
    return (numpy.column_stack([vertices[axis] for axis in "xyz"]).astype("f8"),
            faces["of"].astype("i4"))


def write_ply(path, vertices, faces):
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n"
              "property double x\nproperty double y\nproperty double z\n"
              f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
    rows = numpy.zeros(len(faces), [("count", "u1"), ("of", "<i4", 3)])
    rows["count"], rows["of"] = 3, faces
    path.write_bytes(header.encode() + vertices.astype("<f8").tobytes() + rows.tobytes())


def frames_of(scene):
    for folder in (scene, scene / "frames"):
        found = sorted(folder.glob("*.ply"))
        if len(found) == 2:
            return found
    sys.exit(f"{scene}: expected a folder with two PLY frames")


def mean_edge(vertices, faces):
    edges = numpy.unique(numpy.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)), axis=0)
    return numpy.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1).mean()


class Ours:
    def __init__(self, program, folder):
        self.program, self.folder = program, pathlib.Path(folder)

    def step(self, before, after, distance, *options):
        """What `ccd step` says, as JSON."""
        out = self.folder / "out.json"
        separation = ["--separation", repr(distance)] if distance else []
        subprocess.run([self.program, "step", before, after, *separation, *options, "--json", out],
                       check=True, stdout=subprocess.DEVNULL)
        return json.loads(out.read_text())

    def advance(self, before, after, distance):
        """The fraction, and seconds without those of reading and writing."""
        def once():
            said = self.step(before, after, distance, "--advance", self.folder / "free.ply")
            return said["advance"], said["seconds"]["total"] - said["seconds"]["read"]
        runs = [once() for _ in range(REPEATS)]
        return runs[0][0], min(seconds for _, seconds in runs)

    def pairs_on_the_way(self, before, vertices, faces, distance):
        after = self.folder / "after.ply"
        write_ply(after, vertices, faces)
        said = self.step(before, after, distance, "--toi", self.folder / "times.csv")
        return sum(said["collisions"].values()) - said["touching_at_start"]


def peer_steps(results, before, after, faces, distance):
    """Puts the step size and its seconds, some times."""
    ipctk.set_logger_level(ipctk.LoggerLevel.error)  # it warns of each pair that is near
    mesh = ipctk.CollisionMesh(before, ipctk.edges(faces), faces)
    for _ in range(REPEATS):
        start = time.perf_counter()
        step = ipctk.compute_collision_free_stepsize(mesh, before, after, distance)
        results.put((step, time.perf_counter() - start))


def peer_step(*asked):
    """The step size, and the least time; nothing where one takes longer than the limit: it may not end
    where pairs touch at the start."""
    results = multiprocessing.Queue()
    peer = multiprocessing.Process(target=peer_steps, args=(results, *asked))
    peer.start()
    try:
        runs = [results.get(timeout=LIMIT) for _ in range(REPEATS)]
    except queue.Empty:
        return None
    finally:
        peer.kill()
        peer.join()
    return runs[0][0], min(seconds for _, seconds in runs)


def rows_of(scene, ours):
    first, second = frames_of(scene)
    (before, faces), (after, _) = read_ply(first), read_ply(second)
    for share in DISTANCES:
        distance = float(share * mean_edge(before, faces))
        fraction, seconds = ours.advance(first, second, distance)
        row = [scene.name, f"{share:g}", f"{fraction:.6g}", f"{seconds:.2f}"]
        found = ipctk and peer_step(before, after, faces, distance)
        if ipctk and not found:
            row += ["-", f"over {LIMIT}", "-", "-"]
        elif found:
            step, peer_seconds = found
            there = before + step * (after - before)
            met = ours.pairs_on_the_way(first, there, faces, distance)
            row += [f"{step:.6g}", f"{peer_seconds:.2f}",
                    f"{step / fraction:.4f}" if fraction else "-", str(met)]
        yield row


def main(arguments):
    if len(arguments) < 2:
        sys.exit(__doc__)
    heading = ["scene", "distance / mean edge", "advance", "s"]
    if ipctk:
        print(f"ipctk {ipctk.__version__}")
        heading += ["peer's step", "s", "peer / advance", "pairs on its way"]
    else:
        print("ipctk is not installed (pip install ipctk): ccd::advance alone")
    print("| " + " | ".join(heading) + " |\n|" + "---|" * len(heading))
    with tempfile.TemporaryDirectory() as folder:
        ours = Ours(arguments[0], folder)
        for scene in arguments[1:]:
            for row in rows_of(pathlib.Path(scene).resolve(), ours):
                print("| " + " | ".join(row) + " |", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
