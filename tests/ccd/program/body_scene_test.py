# `ccd bodies`: scenes of bodies that turn, in JSON.
import csv
import json
import shutil
import struct
import subprocess
import sys
import unittest

from program_test import SOURCE, ProgramTest, obj
from view_test import Page

# A quarter of a turn about z: the tip (5, 0, 0) is at (3, 4, 0) at t = 1/2.
QUARTER = [[0, 0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0, 1]]
HEADING = ("step,body_a,body_b,time,low,high,touching_at_start,crossing_at_start,vertex_face,edge_edge,vertex_edge,"
           "vertex_vertex")


class Scenes(ProgramTest):
    def scene(self, *bodies, text=None, **members):
        self.write("meshes/tip.obj", obj([(5, 0, 0)], more="p 1\n"))
        self.write("meshes/wall.obj", obj([(3, -9, -9), (3, 9, -9), (3, 0, 9)], [(0, 1, 2)]))
        self.write("meshes/rod.obj", obj([(1, 0, 0), (2, 0, 0)], more="l 1 2\n"))
        return self.write("meshes/scene.json", json.dumps({"bodies": bodies, **members}) if text is None else text)


class Bodies(Scenes):
    def decided(self, scene, *options, status=3):
        out = self.directory / "out.json"
        done = self.run_program("bodies", scene, "--json", out, *options)
        self.assertEqual((done.returncode, done.stderr), (status, ""))
        return json.loads(out.read_text())["steps"]

    def tip_and_wall(self, poses=QUARTER, wall=None, **members):
        return self.scene({"name": "tip", "mesh": "tip.obj", "poses": poses},
                          {"name": "wall", "mesh": "wall.obj", **(wall or {})}, **members)

    def test_a_tip_that_turns_meets_a_wall_at_an_exact_time(self):
        scene, table, pairs = self.tip_and_wall(times=[2, 4]), self.directory / "out.csv", self.directory / "out.pairs"
        step, = self.decided(scene, "--csv", table, "--pairs", pairs)
        contact = {"step": 0, "body_a": "tip", "body_b": "wall", "time": 3.0, "low": 0.5, "high": 0.5, "touching_at_start": 0,
                   "crossing_at_start": 0, "vertex_face": 1, "edge_edge": 0, "vertex_edge": 0, "vertex_vertex": 0}
        self.assertEqual(step, {"step": 0, "from": 2, "to": 4, "body_pairs": 1, "candidates": {
            "vertex_face": 1, "edge_edge": 0, "vertex_edge": 0, "vertex_vertex": 0},
            "first_contact": [0.5, 0.5], "contacts": [contact]})
        self.assertEqual(pairs.read_text(), "0,vf,0,1,2,3,0x1p-1,0x1p-1\n")
        lines = table.read_text().splitlines()
        self.assertEqual(lines[0], HEADING)
        row, = csv.DictReader(lines)
        self.assertEqual(row, {k: str(v) for k, v in contact.items()})

    def test_the_table_counts_free_steps(self):
        done = self.run_program("bodies", self.tip_and_wall([QUARTER[0], *QUARTER, [0, 0, 0, 0, 0, 0, 1]]))
        self.assertEqual(done.returncode, 3)
        lines = done.stdout.splitlines()
        self.assertEqual(lines[1].split()[:3], ["1", "tip", "wall"])
        self.assertEqual(lines[-1], "2 of 3 steps are free of contact")

    def test_edges_that_cross_faces_at_the_start(self):
        # A rod on the x axis goes through the wall while both move.
        scene = self.scene({"mesh": "rod.obj", "poses": [[1.5, 0, 0, 1, 0, 0, 0], [1.5, 1, 0, 1, 0, 0, 0]]},
                           {"mesh": "wall.obj", "poses": [[0, 0, 0, 1, 0, 0, 0], [0, 1, 0, 1, 0, 0, 0]]})
        pairs = self.directory / "out.pairs"
        contact, = self.decided(scene, "--pairs", pairs)[0]["contacts"]
        self.assertEqual((contact["low"], contact["high"], contact["touching_at_start"], contact["crossing_at_start"],
                          contact["edge_edge"]), (0, 0, 0, 1, 0))
        self.assertEqual(pairs.read_text(), "0,ef,0,1,2,3,4\n")
        self.assertEqual(self.good("bodies", scene, "--no-check-start"), "1 of 1 steps are free of contact\n")

    def test_a_part_of_the_steps(self):
        scene = self.tip_and_wall([QUARTER[0], *QUARTER])
        self.assertEqual(self.good("bodies", scene, "--count", 1), "1 of 1 steps are free of contact\n")
        step, = self.decided(scene, "--first", 1)
        self.assertEqual((step["step"], step["first_contact"]), (1, [0.5, 0.5]))
        self.assertIn("--first is 2; expected 0 to 1, as there are 3 frames", self.bad_usage("bodies", scene, "--first", 2))

    def test_groups_and_skipped_pairs_are_not_tested(self):
        for wall, members, tested in (({}, {}, 1), ({}, {"skip": [["wall", "tip"]]}, 0), ({"group": "b"}, {}, 1)):
            step, = self.decided(self.tip_and_wall(wall=wall, **members), status=3 if tested else 0)
            self.assertEqual(step["body_pairs"], tested)
        bodies = [{"mesh": "tip.obj", "poses": QUARTER, "group": "arm"}, {"mesh": "wall.obj", "group": "arm"}]
        self.assertEqual(self.decided(self.scene(*bodies), status=0)[0]["body_pairs"], 0)

    def test_poses_about_a_centre_and_affine_poses(self):
        # The tip turns about (4, 0, 0): a circle of radius 1 meets x = 3.5 where it would meet x = -0.5 about 0.
        about = self.scene({"name": "tip", "mesh": "tip.obj", "centre": [4, 0, 0], "poses": QUARTER},
                           {"name": "wall", "mesh": "wall.obj", "poses": [[-2.5, 0, 0, 1, 0, 0, 0]]})
        # x = (1 - t^2)/(1 + t^2) is 1/2 at t = 1/sqrt(3).
        low, high = self.decided(about)[0]["first_contact"]
        self.assertTrue(low ** 2 * 3 <= 1 + 1e-15 and high - low < 2e-16 and abs(low - 3 ** -.5) < 2e-16)
        identity = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
        shrunk = [[0.5, 0, 0, -1.5], *identity[1:]]
        step, = self.decided(self.scene({"mesh": "tip.obj", "matrices": [identity, shrunk]}, {"mesh": "wall.obj"}))
        self.assertEqual((step["first_contact"], step["contacts"][0]["body_a"]), ([0.5, 0.5], "0"))

    def test_within_a_distance(self):
        step, = self.decided(self.tip_and_wall(), "--separation", 2)
        self.assertEqual((step["first_contact"], step["contacts"][0]["touching_at_start"]), (None, 1))

    def test_the_bracket_is_that_of_the_earliest_pair(self):
        # Vertex 0 meets the wall just after t = 1/2, vertex 1 at t = 1/2.
        self.write("meshes/triangle.obj", "v 0.1 0.1 1e-17\nv 0.2 0.1 0\nv 0.1 0.2 0.5\nf 1 2 3\n")
        self.write("meshes/floor.obj", "v -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n")
        step, = self.decided(self.scene({"mesh": "triangle.obj", "poses": [[0, 0, 1, 1, 0, 0, 0], [0, 0, -1, 1, 0, 0, 0]]},
                                        {"mesh": "floor.obj"}))
        contact, = step["contacts"]
        self.assertEqual([contact["low"], contact["high"]], [0.5, 0.5])
        self.assertEqual(step["first_contact"], [0.5, 0.5])

    def test_meshes_are_not_overwritten(self):
        scene = self.tip_and_wall()
        mesh = self.directory / "meshes/wall.obj"
        before = mesh.read_text()
        self.assertIn("is also an input", self.bad_usage("bodies", scene, "--csv", mesh))
        self.assertEqual(mesh.read_text(), before)

    def test_bad_scenes(self):
        good = {"mesh": "tip.obj", "poses": QUARTER}
        for bodies, members, message in [
                ([], {}, "bodies is '[]'; expected a list of at least one body"),
                ([3], {}, "body 0 is '3'; expected an object"),
                ([{**good, "colour": 1}], {}, "body 0: member 'colour' is unknown; expected one of name, mesh, "),
                ([{"poses": QUARTER}], {}, "body '0': member 'mesh' is missing"),
                ([{**good, "mesh": "none.obj"}], {}, "meshes/none.obj"),
                ([good, {"mesh": "wall.obj", "name": "0"}], {}, "name of body 1 is '0', as of another body"),
                ([good, {"mesh": "wall.obj", "name": "a\x1b"}], {}, "name of body 1 is '\"a\\u001b\"'; expected a text"),
                ([{"mesh": "tip.obj"}], {}, "number of frames is 0; expected at least 2, by 'times' or by a body's 'poses'"),
                ([{"mesh": "none.obj"}], {}, "meshes/none.obj"),
                ([{}], {}, "body '0': member 'mesh' is missing"),
                ([{"mesh": "tip.obj", "centre": [0, 0, 0]}], {}, "centre of body '0' is given without poses"),
                ([{"mesh": "tip.obj"}], {"skip": 1}, "skip is '1'; expected a list of pairs"),
                ([{"mesh": "tip.obj"}], {"times": [1]}, "times is '[1]'; expected a list of at least 2 numbers"),
                ([{**good, "poses": QUARTER[:1]}], {}, "number of frames is 1; expected at least 2"),
                ([good, {**good, "poses": QUARTER * 2}], {}, "number of poses of body '0' is 2; expected 4, one for each"),
                ([good], {"times": [0, 1, 2]}, "number of poses of body '0' is 2; expected 3"),
                ([good], {"times": [1, 1]}, "time 1 is '1'; expected more than the time before"),
                ([good], {"times": [0, "1"]}, "times is '[0,\"1\"]'; expected a list of at least 2 numbers"),
                ([{**good, "poses": [QUARTER[0], [0, 0]]}], {}, "pose 1 of body '0' is '[0,0]'; expected 7 numbers"),
                ([{**good, "poses": 3}], {}, "poses of body '0' is '3'; expected a list"),
                ([{**good, "poses": [QUARTER[0], [0, 0, 0, 0, 0, 0, 1]]}], {}, "body '0', step 0: q0·q1 is 0;"),
                ([{**good, "matrices": []}], {}, "body '0' has 'poses' and 'matrices'"),
                ([good, {"mesh": "wall.obj", "matrices": [[[1, 0, 0, 0]] * 4]}], {}, "row 3 of matrix 0 of body '1' is"),
                ([good, {"mesh": "wall.obj", "matrices": [[[1, 0, 0]] * 4]}], {}, "row 0 of matrix 0 of body '1' is"),
                ([good, {"mesh": "wall.obj", "centre": [0, 0, 0]}], {}, "centre of body '1' is given without poses"),
                ([{**good, "centre": [0, 0]}], {}, "centre of body '0' is '[0,0]'; expected 3 numbers"),
                ([good], {"skip": [["0", "2"]]}, "name in skip is '\"2\"'; expected the name of a body"),
                ([good], {"skip": [["0", "0"]]}, "expected two different bodies"),
                ([good], {"skip": 1}, "skip is '1'; expected a list of pairs")]:
            self.bad_input(message, "bodies", self.scene(*bodies, **members))

    def test_bad_json(self):
        for text, message in [
                ("", "scene.json:1: text is not JSON"), ("{\n\n]", "scene.json:3: text is not JSON"),
                ('{"bodies": [], "bodies": []}', "member 'bodies' is repeated"), ("[]", "scene is '[]'; expected an object"),
                ('{"bodies": [1e999]}', "a number is out of range"), ("[" * 100000, "depth is 9; expected a scene"),
                ('{"times": [0, 1]}', "scene: member 'bodies' is missing"), ('{"bodies": [NaN]}', "scene.json:1: text is not JSON")]:
            self.bad_input(message, "bodies", self.scene(text=text))
        self.bad_input("no.json", "bodies", self.directory / "no.json")

    def test_examples(self):
        subprocess.run([sys.executable, SOURCE / "examples/bodies/make_scenes.py", self.directory], check=True)
        free = {}
        for name in "gears", "boxes", "needle":
            done = self.run_program("bodies", self.directory / name / "scene.json")
            free[name] = (done.returncode, done.stdout.splitlines()[-1].split()[0])
        self.assertEqual(free, {"gears": (3, "11"), "boxes": (3, "6"), "needle": (0, "8")})


