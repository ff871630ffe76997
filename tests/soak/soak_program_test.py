"""The soak program as users run it: stopped by signals and resumed, with the report of an uninterrupted run.

    SOAK_PROGRAM=build/tests/soak/errbound_soak python3 soak_program_test.py
"""

import json
import os
import signal
import subprocess
import tempfile
import time
import unittest
from collections import Counter
from pathlib import Path

PROGRAM = os.environ["SOAK_PROGRAM"]


class StopAndResume(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def command(self, name, queries, *options):
        folder = str(Path(self.folder.name) / name)
        return [PROGRAM, "--folder", folder, "--queries", str(queries), *options]

    def state(self, name):
        state = json.loads((Path(self.folder.name) / name / "state.json").read_text())["value"]
        del state["seconds"]
        return state

    def stop_and_resume(self, queries, *options):
        whole = subprocess.run(
            self.command("whole", queries, *options), capture_output=True, text=True
        )
        self.assertEqual(whole.returncode, 0, whole.stdout + whole.stderr)
        self.assertIn("seed 1: ", whole.stdout)
        self.assertIn(" 0 differ, checksum ", whole.stdout)

        stopped, more = 0, ["--threads", "1"]
        for sent in [signal.SIGINT, signal.SIGTERM] * 50:
            command = self.command("parts", queries, *options, *more)
            part = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
            part.stdout.readline()  # wait for the start
            time.sleep(0.1)
            part.send_signal(sent)
            text = part.stdout.read()
            part.stdout.close()
            more = ["--resume"]
            if part.wait() == 0:
                break
            self.assertEqual(part.returncode, 3, text)
            self.assertIn("--resume goes on", text)
            stopped += 1
        self.assertEqual(part.returncode, 0)
        self.assertGreater(stopped, 0)
        self.assertEqual(self.state("parts"), self.state("whole"))

    def test_comparison(self):
        self.stop_and_resume(8000)

    def test_symmetries(self):
        self.stop_and_resume(600000, "--symmetries")

    def counts(self, name):
        """The counts of a run by table and row, and the number of blocks."""
        state = self.state(name)
        self.assertEqual(state["different"], 0)
        counts = Counter(blocks=state["blocks"])
        for table in state["tables"]:
            for row in table["rows"]:
                for column, count in zip(table["columns"], row["counts"]):
                    counts[table["title"], row["name"], column] += count
        return counts

    def test_ranges_together_make_the_whole_run(self):
        for part, ranges in ((), (0, 4000, 8000)), (("--symmetries",), (0, 200000, 300000, 600000)):
            with self.subTest(part=part):
                whole = f"whole{len(part)}"
                subprocess.run(
                    self.command(whole, ranges[-1], *part), check=True, capture_output=True
                )
                total = Counter()
                for first, end in zip(ranges, ranges[1:]):
                    name = f"{whole}-{first}"
                    command = self.command(name, end - first, "--first", str(first), *part)
                    subprocess.run(command, check=True, capture_output=True)
                    total += self.counts(name)
                self.assertEqual(total, +self.counts(whole))

    def test_unfinished_run_is_not_overwritten(self):
        command = self.command("once", 1)
        self.assertEqual(subprocess.run(command, capture_output=True).returncode, 0)
        again = subprocess.run(command, capture_output=True, text=True)
        self.assertEqual(again.returncode, 1)
        self.assertIn("--resume", again.stderr)
        other_seed = subprocess.run(
            command + ["--resume", "--seed", "2"], capture_output=True, text=True
        )
        self.assertEqual(other_seed.returncode, 1)
        self.assertIn("seed is 1; expected the given one, 2", other_seed.stderr)
        other_range = subprocess.run(
            command + ["--resume", "--first", "5"], capture_output=True, text=True
        )
        self.assertEqual(other_range.returncode, 1)
        self.assertIn("first is 0; expected the given one, 5", other_range.stderr)

    def test_bad_usage(self):
        for options in (["many"], [1, "--unknown"]):
            command = self.command("none", *options)
            self.assertEqual(subprocess.run(command, capture_output=True).returncode, 2)


if __name__ == "__main__":
    unittest.main()
