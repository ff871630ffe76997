# `ccd convert`: conversion of queries from CSV to HDF5 and back, and its errors.
import json
import os
import pathlib
import resource
import signal
import subprocess
import unittest

from program_test import HIT, MISS, ProgramTest, with_truth


class ConvertTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.folder = self.directory
        if "without HDF5" in self.run_program("convert", "none.csv", "none.h5").stderr:
            self.skipTest("built without HDF5")
        self.write("vf.csv", with_truth(HIT, 1) + with_truth(MISS, 0))

    def bad(self, status, message, *arguments):
        done = self.run_program(*arguments)
        self.assertEqual((done.returncode, done.stdout), (status, ""), done.stderr)
        self.assertIn(message, done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)

    def test_there_and_back(self):
        self.good("convert", self.folder / "vf.csv", self.folder / "vf.csv.h5", "--kind", "vf")
        table = self.folder / "table.json"
        self.good("convert", self.folder / "vf.csv.h5", self.folder / "back-vf.csv", "--json", table)
        rows = json.loads(table.read_text())
        self.assertEqual([(pathlib.Path(r["file"]).name, r["queries"]) for r in rows],
                         [("vf.csv.h5", 2), ("back-vf.csv", 2)])
        for row in rows:
            self.assertEqual(row["bytes"], os.path.getsize(row["file"]))
        self.good("convert", self.folder / "back-vf.csv", self.folder / "again.h5")
        self.assertEqual((self.folder / "again.h5").read_bytes(), (self.folder / "vf.csv.h5").read_bytes())
        results = self.folder / "results.json"
        self.good("query", self.folder / "vf.csv.h5", self.folder / "vf.csv", "--method", "exact", "--json", results)
        first, second = ({k: v for k, v in r.items() if k not in ("file", "ns_per_query")}
                         for r in json.loads(results.read_text()))
        self.assertEqual(first, second)

    def test_files_are_joined(self):
        self.good("convert", self.folder / "vf.csv", self.folder / "vf.csv", self.folder / "two.h5")
        out = self.good("query", self.folder / "two.h5", "--method", "exact")
        self.assertRegex(out, r"two\.h5 +vf +exact +4 +2 +0 +0")

    def test_nothing_is_left_behind(self):
        # 40,000 queries take long enough for a signal to arrive.
        many = self.write("many-vf.csv", with_truth(HIT, 1) * 40000)
        temporary = self.folder / "temporary"
        temporary.mkdir()
        environment = dict(os.environ, TMPDIR=str(temporary))
        command = [os.environ["CCD_PROGRAM"], "convert", many, many, many, many]
        for out in (self.folder / "out.h5", self.folder / "out.csv"):
            process = subprocess.Popen([*command, out], env=environment, stdout=subprocess.PIPE,
                                       stderr=subprocess.PIPE)
            while not list(temporary.iterdir()):
                self.assertIsNone(process.poll(), "ended too soon")
            process.send_signal(signal.SIGTERM)
            self.assertEqual((process.communicate(timeout=60), process.returncode), ((b"", b""), -signal.SIGTERM))
            self.assertFalse(out.exists())
            self.assertEqual(list(temporary.iterdir()), [])
            done = subprocess.run([*command, out], env=dict(environment, TMPDIR=str(self.folder / "none")),
                                  capture_output=True, text=True)
            self.assertEqual(done.returncode, 1, done.stderr)
            self.assertIn("TMPDIR is not usable", done.stderr)
            self.assertFalse(out.exists())
            for size in (0, 1 << 12, 1 << 20):
                done = subprocess.run([*command, out], env=environment, capture_output=True, text=True,
                                      preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)))
                self.assertEqual((done.returncode, done.stderr.count("\n")), (1, 1), done.stderr)
                self.assertEqual(list(temporary.iterdir()), [])
                self.assertFalse(out.exists())

    def test_pipe_that_nobody_reads(self):
        many = self.write("many-vf.csv", with_truth(HIT, 1) * 2000)
        temporary = self.folder / "temporary"
        temporary.mkdir()
        pipe = self.folder / "out.csv"
        os.mkfifo(pipe)
        process = subprocess.Popen([os.environ["CCD_PROGRAM"], "convert", many, pipe], stderr=subprocess.PIPE,
                                   text=True, env=dict(os.environ, TMPDIR=str(temporary)))
        with open(pipe, "rb") as end:
            end.read(10)
        err = process.communicate(timeout=60)[1]
        self.assertEqual((process.returncode, err.count("\n")), (1, 1), err)
        self.assertIn("out.csv: writing failed (Broken pipe)", err)
        self.assertEqual(list(temporary.iterdir()), [])

    def test_ignored_signals_stay_ignored(self):
        many = self.write("many-vf.csv", with_truth(HIT, 1) * 20000)
        ignore = lambda: signal.signal(signal.SIGINT, signal.SIG_IGN)
        process = subprocess.Popen([os.environ["CCD_PROGRAM"], "convert", many, self.folder / "out.h5"],
                                   stdout=subprocess.DEVNULL, preexec_fn=ignore)
        while process.poll() is None:
            process.send_signal(signal.SIGINT)
        self.assertEqual(process.returncode, 0)
        self.assertTrue((self.folder / "out.h5").exists())

    def test_what_is_refused(self):
        vf, out = self.folder / "vf.csv", self.folder / "out.h5"
        plain = self.write("plain-vf.csv", HIT)
        edges = self.write("ee.csv", with_truth(HIT, 1))
        self.bad(2, "expected a name that ends in .h5, .hdf5 or .csv", "convert", vf, self.folder / "out.txt")
        self.bad(1, "plain-vf.csv: truth is missing; expected truth, as in the first file",
                 "convert", vf, plain, out)
        self.bad(1, "ee.csv: kind of queries is edge_edge; expected vertex_face", "convert", vf, edges, out)
        self.bad(2, "is also an input or another output", "convert", vf, vf)
        self.bad(1, "none.csv: file does not exist", "convert", self.folder / "none.csv", out)
        self.assertFalse(out.exists())
        self.good("convert", vf, out)
        self.bad(1, "out.h5: kind of queries is vertex_face; expected edge_edge", "query", out, "--kind", "ee")
        whole = out.read_bytes()
        out.write_bytes(whole[:60] + bytes([whole[60] ^ 255]) + whole[61:])
        self.bad(1, "out.h5: ", "query", out)
        out.write_bytes(whole[:-100])
        self.bad(1, "out.h5: cannot be read", "query", out)


if __name__ == "__main__":
    unittest.main()
