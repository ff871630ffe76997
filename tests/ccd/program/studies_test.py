# Studies over ranks: `ccd_mpi query` and `ccd_mpi stress` find what `ccd` does, on any number of ranks
# and after a rank was killed. MPIEXEC and MPIEXEC_NUMPROC_FLAG say how programs are run over ranks,
# CCD_MPI_PROGRAM which.
import fcntl
import json
import os
import random
import signal
import sys
import time
import unittest

from program_test import HIT, MISS, SOURCE, ProgramTest, with_truth

sys.path.append(str(SOURCE / "tests/support"))
import over_ranks

def without_times(results):
    return [{key: value for key, value in r.items() if key != "ns_per_query"} for r in results]


class StudyTest(ProgramTest):
    def start_over(self, ranks, *arguments):
        return over_ranks.start(ranks, os.environ["CCD_MPI_PROGRAM"], *arguments)

    def over_ranks(self, ranks, *arguments):
        return over_ranks.run(ranks, os.environ["CCD_MPI_PROGRAM"], *arguments)

    def good_over(self, ranks, *arguments):
        status, out, err = self.over_ranks(ranks, *arguments)
        self.assertEqual((status, err), (0, ""))
        return out

    def bad_over(self, ranks, status, message, *arguments):
        found, out, err = self.over_ranks(ranks, *arguments)
        self.assertEqual((found, out), (status, ""), err)
        self.assertEqual(err.count(message), 1, err)

    def started(self, ranks, journal, *arguments):
        """A run that has kept something."""
        process = self.start_over(ranks, *arguments, "--journal", journal)
        while not journal.exists() or journal.read_text().count("\n") < 2:
            self.assertIsNone(process.poll(), "ended too soon")
            time.sleep(0.01)
        return process

    def slow(self, name):
        """Queries that take seconds: coordinates of all sizes, as exact sums of thousands of bits."""
        choose = random.Random(1)

        def number():
            return repr(choose.choice((-1, 1)) * choose.random()
                        * 10.0 ** choose.choice((-300, -150, 0, 90, 270)))

        return self.write(name, "".join(f"{number()},{number()},{number()}\n"
                                        for _ in range(8 * 6000)))


