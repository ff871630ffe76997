# Tests of `errbound explain` as a user runs it, on the file of an example: tables, pictures, exit statuses,
# messages. The programs' paths are in the environment variables ERRBOUND_PROGRAM and ERRBOUND_EXAMPLE.
import json
import os
import pathlib
import re
import subprocess
import unittest
from xml.etree import ElementTree

from program import ProgramTest

PROGRAM = os.environ["ERRBOUND_PROGRAM"]
EXAMPLE = os.environ["ERRBOUND_EXAMPLE"]
ROOT = pathlib.Path(__file__).resolve().parents[3]
SVG = "{http://www.w3.org/2000/svg}"


def without_noise(line):
    """Returns a line of a table without the amount and the share if the share is below one percent: the
    smallest amounts differ if the compiler fuses products into sums."""
    share = re.search(r" (\d+\.\d) %  (.*)", line)
    return share[2] if share and float(share[1]) < 1 else line


def bars(picture):
    """Returns the titles of bars of at least one percent. A compiler cache may shorten sources' paths."""
    titles = [re.sub(r"\([^():]*/(?=examples/)", "(", title.text)
              for title in ElementTree.parse(picture).iter(SVG + "title")]
    return [title for title in titles if float(re.search(r": (\d+\.\d) %", title)[1]) >= 1]


class Explain(ProgramTest):
    command = [PROGRAM, "explain"]

    def setUp(self):
        super().setUp()
        self.file = self.directory / "variance.json"
        self.printed = subprocess.run([EXAMPLE, self.file], capture_output=True, text=True, check=True).stdout

    def test_the_table_is_the_programs_own(self):
        results = json.loads(self.file.read_text())["results"]
        tables = self.good(self.file).split("\n\n")
        self.assertEqual(len(tables), len(results))
        for table, result in zip(tables, results):
            self.assertIn(table.strip(), self.printed)
            self.assertTrue(table.startswith(result["name"] + " = "))
            self.assertEqual(len(table.strip().splitlines()), 2 + len(result["contributions"])
                             + ("add up to" in table))
        with open(self.file) as text:
            self.assertEqual(self.good("-", stdin=text), self.good(self.file))

    def test_contributions_add_up(self):
        for result in json.loads(self.file.read_text())["results"]:
            amounts = [c["amount"] for c in result["contributions"]]
            self.assertEqual(amounts, sorted(amounts, reverse=True))
            self.assertGreaterEqual(sum(amounts), result["error"] * (1 - 1e-13))
            if result["rule"] == "tight":
                self.assertLessEqual(sum(amounts), result["error"] * (1 + 1e-13))

    def test_one_result_and_few_lines(self):
        text = self.good(self.file, "--result", "naive variance", "--lines", 1)
        lines = text.splitlines()
        self.assertEqual(len(lines), 4)
        self.assertIn("naive > sum (variance.cpp:", lines[2])
        self.assertRegex(lines[3], r"^  and \d+ more$")

    def test_pictures(self):
        picture = self.directory / "out.svg"
        self.good(self.file, "--picture", picture)
        svg = ElementTree.parse(picture).getroot()
        self.assertEqual(svg.tag, SVG + "svg")
        titles = [title.text for title in svg.iter(SVG + "title")]
        self.assertTrue(any(title.startswith("squares (") for title in titles))
        self.assertEqual(sum(title.startswith("naive variance: 100.0 %") for title in titles), 1)
        done = self.run_program(self.file, "--picture", "-")
        self.assertEqual(done.stdout, picture.read_text())
        self.assertIn("naive variance = ", done.stderr)

    def test_the_page_shows_what_the_example_prints(self):
        page = (ROOT / "docs/how-wrong.md").read_text().split("\n## Over all inputs\n")[0]
        printed = [without_noise(line) for line in self.printed.splitlines()]
        blocks = [text for language, text in
                  re.findall(r"^```(\w*)\n(.*?)^```$", page, re.MULTILINE | re.DOTALL) if not language]
        self.assertEqual(len(blocks), 4)
        for block in blocks:
            lines = [without_noise(line) for line in block.splitlines()]
            self.assertIn("\n".join(lines), "\n".join(printed))
        picture = self.directory / "out.svg"
        self.good(self.file, "--picture", picture)
        self.assertEqual(bars(picture), bars(ROOT / "docs/variance.svg"))

    def test_bad_input(self):
        picture = self.directory / "out.svg"
        for text, message in (("", "text at byte 1 is not JSON"), ("{}", "format is missing"),
                              (self.file.read_text()[:-20], "text at byte")):
            bad = self.directory / "bad.json"
            bad.write_text(text)
            self.refused(1, "bad.json: " + message, bad, "--picture", picture)
            self.assertFalse(picture.exists())
        self.refused(1, "missing.json", self.directory / "missing.json")

    def test_bad_output(self):
        missing = self.directory / "missing" / "out"
        for program, *arguments in ((PROGRAM, "explain", self.file, "--picture", missing), (EXAMPLE, missing)):
            done = subprocess.run([program, *arguments], capture_output=True, text=True)
            self.assertEqual(done.returncode, 1)
            self.assertIn(f"{missing}: ", done.stderr)
            self.assertFalse(missing.parent.exists())

    def test_bad_usage(self):
        text = self.file.read_text()
        for arguments in ((), (self.file, "--result", "no such"), (self.file, "--lines", "0"),
                          (self.file, "--picture", self.file), (self.file, self.file)):
            self.refused(2, "", *arguments)
        self.assertEqual(self.file.read_text(), text)


if __name__ == "__main__":
    unittest.main()
