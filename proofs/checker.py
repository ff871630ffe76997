"""Reads, builds and checks a folder of Coq files, so that nothing is believed that Coq does not say.

A folder has _CoqProject, which names its files and nothing else, and those files. What a text search
can miss, two commands find: Print Assumptions of each theorem, whose every line must be understood,
and coqchk, which checks the compiled files again and prints what they rest on by full names. The
statements of theorems are printed, for comparison with a text that people read.
"""
import os
import re
import secrets
import shutil
import subprocess
from pathlib import Path

# Coq's standard library has its real numbers and classical logic from these; Flocq adds none. By
# name and type: another file may have an axiom of the same name.
ALLOWED = {
    "ClassicalDedekindReals.sig_not_dec": "forall P : Prop, {~ ~ P} + {~ P}",
    "ClassicalDedekindReals.sig_forall_dec":
        "forall P : nat -> Prop, (forall n : nat, {P n} + {~ P n}) -> {n : nat | ~ P n} + {forall n : nat, P n}",
    "FunctionalExtensionality.functional_extensionality_dep":
        "forall (A : Type) (B : A -> Type) (f g : forall x : A, B x), (forall x : A, f x = g x) -> f = g",
    "Classical_Prop.classic": "forall P : Prop, P \\/ ~ P",
}
# coqchk counts what modules of the standard library hide as axioms, too: only Coq's own may be there.
ALLOWED_FULL = re.compile(
    r"Coq\.(Reals\.ClassicalDedekindReals\.(sig_not_dec|sig_forall_dec)"
    r"|Logic\.(FunctionalExtensionality\.functional_extensionality_dep|Classical_Prop\.classic)"
    r"|Reals\.Rdefinitions\.R\w+Impl\.\w+|ssr\.ssrunder\.Under_rel\.\w+)")
# What leaves a statement without proof, or switches a check of Coq's off; what changes how statements are
# printed; and modules, in which a theorem would have another name.
REFUSED = re.compile(
    r"\b(Admitted|admit|Abort|Axioms?|Parameters?|Conjecture|Admit\s+Obligations|bypass_check)\b"
    r"|\b(Unset|Set)\s+(Guard|Positivity|Universe)\s+Checking|\bDefinitional\s+UIP\b"
    r"|\b(Unset|Set)\s+Printing\b|\b(Module|Functor|Include|Redirect)\b"
    r"|\b(Load|Declare\s+ML\s+Module|Add\s+(Rec\s+)?(LoadPath|ML\s+Path))\b")
# Of programs, which only files of these names make.
EXTRACTION, EXTRACTING = re.compile(r"\b(Recursive\s+|Separate\s+)?Extraction\b"), re.compile("Tie")
SUPPOSED = re.compile(r"\b(?:(Section)\s+\w+|(End)\s+\w+|(Hypothes[ie]s|Variables?|Context))\b")


class Refused(Exception):
    """What is wrong, in a line or more."""


def code_of(text):
    """Coq's code without comments, which nest, and what strings hold, which comments may have, too."""
    out, depth, i = [], 0, 0
    while i < len(text):
        pair = text[i:i + 2]
        if text[i] == '"':
            end = i + 1  # two quotes in a string are one that it holds
            while text[end:end + 1] != '"' or text[end:end + 2] == '""':
                end += 2 if text[end:end + 2] == '""' else 1
                if end >= len(text):
                    raise Refused("found a string that does not end")
            if not depth:
                out.append('""')
            i = end + 1
        elif pair == "(*":
            depth, i = depth + 1, i + 2
        elif pair == "*)" and depth:
            depth, i = depth - 1, i + 2
            out.append("" if depth else " ")  # words on both sides are two
        else:
            if not depth:
                out.append(text[i])
            i += 1
    if depth:
        raise Refused("found a comment that does not end")
    return "".join(out)


