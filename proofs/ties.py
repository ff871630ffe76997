"""The functions that decide, and those that are tied: their results on some inputs are compared with those of the
proofs' definitions (README.md, The tie). ties.txt lists their files, and tie.txt has the results."""
import re
import sys
import textwrap
from pathlib import Path

proofs = Path(__file__).resolve().parent
root = proofs.parent
sys.path.insert(0, str(root / "tests/project"))
from layout_test import cpp_functions  # noqa: E402


def paragraphs(text):
    """Returns the lines of a text without comments and empty lines, each joined with its continuations, which are
    indented by four spaces."""
    text = re.sub(r"^#.*\n", "", text, flags=re.MULTILINE)
    return [line for line in re.sub(r"\n    ", " ", text).splitlines() if line]


def listed():
    """Returns for each tie its files and the first words of its paragraphs in tie.txt; then the untied functions of those
    files, by file; then the files without a tie."""
    ties, untied, others, paths = {}, {}, [], None
    for line in paragraphs((proofs / "ties.txt").read_text()):
        if line == "no tie":
            paths = others
        elif not line.startswith(" "):
            tie, starts = line.split(", ")
            paths = []
            ties[tie] = paths, tuple(starts.split())
        else:
            files, names = re.fullmatch(r"(.*?)(?: except (.*?))?(?:: .*)?", line.strip()).groups()
            paths += files.split()
            untied.update({path: set(names.split()) for path in files.split()} if names else {})
    return ties, untied, others


TIES, UNTIED, OTHERS = listed()


def functions(path):
    """Yields (name, first line, number of lines) for every function of a file."""
    text = (root / path).read_text()
    for _, first, lines in cpp_functions(text):
        head = "\n".join(text.split("\n")[first - 1:first - 1 + lines]).split("{")[0]
        head = re.sub(r"\((min|max)\)\(", r" \1(", head)  # in parentheses because of macros of these names
        names = [name for name in re.findall(r"(operator\s*\(\)|operator[^\s(]+|[~\w]+|\])\s*\(", head)
                 if name not in ("requires", "decltype", "noexcept", "explicit")]
        name = names[0] if names else head.split()[0]
        if name == "]":  # the variable of a lambda
            name = re.search(r"(\w+)\s*=[^=]*\[", head)[1]
        yield name, first, lines


def untied_functions(path):
    """Returns (first line, number of lines) for the untied functions of a tied file."""
    return [(first, lines) for name, first, lines in functions(path) if name in UNTIED.get(path, ())]


def count():
    """Returns the number of compared functions by tie, and the number of others. Raises ValueError if ties.txt names a
    file or function that does not exist, or lacks a file with theorems."""
    tied, others = {}, sum(len(list(functions(path))) for path in OTHERS)
    for tie, (paths, _) in TIES.items():
        names = {path: [name for name, _, _ in functions(path)] for path in paths}
        for path in paths:
            if unknown := UNTIED.get(path, set()) - set(names[path]):
                raise ValueError(f"ties.txt: {path} has no {sorted(unknown)}")
        left_out = sum(name in UNTIED.get(path, ()) for path in paths for name in names[path])
        tied[tie] = sum(map(len, names.values())) - left_out
        others += left_out
    known = {path for paths, _ in TIES.values() for path in paths} | set(OTHERS)
    for path in (path for folder in ("include", "ccd") for path in sorted((root / folder).rglob("*.[hc]pp"))):
        name = str(path.relative_to(root))
        if name not in known and re.search(r"proofs/(\w+/)?\w+\.v", path.read_text()) and any(functions(name)):
            raise ValueError(f"{name} names theorems, and ties.txt does not list it")
    return tied, others


def group(operation):
    """Returns the group of an operation, whose results have one hash, as in tests/proofs/table.hpp: its name up to '.' or
    '<', except that a number after '.' belongs to the name."""
    return re.sub(r"[.<](?!\d+$).*", "", operation)


def combined(hashes):
    """Returns the hash (FNV-1a) of a group's hashes, in the order of the operations' names."""
    value = 2166136261
    for each in hashes:
        value = (value ^ each) * 16777619 & 0xffffffff
    return value


def grouped(lines):
    """Returns for each format, from lines "format operation cases hash", the number of all its cases and its groups, each
    with its lines. Operations that are missing for a format with fused products have the results of the others."""
    formats = {}
    for line in lines:
        name, operation, *_ = line.split()
        formats.setdefault(name, {})[operation] = line
    found = {}
    for name, own in formats.items():
        known = {**formats.get(name.removesuffix(",fma"), {}), **own}
        groups = {group(operation): [] for operation in own}
        for operation in sorted(known):
            groups.get(group(operation), []).append(known[operation])
        found[name] = sum(int(line.split()[2]) for line in own.values()), groups
    return found


def entry(name, lines):
    return f"{name}:{combined(int(line.split()[3], 16) for line in lines):08x}"


def results(lines):
    """Returns the text of tie.txt for lines "format operation cases hash": a paragraph for each format, with the number
    of all its cases, and the hash of each group of operations."""
    return "".join(textwrap.fill(" ".join([f"{name} {cases}", *(entry(*each) for each in groups.items())]), 120,
                                 subsequent_indent="    ", break_long_words=False, break_on_hyphens=False) + "\n"
                   for name, (cases, groups) in grouped(lines).items())


def recorded():
    """Returns (format, number of cases, entries "group:hash") for each paragraph of tie.txt."""
    found = (line.split() for line in paragraphs((proofs / "tie.txt").read_text()))
    return [(name, int(cases), entries) for name, cases, *entries in found]


def of_tie(tie):
    """Returns what tie.txt records of a tie."""
    return [record for record in recorded() if re.match(r"\w+", record[0])[0] in TIES[tie][1]]


def cases():
    """Returns the number of inputs in tie.txt by tie."""
    return {tie: sum(number for _, number, _ in of_tie(tie)) for tie in TIES}


def differences(lines):
    """Returns those of the lines "format operation cases hash" whose groups differ from tie.txt. If the code differs, its
    test prints its lines of the group."""
    known = {(name, entry) for name, _, entries in recorded() for entry in entries}
    return [line for name, (_, groups) in grouped(lines).items() for each in groups.items()
            if (name, entry(*each)) not in known for line in each[1]]
