# Tests of `errbound conformance` as a user runs it, on small files in the forms of published sets.
# The path to the program is in the environment variable ERRBOUND_PROGRAM.
import fractions
import json
import math
import os
import random
import unittest

from program import ProgramTest, rows_of

INTERVALS = """/* Intervals: a comment
   of two lines */
testcase sums {
    add [1.0, 2.0] [3.0, 4.0] = [4.0, 6.0];
    add [0.1] [0x1.999999999999ap-3] = [0x1.3333333333333p-2, 0x1.3333333333334p-2]; // a point
    sub [1.0, 2.0]_com [1.0, 2.0]_dac = [-1.0, 1.0]_dac;
    add [empty] [1.0, 2.0] = [empty];
    add [2.0, 1.0] [1.0, 2.0] = [2.0, 3.0];
    add [1.0, infinity] [1.0, 2.0] = [2.0, infinity];
}
testcase others {
    sqrt [4.0, 9.0] = [2.0, 3.0]; fma [1.0, 2.0] [3.0] [-1.0, 1.0] = [2.0, 7.0];
    pown [-2.0, 1.0] 2 = [0.0, 4.0];
    log [1.0, 2.0] = [0.0, 0x1.62E42FEFA39F0p-1];
    intersection [1.0, 2.0] [1.5, 3.0] = [1.5, 2.0];
    isEmpty [1.0, 2.0] = false;
}
"""
CORES = """
(FPCore (x y) :name "quotient" :pre (and (<= 1 x 4) (<= 1 y 4)) (/ x (+ x y)))
(FPCore (x) :name "loop" :pre (<= 1 x 4) (while (< x 9) ([x x (* x x)]) x))
"""


def determinant(rows):
    """Returns the determinant of fractions by expansion."""
    if len(rows) == 1:
        return rows[0][0]
    return sum((-1) ** k * row[0] * determinant([r[1:] for i, r in enumerate(rows) if i != k])
               for k, row in enumerate(rows))


def sign(points, lifted):
    exact = [[fractions.Fraction(c) for c in p] for p in points]
    rows = [[a - b for a, b in zip(p, exact[-1])] for p in exact[:-1]]
    if lifted:
        rows = [row + [sum(c * c for c in row)] for row in rows]
    d = determinant(rows)
    return (d > 0) - (d < 0)


def fixtures(name, count, dimension, points, lifted):
    """Returns lines of nearly degenerate points with exact signs."""
    source, lines = random.Random(name), []
    for i in range(count):
        p = [[source.choice([1, 3, 12]) + source.randint(-2, 2) * 2.0 ** -50
              for _ in range(dimension)] for _ in range(points)]
        s = sign(p, lifted)
        lines.append(" ".join([str(i), *(repr(c) for q in p for c in q), str(s)]))
    return "\n".join(lines) + "\n"


