"""Tests of a program as a user runs it (PYTHONPATH of errbound_python_test)."""
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
