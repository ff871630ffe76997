#!/usr/bin/env python3
"""Builds the proofs from scratch and prints every theorem with the axioms it rests on.

usage: check.py BUILD_FOLDER

Fails where a proof is missing or unfinished, rests on another axiom than those of Coq's real numbers
and classical logic, or where README.md and the files do not name the same theorems.
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
    shutil.rmtree(build, ignore_errors=True)
    build.mkdir(parents=True)
    for path in [*proofs.glob("*.v"), proofs / "_CoqProject"]:
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
    print(f"\n{len(found)} theorems checked in {time.monotonic() - start:.0f} s")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(Path(sys.argv[1]).resolve())
