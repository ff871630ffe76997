#!/usr/bin/env python3
"""null_calls.py COMPILE_COMMANDS CASES: searches all device code for what nvcc miscompiles silently.

Under --expt-relaxed-constexpr nvcc turns a host-only function that constexpr device code calls into a
call of address 0, and a host-only variable into a null reference; the optimiser then removes the path
as unreachable. Each CUDA source of COMPILE_COMMANDS is compiled to PTX without optimisation (-G -ptx),
where such calls and references are still visible. Fails if there is one, or if one of the kernels of
CASES named broken_... is not found, or one named sound_... is.
"""
import collections
import concurrent.futures
import itertools
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile

FUNCTION = re.compile(r"\s*(?:\.visible |\.weak )?\.(?:func|entry)\s+(?:\([^)]*\)\s*)?([\w$]+)\(")
MOVE = re.compile(r"\s*mov\.[ub]64\s+(%rd\d+), ([%\w$]+);")
STORE = re.compile(r"\s*st\.[ub]64\s+\[(%SP\+\d+)\], (%rd\d+);")
LOAD = re.compile(r"\s*ld\.[ub]64\s+(%rd\d+), \[(%SP\+\d+)\];")
WRITE = re.compile(r"\s*(?!st\.)[a-z]\S*\s+(%rd\d+)\b")
ARGUMENT = re.compile(r"\s*st\.param\.b64\s+\[param(\d+)\+0\], ([%\w]+);")
PARAMETER = re.compile(r"\s*\.param .*\bparam(\d+)\b")
ACCESS = re.compile(r"\s*(?:ld|st)\.(?!param)\S+\s.*\[(%rd\d+)(?:\+\d+)?\]")
CALL = re.compile(r"call(?:\.uni)?\s+(?:\([^)]*\),\s*)?([%\w$]+)")


def functions(ptx):
    name, lines = None, []
    for line in ptx.splitlines():
        if match := FUNCTION.match(line):
            name, lines = match[1], []
        elif line == "}":
            yield name, lines
        lines.append(line)


class Values:
    """The possible contents of registers and stack slots of a function, through moves, stores and loads."""

    def __init__(self, lines):
        self.sources = collections.defaultdict(set)
        for line in lines:
            if match := MOVE.match(line) or STORE.match(line) or LOAD.match(line):
                self.sources[match[1]].add(match[2])
            elif match := WRITE.match(line):
                self.sources[match[1]].add("computed")

    def of(self, operand, visited=()):
        if operand not in self.sources or operand in visited:
            return {operand}
        return set().union(*(self.of(s, (*visited, operand)) for s in self.sources[operand]))

    def is_null(self, operand):
        return self.of(operand) == {"0"}


def findings(ptx):
    """Yields (function, finding) for each call of address 0, null reference and access of address 0."""
    found = []
    for name, lines in functions(ptx):
        values, waiting = Values(lines), iter(lines)
        for line in waiting:
            if "callseq" in line and "{" in line:
                block = list(itertools.takewhile(lambda l: "callseq" not in l, waiting))
                found += [(name, finding) for finding in call_findings(block, values)]
            elif (match := ACCESS.match(line)) and values.is_null(match[1]):
                found.append((name, "access of address 0"))
    return found


def call_findings(block, values):
    target = CALL.search("\n".join(block))[1]
    if values.is_null(target):
        return ["call of address 0"]
    nulls = {int(m[1]) for line in block if (m := ARGUMENT.match(line)) and values.is_null(m[2])}
    count = len({m[1] for line in block if (m := PARAMETER.match(line))})
    targets = {t for t in values.of(target) if t.startswith("_Z")}
    return [f"null reference to {t}" for t in targets if any(is_reference(t, i, count) for i in nulls)]


def is_reference(mangled, index, count):
    """True if argument `index` of `count` is a reference, a function or the object of a member function."""
    name = demangled(mangled)
    depth, start, types = 0, 0, []
    end = name.rindex(")")
    for i in range(end - 1, -1, -1):  # the last parenthesised group, split at its commas
        c = name[i]
        depth += (c in ")>]}") - (c in "(<[{")
        if depth < 0:
            types.insert(0, name[i + 1 : end])
            break
        if c == "," and depth == 0:
            types.insert(0, name[i + 1 : end])
            end = i
    types = [t.strip() for t in types if t.strip() not in ("", "void")]
    if count == len(types) + 1:
        types.insert(0, "this&")
    return index < len(types) and (types[index].endswith("&") or "(*)" in types[index])


_demangled = {}


def demangled(name):
    if name not in _demangled:
        _demangled[name] = subprocess.run(["c++filt", name], capture_output=True, text=True).stdout.strip()
    return _demangled[name]


def unoptimised_ptx(command, source, scratch):
    words = iter(shlex.split(command))
    kept = []
    for word in words:
        if word in ("-o", "-c", "-MF", "-MT", "-x"):
            next(words)
        elif word not in ("-MD", "-dc") and not re.match(r"-O\d|-gencode|--?generate-code|-arch=|-DNDEBUG", word) \
                and not word.startswith("arch="):
            kept.append(word)
    output = os.path.join(scratch, re.sub(r"\W", "_", source + command)[-200:] + ".ptx")
    while "ccache" in kept[0]:
        kept.pop(0)
    subprocess.run([*kept, "-arch=compute_75", "-G", "-ptx", "-o", output, source], check=True)
    with open(output) as file:
        return file.read()


def main(commands, cases):
    with open(commands) as file:
        sources = [entry for entry in json.load(file) if entry["file"].endswith(".cu")]
    jobs = [(entry["command"], entry["file"]) for entry in sources] + [(sources[0]["command"], cases)]
    with tempfile.TemporaryDirectory() as scratch, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        texts = list(pool.map(lambda job: unoptimised_ptx(*job, scratch), jobs))
    failed = False
    for (_, source), text in zip(jobs[:-1], texts):
        for (function, finding), times in collections.Counter(findings(text)).items():
            failed = True
            print(f"{source}: {demangled(function)}: {finding} ({times} times)")
    failed |= not cases_are_found(texts[-1])
    print(f"{len(sources)} device sources searched: {'FAILED' if failed else 'no call of address 0'}")
    return 1 if failed else 0


def cases_are_found(text):
    calls = collections.defaultdict(set)
    for name, lines in functions(text):
        calls[name].update(re.findall(r"\b_Z[\w$]+", " ".join(lines)))
    bad = {function for function, _ in findings(text)}
    right = True
    for kernel in sorted(k for k in set(re.findall(r"\.entry (\w+)\(", text))):
        reached, waiting = set(), [kernel]
        while waiting:
            f = waiting.pop()
            if f not in reached:
                reached.add(f)
                waiting += calls[f]
        if bool(reached & bad) != ("broken_" in kernel):
            right = False
            print(f"{demangled(kernel)}: {'found' if reached & bad else 'not found'}")
    return right


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
