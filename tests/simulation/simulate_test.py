"""The program `simulate`: output, going on, bad usage; and the pictures of a run.

Arguments: the program, the source folder.
"""
import csv
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM, ROOT = sys.argv[1], pathlib.Path(sys.argv[2])


def simulate(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)


class Simulate(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.out = pathlib.Path(self.folder.name) / "run"

    def frames(self, out):
        return {path.name: path.read_bytes() for path in (out / "frames").iterdir()}

    def test_leaves_frames_and_a_table(self):
        ran = simulate("funnel1", "--resolution", 8, "--frames", 12, "--out", self.out)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertIn("12 frames", ran.stdout)
        self.assertIn("certified free", ran.stdout)
        self.assertEqual(len(self.frames(self.out)), 13)
        with open(self.out / "frames.csv") as table:
            rows = list(csv.DictReader(table))
        self.assertEqual([row["frame"] for row in rows], [str(i) for i in range(1, 13)])
        self.assertEqual({row["passed_through"] for row in rows}, {"0"})

    def test_goes_on_as_if_it_had_not_stopped(self):
        whole = self.out.with_name("whole")
        simulate("funnel1", "--resolution", 8, "--frames", 20, "--out", whole)
        for frames in (7, 20):
            simulate("funnel1", "--resolution", 8, "--frames", frames, "--out", self.out)
        self.assertEqual(self.frames(whole), self.frames(self.out))
        with open(self.out / "frames.csv") as table:
            self.assertEqual(len(table.readlines()), 21)

    def test_stops_after_a_frame_when_interrupted(self):
        run = subprocess.Popen([PROGRAM, "funnel2", "--resolution", "16", "--out", str(self.out)],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        while not (self.out / "state").exists():
            time.sleep(0.01)
        run.send_signal(signal.SIGINT)
        output, errors = run.communicate(timeout=60)
        self.assertEqual(run.returncode, 0, errors)
        stopped = int(re.search(r"stopped after frame (\d+) of 1330", output)[1])
        self.assertEqual(len(self.frames(self.out)), stopped + 1)

    def test_refuses_another_run_in_the_same_folder(self):
        simulate("funnel1", "--resolution", 8, "--frames", 2, "--out", self.out)
        before = self.frames(self.out)
        again = simulate("funnel1", "--resolution", 9, "--frames", 2, "--out", self.out)
        self.assertEqual(again.returncode, 1)
        self.assertIn("expected the run to go on with", again.stderr)
        self.assertEqual(self.frames(self.out), before)

    def test_refuses_a_state_that_is_cut(self):
        simulate("funnel1", "--resolution", 8, "--frames", 2, "--out", self.out)
        state = self.out / "state"
        state.write_bytes(state.read_bytes()[:-1])
        again = simulate("funnel1", "--resolution", 8, "--frames", 4, "--out", self.out)
        self.assertEqual(again.returncode, 1)
        self.assertIn("expected a state of", again.stderr)

    def test_bad_usage(self):
        for arguments, told in ((["funnel9"], "expected one of funnel1"),
                                (["funnel1", "--method", "best"], "expected one of float"),
                                (["funnel1", "--resolution", "2"], "--resolution"),
                                ([], "SCENE")):
            ran = simulate(*arguments, "--frames", 1, "--out", self.out)
            self.assertEqual(ran.returncode, 2, arguments)
            self.assertIn(told, ran.stderr)
            self.assertFalse(self.out.exists())

    def test_writes_proposals_and_a_series(self):
        ran = simulate("funnel1", "--resolution", 8, "--frames", 12, "--out", self.out, "--proposals",
                       "--vtp")
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertEqual(len(list((self.out / "proposals").iterdir())), 12)
        series = (self.out / "paraview/series.pvd").read_text()
        self.assertEqual(re.findall(r'file="(\d+)\.vtp"', series), [f"{i:05}" for i in range(12)])

    def test_tables_of_methods(self):
        build = pathlib.Path(PROGRAM).parents[2]
        if not (build / "ccd").exists():
            self.skipTest("the program ccd is not built")
        ran = subprocess.run(
            [sys.executable, ROOT / "examples/simulation/figures.py", build, "--scenes", "funnel1",
             "--streams", "funnel1", "--methods", "tight,exact", "--seeds", "1", "--resolution", "8",
             "--frames", "12", "--steps", "2", "--out", self.out], capture_output=True, text=True)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertIn("| funnel1, 8 to 12 | exact | 1.00 |", ran.stdout)
        self.assertEqual((self.out / "report.md").read_text() + "\n", ran.stdout)

    def test_pictures(self):
        try:
            from PIL import Image
            import numpy
        except ImportError:
            self.skipTest("Pillow or NumPy is not installed")
        simulate("funnel1", "--resolution", 8, "--frames", 5, "--out", self.out)
        ran = subprocess.run([sys.executable, ROOT / "examples/simulation/film.py", self.out,
                              "--pictures", "3"], capture_output=True, text=True)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        with Image.open(self.out / "film.gif") as film:
            self.assertEqual(film.n_frames, 3)
        with Image.open(self.out / "sheet.png") as sheet:
            colours = numpy.unique(numpy.asarray(sheet.convert("RGB")).reshape(-1, 3), axis=0)
            self.assertGreater(len(colours), 20)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