def files_of(folder, library):
    """Names of the folder's files without .v, in _CoqProject's order. It has no other words, such as
    options that would weaken the kernel."""
    lines = [line.strip() for line in (folder / "_CoqProject").read_text().splitlines() if line.strip()]
    if not lines or lines[0] != f"-Q . {library}":
        raise Refused(f"_CoqProject: found '{lines[0] if lines else ''}', expected -Q . {library}")
    for line in lines[1:]:
        if not re.fullmatch(r"[A-Z]\w*\.v", line):
            raise Refused(f"_CoqProject: found '{line}', expected a file's name")
    listed = [line[:-2] for line in lines[1:]]
    there = sorted(path.stem for path in folder.glob("*.v"))
    if sorted(listed) != there:
        raise Refused(f"_CoqProject lists {sorted(listed)}, the folder holds {there}")
    return listed


def theorems(folder, library):
    """File and name of what is called a theorem, in order."""
    found = []
    for name in files_of(folder, library):
        try:
            text = code_of((folder / f"{name}.v").read_text())
        except Refused as why:
            raise Refused(f"{name}.v: {why}") from None
        if hole := REFUSED.search(text) or (not EXTRACTING.match(name) and EXTRACTION.search(text)):
            raise Refused(f"{name}.v: found {hole.group()}")
        if supposed := supposed_outside(text):
            raise Refused(f"{name}.v: found {supposed} outside of sections")
        named = re.findall(r"^Theorem ([\w']+)", text, re.MULTILINE)
        if len(named) != len(re.findall(r"\bTheorem\b", text)):
            raise Refused(f"{name}.v: found a Theorem that does not begin a line, with its name behind it")
        found += [(name, theorem) for theorem in named]
    return found


def supposed_outside(text):
    """What the text supposes where no section ends that; or None."""
    depth = 0
    for start, end, word in SUPPOSED.findall(text):
        depth += bool(start) - bool(end)
        if word and not depth:
            return word
    return None


def run(folder, *command, silent=False):
    """What it prints, errors and warnings among it: none if it has to be `silent` of these."""
    result = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE if silent else subprocess.STDOUT, text=True)
    if result.returncode or result.stderr:
        raise Refused(f"{' '.join(command[:4])}\n{result.stdout}{result.stderr or ''}")
    return result.stdout


def compile_all(folder, build, more=()):
    """Compiles a copy of the folder's files, and then puts `more` beside them."""
    if folder.resolve().is_relative_to(build.resolve()):
        raise Refused(f"{build}: found a build folder that holds the proofs, expected another: what it holds is removed")
    shutil.rmtree(build, ignore_errors=True)
    build.mkdir(parents=True)
    for path in [*folder.glob("*.v"), folder / "_CoqProject"]:
        shutil.copy(path, build)
    run(build, "coq_makefile", "-f", "_CoqProject", "-o", "Makefile")
    run(build, "make", f"-j{os.cpu_count()}")
    for path in more:
        shutil.copy(path, build)


def outputs(build, library, found, subject, commands, *before):
    """Returns Coq's output of each command, by its name; `before` runs first. A random mark separates outputs, so that
    no file can imitate it."""
    mark = secrets.token_hex(16)
    script = [f"From {library} Require {' '.join(dict.fromkeys(name for name, _ in found))}.", *before,
              "Set Printing Width 100.", "Set Printing Depth 1000000.", "Set Printing Implicit."]
    for name, command in commands.items():
        script += [f'Goal True. idtac "{mark} {name}". exact I. Qed.', command]
    file = f"print_{subject}.v"
    (build / file).write_text("\n".join(script) + "\n")
    blocks = re.split(rf"^{mark} (\S+)\n", run(build, "coqc", "-Q", ".", library, file, silent=True), flags=re.MULTILINE)
    if blocks[0] or blocks[1::2] != list(commands):
        raise Refused(f"Coq did not run each command of {subject} once: {blocks[0][:200]}")
    return dict(zip(blocks[1::2], blocks[2::2]))


