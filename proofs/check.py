#!/usr/bin/env python3
"""Builds the proofs from scratch and prints the theorems of each file with their axioms.

Fails if a proof is missing or unfinished, or rests on axioms other than those of Coq's real numbers and classical logic
(checker.py); if the theorems' statements differ from statements.txt; if README.md and the files name different
theorems, or the C++ code names a theorem that does not exist; or if tie.txt, with which
tests/errbound/validation/tie_test.cpp compares the C++ code, differs from the results of the proofs' definitions.
--names only compares names, and does not need Coq.

A full check that passes writes a digest of the files it depends on to passed.txt, which is committed. --passed compares
names, and fails unless the files have that digest.
"""
import argparse
import concurrent.futures
import hashlib
import os
import re
import shutil
import sys
import textwrap
import time
from pathlib import Path

import checker
import records
import ties

LIBRARY = "Errbound"

proofs = Path(__file__).resolve().parent
root = proofs.parent
# Operations of a bound rule. Each must name its theorem.
ALL = {"exact", "within", "error", "sign", "add", "subtract", "multiply", "divide", "scale"}
OPERATION = re.compile(r"static (?:constexpr )?(?:bound<T>|T|sign_type) "
                       r"(exact|within|error|sign|add|subtract|multiply|divide|scale)\(")
# `none` and `stochastic` promise nothing, and `derived` has the promise of its rule.
UNPROVED_RULES = {"none", "stochastic", "derived"}
# Functions of tracked numbers must name their theorems, too, except internal ones.
FUNCTION = re.compile(r"^constexpr (?:tracked<T, Rule>|detail::number_of<\w>) (\w+)\(")
INTERNAL = re.compile(r"^namespace detail \{.*?^\}  // namespace detail$", re.MULTILINE | re.DOTALL)
# The files that Coq extracts, and the programs that run them.
TIE_PROGRAMS = {"code": "tie", "symbols": "tie_symbols", "integers": "tie_integers", "floats": "tie_floats",
                "filters": "tie_filters", "roots": "tie_roots", "words": "tie_words", "times": "tie_times"}
# Parts of programs that take many minutes, which run in parallel.
TIE_PARTS = {"tie": [("words",), ("tiny_3_3",), ("tiny_5_3",), ("tiny_4_4",), ("floats",)]}


PASSED = proofs / "passed.txt"


def fail(message):
    sys.exit(f"proofs: {message}")


def digest():
    """Returns a digest of every file that a full check depends on, except README.md and the C++ code, which are always
    compared. Comments and white space of proofs do not affect it."""
    sum_of_all = hashlib.sha256()
    for path in sorted([*proofs.glob("*.v"), *proofs.glob("*.ml"), *proofs.glob("*.py"), proofs / "tie.txt",
                        proofs / "statements.txt"]):
        text = path.read_text()
        if path.suffix == ".v":
            text = checker.words_of(text)
        content = text.encode()
        sum_of_all.update(f"{path.name} {len(content)}\n".encode() + content)
    return sum_of_all.hexdigest() + "\n"


def compare_with_readme(found):
    named = re.findall(r"^\| `(\w+)` \|", (proofs / "README.md").read_text(), re.MULTILINE)
    missing = [theorem for _, theorem in found if theorem not in named]
    unknown = [name for name in named if name not in [theorem for _, theorem in found]]
    if missing or unknown:
        fail(f"README.md does not name {missing}; it names {unknown}, which are not theorems")


def named_theorems(comment):
    """Returns (file, theorem) for the theorems that a C++ comment names as proofs/File.v, theorem, theorem."""
    text = re.sub(r"\s*\n\s*//+!?<?\s*", " ", comment)
    if unlisted := re.search(r"proofs/\w+\.v(?!, \w)|proofs/\w+\.v, (?:\w+, )*\w+ and \w*_\w*", text):
        fail(f"'{unlisted.group()}': theorems are named as proofs/File.v, theorem, theorem")
    return [(file, name) for file, names in re.findall(r"proofs/(\w+)\.v, ((?:\w+, )*\w+)", text)
            for name in names.split(", ")]


