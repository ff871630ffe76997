"""Reads, builds and checks a folder of Coq files. Nothing is accepted without Coq's confirmation.

A folder has those files and _CoqProject, which only names the library. A text search could miss an assumption, so Coq confirms
it twice. Print Assumptions lists the axioms of each theorem, and every line of its output must be recognised. coqchk
checks the compiled files again and lists their axioms by full names. Coq prints the theorems' statements. A file for
readers must have the printed text of its theorems, and a record the digests of all statements.
"""
import hashlib
import os
import re
import secrets
import shutil
import subprocess
import textwrap
from pathlib import Path

# Coq's standard library builds its real numbers and classical logic on these; Flocq adds none. They are compared by name
# and type, since another file may have an axiom of the same name.
ALLOWED = {
    "ClassicalDedekindReals.sig_not_dec": "forall P : Prop, {~ ~ P} + {~ P}",
    "ClassicalDedekindReals.sig_forall_dec":
        "forall P : nat -> Prop, (forall n : nat, {P n} + {~ P n}) -> {n : nat | ~ P n} + {forall n : nat, P n}",
    "FunctionalExtensionality.functional_extensionality_dep":
        "forall (A : Type) (B : A -> Type) (f g : forall x : A, B x), (forall x : A, f x = g x) -> f = g",
    "Classical_Prop.classic": "forall P : Prop, P \\/ ~ P",
}
# coqchk also counts hidden constants of the standard library's modules as axioms. Only those of Coq are allowed.
ALLOWED_FULL = re.compile(
    r"Coq\.(Reals\.ClassicalDedekindReals\.(sig_not_dec|sig_forall_dec)"
    r"|Logic\.(FunctionalExtensionality\.functional_extensionality_dep|Classical_Prop\.classic)"
    r"|Reals\.Rdefinitions\.R\w+Impl\.\w+|ssr\.ssrunder\.Under_rel\.\w+)")
# Commands that leave a statement without proof, disable a check of Coq, or change how statements are printed; and
# modules, in which a theorem would have another name.
REFUSED = re.compile(
    r"\b(Admitted|admit|Abort|Axioms?|Parameters?|Conjecture|Admit\s+Obligations|bypass_check)\b"
    r"|\b(Unset|Set)\s+(Guard|Positivity|Universe)\s+Checking|\bDefinitional\s+UIP\b"
    r"|\b(Unset|Set)\s+Printing\b|\b(Module|Functor|Include|Redirect)\b"
    r"|\b(Load|Declare\s+ML\s+Module|Add\s+(Rec\s+)?(LoadPath|ML\s+Path))\b")
# Extraction of programs, and the names of files that may use it.
EXTRACTION, EXTRACTING = re.compile(r"\b(Recursive\s+|Separate\s+)?Extraction\b"), re.compile("Tie")
SUPPOSED = re.compile(r"\b(?:(Section)\s+\w+|(End)\s+\w+|(Hypothes[ie]s|Variables?|Context))\b")


class Refused(Exception):
    """The reason why a folder is rejected, in a line or more."""


def code_of(text, strings=False):
    """Returns Coq's code without comments, which nest, and unless `strings` with empty strings. Comments may contain
    strings, too."""
    out, depth, i = [], 0, 0
    while i < len(text):
        pair = text[i:i + 2]
        if text[i] == '"':
            end = i + 1  # two quotes in a string stand for one
            while text[end:end + 1] != '"' or text[end:end + 2] == '""':
                end += 2 if text[end:end + 2] == '""' else 1
                if end >= len(text):
                    raise Refused("found a string that does not end")
            if not depth:
                out.append(text[i:end + 1] if strings else '""')
            i = end + 1
        elif pair == "(*":
            depth, i = depth + 1, i + 2
        elif pair == "*)" and depth:
            depth, i = depth - 1, i + 2
            out.append("" if depth else " ")  # words on both sides remain two
        else:
            if not depth:
                out.append(text[i])
            i += 1
    if depth:
        raise Refused("found a comment that does not end")
    return "".join(out)


def words_of(text):
    """Returns Coq's code without comments, with one space for white space outside of strings."""
    return re.sub(r'("(?:[^"]|"")*")|\s+', lambda m: m[1] or " ", code_of(text, strings=True)).strip()