def axioms_of(text):
    """Name and type of each axiom that Print Assumptions names. Every line has to be understood."""
    lines = text.rstrip("\n").split("\n")
    if lines == ["Closed under the global context"]:
        return {}
    if lines[0] != "Axioms:":
        raise Refused(f"found '{lines[0]}', expected axioms")
    found, name = {}, None
    for line in lines[1:]:
        if entry := re.fullmatch(r"([\w.']+)( : .*)?", line):
            name = entry[1]
            found[name] = entry[2] or ""
        elif name and line.startswith(" "):
            found[name] += " " + line
        else:
            raise Refused(f"found '{line}', expected an axiom and its type")
    return {name: " ".join(type_.split()).removeprefix(":").strip() for name, type_ in found.items()}


def assumptions(build, library, found):
    """By file, its theorems and the names of the axioms that they rest on, which are allowed. Coq runs once for all
    that a file has, since it looks through the libraries each time."""
    files = {name: [theorem for of, theorem in found if of == name] for name, _ in found}
    together = {name: ", ".join(f"@{name}.{theorem}" for theorem in theorems) for name, theorems in files.items()}
    commands = {name: f"Definition of_{name} := ({all_}).\nPrint Assumptions of_{name}."
                for name, all_ in together.items()}
    used = {}
    for name, text in outputs(build, library, found, "assumptions", commands).items():
        try:
            axioms = axioms_of(text)
        except Refused as why:
            raise Refused(f"{name}.v: {why}") from None
        for axiom, type_ in axioms.items():
            if ALLOWED.get(axiom) != type_:
                raise Refused(f"{name}.v: a theorem rests on {axiom} : {type_}")
        used[name] = files[name], sorted(axioms)
    return used


def statements(build, library, found):
    """What the theorems state, with what sections supposed, in the real numbers' notations and no others."""
    notations = ("From Coq Require Import ZArith Reals.", "Open Scope R_scope.")
    names = [f"{name}.{theorem}" for name, theorem in found]
    answers = outputs(build, library, found, "statements", {name: f"Check @{name}." for name in names}, *notations)
    for name, answer in answers.items():
        if not re.match(rf"@?{re.escape(name)}\n +: ", answer) or "..." in answer or "\nwhere" in answer:
            raise Refused(f"{name}: found '{answer}', expected a whole statement")
    return "".join(re.sub(r"^\S+\n", f"{name}\n", answers[name].rstrip("\n")) + "\n\n" for name in names)


def compare(text, path, build):
    """Of what is kept in `path`, and made anew."""
    if not path.exists() or path.read_text() != text:
        (build / path.name).write_text(text)
        raise Refused(f"{path.name} is not what Coq says, {build / path.name} is: if that is meant, copy it")


def check_compiled(build, library, names):
    """By coqchk, of what was compiled; of the libraries it believes what their packages hold."""
    printed = run(build, "coqchk", "-o", "-silent", "-Q", ".", library,
                  *(word for name in names for word in ("-norec", f"{library}.{name}")))
    parts = dict(re.findall(r"^\* ([^:\n]+):(.*?)(?=^\* |\Z)", printed, re.MULTILINE | re.DOTALL))
    expected = {"Theory", "Axioms", "Constants/Inductives relying on type-in-type",
                "Constants/Inductives relying on unsafe (co)fixpoints", "Inductives whose positivity is assumed"}
    if set(parts) != expected:
        raise Refused(f"coqchk: found {sorted(parts)}, expected {sorted(expected)}")
    for part, text in parts.items():
        if part == "Theory":
            wrong = text.split() != "Set is predicative".split() and text.strip()
        elif part == "Axioms":
            wrong = [name for name in text.split() if name != "<none>" and not ALLOWED_FULL.fullmatch(name)]
        else:
            wrong = text.strip() != "<none>" and text.strip()
        if wrong:
            raise Refused(f"coqchk: {part}: {wrong}")
