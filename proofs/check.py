#!/usr/bin/env python3
"""Builds the proofs from scratch and prints every theorem with the axioms it rests on.

usage: check.py BUILD_FOLDER
       check.py --names

Fails where a proof is missing or unfinished, rests on another axiom than those of Coq's real numbers
and classical logic; where README.md and the files do not name the same theorems, or the C++ code names
one that is not there; and where tie.txt, to which tests/errbound/validation/tie_test.cpp holds the C++ code, is not what the
proofs' definitions compute. --names only compares names, and needs no Coq.
"""
import os
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

# Coq's standard library has its real numbers and classical logic from these; Flocq adds none.
ALLOWED = {
    "ClassicalDedekindReals.sig_not_dec",
    "ClassicalDedekindReals.sig_forall_dec",
    "FunctionalExtensionality.functional_extensionality_dep",
    "Classical_Prop.classic",
}
# What leaves a statement without proof, or switches a check of Coq's off.
UNPROVED = re.compile(
    r"\b(Admitted|admit|Abort|Axioms?|Parameters?|Conjecture|Admit\s+Obligations|bypass_check)\b"
    r"|\bUnset\s+(Guard|Positivity|Universe)\s+Check")

proofs = Path(__file__).resolve().parent
root = proofs.parent
# Operations of a bound rule, each of which must name its theorem.
ALL = {"exact", "within", "error", "sign", "add", "subtract", "multiply", "divide", "scale"}
OPERATION = re.compile(r"static (?:constexpr )?(?:bound<T>|T|sign_type) "
                       r"(exact|within|error|sign|add|subtract|multiply|divide|scale)\(")
# A function of tracked numbers, each of which must, too.
FUNCTION = re.compile(r"^constexpr tracked<T, Rule> (\w+)\(")


def fail(message):
    sys.exit(f"proofs: {message}")


def without_comments(text):
    """Coq's comments nest."""
    out, depth, i = [], 0, 0
    while i < len(text):
        pair = text[i:i + 2]
        if pair == "(*":
            depth, i = depth + 1, i + 2
        elif pair == "*)" and depth:
            depth, i = depth - 1, i + 2
        else:
            if not depth:
                out.append(text[i])
            i += 1
    return "".join(out)


def theorems():
    """File's name without .v, and what it calls a theorem; _CoqProject's order."""
    listed = [line[:-2] for line in (proofs / "_CoqProject").read_text().split() if line.endswith(".v")]
    there = sorted(path.stem for path in proofs.glob("*.v"))
    if sorted(listed) != there:
        fail(f"_CoqProject lists {sorted(listed)}, the folder holds {there}")
    found = []
    for name in listed:
        text = without_comments((proofs / f"{name}.v").read_text())
        if hole := UNPROVED.search(text):
            fail(f"{name}.v: {hole.group()}")
        found += [(name, theorem) for theorem in re.findall(r"^Theorem (\w+)", text, re.MULTILINE)]
    return found


def compare_with_readme(found):
    named = re.findall(r"^\| `(\w+)` \|", (proofs / "README.md").read_text(), re.MULTILINE)
    missing = [theorem for _, theorem in found if theorem not in named]
    unknown = [name for name in named if name not in [theorem for _, theorem in found]]
    if missing or unknown:
        fail(f"README.md does not name {missing}; it names {unknown}, which are no theorems")


def named_theorems(comment):
    """What a C++ comment names: proofs/File.v, theorem, theorem"""
    text = re.sub(r"\s*\n\s*//+!?<?\s*", " ", comment)
    if unlisted := re.search(r"proofs/\w+\.v(?!, \w)|proofs/\w+\.v, (?:\w+, )*\w+ and \w*_\w*", text):
        fail(f"'{unlisted.group()}': theorems are named as proofs/File.v, theorem, theorem")
    return [(file, name) for file, names in re.findall(r"proofs/(\w+)\.v, ((?:\w+, )*\w+)", text)
            for name in names.split(", ")]


