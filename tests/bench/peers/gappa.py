#!/usr/bin/env python3
"""Bounds the errors of FPCore programs by Gappa: prints lines CORE,BOUND for errbound ranges.

    tests/bench/peers/gappa.py FILE.fpcore... > gappa.csv
    build/errbound ranges FILE.fpcore... --round-inputs --published gappa.csv

Needs the program gappa (Debian, Ubuntu: apt-get install gappa). Inputs are real numbers, rounded to
nearest. Programs with functions, conditions, loops or unbounded inputs are omitted. Gappa gets no
hints, and 60 seconds a program.
"""
import re
import subprocess
import sys

FORMATS = {"binary64": "ieee_64", "binary32": "ieee_32", "binary16": "ieee_16"}
RELATIONS = {"<=": 1, "<": 1, ">=": -1, ">": -1}


class Omitted(Exception):
    """A program that is not compared."""


def parsed(text):
    """Returns the expressions of a file: nested lists of atoms."""
    tokens = re.findall(r'"[^"]*"|[()\[\]]|[^\s()\[\]";]+', re.sub(r";[^\n]*", "", text))
    stack = [[]]
    for token in tokens:
        if token in "([":
            stack.append([])
        elif token in ")]":
            done = stack.pop()
            stack[-1].append(done)
        else:
            stack[-1].append(token)
    return stack[0]


def is_number(atom):
    return isinstance(atom, str) and re.fullmatch(r"[-+]?[\d.]+(e[-+]?\d+)?(/\d+)?", atom) is not None


def boxes_of(pre, box):
    """Narrows the box, a dictionary of [lower, upper], by a precondition."""
    if pre[0] == "and":
        for part in pre[1:]:
            boxes_of(part, box)
    if pre[0] not in RELATIONS:
        return
    for low, high in zip(pre[1:], pre[2:]):
        low, high = (low, high) if RELATIONS[pre[0]] > 0 else (high, low)
        if isinstance(high, str) and high in box and is_number(low):
            box[high][0] = low
        if isinstance(low, str) and low in box and is_number(high):
            box[low][1] = high


class Program:
    """Definitions of an expression in Gappa's language, rounded and exact."""

    def __init__(self):
        self.lines, self.count = [], 0

    def pair(self, rounded, exact):
        """Defines both numbers; returns their names."""
        self.count += 1
        names = f"r{self.count}", f"e{self.count}"
        self.lines += [f"{names[0]} = {rounded};", f"{names[1]} = {exact};"]
        return names

    def value(self, e, names):
        if isinstance(e, str):
            if e in names:
                return names[e]
            if is_number(e):
                return (e, e) if re.fullmatch(r"\d+", e) else self.pair(f"rnd({e})", e)
            raise Omitted("constant " + e)
        op, arguments = e[0], e[1:]
        if op in ("let", "let*"):
            inner = dict(names)
            for name, bound in arguments[0]:
                inner[name] = self.value(bound, names if op == "let" else inner)
            return self.value(arguments[1], inner)
        if op == "!":
            return self.value(arguments[-1], names)
        x = [self.value(a, names) for a in arguments]
        if op == "-" and len(x) == 1:
            return self.pair(*(f"-{a}" for a in x[0]))
        if op in "+-*/" and len(x) >= 2:
            result = x[0]
            for y in x[1:]:
                result = self.pair(f"rnd({result[0]} {op} {y[0]})", f"{result[1]} {op} {y[1]}")
            return result
        if op == "sqrt":
            return self.pair(f"rnd(sqrt({x[0][0]}))", f"sqrt({x[0][1]})")
        if op == "fabs":
            return self.pair(f"|{x[0][0]}|", f"|{x[0][1]}|")
        raise Omitted("operation " + str(op))


def input_of(core):
    """Returns Gappa's input for a core."""
    rest = core[2:] if isinstance(core[1], list) else core[3:]
    arguments = core[1] if isinstance(core[1], list) else core[2]
    properties = {a: b for a, b in zip(rest, rest[1:]) if isinstance(a, str) and a[0] == ":"}
    if ":pre" not in properties or not all(isinstance(a, str) for a in arguments):
        raise Omitted("inputs")
    box = {a: [None, None] for a in arguments}
    boxes_of(properties[":pre"], box)
    if any(None in ends for ends in box.values()):
        raise Omitted("unbounded inputs")
    program = Program()
    names = {a: program.pair(f"rnd(x{i})", f"x{i}") for i, a in enumerate(arguments)}
    rounded, exact = program.value(rest[-1], names)
    ranges = " /\\ ".join(f"x{i} in [{low}, {high}]" for i, (low, high) in enumerate(box.values()))
    form = FORMATS[properties.get(":precision", "binary64")]
    return "\n".join([f"@rnd = float<{form}, ne>;", *program.lines,
                      f"{{ {ranges} -> {rounded} - {exact} in ? }}", ""])


def main():
    for path in sys.argv[1:]:
        with open(path) as file:
            cores = parsed(file.read())
        for core in cores:
            name = next((core[i + 1].strip('"') for i, a in enumerate(core) if a == ":name"), path)
            try:
                text = input_of(core)
                done = subprocess.run(["gappa"], input=text, capture_output=True, text=True, timeout=60)
            except (Omitted, subprocess.TimeoutExpired) as reason:
                print(f"{name}: {reason}", file=sys.stderr)
                continue
            end = r"(-?\d+)(?:b(-?\d+))?"  # m·2^e
            ends = re.search(rf" in \[{end}(?: {{[^}}]*}})?, {end}", done.stderr)
            if ends:
                m, e, n, f = (int(x or 0) for x in ends.groups())
                print(f"{name},{max(abs(m) * 2.0**e, abs(n) * 2.0**f)!r}")
            else:
                print(f"{name}: no bound", file=sys.stderr)


if __name__ == "__main__":
    main()
