"""The compiler finds omitted checks of uncertain signs in the predicates that branch.

usage: omissions_test.py SOURCE_FOLDER COMPILER

Omits each check, and each sign of the checks of several signs, one at a time, and compiles.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

LEAST_FOUND = 18  # the others matter behind a dozen degenerate cases only
HEADERS = ["errbound/predicates.hpp", "errbound/simplices/predicates.hpp"]
PREDICATES = {"segments_intersect": "segments_intersect3d", "segment_triangle": "segment_intersects_triangle",
              "triangles_intersect": "triangle_intersects_triangle"}


def omissions(line, before):
    """Yields each mutation of a line and the line before it."""
    signs = re.findall(r"!certain\(\w+\)", line)
    loop = re.search(r"\{(.*)\}", before)
    if len(signs) > 1:
        for sign in signs:
            rest = " || ".join(s for s in signs if s != sign)
            yield re.sub(r"\(!certain.*\) return", f"({rest}) return", line), before
    if "|| !certain(s)" in line:
        yield line.replace(" || !certain(s)", ""), before
        return
    yield "(void)0;", re.sub(r"^\s*for .*", "", before)
    if loop:
        for sign in loop[1].split(", "):
            rest = ", ".join(s for s in loop[1].split(", ") if s != sign)
            yield line, before.replace(loop[1], rest)


def is_found(text, predicate, include, compiler, folder):
    source = folder / "omission.cpp"
    source.write_text(f"{text}\nstatic_assert(errbound::{predicate}.counts.roundings > 0);\n")
    done = subprocess.run([compiler, "-std=c++20", "-fsyntax-only", f"-I{include}", source],
                          capture_output=True, text=True)
    refused = "acts on a sign that is uncertain" in done.stderr
    if not refused and done.returncode != 0:
        sys.exit(f"expected a program, but for what is left out, found\n{done.stderr}")
    return refused


def main():
    root, compiler = pathlib.Path(sys.argv[1]), sys.argv[2]
    tried = found = 0
    with tempfile.TemporaryDirectory() as folder:
        for header in HEADERS:
            lines = (root / "include" / header).read_text().split("\n")
            predicate = None
            for i, line in enumerate(lines):
                form = re.match(r"constexpr sign_type (\w+)\(", line)
                predicate = PREDICATES.get(form[1]) if form else predicate
                if predicate is None or "!certain" not in line:
                    continue
                for mutant, before in omissions(line, lines[i - 1]):
                    text = "\n".join([*lines[:i - 1], before, mutant, *lines[i + 1:]])
                    tried += 1
                    if is_found(text, predicate, root / "include", compiler, pathlib.Path(folder)):
                        found += 1
                    else:
                        print(f"not found: {header}:{i + 1}: {(before + mutant).strip()}")
    print(f"{tried} omissions, {found} found")
    return found < LEAST_FOUND


if __name__ == "__main__":
    sys.exit(main())
