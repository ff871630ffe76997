# Tests of the program `errbound` as a user runs it: exit statuses, messages, files it writes.
# The path to the program is in the environment variable ERRBOUND_PROGRAM.
import json
import os
import unittest
from collections import Counter

from program import ProgramTest, rows_of


class Validate(ProgramTest):
    command = [os.environ["ERRBOUND_PROGRAM"]]

    def good(self, *arguments):
        text = super().good("validate", *arguments)
        self.assertTrue(text.endswith("\nno violations\n"), text)
        return text

    def test_expressions_as_table_json_and_csv(self):
        out, table = self.directory / "out.json", self.directory / "out.csv"
        text = self.good("--expressions", 2000, "--json", out, "--csv", table)
        found = json.loads(out.read_text())
        self.assertEqual(list(found), ["counts", "violations", "tightness", "functions"])
        self.assertEqual(found["violations"], [])
        for entry in found["counts"]:
            self.assertGreaterEqual(entry["cases"], 2000)
            self.assertEqual(entry["violations"], 0)
            self.assertIn(f"{entry['values']:,}", text)
        rules = {entry["rule"] for entry in found["counts"]}
        last = text.rstrip().splitlines()[-2 - len(rules):-2]  # a line per rule, "", the verdict
        self.assertEqual({line.split()[0] for line in last}, rules)
        for line in last:
            rule, cases, values = line.replace(",", "").split()[:3]
            entries = [entry for entry in found["counts"] if entry["rule"] == rule]
            self.assertEqual(int(cases), sum(entry["cases"] for entry in entries))
            self.assertEqual(int(values), sum(entry["values"] for entry in entries))
        self.assertLessEqual({"none", "safe", "tight"}, rules)
        for row, entry in zip(rows_of(table), found["tightness"], strict=True):
            self.assertEqual(list(row), list(entry))
            self.assertEqual(row["quantity"], entry["quantity"])
            self.assertEqual(int(row["ratios"]), entry["ratios"])
            if entry["ratios"] == 0:
                self.assertIsNone(entry["median"])
                self.assertEqual(row["median"], "")
                continue
            quantiles = [entry[q] for q in ("min", "q01", "q25", "median", "q75", "q99", "max")]
            self.assertEqual(quantiles, sorted(quantiles))
            self.assertAlmostEqual(float(row["median"]), entry["median"], places=3)
            self.assertEqual(row["clamped"], entry["clamped"])
            for q in entry["clamped"].split():
                self.assertGreaterEqual(abs(entry[q]), 40)
            self.assertEqual(entry["claimed"], 0.95 if entry["rule"] == "stochastic" else None)
            if entry["rule"] == "stochastic":
                self.assertAlmostEqual(float(row["observed"]), entry["observed"], places=3)
            if entry["measure"] == "bound/error":
                self.assertGreaterEqual(entry["min"], 0)

    def test_same_result_for_same_seed_and_any_threads(self):
        common = ("--expressions", 3000, "--rules", "tight")
        one = self.good(*common, "--threads", 1)
        self.assertEqual(one, self.good(*common, "--threads", 3))
        self.assertNotEqual(one, self.good(*common, "--seed", 2))

    def test_ranges_together_make_the_whole_run(self):
        def totals(*ranges):
            totals = Counter()
            for first, end in zip(ranges, ranges[1:]):
                out = self.directory / "out.json"
                self.good("--rules", "tight,none", "--seed", 3, "--first", first,
                          "--expressions", end - first, "--json", out)
                found = json.loads(out.read_text())
                for entry in found["counts"]:
                    for count in ("cases", "values", "undetermined"):
                        totals[entry["rule"], entry["number"], count] += entry[count]
                for entry in found["tightness"]:
                    key = entry["rule"], entry["number"], entry["quantity"]
                    totals[key] += entry["ratios"] + entry["exact"] + entry["unknown"]
            return totals
        self.assertEqual(totals(0, 4000), totals(0, 1000, 1007, 4000))

    def test_functions(self):
        out, table = self.directory / "out.json", self.directory / "out.csv"
        common = ("--functions", "exp,cbrt,pow", "--samples", 3000)
        text = self.good(*common, "--json", out, "--functions-csv", table)
        self.assertNotIn("expressions", text)
        found = json.loads(out.read_text())["functions"]
        self.assertEqual([(f["function"], f["number"]) for f in found],
                         [(f, n) for f in ("exp", "cbrt", "pow") for n in ("double", "float")])
        for f, row in zip(found, rows_of(table), strict=True):
            self.assertEqual(sorted(row), sorted(f))
            self.assertGreater(f["arguments"], 1000)
            self.assertGreater(f["largest"], 0.4)
            self.assertLessEqual(f["largest"], f["assumed"])
            self.assertEqual((row["at"], int(row["violations"])), (f["at"], 0))
            self.assertIn(f["at"], text)
        self.assertEqual(text, self.good(*common, "--threads", 3))
        self.assertNotEqual(text, self.good(*common, "--seed", 2))
        # They are not correctly rounded to one bit more.
        done = self.run_program("validate", *common, "--units", "0.25")
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stdout, r"\n[1-9][0-9]+ violations\n$")

    def test_a_table_on_standard_output(self):
        done = self.run_program("validate", "--expressions", 100, "--rules", "tight", "--csv", "-")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(done.stdout.startswith("part,rule,number,"))
        self.assertTrue(done.stderr.endswith("\nno violations\n"))

    def test_bad_usage(self):
        for message, *arguments in (
                ("command is missing",), ("nothing", "nothing"),
                ("--rules is 'loose'", "validate", "--rules", "loose"),
                ("--rules is 'tight,tight', with 'tight' twice", "validate", "--rules", "tight,tight"),
                ("--expressions", "validate", "--expressions", "0"),
                ("--operations", "validate", "--operations", "49"),
                ("--operations is given without", "validate", "--tiny", "--operations", "3"),
                ("--functions is 'erf'", "validate", "--functions", "erf"),
                ("--functions is 'exp,sin,exp', with 'exp' twice", "validate", "--functions", "exp,sin,exp"),
                ("--numbers has no float, double", "validate", "--functions", "exp", "--numbers", "float16"),
                ("--samples is given without --functions", "validate", "--samples", 10),
                ("--every-float is given without --functions", "validate", "--every-float"),
                ("--every-float is given; expected a function", "validate", "--functions", "atan2", "--every-float"),
                ("--every-float is given; expected a function", "validate", "--functions", "sin", "--numbers", "double",
                 "--every-float"),
                ("--units is given without --functions", "validate", "--units", "1"),
                ("--units is out of range", "validate", "--functions", "sin", "--units", "nan"),
                ("--units is out of range", "validate", "--functions", "sin", "--units", "0"),
                ("--seed", "validate", "--seed", "-1"), ("--seed", "validate", "--seed", str(2**64)),
                ("--seed is given without", "validate", "--tiny", "--seed", "3"),
                ("--first is given without --expressions", "validate", "--tiny", "--first", 3),
                ("--every-bound is given without --tiny", "validate", "--every-bound"),
                ("--csv is given without", "validate", "--functions", "sin", "--csv", "out"),
                ("", "validate", "--json", "out", "--csv", "out")):
            self.refused(2, message, *arguments)


if __name__ == "__main__":
    unittest.main()
