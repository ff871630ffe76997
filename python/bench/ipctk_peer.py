"""Compares step sizes and times: ipc-toolkit's functions, these with our broad phase, and our functions.

usage: ipctk_peer.py SCENE...   (folders with two frames of a mesh, in them or in their folder frames)

All threads; least of three times, at most a minute each. The last column counts pairs in contact in the motion to
before + step * (after - before), decided by exact, except those that touch at the start.
"""
import multiprocessing
import pathlib
import queue
import sys
import time

import ipctk
import numpy as np

from errbound import ccd, io
from errbound import ipctk as exact

REPEATS, LIMIT = 3, 60  # LIMIT: seconds of one call


def ways(mesh, before, after):
    return {
        "ipctk": lambda: ipctk.compute_collision_free_stepsize(mesh, before, after),
        "ipctk, our broad phase": lambda: ipctk.compute_collision_free_stepsize(
            mesh, before, after, 0, exact.BroadPhase()),
        "errbound.ipctk": lambda: exact.compute_collision_free_stepsize(mesh, before, after),
    }


def answer(results, name, before, after, faces):
    ipctk.set_logger_level(ipctk.LoggerLevel.error)  # it warns for each pair that is near
    mesh = ipctk.CollisionMesh(np.asfortranarray(before), ipctk.edges(faces), faces)
    for _ in range(REPEATS):
        start = time.perf_counter()
        step = ways(mesh, before, after)[name]()
        results.put((step, time.perf_counter() - start))


def timed(*arguments):
    """Returns step size and seconds, or None after LIMIT seconds."""
    results = multiprocessing.Queue()
    process = multiprocessing.Process(target=answer, args=(results, *arguments))
    process.start()
    try:
        found = [results.get(timeout=LIMIT) for _ in range(REPEATS)]
    except queue.Empty:
        return None
    finally:
        process.kill()
        process.join()
    return found[0][0], min(seconds for _, seconds in found)


def row(scene):
    frames = sorted(scene.glob("*.ply")) or sorted((scene / "frames").glob("*.ply"))
    if len(frames) != 2:
        sys.exit(f"{scene}: number of frames is {len(frames)}; expected 2")
    first, second = (io.read_mesh(path) for path in frames)
    before, after, faces = first.vertices, second.vertices, first.faces.astype(np.int32)
    cells = [scene.name]
    for name in ways(None, None, None):
        found = timed(name, before, after, faces)
        if found is None:
            cells += ["-", f"over {LIMIT}", "-"]
            continue
        step, seconds = found
        way = ccd.step(before, before + step * (after - before), faces, initial_contact=True)
        cells += [f"{step:.6g}", f"{seconds:.2f}", str(len(way.pairs) - len(way.touching_at_start))]
    return cells


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    print(f"ipctk {ipctk.__version__}")
    heading = ["scene"] + [f"{name}{what}" for name in ways(None, None, None)
                           for what in (": step", ", s", ", pairs")]
    print("| " + " | ".join(heading) + " |\n|" + "---|" * len(heading))
    for scene in sys.argv[1:]:
        print("| " + " | ".join(row(pathlib.Path(scene).resolve())) + " |", flush=True)


if __name__ == "__main__":
    main()
