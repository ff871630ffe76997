#!/usr/bin/env python3
"""Decides one step of a bundled scene by four methods. Prints a table of reported pairs and draws those of exact.

    python3 examples/demo/demo.py CCD OUT

CCD is the program `ccd`. OUT receives each method's pairs (.csv) and statistics (.json), and contacts.png.
"""
import json
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
FRAMES = [HERE.parent / "scenes/cloth-over-ball" / name for name in ("frame0.ply", "frame1.ply")]
METHODS = ["float", "safe", "tight", "exact"]
ROW = "{:<8}{:>10}{:>10}{:>10}{:>10}{:>12}{:>10}{:>12}"


def step(ccd, out, method):
    pairs, statistics = out / f"{method}.csv", out / f"{method}.json"
    count = ["--explain"] if method == "exact" else []  # exact counts its candidates only on request
    subprocess.run([ccd, "step", *FRAMES, "--method", method, *count, "--pairs", pairs, "--json", statistics],
                   check=True, stdout=subprocess.DEVNULL)
    return json.loads(statistics.read_text()), set(pairs.read_text().splitlines())


def main(ccd, out):
    out.mkdir(parents=True, exist_ok=True)
    results = {method: step(ccd, out, method) for method in METHODS}
    exact = results["exact"][1]
    print("\nOne step of a cloth over a ball: reported pairs by method\n")
    print(ROW.format("", "vf", "vf", "ee", "ee", "false", "missed", "narrow"))
    print(ROW.format("method", "pairs", "reported", "pairs", "reported", "positives", "", "phase, ms"))
    for method, (found, pairs) in results.items():
        candidates, collisions = found["candidates"], found["collisions"]
        print(ROW.format(
            method, candidates["vertex_face"], collisions["vertex_face"], candidates["edge_edge"],
            collisions["edge_edge"], len(pairs - exact), len(exact - pairs), f"{1000 * found['seconds']['narrow']:.1f}"))
    picture = out / "contacts.png"
    subprocess.run([sys.executable, HERE / "draw_pairs.py", *FRAMES, out / "exact.csv", picture], check=True)
    print("\nvf: vertex against face, ee: edge against edge; false positives and missed pairs by comparison with exact.")
    print("Uncertain pairs are reported. exact runs in SIMD batches, the others pair by pair.")
    at_start = results["exact"][0].get("intersections_at_start", {})
    print(f"The scene's first frame is not free: {sum(at_start.values())} pairs of faces intersect there, as in frames of the\n"
          "public benchmark. Steps report contacts on the way; ccd check lists the intersections of a frame.")
    print(f"pairs:   {(out / 'exact.csv').resolve()}\npicture: {picture.resolve()}")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: demo.py CCD OUT")
    main(sys.argv[1], Path(sys.argv[2]))
