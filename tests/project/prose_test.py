"""Checks how comments, docstrings and pages are written, in all tracked files.

usage: prose_test.py SOURCE_FOLDER [--statistics] [PATH...]

It fails if a rule is broken. --statistics only prints counts. A sentence must not open with a word that makes it a
fragment, contain a word of the list, or have more than MOST_WORDS words. A header must not open with more than
MOST_LINES lines of comment.
"""
import ast
import io
import re
import subprocess
import sys
import tokenize
from pathlib import Path

MOST_WORDS = 25
MOST_LINES = 12
OPENINGS = re.compile(r"(Of|That|Those|What|Whether|By|As)\b(?! (is|are|was) )")
WORDS = re.compile(
    r"\b(but for|so many|likewise|held against|told apart|left open|whoever|nobody|as it comes|as long as it takes|"
    r"in turns|now and then|nothing is known|(?:is|are|was|were) asked|asks|says|tells|knows|of one's own|mended|mends)\b",
    re.IGNORECASE)
# Sentences that the rules do not fit, by their file and a part of them.
TABLE = "include/errbound/rules/rule.hpp"  # the members of a rule
EXCEPTIONS = [(TABLE, "for tables and messages"), (TABLE, "minimal_precision"),
              ("tests/errbound/headers_alone.sh", "define near")]  # macros, not comments


def of_cpp(text):
    alone = []
    for line in text.splitlines():
        found = re.match(r"\s*//[/!]?<? ?(.*)", line)
        alone.append("# " + found[1] if found else "")
        if not found and (found := re.match(r".*\S.*?[;,{] +//[/!]?<? ?(.*)", line)):
            yield found[1]
    yield from of_scripts("\n".join(alone))


def of_python(text):
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)) and ast.get_docstring(node):
            yield ast.get_docstring(node)
    alone = [""] * (text.count("\n") + 1)
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT and token.line.lstrip().startswith("#"):
            alone[token.start[0] - 1] = token.string
        elif token.type == tokenize.COMMENT:
            yield token.string
    yield from of_scripts("\n".join(alone))


def of_scripts(text):
    """Returns blocks of comment lines."""
    return re.findall(r"(?:^ *# ?.*\n?)+", text, re.MULTILINE)


def of_pages(text):
    text = re.sub(r"```.*?```|~~~.*?~~~", "\n\n", text, flags=re.DOTALL)
    yield re.sub(r"^ *(\||#).*$", "\n", text, flags=re.MULTILINE)


def of_proofs(text):
    """Yields the comments of Coq and OCaml, which may nest, without their lists of theorems."""
    depth = start = 0
    for m in re.finditer(r"'\"'|\"[^\"]*\"|\(\*+|\*+\)", text):
        start = start if depth else m.end()
        depth += m[0].startswith("(") - m[0].endswith(")")
        if not depth and m[0].endswith(")"):
            yield re.sub(r"^ {8,}.*$", "\n", text[start:m.start()], flags=re.MULTILINE)


READERS = {".hpp": of_cpp, ".cpp": of_cpp, ".cuh": of_cpp, ".cu": of_cpp, ".py": of_python, ".pyi": of_python,
           ".v": of_proofs, ".ml": of_proofs, ".md": of_pages, ".sh": of_scripts, ".cmake": of_scripts}


def sentences(block):
    block = re.sub(r"^ *#+ ?", "", block, flags=re.MULTILINE)
    for paragraph in re.split(r"\n\s*\n|\n(?=\s*(?:[*-]|\d+\.) )", block):
        text = " ".join(re.sub(r"^\s*(?:[*-]|\d+\.) |\*\*", "", paragraph).split())
        text = re.sub(r"`[^`]*`|\[([^\]]*)\]\([^)]*\)", lambda m: m[1] or "X", text)
        text = re.sub(r"X(?:(?:,|,? and|,? or) X\b)+", "X", text)  # a list of names counts as one word
        yield from re.split(r"(?<=[.!?;:])[)\"]*\s+", text)


def broken(path, text):
    """Yields pairs of a broken rule and its sentence."""
    for block in READERS[path.suffix](text):
        for sentence in sentences(block):
            if OPENINGS.match(sentence):
                yield "opening", sentence
            if word := WORDS.search(sentence):
                yield f"\"{word[0].lower()}\"", sentence
            if len(re.findall(r"[A-Za-z]\S*", sentence)) > MOST_WORDS:
                yield f"over {MOST_WORDS} words", sentence
    opening = re.match(r"(?://.*\n)*", text)[0].count("\n")
    if path.suffix == ".hpp" and opening > MOST_LINES:
        yield "opening comment", f"{opening} lines, expected at most {MOST_LINES}"


def files(root, patterns):
    """Returns the files of git that match; without git, all that match."""
    if (root / ".git").exists():
        names = subprocess.run(["git", "-C", root, "ls-files", "-z", *patterns], check=True, stdout=subprocess.PIPE,
                               text=True).stdout.split("\0")
    else:
        names = [path.relative_to(root) for pattern in patterns or ["**/*"] for path in root.glob(pattern)]
    return [path for path in sorted(map(Path, names)) if path.suffix in READERS]


def main():
    root, arguments = Path(sys.argv[1]), sys.argv[2:]
    statistics = "--statistics" in arguments
    patterns = [a for a in arguments if a != "--statistics"]
    counts = {}
    for path in files(root, patterns):
        for rule, sentence in broken(path, (root / path).read_text(errors="replace")):
            if any(str(path) == name and part in sentence for name, part in EXCEPTIONS):
                continue
            counts[rule] = counts.get(rule, 0) + 1
            if not statistics:
                print(f"{path}: {rule}: {sentence}")
    for rule, count in sorted(counts.items(), key=lambda item: -item[1]):
        print(f"{count:6,} {rule}")
    return bool(counts) and not statistics


if __name__ == "__main__":
    sys.exit(main())
