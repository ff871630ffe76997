# `errbound_mpi validate` finds what `errbound validate` does, on any number of ranks and after a rank
# was killed. ERRBOUND_PROGRAM and ERRBOUND_MPI_PROGRAM say which programs, MPIEXEC and
# MPIEXEC_NUMPROC_FLAG how programs are run over ranks.
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.append(str(pathlib.Path(__file__).parents[2] / "support"))
import over_ranks

from validate_program_test import HIT

MISS = HIT.replace("0.23,0.1,-0.7", "0.2,0.1,0.3")


class ValidateOverRanks(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.directory = pathlib.Path(directory.name)
        self.kept = self.directory / "kept"

    def write(self, name, text):
        (self.directory / name).write_text(text)
        return self.directory / name

    def results(self, run, *arguments):
        """What is printed and written."""
        table, csv = self.directory / "out.json", self.directory / "out.csv"
        status, out, err = run("validate", *arguments, "--json", table, "--csv", csv)
        self.assertEqual((status, err), (0, ""))
        found = out, table.read_text(), csv.read_text()
        table.unlink()
        csv.unlink()
        return found

    def alone(self, *arguments):
        done = subprocess.run([os.environ["ERRBOUND_PROGRAM"], *map(str, arguments)],
                              capture_output=True, text=True, timeout=300)
        return done.returncode, done.stdout, done.stderr

    def over(self, ranks):
        return lambda *arguments: over_ranks.run(ranks, os.environ["ERRBOUND_MPI_PROGRAM"], *arguments)

    def bad(self, ranks, status, message, *arguments):
        found, out, err = self.over(ranks)("validate", *arguments)
        self.assertEqual((found, out), (status, ""), err)
        self.assertEqual(err.count(message), 1, err)

    def test_same_as_one_process(self):
        files = self.write("vf.csv", (HIT + MISS) * 40), self.write("one-ee.csv", MISS)
        arguments = ("--queries", *files, "--expressions", 5000, "--rules", "tight,none,safe")
        one = self.results(self.alone, *arguments)
        for part in (str(files[0]), str(files[1]), "expressions"):
            self.assertIn(f"{part} ", one[0])
        for ranks, more in ((1, ()), (2, ("--threads", 2)), (3, ("--journal", self.kept)), (5, ())):
            self.assertEqual(self.results(self.over(ranks), *arguments, *more), one)
            self.assertFalse(self.kept.exists())

    def test_tiny(self):
        arguments = ("--tiny", "--expressions", 10, "--rules", "tight")
        one = self.results(self.alone, *arguments)
        self.assertIn("tiny ", one[0])
        self.assertEqual(self.results(self.over(3), *arguments), one)

    def test_functions(self):
        arguments = ("--functions", "sin,atan2", "--samples", 50000, "--expressions", 10)
        one = self.results(self.alone, *arguments)
        self.assertIn("atan2 ", one[0])
        for ranks, more in ((2, ("--journal", self.kept)), (3, ("--threads", 2))):
            self.assertEqual(self.results(self.over(ranks), *arguments, *more), one)

    def test_killed_rank(self):
        arguments = ("--expressions", 150000, "--seed", 5)
        process = over_ranks.start(3, os.environ["ERRBOUND_MPI_PROGRAM"], "validate", *arguments,
                                   "--json", self.directory / "none.json", "--journal", self.kept)
        while not self.kept.exists() or self.kept.read_text().count("\n") < 2:
            self.assertIsNone(process.poll(), "ended too soon")
            time.sleep(0.01)
        os.kill(over_ranks.pids(process)[1], signal.SIGKILL)
        out, err = process.communicate(timeout=60)
        self.assertEqual((process.returncode, out), (137, ""), err)
        self.assertFalse((self.directory / "none.json").exists())
        self.bad(2, 1, "kept:1: found the journal of another study", "--expressions", 150001, "--seed",
                 5, "--journal", self.kept)
        resumed = self.results(self.over(2), *arguments, "--journal", self.kept)
        self.assertFalse(self.kept.exists())
        self.assertEqual(resumed, self.results(self.alone, *arguments))

    def test_errors(self):
        file = self.write("vf.csv", HIT)
        self.bad(3, 1, "bad_vf.csv:1: found 'x'", "--queries",
                 self.write("bad_vf.csv", HIT.replace("0.7\n", "x\n", 1)))
        self.bad(2, 1, "found no such file", "--queries", self.directory / "none-vf.csv")
        self.bad(2, 2, "found the output", "--queries", file, "--journal", file)
        self.bad(2, 2, "--rules: found 'loose'", "--rules", "loose")
        self.bad(2, 2, "--operations", "--operations", 49)
        self.assertEqual(file.read_text(), HIT)

    def test_help(self):
        status, out, err = self.over(3)("validate", "--help")
        self.assertEqual((status, err), (0, ""))
        self.assertEqual(out.count("--journal"), 1)


if __name__ == "__main__":
    unittest.main()
