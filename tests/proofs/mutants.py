"""Changes every constant, comparison, branch, sum and difference of the tied functions once. Tests must find each change.

usage: mutants.py COMPILER BUILD_FOLDER [TIE...]

The test of a tie is the program tie_TIE.cpp, or tie_test.cpp for rules, which compares the code with results of the proofs' definitions
(proofs/tie.txt). A copy of the tied files has all mutants (made_mutants.py) with numbers (mutants.hpp), and one program
runs them one after the other. Mutants that it neither finds nor evaluates, such as constants of the compiler, are
compiled separately. The others must be in equivalent_mutants.txt, with the reason why no result differs.

Prints how many were found, and records that in proofs/mutants.txt. Fails if an unlisted mutant is not found.
"""
import collections
import concurrent.futures
import datetime
import os
import re
import resource
import shutil
import subprocess
import sys
import time
from pathlib import Path

root = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(root / "proofs"))
import records  # noqa: E402
import ties  # noqa: E402
from made_mutants import mutants_of  # noqa: E402

# Reads out of bounds are detected, too. Functions that are not called may call undefined ones.
OPTIONS = ["-std=c++20", "-O1", "-ffp-contract=off", "-w", "-fmax-errors=100", "-D_GLIBCXX_ASSERTIONS",
           "-fsanitize=bounds", "-fsanitize-undefined-trap-on-error", "-ffunction-sections",
           "-Wl,--gc-sections", f'-DERRBOUND_TIE_TABLE="{root}/proofs/tie.txt"']
# Additional sources of a tie, and the options with which it is compiled, one after the other.
MORE_SOURCES = {"rules": [root / "errbound/validation/tiny_float.cpp", "-lmpfr", "-lgmp"]}
VARIANTS = {"rules": [[], ["-mfma"]]}


def edited(text, changes):
    """Returns the text after changes (start, end, new), which do not overlap."""
    for start, end, new in sorted(changes, reverse=True):
        text = text[:start] + new + text[end:]
    return text


