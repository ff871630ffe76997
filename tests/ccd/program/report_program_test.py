# Tests of `ccd report` as users run it: output files, resumption after a stop, exit statuses.
import csv
import os
import struct
import subprocess
import unittest

from program_test import AFTER, BEFORE, FACES, PROGRAM, ProgramTest, obj

# A vertex that falls through a triangle.
HIT = ["0.25,0.25,1", "0,0,0", "1,0,0", "0,1,0", "0.25,0.25,-1", "0,0,0", "1,0,0", "0,1,0"]

HAVE_MATPLOTLIB = subprocess.run(["/usr/bin/python3", "-c", "import matplotlib"],
                                 capture_output=True, check=False).returncode == 0


class Report(ProgramTest):
    def setUp(self):
        super().setUp()
        self.data, self.out = self.directory / "data", self.directory / "out"
        self.write("falling/frame0.obj", obj(BEFORE, FACES))
        self.write("falling/frame1.obj", obj(AFTER, FACES))
        # Pictures take seconds, so only their tests draw them.
        self.write("../no/matplotlib.py", "raise ImportError")

    def write(self, name, text):
        return super().write(f"data/{name}", text)

    def report(self, *arguments, sections="methods,times,bounds", pictures=False, status=0):
        environment = dict(os.environ)
        if not pictures:
            environment["PYTHONPATH"] = str(self.directory / "no")
        done = subprocess.run(
            [PROGRAM, "report", "--quick", "--sections", sections, "--out", self.out,
             *map(str, arguments)], capture_output=True, text=True, timeout=300, check=False,
            env=environment)
        self.assertEqual(done.returncode, status, done.stderr)
        return done.stdout if status != 2 else done.stderr

    def table(self, name):
        with (self.out / name).open(newline="") as file:
            return list(csv.DictReader(file))

    def parts(self):
        return {path.name: path.read_text() for path in (self.out / "parts").iterdir()}

    def test_tables_tell_the_same(self):
        self.write("hits/vertex-face/1.csv", "".join(f"{line},1\n" for line in HIT))
        text = self.report(self.data, "--commit", "of-the-test")
        rows = self.table("methods.csv")
        self.assertEqual({r["data_set"] for r in rows}, {"falling", "hits"})
        for method in ("exact", "exact, batch"):
            found = [(r["data_set"], r["origin"], r["kind"], r["queries"], r["colliding"],
                      r["collisions"], r["false_positives"], r["false_negatives"])
                     for r in rows if r["method"] == method]
            self.assertIn(("hits", "stored", "vf", "1", "1", "1", "0", "0"), found)
            self.assertIn(("falling", "scene", "vf", "3", "3", "3", "0", "0"), found)
        self.assertTrue(all(float(r["ns_min"]) > 0 for r in rows))
        markdown = (self.out / "report.md").read_text()
        self.assertIn("of-the-test", markdown)
        self.assertIn("None: every method kept its promise", markdown)
        for method in {r["method"] for r in rows}:
            self.assertIn(f"| {method} |", markdown)
            self.assertIn(f"\n{method} ", text)
        for r in self.table("times.csv"):
            times = [float(r[key]) for key in ("ns_median", "ns_90", "ns_99", "ns_99_9",
                                               "ns_worst")]
            self.assertEqual(times, sorted(times))
        self.assertEqual({r["variable"] for r in self.table("bounds.csv")},
                         {"Y(0)", "Y(1)", "Y'(0)", "Y'(1)", "Y''(0)", "Y''(1)"})

    def test_first_contacts(self):
        # The vertex touches at 1/2, at 1/3, never, or at the start.
        miss, third = ([*HIT[:4], f"0.25,0.25,{z}", *HIT[5:]] for z in (0.5, -2))
        self.write("hits/vertex-face/1.csv", "\n".join([*HIT, *third, *miss, "0.25,0.25,0", *HIT[1:], *HIT]) + "\n")
        self.report(self.data, sections="contacts")
        rows = {(r["data_set"], r["kind"]): r for r in self.table("contacts.csv")}
        counts = ("queries", "contacts", "at_start", "one_double", "neighbours")
        self.assertEqual([rows["hits", "vf"][c] for c in counts], ["5", "4", "1", "2", "1"])
        self.assertEqual(float(rows["hits", "vf"]["width_largest"]), 2.0**-54)
        self.assertEqual([rows["falling", "vf"][c] for c in counts[:2]], ["3", "3"])
        for r in rows.values():
            self.assertEqual(sum(int(r[c]) for c in counts[2:]), int(r["contacts"]))
            if r["width_largest"]:
                self.assertLessEqual(float(r["width_largest"]), 2.0**-53)
            self.assertGreater(float(r["ns_batch_time"]), 0)
        self.assertIn(("touch-start", "ee"), rows)
        self.assertNotIn(("not-finite", "ee"), rows)
        markdown = (self.out / "report.md").read_text()
        self.assertIn("## First contacts", markdown)
        self.assertIn("| double-root | vf | ", markdown)

    def test_goes_on_where_it_was(self):
        def resumed(text):
            lines = [line for line in text.splitlines() if line.startswith("going on: ")]
            return lines[0].split()[2] if lines else "0"

        arguments = [self.data, "--method", "float,exact"]
        self.assertEqual(resumed(self.report(*arguments)), "0")
        first, table = self.parts(), self.table("methods.csv")
        self.assertEqual(resumed(self.report(*arguments)), str(len(first)))
        self.assertEqual(self.parts(), first)
        self.assertEqual(self.table("methods.csv"), table)

        # One part is missing and one damaged: only these are measured again.
        gone, damaged = sorted(name for name in first if "errors" in name)[:2]
        (self.out / "parts" / gone).unlink()
        (self.out / "parts" / damaged).write_text(first[damaged].replace('"queries": ',
                                                                         '"queries": 1'))
        self.assertEqual(resumed(self.report(*arguments)), str(len(first) - 2))
        self.assertEqual(self.parts().keys(), first.keys())
        self.assertEqual(self.parts()[gone], first[gone])
        self.assertEqual(self.parts()[damaged], first[damaged])

        # Other methods are timed again; errors and bounds do not depend on methods.
        kept = sum("errors_of_exact" in name or "bounds" in name for name in first)
        self.assertEqual(resumed(self.report(self.data, "--method", "exact")), str(kept))
        # With other data nothing is kept.
        self.write("falling/frame1.obj", obj([*AFTER[:-1], (0.2, 0.4, -0.7)], FACES))
        self.assertEqual(resumed(self.report(*arguments)), "0")

    def test_broken_promise(self):
        self.write("hits/vf/1.csv", "".join(f"{line},0\n" for line in HIT))
        text = self.report(self.data, "--method", "exact", status=1)
        self.assertIn("FAILED: exact: 1 false collisions on hits, vf, against its promise", text)
        self.assertIn("* exact: 1 false collisions on hits, vf, against its promise",
                      (self.out / "report.md").read_text())

    def test_left_out(self):
        self.write("bad/vf/1.csv", "1,2\n")
        self.write("bad/table.csv", "a,b\n")
        text = self.report(self.data, "--method", "exact")
        self.assertIn("1.csv:1: ", text)
        self.assertIn("table.csv: its path names no kind of query", text)
        self.assertIn("table.csv`: its path names no kind of query",
                      (self.out / "report.md").read_text())

    def test_bad_input_and_usage(self):
        empty = self.directory / "empty"
        empty.mkdir()
        self.report(empty, status=1)
        self.report(self.directory / "missing", status=1)
        self.assertFalse(self.out.exists())
        self.assertIn("--sections", self.report(self.data, "--sections", "all", status=2))

    @unittest.skipUnless(HAVE_MATPLOTLIB, "no matplotlib")
    def test_pictures(self):
        self.report(self.data, "--method", "float,exact", pictures=True,
                    sections="methods,times,contacts,bounds")
        markdown = (self.out / "report.md").read_text()
        for name in ("pareto", "bounds", "times", "contacts"):
            self.assertTrue((self.out / f"{name}.png").read_bytes().startswith(b"\x89PNG"))
            self.assertIn("<svg", (self.out / f"{name}.svg").read_text())
            self.assertIn(f"]({name}.png)", markdown)
        self.check_sizes()
        # A later report that cannot draw does not show these pictures.
        self.report(self.data, "--method", "exact")
        self.assertFalse((self.out / "pareto.png").exists())
        self.assertNotIn("pareto.png", (self.out / "report.md").read_text())

    def check_sizes(self):
        for picture in self.out.glob("*.png"):
            sides = struct.unpack(">II", picture.read_bytes()[16:24])
            self.assertLessEqual(max(sides), 2000, picture)
            self.assertGreaterEqual(min(sides), 300, picture)

    @unittest.skipUnless(HAVE_MATPLOTLIB, "no matplotlib")
    def test_pictures_of_many_rows_fit_a_screen(self):
        """The picture of 14 rules and 33 quantities was 12,816 pixels tall."""
        self.report(self.data, "--method", "exact", sections="methods")
        quantiles = [f"q{p}" for p in (1, 25, 50, 75, 99)]
        values = range(5)
        with open(self.out / "tightness.csv", "w") as file:
            print("part,rule,number,quantity,measure,q01,q25,median,q75,q99", file=file)
            for rule in range(14):
                for quantity in range(33):
                    print("expressions", f"rule{rule}", "double", f"quantity {quantity}", "bound/error",
                          *(v * rule / 4 - (quantity == 3) for v in values), sep=",", file=file)
        with open(self.out / "bounds.csv", "w") as file:
            print("data_set,kind,rule,variable", *(f"relative_{q}" for q in quantiles), sep=",", file=file)
            for data_set in range(6):
                for kind in "vf", "ee":
                    for variable in "abcdef":
                        print(f"set {data_set}", kind, "tight", variable, *(10.0**(v - 16) for v in values),
                              sep=",", file=file)
        subprocess.run(["/usr/bin/python3", self.out / "plot.py"], check=True)
        self.check_sizes()
        self.assertTrue((self.out / "tightness.png").exists())


if __name__ == "__main__":
    unittest.main()