def files_of(folder, library):
    """Returns the paths of the files by their names, both without .v, in the order of the paths. _CoqProject must have no
    other words than the library, such as options that would weaken the kernel."""
    project = (folder / "_CoqProject").read_text().strip()
    if project != f"-Q . {library}":
        raise Refused(f"_CoqProject: found '{project}', expected -Q . {library}")
    there = sorted(str(path.relative_to(folder)) for path in folder.rglob("*.v"))
    for path in there:
        if not re.fullmatch(r"(?:[a-z]+/)?[A-Z]\w*\.v", path):
            raise Refused(f"found the file {path}, expected File.v or folder/File.v")
    files = {path.rsplit("/", 1)[-1][:-2]: path[:-2] for path in there}
    if len(files) != len(there):
        raise Refused("found two files with one name")
    return files


def theorems(folder, library):
    """Returns (file, name) of every Theorem, in order."""
    found = []
    for name, path in files_of(folder, library).items():
        try:
            text = code_of((folder / f"{path}.v").read_text())
        except Refused as why:
            raise Refused(f"{name}.v: {why}") from None
        if hole := REFUSED.search(text) or (not EXTRACTING.match(name) and EXTRACTION.search(text)):
            raise Refused(f"{name}.v: found {hole.group()}")
        if supposed := supposed_outside(text):
            raise Refused(f"{name}.v: found {supposed} outside of sections")
        named = re.findall(r"^Theorem ([\w']+)", text, re.MULTILINE)
        if len(named) != len(re.findall(r"\bTheorem\b", text)):
            raise Refused(f"{name}.v: found a Theorem that does not begin a line, followed by its name")
        found += [(name, theorem) for theorem in named]
    return found


def supposed_outside(text):
    """Returns a keyword that assumes something outside of sections, or None."""
    depth = 0
    for start, end, word in SUPPOSED.findall(text):
        depth += bool(start) - bool(end)
        if word and not depth:
            return word
    return None


def run(folder, *command, silent=False, given=None):
    """Runs a command, with the file `given` as its input if that exists; returns its output with errors and warnings. If
    `silent`, fails on errors and warnings."""
    with open(given if given and given.exists() else os.devnull) as standard_input:
        result = subprocess.run(command, cwd=folder, stdin=standard_input, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE if silent else subprocess.STDOUT, text=True)
    if result.returncode or result.stderr:
        raise Refused(f"{' '.join(map(str, command[:4]))}\n{result.stdout}{result.stderr or ''}")
    return result.stdout


def compile_all(folder, build, more=()):
    """Compiles a copy of the folder's files, then copies `more` next to them."""
    if folder.resolve().is_relative_to(build.resolve()):
        raise Refused(f"{build}: the build folder contains the proofs; expected another folder, whose contents are removed")
    shutil.rmtree(build, ignore_errors=True)
    build.mkdir(parents=True)
    files = [path.relative_to(folder) for path in sorted(folder.rglob("*.v"))]
    for path in [*files, Path("_CoqProject")]:
        (build / path).parent.mkdir(exist_ok=True)
        shutil.copy(folder / path, build / path)
    run(build, "coq_makefile", "-f", "_CoqProject", *files, "-o", "Makefile")
    run(build, "make", f"-j{os.cpu_count()}")
    for path in more:
        shutil.copy(path, build)


def answers(build, library, found, subject, commands, *before):
    """Returns Coq's output for commands, by their keys, after other commands. Text that a file makes Coq print cannot
    be mistaken for an answer, since a random mark separates the answers."""
    mark = secrets.token_hex(16)
    script = [f"From {library} Require {' '.join(dict.fromkeys(name for name, _ in found))}.", *before,
              "Set Printing Width 118.", "Set Printing Depth 1000000.", "Set Printing Implicit."]
    for key, command in commands.items():
        script += [f'Goal True. idtac "{mark} {key}". exact I. Qed.', command]
    file = f"answers_{subject}.v"
    (build / file).write_text("\n".join(script) + "\n")
    blocks = re.split(rf"^{mark} (\S+)\n", run(build, "coqc", "-Q", ".", library, file, silent=True), flags=re.MULTILINE)
    if blocks[0] or blocks[1::2] != list(commands):
        raise Refused(f"Coq did not answer each command of {subject} once: {blocks[0][:200]}")
    return dict(zip(blocks[1::2], blocks[2::2]))


