"""Predicates compile in a small multiple of the time that their header takes alone.

usage: compile_time_test.py SOURCE_FOLDER COMPILER

Compares user times of the compiler within one run, so that the machine's speed does not matter. Each limit
is a third to a half above the ratio measured and below the ratio before that (docs/measured.md).
"""
import pathlib
import resource
import subprocess
import sys
import tempfile

TRIES = 4  # a ratio must be within its limit once: other work makes times longer, never shorter
PREDICATES = "errbound/predicates.hpp"
CUSTOM = "custom 2 3"
DEFINITION = """namespace errbound {
inline constexpr auto custom = predicate<points<2, 2, 2>>([](const auto& a, const auto& b, const auto& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
});
}"""
LIMITS = [(PREDICATES, ["segments_intersect2d 2 4"], 4), (PREDICATES, ["segments_intersect3d 3 4"], 5),
          (PREDICATES, ["segment_intersects_triangle 3 5"], 7),
          (PREDICATES, ["insphere 3 5"], 6), (PREDICATES, ["insphere4d 4 6"], 9),
          (PREDICATES, ["orient2d 2 3", "orient3d 3 4", "incircle 2 4", "insphere 3 5"], 9),
          (PREDICATES, ["orient5d 5 6"], 8), (PREDICATES, ["insphere5d 5 7"], 9),
          ("errbound/predicate.hpp", [CUSTOM], 3),
          ("errbound/simplices/predicates.hpp", ["triangle_intersects_triangle 3 6"], 13)]


def source_of(header, predicates):
    lines = ["#include <array>", f"#include <{header}>"]
    for predicate in predicates:
        if predicate == CUSTOM:
            lines.append(DEFINITION)
        name, dimension, count = predicate.split()
        names = "abcdefg"[:int(count)]
        arguments = ", ".join(f"const std::array<double, {dimension}>& {point}" for point in names)
        lines.append(f"errbound::sign_type {name}_of({arguments}) {{ return errbound::{name}({', '.join(names)}); }}")
    return "\n".join(lines) + "\n"


def user_seconds(header, predicates, root, compiler, folder):
    source = folder / "predicates.cpp"
    source.write_text(source_of(header, predicates))
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run([compiler, "-std=c++20", "-O2", f"-I{root / 'include'}", "-c", source, "-o", folder / "predicates.o"],
                   check=True)
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def main():
    root, compiler = pathlib.Path(sys.argv[1]), sys.argv[2]
    failed = False
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for header, predicates, limit in LIMITS:
            for _ in range(TRIES):
                alone = user_seconds(header, [], root, compiler, folder)
                ratio = user_seconds(header, predicates, root, compiler, folder) / alone
                if ratio <= limit:
                    break
            names = ", ".join(predicate.split()[0] for predicate in predicates)
            print(f"{names}: {ratio:.1f} times the header's {alone:.2f} s, limit {limit}")
            failed |= ratio > limit
    return failed


if __name__ == "__main__":
    sys.exit(main())
