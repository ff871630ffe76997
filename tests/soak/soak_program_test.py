"""The soak program as users run it: ranges, and runs that signals stop, together have the counts of the whole run.

    PYTHONPATH=tests/support SOAK_PROGRAM=build/tests/soak/errbound_soak python3 tests/soak/soak_program_test.py
"""

import os
import re
import signal
import subprocess
import time
import unittest
from collections import Counter

from program import ProgramTest


class Soak(ProgramTest):
    def setUp(self):
        super().setUp()
        self.command = [os.environ["SOAK_PROGRAM"], "--folder", self.directory]

    def counts(self, text):
        """Returns the counts that a run printed, by row."""
        self.assertIn(" 0 differ, checksum ", text)
        counts = Counter()
        for line in text.splitlines():
            name, *cells = re.split(r"\s{2,}", line.strip())
            for column, cell in enumerate(cells[:-1]):  # the last one is a share
                if re.fullmatch(r"[\d,]+", cell):
                    counts[name, column] += int(cell.replace(",", ""))
        self.assertGreater(len(counts), 50)
        return counts

    def run_whole(self, *options):
        return self.counts(self.good(*options))

    def test_bad_usage(self):
        for message, *arguments in (
                ("--threads is many; expected 0 to 4096", "--threads", "many"),
                ("--queries is given with --meshes; expected only one", "--queries", 5, "--meshes", 5),
                ("value of --meshes is missing; expected UINT in ", "--meshes"),
                ("several of --symmetries,--meshes,", "--symmetries", "--meshes", 5),
                ("option is '--mesh'; expected one that ./run soak --help lists", "--mesh", 5)):
            self.refused(2, message, *arguments)

    def test_ranges_together_make_the_whole_run(self):
        for part, ranges in ((), (0, 4000, 8000)), (("--symmetries",), (0, 200000, 300000, 600000)):
            with self.subTest(part=part):
                total = sum((self.run_whole("--first", first, "--queries", end - first, *part)
                             for first, end in zip(ranges, ranges[1:])), Counter())
                self.assertEqual(total, +self.run_whole("--queries", ranges[-1], *part))

    def test_stopped_runs_are_continued(self):
        for part, queries in ((), 8000), (("--symmetries",), 600000):
            total, left, stopped = Counter(), ["--queries", str(queries)], 0
            for sent in [signal.SIGINT, signal.SIGTERM] * 50:
                run = subprocess.Popen([*self.command, *part, *left, "--threads", "1"], stdout=subprocess.PIPE, text=True)
                run.stdout.readline()  # wait for the start
                time.sleep(0.2)
                run.send_signal(sent)
                text = run.stdout.read()
                run.stdout.close()
                total += self.counts(text)
                if run.wait() == 0:
                    break
                self.assertEqual(run.returncode, 3, text)
                first, count = re.search(r"what is left: --first (\d+), and (\d+) queries", text).groups()
                left = ["--first", first, "--queries", count]
                stopped += 1
            self.assertEqual(run.returncode, 0)
            self.assertGreater(stopped, 0)
            self.assertEqual(total, +self.run_whole("--queries", queries, *part))

    def test_bad_usage(self):
        for options in (["--queries", "many"], ["--unknown"]):
            self.refused(2, "", *options)


if __name__ == "__main__":
    unittest.main()
