"""Tests of a program as a user runs it (PYTHONPATH of errbound_python_test)."""
import csv
import pathlib
import subprocess
import tempfile
import unittest


class ProgramTest(unittest.TestCase):
    command = ()  # the program and its first arguments

    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.directory = pathlib.Path(directory.name)

    def run_program(self, *arguments, **options):
        return subprocess.run([*self.command, *map(str, arguments)], capture_output=True, text=True, timeout=300, **options)

    def good(self, *arguments, **options):
        """Returns the output of a run that must succeed without messages."""
        done = self.run_program(*arguments, **options)
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
        return done.stdout

    def refused(self, status, message, *arguments):
        """A run must end with this status and message, and print nothing else."""
        done = self.run_program(*arguments)
        self.assertEqual((done.returncode, done.stdout), (status, ""), arguments)
        self.assertIn(message, done.stderr)
        self.assertNotEqual(done.stderr, "")


def rows_of(table):
    """Returns the rows of a CSV file by the names of its columns."""
    with open(table, newline="") as file:
        return list(csv.DictReader(file))