class Query(StudyTest):
    def test_same_as_one_process(self):
        files = [self.write("a/vertex-face/one.csv",
                            (with_truth(HIT, 1) + with_truth(MISS, 0) + with_truth(MISS, 1)) * 70),
                 self.write("b/edge-edge/two.csv", (HIT + MISS).replace("\n", "\r\n") * 15 + "\n \n"),
                 self.write("s/vertex-face/3.csv", HIT * 20 + MISS),
                 self.write("s/mma_bool/3_mma_bool.json", json.dumps([True] * 21))][:3]
        one, all_ = self.directory / "one.json", self.directory / "all.json"
        table = self.good("query", *files, "--json", one).splitlines()
        for ranks, chunk in ((1, 1000), (2, 8), (3, 7), (5, 1)):
            found = self.good_over(ranks, "query", *files, "--json", all_, "--chunk", chunk,
                                   "--journal", self.directory / "kept").splitlines()
            self.assertEqual([line.split()[:7] for line in found],
                             [line.split()[:7] for line in table])
            self.assertEqual(without_times(json.loads(all_.read_text())),
                             without_times(json.loads(one.read_text())))
            self.assertFalse((self.directory / "kept").exists())

    def test_lines(self):
        file = self.write("vf.csv", (HIT + MISS * 2) * 20)
        for option in ("--verdicts", "--toi"):
            one, all_ = self.directory / "one.txt", self.directory / "all.txt"
            self.good("query", file, "--method", "exact", option, one)
            for ranks in (1, 4):
                self.good_over(ranks, "query", file, "--method", "exact", option, all_,
                               "--chunk", 7)
                self.assertEqual(all_.read_bytes(), one.read_bytes())

    def killed_and_resumed(self, signal_, status, message):
        file, kept = self.slow("vf.csv"), self.directory / "kept"
        one, all_ = self.directory / "one.txt", self.directory / "all.txt"
        self.good("query", file, "--method", "exact", "--verdicts", one)
        arguments = ("query", file, "--method", "exact", "--chunk", 20, "--verdicts", all_)
        process = self.started(3, kept, *arguments)
        os.kill(over_ranks.pids(process)[1], signal_)
        begin = time.monotonic()
        out, err = process.communicate(timeout=60)
        self.assertLess(time.monotonic() - begin, 15)
        self.assertEqual((process.returncode, out), (status, ""), err)
        self.assertEqual(err.count(message), 1, err)
        if signal_ == signal.SIGKILL:  # which has mpirun end the others
            self.assertIn(f"ccd_mpi: asked to end; what is done is in {kept}, and the same", err)
        self.assertFalse(all_.exists())
        done = kept.read_text().count("\n") - 1
        self.assertGreater(300, done)
        self.good_over(2, *arguments, "--journal", kept)
        self.assertEqual(all_.read_bytes(), one.read_bytes())
        self.assertEqual(sorted(p.name for p in self.directory.iterdir()),
                         ["all.txt", "one.txt", "vf.csv"])

    def test_killed_rank(self):
        self.killed_and_resumed(signal.SIGKILL, 137, "exited on signal 9")

    def test_rank_that_is_asked_to_end(self):
        self.killed_and_resumed(signal.SIGTERM, 3, "ccd_mpi: ended with ")

    def test_interrupted(self):
        file, kept = self.slow("vf.csv"), self.directory / "kept"
        process = self.started(2, kept, "query", file, "--method", "exact", "--chunk", 20)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
        self.assertNotEqual(process.returncode, 0)
        self.assertEqual(out, "")
        self.assertIn(f"ccd_mpi: asked to end; what is done is in {kept}", err)

    def test_torn_journal(self):
        file, kept = self.slow("vf.csv"), self.directory / "kept"
        arguments = ("query", file, "--method", "exact", "--chunk", 20, "--verdicts",
                     self.directory / "all.txt")
        process = self.started(2, kept, *arguments)
        os.kill(over_ranks.pids(process)[0], signal.SIGKILL)
        process.communicate(timeout=60)
        good = kept.read_bytes()
        one = self.directory / "one.txt"
        self.good("query", file, "--method", "exact", "--verdicts", one)
        damaged = bytearray(good)
        damaged[-10] ^= 1
        for torn in (good[:-3], good + b"00000000 1 [", bytes(damaged), good + good[-200:]):
            kept.write_bytes(torn)
            self.good_over(3, *arguments, "--journal", kept)
            self.assertEqual((self.directory / "all.txt").read_bytes(), one.read_bytes())

    def test_errors(self):
        file, kept = self.write("vf.csv", (HIT + MISS) * 20), self.directory / "kept"
        rows = ((HIT + MISS) * 20).splitlines()
        rows[101] = "1,1,2,1,x,1"
        self.bad_over(3, 1, "bad_vf.csv:102: found 'x'", "query",
                      self.write("bad_vf.csv", "\n".join(rows)), "--chunk", 2)
        self.bad_over(3, 1, "bad_vf.csv:102: found 'x'", "query", self.directory / "bad_vf.csv",
                      "--journal", kept)
        self.assertFalse(kept.exists())  # nothing was done
        self.bad_over(2, 1, "short-vf.csv:167: found a truncated query, 7 rows from line 161", "query",
                      self.write("short-vf.csv", (HIT + MISS) * 10 + HIT.rsplit("\n", 2)[0]),
                      "--chunk", 1)
        self.bad_over(2, 1, "found no such file", "query", self.directory / "none-vf.csv")
        self.bad_over(2, 1, "found an empty file", "query", self.write("empty-vf.csv", ""))
        self.bad_over(2, 1, "found no kind of query", "query", self.write("coffee.csv", HIT))
        self.bad_over(2, 2, "found the output", "query", file, "--journal", file)
        self.bad_over(2, 2, "--method: found 'none'", "query", file, "--method", "none")
        self.bad_over(2, 1, "/dev/full: found no regular file", "query", file, "--journal", "/dev/full")
        pipe = self.directory / "pipe"
        os.mkfifo(pipe)
        self.bad_over(2, 1, "pipe: found no regular file", "query", file, "--journal", pipe)
        kept.write_text("errbound study 1 abc")
        self.bad_over(2, 1, "kept:1: found a journal that is cut off in its first line", "query", file,
                      "--journal", kept)
        kept.write_text("1,2,3\n")
        self.bad_over(2, 1, "kept:1: found no journal of a study", "query", file, "--journal", kept)
        self.assertEqual(kept.read_text(), "1,2,3\n")
        kept.unlink()
        slow = ("query", self.slow("slow-vf.csv"), "--chunk", 20, "--journal", kept, "--method")
        process = self.started(2, kept, *slow[:-3], "--method", "exact")
        os.kill(over_ranks.pids(process)[0], signal.SIGKILL)
        process.communicate(timeout=60)
        self.bad_over(1, 1, "kept:1: found the journal of another study", *slow, "tight")
        with kept.open() as held:
            fcntl.flock(held, fcntl.LOCK_EX)
            self.bad_over(1, 1, "that has not ended", *slow, "exact")


class Stress(StudyTest):
    OPTIONS = ("stress", "--quick", "--queries", 20, "--family", "touch-end,stiff")

    def cells(self, folder):
        return [line.rsplit(",", 1)[0] for line in (folder / "stress.csv").read_text().splitlines()]

    def test_same_as_one_process(self):
        one, all_ = self.directory / "one", self.directory / "all"
        wanted = self.good(*self.OPTIONS, "--out", one).splitlines()
        for ranks in (1, 2, 3):
            found = self.good_over(ranks, *self.OPTIONS, "--out", all_).splitlines()
            self.assertEqual([line.split()[:8] for line in found],
                             [line.split()[:8] for line in wanted])
            self.assertEqual(self.cells(all_), self.cells(one))

    def test_killed_rank(self):
        one, all_, kept = (self.directory / name for name in ("one", "all", "kept"))
        options = ("stress", "--queries", 20, "--method", "exact,tight", "--family",
                   "scale,offset,displacement,sliver,stiff")
        self.good(*options, "--out", one)
        process = self.started(3, kept, *options, "--out", all_)
        os.kill(over_ranks.pids(process)[2], signal.SIGKILL)
        out, err = process.communicate(timeout=60)
        self.assertEqual((process.returncode, out), (137, ""), err)
        self.assertEqual(list(all_.iterdir()), [])
        self.good_over(2, *options, "--out", all_, "--journal", kept)
        self.assertEqual(self.cells(all_), self.cells(one))
        self.assertFalse(kept.exists())


if __name__ == "__main__":
    unittest.main()
