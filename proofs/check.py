#!/usr/bin/env python3
"""Builds the proofs from scratch and prints the theorems of each file with their axioms.

Fails if a proof is missing or unfinished, or rests on axioms other than those of Coq's real numbers and classical logic
(checker.py). Fails if a statement differs from its digest in digests.txt, or from the text of Main.v, which restates the
main theorems for readers. Fails if a file's first comment or the C++ code name other theorems than the files have. Fails
if tie.txt, with which tests/errbound/validation/tie_test.cpp and tests/proofs compare the C++ code, differs from the
results of the proofs' definitions.

A full check that passes writes a digest of the files it depends on to passed.txt, which is committed.
"""
import argparse
import collections
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
# The file that restates theorems for readers, and the digests of the statements of all others.
MAIN, DIGESTS = "Main", proofs / "digests.txt"
# The files that Coq extracts, and the programs that run them.
TIE_PROGRAMS = {"code": "tie", "symbols": "tie_symbols", "integers": "tie_integers", "floats": "tie_floats",
                "filters": "tie_filters", "roots": "tie_roots", "words": "tie_words", "times": "tie_times"}
# The programs that read inputs of a tie, which tests/proofs/tie_inputs.cpp writes.
INPUTS = {"tie_integers": "integers", "tie_floats": "floats", "tie_times": "times"}
# Parts of programs that take many minutes, which run in parallel.
TIE_PARTS = {"tie": [("words",), ("tiny_3_3",), ("tiny_5_3",), ("tiny_4_4",), ("floats",)]}


PASSED = proofs / "passed.txt"


def fail(message):
    sys.exit(f"proofs: {message}")


def digest():
    """Returns a digest of every file that a full check depends on, except the C++ code and what names its parts, which
    are always compared. Comments and white space of proofs do not affect it."""
    sum_of_all = hashlib.sha256()
    for path in sorted([*proofs.rglob("*.v"), *proofs.rglob("*.ml"), proofs / "check.py", proofs / "checker.py",
                        proofs / "tie.txt", DIGESTS], key=lambda path: path.name):
        text = path.read_text()
        if path.suffix == ".v":
            text = checker.words_of(text)
        content = text.encode()
        sum_of_all.update(f"{path.name} {len(content)}\n".encode() + content)
    return sum_of_all.hexdigest() + "\n"


def head_of(name):
    """Returns a file's first comment."""
    path = checker.files_of(proofs, LIBRARY)[name]
    return re.match(r"\(\*\*? *(.*?)\*\)", (proofs / f"{path}.v").read_text(), re.DOTALL)[1].rstrip()


def compare_with_texts(found):
    """Fails if digests.txt has other files or numbers of theorems, or the files' first comments name other theorems."""
    theorems = collections.Counter(name for name, _ in found if name != MAIN)
    digests = {name: len(each) for name, each in checker.recorded(DIGESTS).items()}
    if digests != theorems:
        different = sorted({name for name, _ in digests.items() ^ theorems.items()})
        fail(f"digests.txt must have a digest for each theorem of each file; different: {' '.join(different[:20])}")
    for name, theorem in found:
        if name != MAIN and theorem not in re.findall(r"[\w']+", head_of(name)):
            fail(f"{name}.v: its first comment does not name {theorem}")


def named_theorems(comment):
    """Returns (file, theorem) for the theorems that a C++ comment names as proofs/File.v, theorem, theorem, with the
    file's folder if it has one."""
    text = re.sub(r"\s*\n\s*//+!?<?\s*", " ", comment)
    if unlisted := re.search(r"proofs/[\w/]+\.v(?!, \w)|proofs/[\w/]+\.v, (?:\w+, )*\w+ and \w*_\w*", text):
        fail(f"'{unlisted.group()}': theorems are named as proofs/File.v, theorem, theorem")
    return [(file, name) for file, names in re.findall(r"proofs/([\w/]+)\.v, ((?:\w+, )*\w+)", text)
            for name in names.split(", ")]


def compare_with_code(found):
    """Fails if the C++ code names a theorem that does not exist. Operations of a bound rule and functions of tracked
    numbers must name one."""
    paths = checker.files_of(proofs, LIBRARY)
    known = {(paths[file], name) for file, name in found}
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


def write_inputs(build):
    """Writes the inputs of ties that read them."""
    checker.run(build, os.environ.get("CXX", "g++"), "-std=c++20", "-O1", "-ffp-contract=off", '-DERRBOUND_TIE_TABLE=""',
                f"-I{root}/include", f"-I{root}", root / "tests/proofs/tie_inputs.cpp", "-o", "tie_inputs")
    for program, tie in INPUTS.items():
        (build / f"{program}.in").write_text(checker.run(build, "./tie_inputs", tie))


def folder_of(build, program):
    return build / f"{program}_program"


def make_tie(build, extracted, program):
    """Builds a program of extracted definitions; returns its folder."""
    folder = folder_of(build, program)  # a separate one: compilers of all ties may run in parallel
    folder.mkdir()
    sources = ["tie_hash.ml", "tie_queries.ml", f"{extracted}.ml", f"{program}.ml"]
    for name in sources:  # without extracted.mli, which would hide types
        shutil.copy(build / name, folder)
    checker.run(folder, "ocamlfind", "ocamlopt", "-package", "zarith", "-linkpkg", "-w", "-a", "-unsafe", "-inline",
                "100", *sources, "-o", "program")
    return folder


