"""A soak over the ranks of MPI: the same as in one process, for every number of ranks; a rank that is
killed ends the run, which goes on from its state, over ranks or alone, to the same result.
"""
import json
import os
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

ALONE, SHARED = os.environ["SOAK_PROGRAM"], os.environ["SOAK_MPI_PROGRAM"]
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                   OMPI_MCA_rmaps_base_oversubscribe="1")


def children_of(process):
    """By Linux's /proc: the process's number, its name in parentheses, its state, its parent, ..."""
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            text = stat.read_text()
        except OSError:  # it has ended
            continue
        if int(text.rpartition(")")[2].split()[1]) == process:
            found.append(int(stat.parent.name))
    return sorted(found)


class SharedSoak(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def command(self, name, ranks, queries, *options):
        launcher = [os.environ["MPIEXEC"], os.environ["MPIEXEC_NUMPROC_FLAG"], str(ranks), SHARED]
        return [*(launcher if ranks else [ALONE]), "--threads", "1", "--folder", str(self.folder / name),
                "--queries", str(queries), *options]

    def run_to_end(self, name, ranks, queries, *options):
        done = subprocess.run(self.command(name, ranks, queries, *options), capture_output=True, text=True,
                              timeout=300, env=ENVIRONMENT)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(done.stdout.count(" 0 differ, checksum "), 1, done.stdout)

    def state(self, name):
        state = json.loads((self.folder / name / "state.json").read_text())
        del state["seconds"]
        return state

    def test_same_for_every_number_of_ranks(self):
        self.run_to_end("alone", 0, 8000)
        for ranks in (1, 2, 3):
            self.run_to_end(f"{ranks}", ranks, 8000)
            self.assertEqual(self.state(f"{ranks}"), self.state("alone"))

    def test_goes_on_after_a_rank_was_killed(self):
        many = 10**9
        run = subprocess.Popen(self.command("killed", 3, many, "--symmetries"), stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True, env=ENVIRONMENT, start_new_session=True)
        try:
            run.stdout.readline()  # only then has it started
            time.sleep(2)
            ranks = children_of(run.pid)
            self.assertEqual(len(ranks), 3)
            os.kill(ranks[1], signal.SIGKILL)
            _, error = run.communicate(timeout=30)  # within seconds
        finally:
            if run.poll() is None:
                os.killpg(run.pid, signal.SIGKILL)
        self.assertNotEqual(run.returncode, 0)
        self.assertIn("signal 9", error)
        blocks = self.state("killed")["blocks"]
        # Over other ranks, then alone: as if nothing had been.
        queries = 40000
        self.run_to_end("killed", 2, queries // 2, "--symmetries", "--resume")
        self.run_to_end("killed", 0, queries, "--symmetries", "--resume")
        self.run_to_end("whole", 0, queries, "--symmetries")
        self.assertGreaterEqual(self.state("killed")["blocks"], blocks)
        self.assertEqual(self.state("killed"), self.state("whole"))

    def test_what_is_wrong_is_told_once(self):
        self.run_to_end("there", 0, 4000)
        done = subprocess.run(self.command("there", 3, 8000), capture_output=True, text=True, env=ENVIRONMENT)
        self.assertEqual(done.returncode, 1)
        self.assertEqual(done.stderr.count("found a run's state"), 1, done.stderr)


if __name__ == "__main__":
    unittest.main()
