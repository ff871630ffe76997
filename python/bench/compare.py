"""Compares calls of the package with C++: a step of a mesh, and its edge/edge candidates by index.

Arguments: the program errbound_python_peer; optionally two frames. The default is the public cloth-ball step, if it
is stored (ERRBOUND_SHARED_DATA), or the bundled scene.
"""
import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

from errbound import ccd, io

ROOT = Path(__file__).resolve().parents[2]
ROUNDS = 41


def scene():
    if len(sys.argv) > 2:
        return sys.argv[2:4]
    stored = Path(os.environ.get("ERRBOUND_SHARED_DATA", ROOT / ".." / "shared" / "data"))
    frames = sorted((stored / "scenes" / "cloth-ball" / "frames").glob("*.ply"))
    return frames[:2] if len(frames) >= 2 else sorted((ROOT / "examples/scenes/cloth-over-ball").glob("*.ply"))


def main():
    frames = scene()
    before, after = map(io.read_mesh, frames)
    positions = before.vertices, after.vertices
    steps = ccd.Steps(before.faces, before.edges, vertices=len(before.vertices))
    pairs = steps.candidates(*positions).edge_edge
    calls = {"step": lambda: len(steps.run(*positions).pairs),
             "decide": lambda: len(ccd.decide(pairs, "edge_edge", positions=positions).outcome)}
    peer = subprocess.Popen([sys.argv[1], *frames], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    print(f"{frames[0]}: milliseconds, medians of {ROUNDS} alternating calls; the ratio's median")
    for name, call in calls.items():
        of_python, of_cpp = [], []
        for _ in range(ROUNDS):
            start = time.perf_counter()
            found = call()
            of_python.append(time.perf_counter() - start)
            print(name, file=peer.stdin, flush=True)
            seconds, expected = peer.stdout.readline().split()
            of_cpp.append(float(seconds))
            assert found == int(expected), (name, found, expected)
        ratio = statistics.median(a / b for a, b in zip(of_python, of_cpp))
        print(f"{name:8} Python {1e3 * statistics.median(of_python):8.2f}  "
              f"C++ {1e3 * statistics.median(of_cpp):8.2f}  ratio {ratio:.3f}")
    peer.stdin.close()
    peer.wait()


if __name__ == "__main__":
    main()
