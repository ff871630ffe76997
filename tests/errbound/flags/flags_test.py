"""The effects of compilers' flags on the library's promises are those listed in docs/guarantees.md.

usage: flags_test.py SOURCE_FOLDER

Compiles numbers.cpp under the flags of each row of the page's table, with each installed compiler, and
runs it. Either the flag is refused, or it is found at run time, or all numbers are right.
"""
import concurrent.futures
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(sys.argv[1])
HERE = ROOT / "tests/errbound/flags"


def table():
    """Yields the place of the flags, the flags, and the cell of each compiler, for each row."""
    compilers = []
    for line in (ROOT / "docs/guarantees.md").read_text().splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if cells[0] == "flag":
            compilers = cells[1:-1]
        elif compilers and cells[0].startswith("`"):
            flags, where = re.fullmatch(r"`(.*)`(.*)", cells[0]).groups()
            yield where, flags.split(), dict(zip(compilers, cells[1:-1]))
        elif compilers and not line.startswith("|"):
            return


def outcome(compiler, where, flags, folder):
    """Returns the text that the cell of the table must have."""
    common = [compiler, "-std=c++20", "-O3", "-fPIC", f"-I{ROOT / 'include'}"]
    for unit in "numbers", "other_unit":
        its = flags if where == "" or (where, unit) == (", one of two units", "other_unit") else []
        done = subprocess.run([*common, *its, "-c", HERE / f"{unit}.cpp", "-o", folder / f"{unit}.o"],
                              capture_output=True, text=True)
        if "errbound: " in done.stderr:
            return "refused"
        if re.search(r"No such file|file not found", done.stderr):
            return "not installed"
        if done.returncode != 0:
            return "unknown"
    other = folder / "other_unit.o"
    if where == ", linking a shared library":
        library = folder / "other_unit.so"
        subprocess.run([*common, *flags, "-shared", other, "-o", library], check=True)
        other = library
    link = flags if where in ("", ", linking") else []
    subprocess.run([*common, *link, folder / "numbers.o", other, "-o", folder / "numbers"], check=True)
    ran = subprocess.run([folder / "numbers"], capture_output=True, text=True)
    sound, other, wrong = re.search(r"(\w+), other unit (\w+), (\d+) wrong", ran.stdout).groups()
    if where == ", one of two units":
        return "found" if (sound, other) == ("sound", "unsound") else f"numbers {sound}, other {other}"
    if sound == "unsound":
        return "found"
    return "harmless" if wrong == "0" else f"not found: {ran.stdout.strip()}"


def compilers_of(name):
    """Returns the installed compilers of a column."""
    names = {"clang": ["clang++", *(f"clang++-{version}" for version in range(15, 20))]}.get(name, [name])
    return [found for found in names if shutil.which(found)]


def said_of(compiler, cell):
    """Returns the cell's outcome for this version of the compiler."""
    before, other, how, version = re.fullmatch(r"(\w+)(?:, (\w+) (by|from) (\d+)(?: on)?)?", cell).groups()
    if other is None:
        return before
    major = int(subprocess.run([compiler, "-dumpversion"], capture_output=True, check=True,
                               text=True).stdout.split(".")[0])
    return other if major == int(version) or (how == "from" and major > int(version)) else before


def row_outcome(case):
    where, flags, compiler, said = case
    with tempfile.TemporaryDirectory() as folder:
        return outcome(compiler, where, flags, pathlib.Path(folder))


def main():
    rows = list(table())
    cases = [(where, flags, compiler, said_of(compiler, said[name]))
             for where, flags, said in rows for name in said for compiler in compilers_of(name)]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        found = list(pool.map(row_outcome, cases))
    wrong = 0
    for (where, flags, compiler, said), seen in zip(cases, found):
        differs = seen not in (said, "not installed")
        wrong += differs
        print(f"{'WRONG' if differs else 'ok':6}{compiler:11} {' '.join(flags)}{where}: {seen}"
              + (f", not {said}" if differs else ""))
    print(f"{len(cases)} cases of {len(rows)} rows, {wrong} not as the page says")
    return wrong > 0 or len(rows) == 0


if __name__ == "__main__":
    sys.exit(main())
