# Input and output of the program `ccd`: standard streams, pipes, full disks, limits, missing
# permissions, signals. Each output file is whole or unchanged.
import contextlib
import os
import resource
import signal
import subprocess
import time
import unittest

from program_test import BEFORE, FACES, HIT, MISS, PROGRAM, SOURCE, ProgramTest, obj, ply

SCENE = [str(SOURCE / f"examples/scenes/cloth-over-ball/frame{i}.ply") for i in (0, 1)]
IS_ROOT = os.geteuid() == 0
FATAL = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL)



def limit(which, size):
    return lambda: resource.setrlimit(which, (size, size))


class Outputs(ProgramTest):
    def setUp(self):
        super().setUp()
        self.frames = self.triangles()
        self.good("step", *self.frames, "--pairs", self.directory / "expected")
        self.expected = (self.directory / "expected").read_text()
        self.before = self.files()

    def files(self):
        return {p.name: p.read_bytes() for p in self.directory.rglob("*") if p.is_file()}

    def run_with(self, *arguments, **options):
        streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **options}
        return subprocess.run([PROGRAM, *map(str, arguments)], text=True, timeout=120, **streams)

    def refused(self, message, *arguments, **options):
        done = self.run_with(*arguments, **options)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn(message, done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertEqual(self.files(), self.before)


class Streams(Outputs):
    def test_a_file_was_named_dash(self):
        for name in ("-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"):
            done = self.run_with("step", *self.frames, "--pairs", name, cwd=self.directory)
            self.assertEqual((done.returncode, done.stdout), (0, self.expected), name)
            self.assertIn("vertex-face", done.stderr)  # the table moves to standard error
        self.assertEqual(self.files(), self.before)
        query = self.write("vf.csv", HIT + MISS)
        done = self.run_with("query", query, "--method", "exact", "--verdicts", "-")
        self.assertEqual((done.returncode, done.stdout), (0, "1\n0\n"))

    def test_the_table_overwrote_a_redirected_dev_stdout(self):
        for name in ("-", "/dev/stdout"):
            out = self.directory / "redirected"
            with open(out, "w") as stdout:
                done = self.run_with("step", *self.frames, "--pairs", name, stdout=stdout)
            self.assertEqual((done.returncode, out.read_text()), (0, self.expected))

    def test_standard_output_twice(self):
        for second in ("-", "/dev/stdout"):
            self.assertIn("expected a separate file",
                          self.bad_usage("step", *self.frames, "--pairs", "-", "--json", second))

    def test_frames_from_pipes_were_refused_for_their_extension(self):
        for text in (ply(BEFORE, FACES), obj(BEFORE, FACES), "\ufeff" + obj(BEFORE, FACES)):
            for name in ("-", "/dev/stdin"):
                done = self.run_with("step", name, self.frames[1], "--pairs", "-", input=text)
                self.assertEqual((done.returncode, done.stdout), (0, self.expected), done.stderr)
            self.write("redirected", text)
            with open(self.directory / "redirected") as stdin:
                done = self.run_with("step", "-", self.frames[1], "--pairs", "-", stdin=stdin)
            self.assertEqual((done.returncode, done.stdout), (0, self.expected), done.stderr)
        done = self.run_with("step", "-", "-", input=ply(BEFORE, FACES))
        self.assertEqual(done.returncode, 2)
        self.assertIn("standard input is given twice", done.stderr)

    def test_queries_from_a_pipe(self):
        done = self.run_with("query", "-", "--kind", "vf", "--method", "exact", "--verdicts", "-",
                             input=MISS + HIT)
        self.assertEqual((done.returncode, done.stdout), (0, "0\n1\n"), done.stderr)

    def test_standard_output_that_is_closed_or_full(self):
        with open("/dev/full", "w") as full:
            self.refused("standard output cannot be written", "step", *self.frames, stdout=full)
            self.refused("-: writing failed (No space left on device)",
                         "step", *self.frames, "--pairs", "-", stdout=full)
        closed = {"stdout": None, "preexec_fn": lambda: os.close(1)}
        self.refused("standard output cannot be written", "step", *self.frames, **closed)
        # The table must not go to a file that got the descriptor of standard output.
        out = self.directory / "out"
        done = self.run_with("step", *self.frames, "--pairs", out, **closed)
        self.assertEqual((done.returncode, out.read_text()), (1, self.expected))

    def test_a_reader_that_goes_away(self):
        for restore, status in ((True, -signal.SIGPIPE), (False, 1)):
            reader, writer = os.pipe()
            os.close(reader)
            done = self.run_with("step", *self.frames, "--json", "-", stdout=writer,
                                 restore_signals=restore)
            os.close(writer)
            self.assertEqual(done.returncode, status)
            self.assertEqual(self.files(), self.before)


class Refusals(Outputs):
    def test_a_limit_on_file_sizes_left_a_temporary_file(self):
        old = self.write("old", "as it was\n")
        self.before = self.files()
        for size in (0, 1, len(self.expected) - 1):
            for out in (self.directory / "new", old):
                self.refused(f"{out}: writing failed (File too large)", "step", *self.frames,
                             "--pairs", out, preexec_fn=limit(resource.RLIMIT_FSIZE, size))

    def test_an_output_that_fails_beside_another(self):
        """Expects status 1 and the file's name; the other output is whole, and no other file is left."""
        for bad, why in (("/dev/full", "No space left on device"), (self.directory, "is a directory"),
                         (self.directory / "none" / "out", "No such file")):
            other = self.directory / "other"
            done = self.run_with("step", *self.frames, "--pairs", other, "--json", bad)
            self.assertEqual(done.returncode, 1)
            self.assertIn(str(bad), done.stderr)
            self.assertIn(why, done.stderr)
            if other.exists():
                self.assertEqual(other.read_text(), self.expected)
                other.unlink()
            self.assertEqual(self.files(), self.before)

    def test_a_full_disk(self):
        disk = self.directory / "disk"
        disk.mkdir()
        mounted = IS_ROOT and subprocess.run(
            ["mount", "-t", "tmpfs", "-o", "size=4k", "tmpfs", disk], capture_output=True).returncode == 0
        if not mounted:
            self.skipTest("no right to mount a small disk")
        try:
            done = self.run_with("step", *SCENE, "--pairs", disk / "out")
            self.assertEqual(done.returncode, 1)
            self.assertIn("No space left on device", done.stderr)
            self.assertEqual(os.listdir(disk), [])
        finally:
            subprocess.run(["umount", disk], check=True)

    def test_missing_rights(self):
        self.directory.chmod(0o755)
        locked = self.directory / "locked"
        locked.mkdir(mode=0o555)
        self.write("open/read-only", "as it was\n")
        (self.directory / "open").chmod(0o777)
        (self.directory / "open/read-only").chmod(0o444)
        self.before = self.files()
        nobody = {"user": 65534, "group": 65534, "extra_groups": []} if IS_ROOT else {}
        if nobody and subprocess.run([PROGRAM, "--version"], capture_output=True, **nobody).returncode:
            self.skipTest("the program is out of nobody's reach")
        for out in (locked / "out", self.directory / "open/read-only"):
            self.refused(f"{out}: cannot be written (Permission denied)", "step", *self.frames,
                         "--pairs", out, **nobody)

    def test_links(self):
        (self.directory / "link").symlink_to("target")
        self.refused("is a symbolic link to nothing", "step", *self.frames, "--pairs",
                     self.directory / "link")
        self.write("target", "old")
        self.good("step", *self.frames, "--pairs", self.directory / "link")
        self.assertTrue((self.directory / "link").is_symlink())
        self.assertEqual((self.directory / "target").read_text(), self.expected)

    def test_a_name_as_long_as_names_can_be(self):
        out = self.directory / ("n" * 255)
        self.good("step", *self.frames, "--pairs", out)
        self.assertEqual(out.read_text(), self.expected)

    @unittest.skipIf(os.environ.get("CCD_SANITIZERS"), "sanitizers need address space")
    def test_little_memory(self):
        """With growing memory limits, runs end with one line of error or succeed. They never end by an uncaught
        exception or a stack that cannot grow."""
        statuses = []
        for kilobytes in range(10 << 10, 120 << 10, 128):
            little = limit(resource.RLIMIT_AS, kilobytes << 10)
            if not statuses and self.run_with("--version", preexec_fn=little).returncode != 0:
                continue  # the program was not loaded
            done = self.run_with("step", *SCENE, "--threads", 1, "--pairs", self.directory / "out",
                                 preexec_fn=little)
            statuses.append(done.returncode)
            self.assertIn(done.returncode, (0, 1), done.stderr)
            self.assertIn(done.stderr, ("", "ccd: out of memory\n"))
            if statuses[-20:].count(0) == 20:
                break
        self.assertEqual(set(statuses), {0, 1})


class Signals(Outputs):
    @contextlib.contextmanager
    def started(self, *arguments):
        process = subprocess.Popen([PROGRAM, *map(str, arguments)], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        try:
            yield process
        finally:
            process.kill()
            process.wait()

    def test_at_any_time(self):
        """Expects each file whole or unchanged."""
        out, json = self.directory / "out", self.directory / "json"
        began = time.monotonic()
        self.good("step", *SCENE, "--threads", 2, "--pairs", out, "--json", json)
        took = time.monotonic() - began
        whole = out.read_bytes()
        for i in range(60):
            for file in (out, json):
                file.write_text("as it was\n")
            with self.started("step", *SCENE, "--threads", 2, "--pairs", out, "--json", json) as process:
                time.sleep(took * (i % 20) / 16)
                process.send_signal(FATAL[i % 4])
                self.assertIn(process.wait(30), (0, -FATAL[i % 4]))
            self.assertIn(out.read_bytes(), (b"as it was\n", whole))
            if json.read_text() != "as it was\n":
                self.assertEqual(json.read_bytes()[-2:], b"}\n")


if __name__ == "__main__":
    unittest.main()