class Run:
    """The mutants of a tie."""

    def __init__(self, compiler, build, tie):
        self.compiler, self.build, self.tie = compiler, build / tie, tie
        self.source = root / records.program(tie)
        self.start = time.monotonic()
        shutil.rmtree(self.build, ignore_errors=True)
        self.limit = None  # CPU seconds that a mutant may take, since some do not end
        self.variants = VARIANTS.get(tie, [[]])
        self.texts, self.mutants = {}, []
        for path in ties.TIES[tie][0]:
            self.texts[path], found = mutants_of(path, ties.untied_functions(path))
            self.mutants += found

    def report(self, message):
        print(f"{self.tie}: {message}, {time.monotonic() - self.start:.0f} s", file=sys.stderr, flush=True)

    def write(self, folder, texts):
        for path, text in texts.items():
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_text(text)

    def compile(self, folder, options):
        """Compiles the program with the files in `folder` in place of the code's. Returns it, or None, and the errors."""
        compiled = [path for path in self.texts if path.endswith(".cpp")]
        sources = [(folder if (folder / path).exists() else root) / path for path in compiled]
        result = subprocess.run(
            [self.compiler, *OPTIONS, *options, f"-I{folder}/include", f"-I{folder}", f"-I{root}/include", f"-I{root}",
             self.source, *sources, *MORE_SOURCES.get(self.tie, []), "-o", folder / "program"], capture_output=True, text=True)
        return (None if result.returncode else folder / "program"), result.stderr

    def differs(self, program, mutant, number=0):
        """Returns (True if the program fails or does not end, True if it evaluated the mutant of that number)."""
        limited = f'ulimit -t {self.limit}; exec "$0" first "$1"'
        result = subprocess.run(["sh", "-c", limited, program, Path(mutant.path).stem],
                                capture_output=True, env={**os.environ, "ERRBOUND_MUTANT": str(number)})
        return result.returncode != 0, b"reached" in result.stderr

    def expect_none(self, program):
        """Exits if the code without a mutant differs. Sets the time limit of mutants, six times its time."""
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        result = subprocess.run([program, "first"], capture_output=True, text=True)
        if result.returncode:
            sys.exit(f"mutants of {self.tie}: the code without a mutant differs from proofs/tie.txt\n{result.stdout}")
        self.limit = 10 + int(6 * (resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before))

    def numbered_program(self, options):
        """Returns a program with all numbered mutants that compile, and those mutants by number."""
        folder, left_out = self.build / "numbered", set()
        include = '#include "tests/proofs/mutants.hpp"\n'
        while True:
            numbers = {k: m for k, m in enumerate(self.mutants, 1) if m.numbered and m not in left_out}
            changes = collections.defaultdict(list)
            for k, m in numbers.items():
                changes[m.path] += m.by_number(k)
            self.write(folder, {path: re.sub("^(?=#(include|pragma))", include, edited(text, changes[path]),
                                             count=1, flags=re.MULTILINE) for path, text in self.texts.items()})
            program, errors = self.compile(folder, options)
            if program:
                return program, numbers
            wrong = {(path, int(line) - 1) for path, line in re.findall(  # the copy has one more line
                rf"^{re.escape(str(folder))}/(\S+?):(\d+):\d+: (?:fatal )?error:", errors, re.MULTILINE)}
            more = {m for m in numbers.values() if (m.path, m.line_number) in wrong}
            if not more:
                sys.exit(f"mutants of {self.tie}:\n{errors[-4000:]}")
            left_out |= more

    def alone(self, number, mutant):
        """Returns True if the separately compiled mutant is found, None if it does not compile."""
        folder, found = self.build / f"mutant{number}", []
        self.write(folder, {mutant.path: edited(self.texts[mutant.path], mutant.by_itself())})
        for options in self.variants:
            program, _ = self.compile(folder, options)
            found += [self.differs(program, mutant)[0]] if program else []
            if any(found):
                break
        shutil.rmtree(folder)
        return any(found) if found else None

    def run(self):
        """Returns (mutant, True if it is found) for the mutants that compile."""
        found, reached = {}, set()
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            for options in self.variants:
                program, numbers = self.numbered_program(options)
                self.report(" ".join([f"{len(self.mutants)} mutants, {len(numbers)} of them in one program", *options]))
                self.expect_none(program)
                left = [k for k in numbers if not found.get(k)]
                for k, (differs, there) in zip(left, pool.map(lambda k: self.differs(program, self.mutants[k - 1], k), left)):
                    found[k] = differs
                    reached |= {k} if there else set()
            rest = {k: m for k, m in enumerate(self.mutants, 1) if not found.get(k) and (k not in reached or m.binds_differently)}
            self.report(f"{sum(found.values())} of them are found, {len(rest)} are compiled separately")
            found.update(zip(rest, pool.map(lambda k: self.alone(k, rest[k]), rest)))
        return [(m, found[k]) for k, m in enumerate(self.mutants, 1) if found[k] is not None]


def equivalent():
    """Returns the names of the listed mutants, which no result shows."""
    names = set()
    for line in (root / "tests/proofs/equivalent_mutants.txt").read_text().splitlines():
        if line and not line.startswith(("#", " ")):
            first, *more = line.split(", also ")
            names |= {first, *(re.match(r"(.* \| )\S+ -> ", first)[1] + change for change in more)}
    return names


def run(compiler, build, chosen=()):
    """Returns the numbers of mutants made, found, and listed as equivalent, by tie, and the error messages."""
    counts, wrong, known = {}, [], equivalent()
    for tie in chosen or ties.TIES:
        tried = Run(compiler, build, tie).run()
        missed = [m.name for m, found in tried if not found]
        files = {Path(path).name for path in ties.TIES[tie][0]}
        wrong += [f"not found: {name}" for name in missed if name not in known]
        wrong += [f"listed, but found or not made: {name}" for name in sorted(known)
                  if name.split(",")[0] in files and name not in missed]
        counts[tie] = len(tried), len(tried) - len(missed), sum(name in known for name in missed)
    return counts, wrong


def record(counts):
    """Writes the numbers to proofs/mutants.txt."""
    today = datetime.date.today().isoformat()
    records.keep({tie: records.Record(*of_tie, today, records.digest(tie)) for tie, of_tie in counts.items()})


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    if unknown := set(sys.argv[3:]) - set(ties.TIES):
        sys.exit(f"tie is {min(unknown)}; expected one of {', '.join(ties.TIES)}")
    counts, wrong = run(sys.argv[1], Path(sys.argv[2]).resolve(), sys.argv[3:])
    record(counts)
    print(records.table())
    if wrong:
        sys.exit("\n".join(wrong))