class PagesOfBodies(Scenes):
    def page(self):
        out = self.directory / "scene.html"
        scene = self.scene({"name": "tip", "mesh": "tip.obj", "centre": [1, 0, 0], "poses": [
                               [0, 0, 0, 1, 0, 0, 0], [1, 2, 3, 2, 0, 0, 1]]},
                           {"mesh": "rod.obj", "matrices": [[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]],
                                                            [[1, 0, 0, 4], [1, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]]},
                           {"mesh": "wall.obj"})
        self.run_program("bodies", scene, "--view", out)
        self.assertIn("<title>errbound: bodies</title>", out.read_text())
        return Page(out.read_text())

    def test_arrays(self):
        page = self.page()
        self.assertEqual(page.numbers("ends", "I", 1), [(1,), (3,), (6,)])
        tip, rod, wall = page.numbers("motions", "d", 25)
        self.assertEqual(tip, (1, 1, 0, 0, 0, 2, 0, 0, 1, 1, 0, 0, *[0] * 7, 0, 0, 0, 1, 2, 3))
        self.assertEqual(rod, (0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 0, 1, 0, 0, 0, 4, 0, 0))
        self.assertEqual(wall[1:10], wall[10:19])
        self.assertEqual(page.numbers("before", "d", 3)[:3], [(5, 0, 0), (1, 0, 0), (2, 0, 0)])

    @unittest.skipUnless(shutil.which("node"), "no node, which runs the page's script")
    def test_positions_in_the_script(self):
        page = self.page()
        numbers = {name: struct.unpack(f"<{len(page.arrays[name]) // 8}d", page.arrays[name])
                   for name in ("before", "motions")}
        script = (SOURCE / "ccd/io/view/page/bodies.js").read_text() + f"""
            const step = {{rest: {list(numbers["before"])}, motions: new Float64Array({list(numbers["motions"])}),
                           ends: [1, 3, 6]}};
            console.log(JSON.stringify([0, .5, 1].map(t => Array.from(positionsAt(step, t)))));"""
        done = subprocess.run(["node", "-e", script], capture_output=True, text=True, check=True)
        start, middle, end = json.loads(done.stdout)
        wall = [3, -9, -9, 3, 9, -9, 3, 0, 9]
        # The tip is 4 from its centre. Turns by 2 atan(1/3) and 2 atan(1/2): (4/5, 3/5) and (3/5, 4/5).
        for found, expected in ((start, [4, 0, 0, 1, 0, 0, 2, 0, 0]), (middle, [3.7, 3.4, 1.5, 3, .5, 0, 4, 1, 0]),
                                (end, [3.4, 5.2, 3, 5, 1, 0, 6, 2, 0])):
            for x, y in zip(found, expected + wall, strict=True):
                self.assertAlmostEqual(x, y, places=14)


if __name__ == "__main__":
    unittest.main()
