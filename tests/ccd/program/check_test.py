# `ccd check`: intersections of meshes at rest, and what `ccd step` reports of its start.
import json
import unittest

from program_test import AFTER, BASE, BEFORE, SOURCE, ProgramTest, obj, ply
from view_test import Page

SCENE = SOURCE / "examples/scenes/cloth-over-ball/frame0.ply"

# The second triangle passes through the first.
PIERCED = [(0, 0, 0), (4, 0, 0), (0, 4, 0), (1, 1, -1), (1, 1, 1), (1.5, 1, 1)]
FACES = [(2, 1, 0), (5, 4, 3)]


class Check(ProgramTest):
    def check(self, *arguments, status):
        done = self.run_program("check", *arguments)
        self.assertEqual(done.returncode, status, done.stderr)
        return done

    def lines_of(self, file, option="--pairs", *options):
        out = self.directory / "out"
        done = self.run_program("check", file, option, out, *options)
        lines = out.read_text().splitlines()
        if option == "--pairs":
            self.assertEqual(done.returncode, 3 if lines else 0, done.stderr)
        return lines

    def test_pierced_triangles(self):
        file, out = self.write("pierced.ply", ply(PIERCED, FACES)), self.directory / "out.json"
        done = self.check(file, "--json", out, status=3)
        self.assertEqual(done.stdout.splitlines()[1].split()[1:6], ["2", "1", "0", "0", "1"])
        found = json.loads(out.read_text())
        self.assertEqual((found["free"], found["edge_face"]), (False, 2))
        self.assertEqual(found["intersections"]["face_face"], {"touching": 0, "overlapping": 0, "crossing": 1})
        self.assertEqual(sum(sum(of.values()) for of in found["intersections"].values()), 1)
        self.assertEqual(self.lines_of(file), ["ff,0,1,2,3,4,5,crossing"])
        self.assertEqual(self.lines_of(file, "--edge-faces"), ["ef,3,4,0,1,2", "ef,3,5,0,1,2"])
        self.assertEqual(self.check(file, "--pairs", "-", status=3).stdout, "ff,0,1,2,3,4,5,crossing\n")

    def test_free_mesh(self):
        file = self.write("free.ply", ply(BEFORE, [(0, 1, 2), (3, 4, 5)]))
        self.assertEqual(self.lines_of(file), [])
        self.assertIn("free.ply", self.good("check", file))
        other = self.write("pierced.ply", ply(PIERCED, FACES))
        out = self.directory / "out.json"
        self.check(file, other, "--json", out, status=3)
        self.assertEqual([mesh["free"] for mesh in json.loads(out.read_text())], [True, False])

    def test_kinds_and_relations(self):
        vertices = BASE + [(0.25, 0.25, -1), (0.25, 0.25, 1), (0.5, 0.25, 0), (0.25, 0.25, 0.5), (0.25, 0, -1),
                           (0.25, 0, 1), (0.5, 0.5, 0.0)]
        file = self.write("kinds.obj", obj(vertices, [(0, 1, 2)], "l 4 5\nl 8 9\np 6\np 7\np 10\n"))
        self.assertEqual(self.lines_of(file), [
            "ef,3,4,0,1,2,crossing", "ef,7,8,0,1,2,touching", "vf,5,0,1,2,touching", "vf,9,0,1,2,touching",
            "ve,6,3,4,touching"])
        rods = self.write("rods.obj", obj([(0, 0, 0), (2, 0, 0), (1, 0, 0), (3, 0, 0), (1, 0, 0)], (), "l 1 2\nl 3 4\np 5\n"))
        self.assertEqual(self.lines_of(rods), ["ee,0,1,2,3,overlapping", "ve,4,0,1,touching", "ve,4,2,3,touching"])

    def test_equal_positions_and_unused_vertices(self):
        seam = self.write("seam.obj", obj([*BASE, (1, 0, 0), (0, 1, 0), (1, 1, 0)], [(0, 1, 2), (3, 5, 4)]))
        self.assertEqual(self.lines_of(seam), ["ff,0,1,2,3,4,5,touching"])
        self.assertEqual(self.lines_of(seam, "--pairs", "--merge-equal-positions"), [])
        unused = self.write("unused.obj", obj([*BASE, (0.25, 0.25, 0)], [(0, 1, 2)]))
        self.assertEqual(self.lines_of(unused), [])
        self.assertEqual(self.lines_of(unused, "--pairs", "--unused-vertices", "points"), ["vf,3,0,1,2,touching"])

    def test_page(self):
        page = self.directory / "page.html"
        self.check(self.write("pierced.ply", ply(PIERCED, FACES)), "--view", page, status=3)
        shown = Page(page.read_text())
        self.assertEqual(shown.numbers("start_face_face", "I", 6), [(0, 1, 2, 3, 4, 5)])
        self.assertEqual(shown.numbers("start_face_face_relations", "B", 1), [(3,)])
        self.assertEqual(shown.numbers("start_face_face_segments", "d", 6), [(1, 1, 0, 1.25, 1, 0)])
        self.assertEqual(shown.numbers("vertex_face", "I", 4), [])

    def test_bad_input_and_usage(self):
        good = self.write("pierced.ply", ply(PIERCED, FACES))
        self.bad_input("no-file.ply: file does not exist", "check", "no-file.ply")
        self.bad_input("nan", "check",
                       self.write("nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"))
        out = self.directory / "out"
        for arguments, message in [
                ([], "FILE is missing"),
                ([good, good, "--pairs", out], "expected one FILE"),
                ([good, "--view", "page.vtp"], "expected a name that ends in .html"),
                ([good, "--pairs", out, "--json", out], "expected a separate file"),
                ([good, "--pairs", good], "expected a separate file"),
                (["-", "-"], "standard input is given twice")]:
            with self.subTest(arguments=arguments):
                self.assertIn(message, self.bad_usage("check", *arguments))
        self.assertFalse(out.exists())

    def test_bundled_scene(self):
        """StoredFrame of tests/ccd/step has more scenes."""
        out = self.directory / "out.json"
        self.check(SCENE, "--json", out, status=3)
        self.assertEqual(json.loads(out.read_text())["edge_face"], 57)
        self.assertEqual(len(self.lines_of(SCENE, "--edge-faces")), 57)