def compare_with_code(found):
    """Every theorem that the C++ code names is there; every operation of a bound rule names one, and
    every function of tracked numbers."""
    known = set(found)
    for folder in ("include", "ccd", "errbound", "tests"):
        for path in sorted((root / folder).rglob("*.[hc]pp")):
            for name in named_theorems(path.read_text()):
                if name not in known:
                    fail(f"{path.relative_to(root)} names {name[1]} of {name[0]}.v, which is no theorem")
    for path in sorted((root / "include/errbound/rules").glob("*.hpp")):
        text = path.read_text()
        unproved = ALL if path.stem == "none" else set()  # `none` promises nothing
        if "has_division = false" in text:
            unproved = unproved | {"divide"}
        every_one_names(OPERATION, path, text, unproved)
    path = root / "include/errbound/functions.hpp"
    every_one_names(FUNCTION, path, path.read_text().split("}  // namespace detail")[1], set())


def every_one_names(pattern, path, text, unproved):
    """Whatever the pattern finds has a comment before it that names a theorem."""
    comment = ""
    for line in text.splitlines():
        if line.lstrip().startswith("//"):
            comment += line + "\n"
        elif not line.lstrip().startswith("template"):
            found = pattern.search(line)
            if found and found[1] not in unproved and not named_theorems(comment):
                fail(f"{path.relative_to(root)}: {found[1]} names no theorem")
            comment = ""


def check_tie(build):
    """The table that the C++ code is held to is what the extracted definitions compute."""
    run(build, "ocamlfind", "ocamlopt", "-w", "-a", "-unsafe", "-inline", "100",
        "code.mli", "code.ml", "tie.ml", "-o", "tie")
    table = run(build, "./tie")
    if table != (proofs / "tie.txt").read_text():
        (build / "tie.txt").write_text(table)
        fail(f"proofs/tie.txt is not what the definitions compute, {build / 'tie.txt'}: copy it, and the "
             "C++ code has to follow")
    print(f"\ntie.txt: {len(table.splitlines())} hashes as the definitions compute them")


def run(build, *command):
    result = subprocess.run(command, cwd=build, capture_output=True, text=True)
    if result.returncode:
        fail(f"{' '.join(command)}\n{result.stdout}{result.stderr}")
    return result.stdout


def axioms(build, found):
    """Axioms of each theorem, from what Coq prints between one theorem's name and the next."""
    script = [f"From Errbound Require {' '.join(dict.fromkeys(name for name, _ in found))}."]
    for name, theorem in found:
        script += [f'Goal True. idtac "theorem {name}.{theorem}". exact I. Qed.',
                   f"Print Assumptions {name}.{theorem}."]
    (build / "assumptions.v").write_text("\n".join(script) + "\n")
    blocks = re.split(r"^theorem (\S+)\n", run(build, "coqc", "-Q", ".", "Errbound", "assumptions.v"),
                      flags=re.MULTILINE)[1:]
    printed = dict(zip(blocks[::2], blocks[1::2]))
    for name, theorem in found:
        text = printed.get(f"{name}.{theorem}", "")
        if "Closed under the global context" in text:
            yield name, theorem, []
        elif "Axioms:" in text:
            yield name, theorem, re.findall(r"^(\S+)(?= :|$)", text.split("Axioms:")[1], re.MULTILINE)
        else:
            fail(f"no assumptions printed for {name}.{theorem}")


def main(build):
    start = time.monotonic()
    found = theorems()
    compare_with_readme(found)
    compare_with_code(found)
    if build is None:
        return
    shutil.rmtree(build, ignore_errors=True)
    build.mkdir(parents=True)
    for path in [*proofs.glob("*.v"), proofs / "_CoqProject", proofs / "tie.ml"]:
        shutil.copy(path, build)
    run(build, "coq_makefile", "-f", "_CoqProject", "-o", "Makefile")
    run(build, "make", f"-j{os.cpu_count()}")

    wrong = []
    for name, theorem, used in axioms(build, found):
        short = sorted(axiom.rsplit(".", 1)[-1] for axiom in used)
        print(f"{name + '.v':<18}{theorem:<34}{', '.join(short) or 'no axioms'}")
        wrong += [f"{theorem} rests on {axiom}" for axiom in used if axiom not in ALLOWED]
    if wrong:
        fail("; ".join(wrong))
    check_tie(build)
    print(f"{len(found)} theorems checked in {time.monotonic() - start:.0f} s")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(None if sys.argv[1] == "--names" else Path(sys.argv[1]).resolve())
