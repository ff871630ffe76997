# Tests of `errbound ranges` as a user runs it: bounds, reasons, files it writes, messages.
# The path to the program is in the environment variable ERRBOUND_PROGRAM.
import json
import os
import unittest

from program import ProgramTest, rows_of

CORES = """
; A comment (with a bracket
(FPCore (x y) :name "quotient" :precision binary32 :pre (and (<= 1 x 4) (<= 1 y 4)) (/ x (+ x y)))
(FPCore (x1 x2 x3) :name "rigid body"
  :pre (and (<= -15 x1 15) (<= -15 x2 15) (>= 15 x3 -15))
  (- (- (- (- (* x1 x2)) (* (* 2 x2) x3)) x1) x3))
(FPCore (t) :name "constants" :pre (<= 0 t 1/3) (let* ([a 0.1] [b (+ a t)]) (* PI b)))
(FPCore (x y) :name "constraint" :pre (and (<= 0 x 8) (<= 0 y 8) (<= x 1) (<= (+ x y) 2)) (+ x y))
(FPCore (x) :name "decided" :pre (<= 3 x 4) (if (< x 2) (exp x) (- x 3)))
(FPCore (x) :name "undecided" :pre (<= 1 x 4) (if (< x 2) x 1))
(FPCore (x) :name "loop" :pre (<= 1 x 4) (while (< x 9) ([x x (* x x)]) x))
(FPCore (x) :name "unbounded" :pre (>= x 1) (sqrt x))
(FPCore (x) :name "domain" :pre (<= -1 x 1) (log x))
(FPCore (x) :name "operation" :pre (<= 1 x 2) (gamma x))
(FPCore (x) :name "mixed" :pre (<= 1 x 2) (* x (! :precision binary32 (* x x))))
(FPCore (x) :name "format" :precision posit16 :pre (<= 1 x 2) (* x x))
"""