class Conformance(ProgramTest):
    def setUp(self):
        super().setUp()
        self.folder = self.directory / "sets"
        self.folder.mkdir()

    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
        return path

    def run_program(self, *arguments):
        self.command = [os.environ["ERRBOUND_PROGRAM"], "conformance", self.folder]
        return super().run_program(*arguments)

    def found(self, *arguments, status=0):
        out = self.folder.parent / "out.json"
        done = self.run_program("--json", out, *arguments)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        all = json.loads(out.read_text())
        return {(r["set"], r["subject"], r["method"]): r for r in all["table"]}, all, done.stdout

    def test_predicates(self):
        for name, *shape in (("orient2d", 2, 3, False), ("orient3d", 3, 4, False),
                             ("incircle", 2, 4, True), ("insphere", 3, 5, True)):
            self.write(f"{name}.txt", fixtures(name, 60, *shape))
        self.write("notes.txt", "1 2 3\n")
        rows, all, _ = self.found()
        self.assertEqual(all["wrong"], [])
        for name in ("orient2d", "orient3d", "incircle", "insphere"):
            self.assertEqual(rows["predicates", name, "exact"]["cases"], 60)
            self.assertEqual(rows["predicates", name, "exact"]["wrong"], 0)
            self.assertGreater(rows["predicates", name, "tight"]["uncertain"], 0)
            self.assertEqual(rows["predicates", name, "residual"]["wrong"], 0)
        self.assertGreater(rows["predicates", "insphere", "tight"]["median_ratio"], 1)
        self.assertIsNone(rows["predicates", "orient2d", "stochastic"]["wrong"])
        self.assertEqual(all["skipped"], [{"skipped": "files", "count": 1,
                                           "reason": "a text file is not named by a predicate"}])

    def test_wrong_signs_are_found(self):
        path = self.write("orient2d.txt", "0 0 0 1 0 0 1 1\n1 0 0 1 0 0 1 -1\nno numbers\n3 inf 0 1 0 0 1 1\n")
        rows, all, text = self.found("--rules", "tight", status=1)
        self.assertEqual(rows["predicates", "orient2d", "exact"]["wrong"], 1)
        self.assertEqual(all["wrong"], [f"{path}:2: the sign of orient2d by exact is wrong"])
        self.assertIn("1 wrong answer", text)
        self.assertEqual(all["skipped"][0]["count"], 2)

    def test_intervals(self):
        path = self.write("sums.itl", INTERVALS)
        rows, all, _ = self.found("--csv", self.folder.parent / "out.csv",
                                  "--picture", self.folder.parent / "out.svg")
        cases = {subject: r["cases"] for (_, subject, _), r in rows.items()}
        self.assertEqual(cases, {"add": 2, "sub": 1, "sqrt": 1, "fma": 1, "pown": 1, "log": 1})
        self.assertAlmostEqual(rows["ITF1788", "sub", "interval"]["median_ratio"], 1, delta=0.05)
        reasons = {r["reason"]: r["count"] for r in all["skipped"]}
        self.assertEqual(reasons, {
            "an operand is empty or unbounded": 1,
            "the result is empty, unbounded or no interval": 2,
            "the library has no such operation: intersection, isEmpty": 2})
        self.assertEqual(sum(int(r["cases"]) for r in rows_of(self.folder.parent / "out.csv")), 7)
        self.assertIn("ITF1788, log", (self.folder.parent / "out.svg").read_text())
        path.write_text("testcase wrong { add [1.0] [1.0] = [2.0, 3.0]; }")
        _, all, _ = self.found(status=1)
        self.assertEqual(all["wrong"], [f"{path}:1: the interval of add by interval is wrong"])

    def test_functions(self):
        self.write("binary64/exp.wc", "# hard cases\n0x1.0122ef37212ebp-1\n-0x1p-30\n\nnan\n")
        self.write("binary32/expf.wc", "0x1.8p0\n0x1.0000001p0\n")
        self.write("binary64/atan2.wc", "0x1p+0,0x1.8p+1\n-1.5, 2\n1\n")
        self.write("binary64/erf.wc", "0x1p0\n")
        rows, all, _ = self.found()
        self.assertEqual({subject: (r["cases"], r["wrong"]) for (_, subject, _), r in rows.items()},
                         {"exp": (2, 0), "expf": (1, 0), "atan2": (2, 0)})
        self.assertGreaterEqual(rows["functions", "exp", "tight"]["median_ratio"], 1)
        self.assertEqual({r["reason"]: r["count"] for r in all["skipped"]}, {
            "a line has no finite arguments, or too many or too few": 2,
            "an argument is no float": 1, "the library has no such function: erf": 1})

    def test_polynomials(self):
        wilkinson = [1]
        for root in range(1, 21):
            wilkinson = [a - root * b for a, b in zip([0, *wilkinson], [*wilkinson, 0])]
        self.write("wilk20.pol", "!wilk20\ndri\n0\n20\n\n" + "\n".join(map(str, wilkinson)))
        self.write("results/wilk20.res", "".join(f"(0.{k}e2, 0.e-99)\n" if k > 9 else f"({k}, 0.e-9)\n"
                                                 for k in range(1, 21)))
        self.write("exp.pol", "drq\n0\n3\n" + "".join(f"1\n{math.factorial(k)}\n" for k in range(4)))
        self.write("sparse.pol", "sri\n0\n5\n2\n0\n-32\n5\n1\n")
        self.write("sparse.res", "(0.2e1, 0.e-9)\n(0.6e0, 0.19e1)\n(0.6e0, -0.19e1)\n")
        self.write("decimal.pol", "drf\n0\n2\n-2.25e0\n0\n1.\n")
        self.write("decimal.res", "(1.5, 0.e-9)\n(-1.5, 0.e-9)\n")
        self.write("complex.pol", "dci\n0\n1\n1 0\n1 1\n")
        rows, all, _ = self.found("--rules", "tight,residual")
        self.assertEqual(rows["MPSolve", "real roots", "exact"]["cases"], 3)
        self.assertEqual(rows["MPSolve", "value next to a root", "tight"]["wrong"], 0)
        self.assertEqual({r["reason"] for r in all["skipped"]},
                         {"coefficients are complex", "the folder has no results of the polynomial"})
        path = self.write("sparse.res", "(0.2e1, 0.e-9)\n(0.21e1, 0.e-9)\n")
        _, all, _ = self.found("--rules", "tight", status=1)
        self.assertEqual(all["wrong"], [f"{self.folder / 'sparse.pol'}: the list of real roots by exact is wrong"])

    def test_programs(self):
        self.write("cores.fpcore", CORES)
        rows, all, _ = self.found("--rules", "safe,tight,residual", "--measured", 100)
        self.assertEqual([method for _, _, method in rows], ["worst_case", "safe", "tight", "residual"])
        for r in rows.values():
            self.assertEqual((r["subject"], r["cases"], r["wrong"]), ("binary64", 1, 0))
        self.assertEqual(rows["FPBench", "binary64", "safe"]["uncertain"], 1)  # no division
        self.assertEqual(all["skipped"][0]["reason"], "the program has a loop")

    def test_bad_input(self):
        self.refused(1, "")
        self.refused(2, "tightest", "--rules", "tightest")
        self.refused(2, "-1", "--seconds", "-1")
        path = self.write("sums.itl", INTERVALS)
        self.refused(2, "", "--csv", path)
        self.assertEqual(path.read_text(), INTERVALS)
        self.folder = self.folder / "missing"
        self.refused(1, "is no folder; expected a folder")


if __name__ == "__main__":
    unittest.main()