def compare_with_code(found):
    """Fails if the C++ code names a theorem that does not exist. Operations of a bound rule and functions of tracked
    numbers must name one."""
    known = set(found)
    for folder in ("include", "ccd", "errbound", "tests"):
        for path in sorted((root / folder).rglob("*.[hc]pp")):
            for name in named_theorems(path.read_text()):
                if name not in known:
                    fail(f"{path.relative_to(root)} names {name[1]} of {name[0]}.v, which is not a theorem")
    for path in sorted((root / "include/errbound/rules").glob("*.hpp")):
        text = path.read_text()
        unproved = ALL if path.stem in UNPROVED_RULES else set()
        if "has_division = false" in text:
            unproved = unproved | {"divide"}
        every_one_names(OPERATION, path, text, unproved)
    path = root / "include/errbound/functions.hpp"
    every_one_names(FUNCTION, path, INTERNAL.sub("", path.read_text()), set())


def every_one_names(pattern, path, text, unproved):
    """Fails if a function that the pattern finds has no comment before it that names a theorem."""
    comment = ""
    for line in text.splitlines():
        if line.lstrip().startswith("//"):
            comment += line + "\n"
        elif not line.lstrip().startswith(("template", "requires")):
            found = pattern.search(line)
            if found and found[1] not in unproved and not named_theorems(comment):
                fail(f"{path.relative_to(root)}: {found[1]} names no theorem")
            comment = ""


def make_tie(build, extracted, program):
    """Builds a program of extracted definitions; returns its folder."""
    folder = build / program  # a separate one: compilers of all ties may run in parallel
    folder.mkdir()
    sources = ["tie_hash.ml", "tie_queries.ml", f"{extracted}.ml", f"{program}.ml"]
    for name in sources:  # without extracted.mli, which would hide types
        shutil.copy(build / name, folder)
    checker.run(folder, "ocamlfind", "ocamlopt", "-package", "zarith", "-linkpkg", "-w", "-a", "-unsafe", "-inline",
                "100", *sources, "-o", "program")
    return folder


def tie_lines(pool, build):
    """Returns futures of the output of all programs of extracted definitions, part by part, in the order of tie.txt."""
    made = {program: pool.submit(make_tie, build, extracted, program) for extracted, program in TIE_PROGRAMS.items()}
    return [pool.submit(checker.run, folder.result(), "./program", *part)
            for program, folder in made.items() for part in TIE_PARTS.get(program, [()])]


def check_tie(build, tables):
    """Fails if the table for the C++ code differs from the results of the extracted definitions."""
    table = "".join(tables)
    checker.compare(table, proofs / "tie.txt", build)
    print(f"\ntie.txt: {len(table.splitlines())} hashes equal those of the definitions")


def main(build, passed):
    start = time.monotonic()
    files = digest()
    found = checker.theorems(proofs, LIBRARY)
    compare_with_readme(found)
    compare_with_code(found)
    try:
        ties.count()
    except ValueError as why:
        fail(why)
    if passed and (not PASSED.exists() or PASSED.read_text() != files):
        fail("the files differ from those of the last full check that passed")
    if passed:
        print(f"{len(found)} theorems: names compared; the files are those of the last full check that passed")
    if build is None:
        return
    checker.compile_all(proofs, build, proofs.glob("*.ml"))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:  # each on one core, the longest first
        compiled = pool.submit(checker.check_compiled, build, LIBRARY, checker.files_of(proofs, LIBRARY))
        tables = tie_lines(pool, build)
        used = pool.submit(checker.assumptions, build, LIBRARY, found)
        stated = pool.submit(checker.statements, build, LIBRARY, found)
        for name, (theorems, axioms) in used.result().items():
            short = ", ".join(axiom.rsplit(".", 1)[-1] for axiom in axioms)
            print(textwrap.fill(f"{name}.v, {short or 'no axioms'}: {', '.join(theorems)}", 120, subsequent_indent="    "))
        checker.compare(stated.result(), proofs / "statements.txt", build)
        check_tie(build, [table.result() for table in tables])
        compiled.result()
    print(records.table())
    PASSED.write_text(files)
    print(f"{len(found)} theorems checked in {time.monotonic() - start:.0f} s")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    what = parser.add_mutually_exclusive_group()
    what.add_argument("build_folder", nargs="?", type=Path, help="where to build; its contents are removed")
    what.add_argument("--names", action="store_true", help="only compare names")
    what.add_argument("--passed", action="store_true", help="compare names, and the files with those of the last full check")
    options = parser.parse_args()
    if not (options.names or options.passed) and options.build_folder is None:
        parser.error("a build folder, --names or --passed is required")
    try:
        main(options.build_folder and options.build_folder.resolve(), options.passed)
    except checker.Refused as why:
        fail(why)
