"""Changes every constant, comparison, branch, sum and difference of the tied functions once: each change
must be found.

usage: mutants.py COMPILER BUILD_FOLDER [TIE...]

A tie is a program here, tie_TIE.cpp, that compares the code with what the proofs' definitions compute
(proofs/tie.txt). In a copy of the files that it ties every mutant (made_mutants.py) has a number (mutants.hpp), and
one program, told the numbers in turn, runs them all. A mutant that is not found so, and whose place that program does
not come to, since a constant is one for the compiler, say, is compiled by itself. What is left has to be in
equivalent_mutants.txt, with the reason why no result shows it. Prints how many were found, and records that in
proofs/mutants.txt; fails where another mutant is left.
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

# What reads beyond an array, too, is found. Functions that are not called may call what is not there.
OPTIONS = ["-std=c++20", "-O1", "-ffp-contract=off", "-w", "-fmax-errors=100", "-D_GLIBCXX_ASSERTIONS",
           "-fsanitize=bounds", "-fsanitize-undefined-trap-on-error", "-ffunction-sections",
           "-Wl,--gc-sections", f'-DERRBOUND_TIE_TABLE="{root}/proofs/tie.txt"']
# Of a tie, what is compiled beside it, and options that it is compiled with in turn.
MORE_SOURCES = {"rules": [root / "errbound/validation/tiny_float.cpp", "-lgtest", "-lmpfr", "-lgmp"]}
VARIANTS = {"rules": [[], ["-mfma"]]}


def edited(text, changes):
    """`changes`: (start, end, new), which do not overlap."""
    for start, end, new in sorted(changes, reverse=True):
        text = text[:start] + new + text[end:]
    return text


class Run:
    """The mutants of a tie."""

    def __init__(self, compiler, build, tie):
        self.compiler, self.build, self.tie = compiler, build / tie, tie
        self.source = root / f"tests/proofs/tie_{tie}.cpp"
        self.start = time.monotonic()
        shutil.rmtree(self.build, ignore_errors=True)
        self.limit = None  # seconds of a processor that a mutant may take: it may not end
        self.variants = VARIANTS.get(tie, [[]])
        self.texts, self.mutants = {}, []
        for path in ties.TIES[tie][0]:
            self.texts[path], found = mutants_of(path, ties.untied_functions(path))
            self.mutants += found

    def tell(self, what):
        print(f"{self.tie}: {what}, {time.monotonic() - self.start:.0f} s", file=sys.stderr, flush=True)

    def write(self, folder, texts):
        for path, text in texts.items():
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_text(text)

    def compile(self, folder, options):
        """The program, of what `folder` has in place of the code's files; None and errors if it does not compile."""
        compiled = [path for path in self.texts if path.endswith(".cpp")]
        sources = [(folder if (folder / path).exists() else root) / path for path in compiled]
        result = subprocess.run(
            [self.compiler, *OPTIONS, *options, f"-I{folder}/include", f"-I{folder}", f"-I{root}/include", f"-I{root}",
             self.source, *sources, *MORE_SOURCES.get(self.tie, []), "-o", folder / "program"], capture_output=True, text=True)
        return (None if result.returncode else folder / "program"), result.stderr

    def differs(self, program, mutant, number=0):
        """Whether it fails, too, or does not end; and whether the mutant of that number was come to."""
        limited = f'ulimit -t {self.limit}; exec "$0" first "$1"'
        result = subprocess.run(["sh", "-c", limited, program, Path(mutant.path).stem],
                                capture_output=True, env={**os.environ, "ERRBOUND_MUTANT": str(number)})
        return result.returncode != 0, b"reached" in result.stderr

    def expect_none(self, program):
        """That the code without a mutant does not differ. Mutants may take six times as long."""
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        result = subprocess.run([program, "first"], capture_output=True, text=True)
        if result.returncode:
            sys.exit(f"mutants of {self.tie}: the code without a mutant differs from proofs/tie.txt\n{result.stdout}")
        self.limit = 10 + int(6 * (resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before))

    def numbered_program(self, options):
        """A program of all mutants that compile so; those that it has, by number."""
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
            wrong = {(path, int(line) - 1) for path, line in re.findall(  # there is one line more
                rf"^{re.escape(str(folder))}/(\S+?):(\d+):\d+: (?:fatal )?error:", errors, re.MULTILINE)}
            more = {m for m in numbers.values() if (m.path, m.line_number) in wrong}
            if not more:
                sys.exit(f"mutants of {self.tie}:\n{errors[-4000:]}")
            left_out |= more

    def alone(self, number, mutant):
        """Whether it is found, compiled by itself; None where it does not compile."""
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
        """(mutant, whether it is found) of those that compile."""
        found, reached = {}, set()
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            for options in self.variants:
                program, numbers = self.numbered_program(options)
                self.tell(" ".join([f"{len(self.mutants)} mutants, {len(numbers)} of them in one program", *options]))
                self.expect_none(program)
                left = [k for k in numbers if not found.get(k)]
                for k, (differs, there) in zip(left, pool.map(lambda k: self.differs(program, self.mutants[k - 1], k), left)):
                    found[k] = differs
                    reached |= {k} if there else set()
            rest = {k: m for k, m in enumerate(self.mutants, 1) if not found.get(k) and (k not in reached or m.binds_differently)}
            self.tell(f"{sum(found.values())} of them are found, {len(rest)} are compiled by themselves")
            found.update(zip(rest, pool.map(lambda k: self.alone(k, rest[k]), rest)))
        return [(m, found[k]) for k, m in enumerate(self.mutants, 1) if found[k] is not None]


def equivalent():
    """Names of mutants that no result shows."""
    lines = (root / "tests/proofs/equivalent_mutants.txt").read_text().splitlines()
    return {line for line in lines if line and not line.startswith(("#", " "))}


def run(compiler, build, chosen=()):
    """By tie, how many mutants were made, found, and are listed as equivalent; and lines that say what is wrong."""
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
    """In proofs/mutants.txt."""
    today = datetime.date.today().isoformat()
    records.keep({tie: records.Record(*of_tie, today, records.digest(tie)) for tie, of_tie in counts.items()})


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    counts, wrong = run(sys.argv[1], Path(sys.argv[2]).resolve(), sys.argv[3:])
    record(counts)
    print(records.table())
    if wrong:
        sys.exit("\n".join(wrong))
