# Compares the program CCD_MPI_PROGRAM on several ranks with `ccd step`. MPIEXEC and MPIEXEC_NUMPROC_FLAG
# run it.
import json
import os
import subprocess
import unittest

from program_test import AFTER, BEFORE, FACES, SOURCE, ProgramTest, obj, ply

RANKS = (1, 2, 3, 5)
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                   OMPI_MCA_rmaps_base_oversubscribe="1", OMPI_MCA_mpi_yield_when_idle="1")


def run_over(ranks, *command):
    done = subprocess.run([os.environ["MPIEXEC"], os.environ["MPIEXEC_NUMPROC_FLAG"], str(ranks), *map(str, command)],
                          capture_output=True, text=True, env=ENVIRONMENT, timeout=300)
    return done.returncode, done.stdout, done.stderr


class DistributedStep(ProgramTest):
    def over_ranks(self, ranks, *arguments):
        return run_over(ranks, os.environ["CCD_MPI_PROGRAM"], *arguments)

    def expect_same(self, before, after):
        one = [self.directory / f"one.{what}" for what in ("pairs", "toi", "json")]
        all_ = [self.directory / f"all.{what}" for what in ("pairs", "toi", "json")]
        options = lambda files: ["--pairs", files[0], "--toi", files[1], "--json", files[2]]
        self.good("step", before, after, "--explain", *options(one))
        expected = json.loads(one[2].read_text())
        for ranks in RANKS:
            done = self.over_ranks(ranks, "step", before, after, "--candidates", *options(all_))
            self.assertEqual((done[0], done[2]), (0, ""))
            self.assertEqual(all_[0].read_bytes(), one[0].read_bytes())
            self.assertEqual(all_[1].read_bytes(), one[1].read_bytes())
            found = json.loads(all_[2].read_text())
            for key in ("method", "candidates", "collisions", "first_contact"):
                self.assertEqual(found[key], expected[key], key)
            self.assertEqual(len(found["ranks"]), ranks)
            self.assertEqual(sum(rank["candidates"] for rank in found["ranks"]),
                             sum(expected["candidates"].values()))

    def test_made_mesh_in_every_form(self):
        self.expect_same(*self.triangles())
        self.expect_same(self.write("a.obj", obj(BEFORE, FACES)), self.write("b.obj", obj(AFTER, FACES)))

    def test_bundled_scene(self):
        self.expect_same(*sorted((SOURCE / "examples/scenes/cloth-over-ball").glob("*.ply")))

    def test_errors_are_reported_once(self):
        a = self.write("a.ply", ply(BEFORE, FACES))
        for message, status, arguments in (
                ("c.ply: file does not exist", 1, (a, self.directory / "c.ply")),
                ("number of vertices is 5; expected 6", 1, (a, self.write("d.ply", ply(AFTER[:5], [(0, 1, 2)])))),
                ("--method is 'none'", 2, (a, a, "--method", "none")),
                ("--method is tight; expected exact with --toi", 2, (a, a, "--method", "tight", "--toi", "-")),
                ("is also an input or another output", 1, (a, a, "--pairs", a))):
            for ranks in (1, 3):
                found, _, err = self.over_ranks(ranks, "step", *arguments)
                self.assertEqual(found, status, err)
                self.assertEqual(err.count(message), 1, err)

    def apart(self, *arguments_of_ranks):
        command = []
        for folder, *arguments in arguments_of_ranks:
            line = " ".join(map(str, (os.environ["CCD_MPI_PROGRAM"], *arguments)))
            command += [":", os.environ["MPIEXEC_NUMPROC_FLAG"], "1", "sh", "-c", f"cd {folder} && exec {line}"]
        found, _, err = run_over(1, *command[3:])
        return found, err

    def test_other_files_of_the_same_name(self):
        folders = [self.directory / name for name in ("here", "there")]
        for folder in folders:
            folder.mkdir()
        (folders[0] / "a.ply").write_text(ply(BEFORE, FACES))
        for other in (ply(AFTER, FACES), ply(BEFORE[:3], [(0, 1, 2)])):
            (folders[1] / "a.ply").write_text(other)
            found, err = self.apart(*((folder, "step", "a.ply", "a.ply") for folder in folders))
            self.assertEqual(found, 1, err)
            self.assertEqual(err.count("a.ply: file on rank 1 differs from that on rank 0"), 1, err)

    def test_other_command_lines(self):
        a = self.write("a.ply", ply(BEFORE, FACES))
        found, err = self.apart((self.directory, "step", a, a), (self.directory, "bogus"))
        self.assertNotEqual(found, 0, err)


if __name__ == "__main__":
    unittest.main()