class Start(ProgramTest):
    def frames(self, before, lift):
        return [self.write("0.ply", ply(before, FACES)),
                self.write("1.ply", ply([(x, y, z + lift) for x, y, z in before], FACES))]

    def test_step_reports_its_start(self):
        frames, out = self.frames(PIERCED, 3), self.directory / "out.json"
        text = self.good("step", *frames, "--json", out)
        self.assertIn("FRAME0 has 1 intersection (1 crossing)", text)
        found = json.loads(out.read_text())
        self.assertEqual(found["intersections_at_start"], {"touching": 0, "overlapping": 0, "crossing": 1})
        self.assertEqual(found["collisions"], {"vertex_face": 0, "edge_edge": 0})
        text = self.good("step", *frames, "--json", out, "--no-check-start")
        self.assertNotIn("FRAME0", text)
        self.assertNotIn("intersections_at_start", json.loads(out.read_text()))

    def test_free_start(self):
        out = self.directory / "out.json"
        self.assertIn("FRAME0 is free of intersections", self.good("step", *self.triangles(BEFORE, AFTER), "--json", out))
        self.assertNotIn("intersections_at_start", json.loads(out.read_text()))

    def test_page_of_a_step_has_intersections(self):
        page = self.directory / "page.html"
        self.good("step", *self.frames(PIERCED, 3), "--view", page)
        self.assertEqual(Page(page.read_text()).numbers("start_face_face", "I", 6), [(0, 1, 2, 3, 4, 5)])


if __name__ == "__main__":
    unittest.main()
