#!/usr/bin/env python3
"""Prints the number of tracked files and lines of each part of the repository."""
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CODE = {".hpp", ".cpp", ".cu", ".cuh"}
# The first part that a path matches counts it.
PARTS = [
    ("proofs, Coq", lambda path: path.parts[0] == "proofs" and path.suffix == ".v"),
    ("proofs, records and programs", lambda path: path.parts[0] == "proofs" or path.parts[:2] == ("tests", "proofs")),
    ("seeds of fuzzers", lambda path: path.parts[:3] == ("tests", "fuzz", "corpus")),
    ("tests", lambda path: path.parts[0] == "tests" or path.parts[:2] == ("python", "tests")),
    ("product C++", lambda path: path.parts[0] in ("include", "errbound", "ccd", "python") and path.suffix in CODE),
    ("Python package", lambda path: path.parts[0] == "python"),
    ("docs", lambda path: path.parts[0] == "docs" and path.suffix == ".md"),
    ("examples", lambda path: path.parts[0] == "examples"),
    ("everything else", lambda path: True),
]


def main():
    counts = {name: [0, 0] for name, _ in PARTS}
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-z"], check=True, stdout=subprocess.PIPE, text=True).stdout
    for path in map(Path, filter(None, listed.split("\0"))):
        name = next(name for name, matches in PARTS if matches(path))
        counts[name][0] += 1
        counts[name][1] += (ROOT / path).read_bytes().count(b"\n")
    counts["all"] = [sum(column) for column in zip(*counts.values())]
    for name, (files, lines) in counts.items():
        print(f"{name:<30}{files:>8,}{lines:>10,}")


if __name__ == "__main__":
    main()