def tie_lines(pool, build, programs=TIE_PROGRAMS.values()):
    """Returns futures of the output of programs of extracted definitions, part by part, in the order of tie.txt."""
    write_inputs(build)
    made = {program: pool.submit(make_tie, build, extracted, program)
            for extracted, program in TIE_PROGRAMS.items() if program in programs}
    return [pool.submit(checker.run, folder.result(), "./program", *part, given=build / f"{program}.in")
            for program, folder in made.items() for part in TIE_PARTS.get(program, [()])]


def check_tie(build, outputs):
    """Fails if the table for the C++ code differs from the results of the extracted definitions."""
    lines = [line for text in outputs for line in text.splitlines()]
    checker.compare(ties.results(lines), proofs / "tie.txt", build, "\n".join(ties.differences(lines)))
    print(f"\ntie.txt: {len(lines)} hashes equal those of the definitions")


def check_names():
    """Compares all names; returns the theorems."""
    found = checker.theorems(proofs, LIBRARY)
    checker.restated(proofs, MAIN, found)
    compare_with_texts(found)
    compare_with_code(found)
    try:
        ties.count()
    except ValueError as why:
        fail(why)
    return found


def check_all(build):
    start, files, found = time.monotonic(), digest(), check_names()
    checker.compile_all(proofs, build, proofs.rglob("*.ml"))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:  # each on one core, the longest first
        compiled = pool.submit(checker.check_compiled, build, LIBRARY, checker.files_of(proofs, LIBRARY).values())
        outputs = tie_lines(pool, build)
        used = pool.submit(checker.assumptions, build, LIBRARY, found)
        stated = pool.submit(checker.statements, build, LIBRARY, found).result()
        for name, (theorems, axioms) in used.result().items():
            short = ", ".join(axiom.rsplit(".", 1)[-1] for axiom in axioms)
            print(textwrap.fill(f"{name}.v, {short or 'no axioms'}: {', '.join(theorems)}", 120, subsequent_indent="    "))
        checker.compare_restated(proofs, MAIN, found, stated)
        others = {name: statement for name, statement in stated.items() if not name.startswith(f"{MAIN}.")}
        checker.compare(checker.record_of(others), DIGESTS, build, checker.differing(others, DIGESTS))
        check_tie(build, [output.result() for output in outputs])
        compiled.result()
    print(records.table())
    PASSED.write_text(files)
    print(f"{len(found)} theorems checked in {time.monotonic() - start:.0f} s")


def show(build, chosen):
    """Prints statements of a compiled folder: of the files and theorems chosen, or those that differ from digests.txt.
    Then it also writes the new digests to that folder."""
    found = [each for each in checker.theorems(proofs, LIBRARY) if each[0] != MAIN]
    if chosen:
        found = [(name, theorem) for name, theorem in found if {name, theorem, f"{name}.{theorem}"} & set(chosen)]
    stated = checker.statements(build, LIBRARY, found)
    if chosen:
        print("".join(f"{name}\n     : {statement}\n\n" for name, statement in stated.items()), end="")
    else:
        print(checker.differing(stated, DIGESTS), end="")
        (build / DIGESTS.name).write_text(checker.record_of(stated))


def run_ties(build, chosen):
    """Runs the programs of a compiled folder, all or those chosen, and prints their lines that differ from tie.txt."""
    for path in proofs.rglob("*.ml"):
        shutil.copy(path, build)
    for program in TIE_PROGRAMS.values():
        shutil.rmtree(folder_of(build, program), ignore_errors=True)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        outputs = tie_lines(pool, build, chosen or TIE_PROGRAMS.values())
        lines = [line for output in outputs for line in output.result().splitlines()]
    print("\n".join([*ties.differences(lines), f"{len(lines)} hashes compared with tie.txt"]))


def main(options):
    if options.list is not None:
        words = [word.lower() for word in options.list]
        print("\n\n".join(f"{name}.v: {head_of(name)}" for name in checker.files_of(proofs, LIBRARY)
                          if all(word in f"{name}.v: {head_of(name)}".lower() for word in words)))
    elif options.show:
        show(Path(options.show[0]).resolve(), options.show[1:])
    elif options.ties:
        run_ties(Path(options.ties[0]).resolve(), options.ties[1:])
    elif options.build_folder:
        check_all(options.build_folder.resolve())
    else:
        found = check_names()
        if options.passed and (not PASSED.exists() or PASSED.read_text() != digest()):
            fail("the files differ from those of the last full check that passed")
        if options.passed:
            print(f"{len(found)} theorems: names compared; the files are those of the last full check that passed")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("build_folder", nargs="?", type=Path, help="where to build; its contents are removed")
    what.add_argument("--names", action="store_true", help="only compare names, without Coq")
    what.add_argument("--passed", action="store_true", help="compare names, and the files with those of the last full check")
    what.add_argument("--list", nargs="*", metavar="WORD", help="print the files' first comments, all or those with each WORD")
    what.add_argument("--show", nargs="+", metavar=("BUILD", "NAME"),
                      help="print the statements of files or theorems, or those that differ from digests.txt, and write "
                      "the new digests to BUILD")
    what.add_argument("--ties", nargs="+", metavar=("BUILD", "PROGRAM"),
                      help="run the extracted programs again, and print the results that differ from tie.txt")
    try:
        main(parser.parse_args())
    except checker.Refused as why:
        fail(why)
