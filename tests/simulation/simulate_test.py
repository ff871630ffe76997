"""The program `simulate`: output, continued runs, bad usage; and the pictures of a run.

Arguments: the program, the source folder.
"""
import csv
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from random import Random

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
        self.assertIn("expected the run to continue", again.stderr)
        self.assertEqual(self.frames(self.out), before)

    def test_refuses_another_run_where_one_was_killed_before_its_first_state(self):
        simulate("funnel1", "--resolution", 8, "--frames", 0, "--out", self.out)
        self.assertFalse((self.out / "state").exists())
        again = simulate("twist", "--resolution", 8, "--frames", 2, "--out", self.out)
        self.assertEqual(again.returncode, 1)
        self.assertIn("expected the run to continue", again.stderr)

    def refused_after(self, name, change, message):
        shutil.rmtree(self.out, ignore_errors=True)
        simulate("funnel1", "--resolution", 8, "--frames", 5, "--out", self.out)
        file = self.out / name
        file.write_bytes(change(file.read_bytes()))
        before = {path: path.read_bytes() for path in self.out.rglob("*") if path.is_file()}
        again = simulate("funnel1", "--resolution", 8, "--frames", 7, "--out", self.out)
        self.assertEqual(again.returncode, 1, message)
        self.assertIn(f"simulate: {file}: ", again.stderr)
        self.assertIn(message, again.stderr)
        self.assertEqual(before, {path: path.read_bytes() for path in self.out.rglob("*") if path.is_file()})

    def test_refuses_a_damaged_state(self):
        whole, flipped = 'is damaged; expected one written by this program', lambda at: lambda data: (
            data[:at] + bytes([data[at] ^ 1]) + data[at + 1:])
        for change in (lambda data: data[:-1], lambda data: data + b"x", lambda data: b"",
                       flipped(8),     # the number of the frame
                       flipped(40),    # a position
                       flipped(-9)):   # a force
            self.refused_after("state", change, whole)

    def test_refuses_a_last_frame_that_is_not_the_states(self):
        # The next frame would be certified from positions that are in no stored frame.
        self.refused_after("frames/00005.ply", lambda data: data[:-1] + b"\1", "frame differs from that of")

    def test_refuses_a_table_that_lacks_rows(self):
        # Regression: a run with an emptied table was reported as certified free.
        lines = lambda data: data.splitlines(keepends=True)
        self.refused_after("frames.csv", lambda data: b"", "line 1 is ''; expected a heading")
        self.refused_after("frames.csv", lambda data: b"".join(lines(data)[:3]),
                           "line 4 is ''; expected the row of frame 3")
        self.refused_after("frames.csv", lambda data: b"".join(lines(data)[:2] + lines(data)[3:]),
                           "line 3 is '3,")

    def test_a_number_that_is_none_or_below_all_normal_ones(self):
        def run_with_energy(text):
            shutil.rmtree(self.out, ignore_errors=True)
            simulate("funnel1", "--resolution", 8, "--frames", 2, "--out", self.out)
            table = self.out / "frames.csv"
            table.write_text(re.sub(r"[^,]+\n$", text + "\n", table.read_text()))
            return simulate("funnel1", "--resolution", 8, "--frames", 2, "--out", self.out)
        self.assertEqual(run_with_energy("1e-315").returncode, 0)
        self.assertIn("frames.csv: line 3: cell is 'none'; expected a number", run_with_energy("none").stderr)

    def test_two_runs_do_not_share_a_folder(self):
        # Regression: two runs wrote rows into one table, which was reported as certified free.
        run = subprocess.Popen([PROGRAM, "funnel2", "--resolution", "16", "--out", str(self.out)],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        while not (self.out / "state").exists():
            time.sleep(0.01)
        second = simulate("funnel2", "--resolution", 16, "--out", self.out)
        run.kill()
        run.communicate()
        self.assertEqual(second.returncode, 1)
        self.assertIn("another process uses the folder", second.stderr)
        # A killed process leaves no lock.
        self.assertEqual(simulate("funnel2", "--resolution", 16, "--frames", 1, "--out", self.out).returncode, 0)

    def test_killed_at_any_time_it_goes_on_to_the_same_bits(self):
        whole, random = self.out.with_name("whole"), Random(1)
        run = lambda out: ["twist", "--resolution", "8", "--frames", "120", "--out", str(out)]
        simulate(*run(whole))
        for kill in (signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGKILL):
            running = subprocess.Popen([PROGRAM, *run(self.out)], stdout=subprocess.DEVNULL)
            time.sleep(random.uniform(0.01, 0.1))
            running.send_signal(kill)
            running.wait()
        self.assertEqual(simulate(*run(self.out)).returncode, 0)
        frames = lambda out: {path.name: path.read_bytes() for path in (out / "frames").glob("*.ply")}
        self.assertEqual(frames(whole), frames(self.out))
        self.assertEqual((whole / "state").read_bytes(), (self.out / "state").read_bytes())

    def test_bad_usage(self):
        for arguments, message in ((["funnel9"], "expected one of funnel1"),
                                (["funnel1", "--method", "best"], "expected one of float"),
                                (["funnel1", "--resolution", "2"], "--resolution"),
                                (["funnel1", "--seed", "-1"], "not in range 0 to 2147483647"),
                                (["funnel1", "--seed", str(2**64)], "not in range 0 to 2147483647"),
                                (["funnel1", "--threads", "-1"], "not in range 0 to 2147483647"),
                                (["funnel1", "--out", ""], "expected a folder's name"),
                                ([], "SCENE")):
            out = [] if "--out" in arguments else ["--out", self.out]
            ran = simulate(*arguments, "--frames", 1, *out)
            self.assertEqual(ran.returncode, 2, arguments)
            self.assertIn(message, ran.stderr)
            self.assertFalse(self.out.exists())

    def test_a_folder_that_cannot_be_made(self):
        name = self.out / ("a" * 300)
        ran = simulate("funnel1", "--resolution", 8, "--frames", 1, "--out", name)
        self.assertEqual(ran.returncode, 1)
        self.assertIn("File name too long; expected a writable folder", ran.stderr)

    def test_every_scene_has_a_resolution_of_its_own(self):
        # Regression: the resolution of `stiff`, 3, was out of range.
        help = simulate("--help").stdout
        own = re.findall(r"^ +([a-z0-9-]+): .*?\(resolution\s+(\d+)", help, re.MULTILINE | re.DOTALL)
        self.assertEqual(len(own), 9)
        for scene, resolution in own:
            ran = simulate(scene, "--resolution", resolution, "--frames", 0, "--out", self.out / scene)
            self.assertEqual(ran.returncode, 0, ran.stderr)

    def test_writes_proposals_and_a_series(self):
        ran = simulate("funnel1", "--resolution", 8, "--frames", 12, "--out", self.out, "--proposals",
                       "--vtp")
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertEqual(len(list((self.out / "proposals").iterdir())), 12)
        series = (self.out / "paraview/series.pvd").read_text()
        self.assertEqual(re.findall(r'file="(\d+)\.vtp"', series), [f"{i:05}" for i in range(12)])

    def test_a_series_of_a_run_that_is_done(self):
        # Regression: an empty series, of a run without proposals, was an error.
        for again in range(2):
            ran = simulate("funnel1", "--resolution", 8, "--frames", 2, "--out", self.out,
                           *(["--vtp"] if again else []))
            self.assertEqual(ran.returncode, 0, ran.stderr)
        (self.out / "paraview/notes.vtp").touch()  # not the run's
        self.assertEqual(simulate("funnel1", "--resolution", 8, "--frames", 3, "--vtp", "--out",
                                  self.out).returncode, 0)
        series = (self.out / "paraview/series.pvd").read_text()
        self.assertEqual(re.findall(r'file="(.*?)"', series), ["00002.vtp"])

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
