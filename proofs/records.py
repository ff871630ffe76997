"""The results of mutants of ties, stored in mutants.txt, and the table of ties that `./run proofs` prints."""
import hashlib
import re
import sys
from pathlib import Path

import ties

proofs = Path(__file__).resolve().parent
root = proofs.parent
RECORD = proofs / "mutants.txt"
sys.path.insert(0, str(root / "tests/project"))
from layout_test import code_alone  # noqa: E402
sys.path.insert(0, str(root / "tests/proofs"))
from made_mutants import mutants_of  # noqa: E402


def sources_of(path):
    """Returns a file of the tests, and the files of tests that it includes."""
    text, found = (root / path).read_text(), {path}
    for included in re.findall(r'^#include "(tests/[^"]+)"', text, re.MULTILINE):
        found |= sources_of(included)
    return found


def program(tie):
    """Returns the path of a tie's test."""
    return "tests/errbound/validation/tie_test.cpp" if tie == "rules" else f"tests/proofs/tie_{tie}.cpp"


def digest(tie):
    """Returns a digest of the mutants, the tests' code and the expected results, without comments and white space."""
    paths, _ = ties.TIES[tie]
    files = [*paths, "tests/proofs/mutants.hpp", *sorted(sources_of(program(tie)))]
    text = "".join(" ".join(code_alone((root / path).read_text()).split()) for path in files)
    for path in paths:
        text += "".join(f"{m.name} {m.numbered}\n" for m in mutants_of(path, ties.untied_functions(path))[1])
    text += str(ties.of_tie(tie))
    return hashlib.sha256(text.encode()).hexdigest()[:12]


class Record:
    """The numbers of a tie's mutants made, found, and listed with a reason; the date and the digest."""

    def __init__(self, made, found, listed, date, digest):
        self.made, self.found, self.listed = int(made), int(found), int(listed)
        self.date, self.digest = date, digest

    def line(self, tie):
        return f"{tie} {self.made} {self.found} {self.listed} {self.date} {self.digest}"


def kept():
    """Returns the records of mutants.txt by tie."""
    lines = [line.split() for line in RECORD.read_text().splitlines() if not line.startswith("#")]
    return {tie: Record(*rest) for tie, *rest in lines}


def keep(more):
    """Writes mutants.txt with these records by tie, and keeps those of other ties."""
    all_kept = {**kept(), **more}
    head = [line for line in RECORD.read_text().splitlines() if line.startswith("#")]
    RECORD.write_text("\n".join(head + [all_kept[tie].line(tie) for tie in ties.TIES if tie in all_kept]) + "\n")


def table():
    """Returns the table of ties as text."""
    (tied, others), inputs, mutants = ties.count(), ties.cases(), kept()
    lines = [f"{'tie':<10}{'functions':>11}{'inputs':>13}{'mutants found / made':>24}{'listed':>12}"]
    for tie, number in tied.items():
        r = mutants.get(tie)
        tried = f"{f'{r.found} / {r.made}':>24}{r.listed:>12}" if r else f"{'no record':>24}"
        of = ""
        if r:
            left = r.made - r.found - r.listed
            of = (f"  {r.date}" + ("" if r.digest == digest(tie) else ", changed since") +
                  (f"; {left} neither found nor listed" if left else ""))
        lines.append(f"{tie:<10}{number:>11}{inputs[tie]:>13}{tried}{of}")
    lines.append(f"{sum(tied.values())} functions are tied of {sum(tied.values()) + others} that decide; ties.txt names "
                 "the others.\nMutants are those that ./run mutants recorded (mutants.txt); they are not run here.\n"
                 "Listed with the reason, equivalent or not: tests/proofs/equivalent_mutants.txt.")
    return "\n".join(lines)
