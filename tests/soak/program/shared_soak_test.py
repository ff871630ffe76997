"""The soak over ranks: the state of one process, also after a rank was killed, and each goes on with
the other's.
"""

import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import over_ranks


class OverRanks(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def start(self, ranks, name, *options):
        program = os.environ["SOAK_MPI_PROGRAM"]
        return over_ranks.start(ranks, program, "--folder", self.folder / name, *options)

    def run_over(self, ranks, name, *options):
        program = os.environ["SOAK_MPI_PROGRAM"]
        return over_ranks.run(ranks, program, "--folder", self.folder / name, *options)

    def run_in_one(self, name, *options):
        folder = str(self.folder / name)
        command = [os.environ["SOAK_PROGRAM"], "--folder", folder, *options]
        done = subprocess.run(command, capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def state(self, name):
        state = json.loads((self.folder / name / "state.json").read_text())
        del state["seconds"]
        return state

    def expect_same(self, *part):
        self.run_in_one("one", *part)
        for ranks in (1, 2, 5):
            status, out, err = self.run_over(ranks, f"over{ranks}", *part)
            self.assertEqual((status, err), (0, ""))
            self.assertIn(" 0 differ, checksum ", out)
            self.assertEqual(self.state(f"over{ranks}"), self.state("one"))

    def test_same_as_one_process(self):
        self.expect_same("--queries", "4000", "--seed", "3")

    def test_meshes(self):
        self.expect_same("--meshes", "300")

    def begun(self, ranks, name, *options):
        """A run that has done something."""
        process = self.start(ranks, name, *options)
        path = self.folder / name / "state.json"
        while not path.exists() or json.loads(path.read_text())["blocks"] == 0:
            self.assertIsNone(process.poll(), "ended too soon")
            time.sleep(0.01)
        return process

    def test_killed_and_resumed(self):
        part = ("--queries", "60000")
        self.run_in_one("one", *part)
        killed = self.begun(3, "all", *part)
        os.kill(over_ranks.pids(killed)[1], signal.SIGKILL)
        begin = time.monotonic()
        _, err = killed.communicate(timeout=60)
        self.assertLess(time.monotonic() - begin, 15)
        self.assertEqual(killed.returncode, 137)
        self.assertIn("exited on signal 9", err)
        self.assertIn("soak: asked to end; --resume goes on\n", err)
        self.assertLess(self.state("all")["blocks"], self.state("one")["blocks"])

        asked = self.start(2, "all", *part, "--resume")
        asked.stdout.readline()  # only then has it started
        os.kill(over_ranks.pids(asked)[0], signal.SIGTERM)
        out, err = asked.communicate(timeout=60)
        if asked.returncode != 0:
            self.assertEqual(asked.returncode, 3, err)
            self.assertIn("--resume goes on", out)
        self.run_in_one("all", *part, "--resume")
        self.assertEqual(self.state("all"), self.state("one"))

        more = ("--queries", "64000", "--resume")
        self.run_in_one("one", *more)
        self.assertEqual(self.run_over(3, "all", *more)[0], 0)
        self.assertEqual(self.state("all"), self.state("one"))

    def test_symmetries_go_on_over_other_ranks_and_alone(self):
        killed = self.begun(3, "killed", "--queries", str(10**9), "--symmetries")
        os.kill(over_ranks.pids(killed)[1], signal.SIGKILL)
        _, err = killed.communicate(timeout=30)  # within seconds
        self.assertNotEqual(killed.returncode, 0)
        self.assertIn("signal 9", err)
        blocks = self.state("killed")["blocks"]
        queries = 600000  # more blocks than the killed run has done
        status, out, err = self.run_over(2, "killed", "--queries", str(queries // 2), "--symmetries", "--resume")
        self.assertEqual((status, err), (0, ""))
        self.run_in_one("killed", "--queries", str(queries), "--symmetries", "--resume")
        self.run_in_one("whole", "--queries", str(queries), "--symmetries")
        self.assertGreaterEqual(self.state("killed")["blocks"], blocks)
        self.assertEqual(self.state("killed"), self.state("whole"))

    def test_errors_are_told_once(self):
        self.assertEqual(self.run_over(2, "once", "--queries", "1")[0], 0)
        for status, message, options in (
            (1, "found a run's state; go on with --resume", ("--queries", "1")),
            (1, "found seed 1, expected the seed given, 2", ("--resume", "--seed", "2")),
            (2, "--unknown", ("--unknown",)),
        ):
            for ranks in (1, 3):
                found, _, err = self.run_over(ranks, "once", *options)
                self.assertEqual(found, status, err)
                self.assertEqual(err.count(message), 1, err)


if __name__ == "__main__":
    unittest.main()