def axioms_of(text):
    """Returns the name and type of each axiom in the output of Print Assumptions. Every line must be recognised."""
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
    """Returns the theorems and the axioms' names by file, and fails on other axioms than those allowed. Print
    Assumptions runs once for a file, since it searches the libraries each time."""
    files = {name: [theorem for of, theorem in found if of == name] for name, _ in found}
    together = {name: ", ".join(f"@{name}.{theorem}" for theorem in theorems) for name, theorems in files.items()}
    commands = {name: f"Definition of_{name} := ({all_}).\nPrint Assumptions of_{name}."
                for name, all_ in together.items()}
    used = {}
    for name, text in answers(build, library, found, "assumptions", commands).items():
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
    """Returns the theorems' statements by name (file.theorem), with their sections' hypotheses, in the notations of Coq's
    numbers and of Flocq only."""
    notations = ("From Coq Require Import ZArith Reals.", "From Flocq Require Import Core BinarySingleNaN.",
                 "Open Scope R_scope.")
    names = [f"{name}.{theorem}" for name, theorem in found]
    printed = answers(build, library, found, "statements", {name: f"Check @{name}." for name in names}, *notations)
    for name, answer in printed.items():
        if not re.match(rf"@?{re.escape(name)}\n +: ", answer) or "..." in answer or "\nwhere" in answer:
            raise Refused(f"{name}: found '{answer}', expected a whole statement")
    return {name: re.sub(r"^\S+\n +: ", "", printed[name]).rstrip("\n") for name in names}


def digest_of(statement):
    return hashlib.sha256(statement.encode()).hexdigest()[:12]


def record_of(stated):
    """Returns the record of statements: a paragraph for each file, with the digests of its theorems in their order."""
    files = {}
    for name, statement in stated.items():
        files.setdefault(name.split(".")[0], []).append(digest_of(statement))
    return "".join(textwrap.fill(" ".join([file, *digests]), 120, subsequent_indent="    ") + "\n"
                   for file, digests in files.items())


def recorded(path):
    """Returns the digests in a record of statements, by file."""
    paragraphs = re.sub(r"\n ", " ", path.read_text() if path.exists() else "").splitlines()
    return {file: digests for file, *digests in map(str.split, paragraphs)}


def differing(stated, path):
    """Returns the statements, as text, whose digests are not in the record."""
    known = recorded(path)
    return "".join(f"{name}\n     : {statement}\n\n" for name, statement in stated.items()
                   if digest_of(statement) not in known.get(name.split(".")[0], []))


def compare(text, path, build, shown=""):
    """Fails if the stored file differs from the new text. `shown` is what differs, for readers."""
    if not path.exists() or path.read_text() != text:
        (build / path.name).write_text(text)
        raise Refused(f"{path.name} differs from Coq's output, {build / path.name}: if the change is intended, copy it\n"
                      f"{shown}".rstrip("\n"))


RESTATED = re.compile(r"^Theorem ([\w']+) :\n(.*?)\.\nProof\. exact @(\w+\.[\w']+)\. Qed\.$", re.MULTILINE | re.DOTALL)


def restated(folder, name, found):
    """Returns (theorem, statement, name of the original) for the theorems of a file that only restates others."""
    all_ = RESTATED.findall(code_of((folder / f"{name}.v").read_text()))
    if [theorem for theorem, _, _ in all_] != [theorem for file, theorem in found if file == name]:
        raise Refused(f"{name}.v: found a Theorem that is not a statement and Proof. exact @File.theorem. Qed.")
    for theorem, _, original in all_:
        if tuple(original.split(".")) not in found or original.split(".")[1] != theorem:
            raise Refused(f"{name}.v: {theorem} restates {original}")
    return all_


def compare_restated(folder, name, found, stated):
    """Fails if a theorem of a file that restates others has another text than Coq prints for it."""
    for theorem, text, original in restated(folder, name, found):
        printed = {stated[f"{name}.{theorem}"], stated[original]}
        if {" ".join(each.split()) for each in printed} != {" ".join(text.split())}:
            raise Refused(f"{name}.v, {theorem}: the text differs from what Coq prints:\n{stated[original]}")


def check_compiled(build, library, paths):
    """Checks the compiled files by coqchk, which trusts the packages of the libraries."""
    printed = run(build, "coqchk", "-o", "-silent", "-Q", ".", library,
                  *(word for path in paths for word in ("-norec", f"{library}.{path.replace('/', '.')}")))
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