class Ranges(ProgramTest):
    command = [os.environ["ERRBOUND_PROGRAM"], "ranges", "--samples", "4000", "--boxes", "3000"]

    def setUp(self):
        super().setUp()
        self.cores = self.directory / "cores.fpcore"
        self.cores.write_text(CORES)

    def test_bounds_as_table_json_csv_and_picture(self):
        out, table, picture = (self.directory / name for name in ["o.json", "o.csv", "o.svg"])
        text = self.good(self.cores, "--json", out, "--csv", table, "--operations", picture, "--relative")
        found = json.loads(out.read_text())
        done = {entry["core"]: entry for entry in found["done"]}
        self.assertEqual(list(done), ["quotient", "rigid body", "constants", "constraint", "decided"])
        for entry in done.values():
            self.assertLessEqual(entry["at_least"], entry["at_most"])
            self.assertLessEqual(entry["at_most"], 2.01 * entry["at_least"])
            self.assertLessEqual(entry["lower"], entry["upper"])
            self.assertIn(entry["core"], text)
        self.assertAlmostEqual(done["rigid body"]["at_most"], 3.75 * 2**-44, delta=2**-60)
        self.assertEqual(done["decided"]["at_most"], 0)
        self.assertLess(done["constraint"]["at_most"], 1.01 * 2**-52)
        x, y = map(float.fromhex, done["quotient"]["where"])
        self.assertTrue(1 <= x <= 4 and 1 <= y <= 4)
        self.assertGreater(done["quotient"]["relative"], done["quotient"]["at_most"])
        self.assertEqual({o["line"] for o in done["quotient"]["operations"]}, {3})
        self.assertAlmostEqual(sum(o["amount"] for o in done["constants"]["operations"]),
                               done["constants"]["at_most"])
        self.assertIn("constant", {o["operation"] for o in done["constants"]["operations"]})
        reasons = {entry["core"]: entry["reason"] for entry in found["not_done"]}
        self.assertIn("the precision posit16 is not supported; expected one of bfloat16, ", reasons.pop("format"))
        self.assertEqual(reasons, {
            "undecided": "a branch depends on the input", "loop": "the program has a loop",
            "unbounded": "the precondition gives no finite range of x",
            "operation": "the operation gamma is not supported",
            "domain": "there is no finite bound: an operation may overflow or leave its domain",
            "mixed": "the program has several precisions"})
        self.assertEqual([float(row["at_most"]) for row in rows_of(table)],
                         [entry["at_most"] for entry in done.values()])
        self.assertTrue(picture.read_text().startswith("<svg"))

    def test_options(self):
        tool, other = (self.directory / name for name in ["tool.csv", "other.csv"])
        tool.write_text("# source\nquotient,1e-7\nrigid body,1e-14\n")
        other.write_text("quotient,1e-9\n")
        table = self.directory / "all.csv"
        text = self.good(self.cores, "--published", tool, "--published", other, "--csv", table)
        self.assertIn("1 of 2 bounds are at most those of tool", text)
        self.assertIn("0 of 1 bounds are at most those of other", text)
        rows = {row["core"]: row for row in rows_of(table)}
        self.assertEqual(rows["quotient"]["other"], "1e-09")
        self.assertEqual(rows["constants"]["tool"], "")
        half = self.good(self.cores, "--only", "quotient", "--precision", "binary16")
        self.assertIn("binary16", half)
        self.assertIn("1 core bounded", half)
        exact, rounded = (self.directory / name for name in ["exact.json", "rounded.json"])
        self.good(self.cores, "--only", "rigid body", "--json", exact)
        self.good(self.cores, "--only", "rigid body", "--json", rounded, "--round-inputs")
        bounds = [json.loads(p.read_text())["done"][0]["at_most"] for p in [exact, rounded]]
        self.assertAlmostEqual(bounds[1] - bounds[0], 92 * 2**-50, delta=2**-60)

    def test_bounds_of_rules(self):
        out, picture = self.directory / "o.json", self.directory / "o.svg"
        self.good(self.cores, "--rules", "safe,tight,residual", "--json", out, "--picture", picture)
        done = {entry["core"]: entry for entry in json.loads(out.read_text())["done"]}
        for name in ("quotient", "rigid body", "constants"):
            self.assertGreaterEqual(done[name]["tight"], done[name]["at_least"])
            self.assertGreaterEqual(done[name]["residual"], done[name]["at_least"])
            self.assertLess(done[name]["tight"], 4 * done[name]["at_most"])
        self.assertIsNone(done["quotient"]["safe"])  # no division
        self.assertGreater(done["rigid body"]["safe"], done["rigid body"]["tight"])
        text = picture.read_text()
        self.assertIn("<title>rigid body, tight: ", text)
        self.assertNotIn("<title>quotient, safe: ", text)

    def test_names_rounding_and_cores_without_inputs(self):
        out = self.directory / "o.json"
        self.cores.write_text("""
(FPCore () :name "constant" (/ 1 3))
(FPCore (E x) :name "hidden" :pre (and (<= 0 E 4) (<= 0 x 4) (<= E x)) (/ 1 (+ x 1/1024)))
(FPCore (x) :name "different" :pre (<= 1 x 2) (if (!= 1 2 1) (/ x 3) x))
(FPCore ((! :round nearestEven x)) :name "nearest" :pre (<= 1 x 2) (/ x 3))
(FPCore (x x) :name "twice" :pre (<= 1 x 2) (+ x x))
(FPCore (x) :name "down" :round toZero :pre (<= 1 x 2) (* x x))
(FPCore (x) :name "up" :pre (<= 1 x 2) (! :round toPositive (* x x)))
(FPCore ((! :precision binary64 x)) :name "wide" :precision binary16 :pre (<= 1 x 2) x)
(FPCore ((x 2)) :name "array" :pre (<= 1 x 2) x)
(FPCore (x) :name "nothing" :pre (and (<= 1 x 2) (< (* x x) 0)) (+ x 1))
(FPCore (x) :name "empty" :pre (<= 1 x 2) (+ x ()))
(FPCore (x) :name "unbound" :pre (<= 1 x 2) (let ((y)) y))
(FPCore (()) :name "unnamed" 1)
(FPCore (x) :name "branch" :pre (<= 1 x 2) (if () x 1))
(FPCore (x) :name "precise" :pre (<= 1 x 2) :precision () x)
""")
        self.good(self.cores, "--json", out)
        found = json.loads(out.read_text())
        done = {entry["core"]: entry for entry in found["done"]}
        self.assertEqual(list(done), ["constant", "hidden", "different", "nearest"])
        self.assertGreater(done["constant"]["at_most"], 0)
        self.assertGreater(done["hidden"]["at_most"], 2**-45)
        self.assertGreaterEqual(done["hidden"]["upper"], 1024)
        self.assertEqual(done["different"]["at_most"], 0)
        reasons = {entry["core"]: entry["reason"] for entry in found["not_done"]}
        precise = reasons.pop("precise")
        self.assertEqual(reasons, {
            "twice": "two arguments have the name x", "down": "rounding is toZero, not to nearest",
            "up": "rounding is toPositive, not to nearest",
            "wide": "the program has several precisions", "array": "an argument is an array",
            "nothing": "no number of the format satisfies the precondition",
            "empty": "the expression () has no operation; expected (OPERATION ARGUMENT...)",
            "unbound": "the binding (y) has no name and value; expected (NAME VALUE)",
            "unnamed": "the argument () has no name; expected NAME or (! PROPERTY... NAME)",
            "branch": "the condition () is not supported; expected a comparison, and, or, not"})
        self.assertIn("the precision () is not supported; expected one of bfloat16, ", precise)

    def test_bad_input(self):
        for text, message in [("(FPCore (x) (+ x 1)", "1: the file ends; expected a closing parenthesis"),
                              ("\n(FPCore (x) (+ x 1]", "2: a bracket is unmatched"),
                              ("(define x)", "1: expression is '(define x)'; expected a core, (FPCore (ARGUMENT...) BODY)"),
                              ("()", "1: expression is '()'; expected a core"), ("[]", "1: expression is '()'"),
                              ("\n(FPCore (x)\n)", "2: expression is '(FPCore (x))'; expected a core"),
                              ("(FPCore f (x))", "1: expression is '(FPCore f (x))'"), ("x", "1: expression is 'x'"),
                              ("(FPCore x x)", "1: expression is '(FPCore x x)'"),
                              ('(FPCore (x) :name "a', "1: a text does not end")]:
            self.cores.write_text(text)
            self.refused(1, f"{self.cores}:{message}", self.cores)
        self.cores.write_text(CORES)
        self.refused(2, "", self.cores, "--only", "none")
        for option, value in (("--precision", "double"), ("--gap", "nan"), ("--function-units", "nan"),
                              ("--seconds", "-1"), ("--measured", "-1"), ("--rules", "tightest"), ("--rules", "")):
            self.refused(2, value, self.cores, option, value)
        self.refused(2, "", self.cores, "--csv", self.cores)
        column = self.directory / "upper.csv"
        column.write_text("quotient,1\n")
        self.refused(2, "", self.cores, "--published", column)
        bad = self.directory / "bad.csv"
        bad.write_text("quotient;1\n")
        self.refused(1, "bad.csv:1: line is 'quotient;1'; expected CORE,BOUND", self.cores, "--published", bad)


if __name__ == "__main__":
    unittest.main()
