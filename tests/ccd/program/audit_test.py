# `ccd audit`: a recorded simulation, step by step; and `--replay`, the pairs of a first contact alone.
import io
import json
import random
import struct
import unittest
import zipfile

from program_test import BASE, BEFORE, FACES, ProgramTest, obj, ply
from view_test import Page

HEADING = "step,crossing,touching,overlapping,contacts,low,high,depth,least_distance"
# A triangle, and a point above its interior.
TRIANGLE = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]


def npy(frames, code="<f8", shape=None, order="False", version=1):
    """Returns the bytes of numpy.save for a list of frames of points."""
    if shape is None:
        shape = f"({len(frames)}, {len(frames[0])}, 3)"
    header = "{'descr': '%s', 'fortran_order': %s, 'shape': %s, }" % (code, order, shape)
    header = header.ljust(117 if version == 1 else 115) + "\n"
    number = struct.Struct(code[0] + {"f4": "f", "f8": "d", "i4": "i"}[code[1:]])
    length = struct.pack("<H" if version == 1 else "<I", len(header))
    return b"\x93NUMPY" + bytes([version, 0]) + length + header.encode() + \
        b"".join(number.pack(x) for frame in frames for point in frame for x in point)


def npz(arrays, compression=zipfile.ZIP_STORED):
    """Returns the bytes of numpy.savez, which writes local headers with 64-bit sizes."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", compression) as archive:
        for name, content in arrays.items():
            with archive.open(name + ".npy", "w", force_zip64=True) as file:
                file.write(content)
    return out.getvalue()


def heights(values):
    return [TRIANGLE + [(0.25, 0.25, z)] for z in values]


class Audit(ProgramTest):
    def mesh(self):
        return self.write("mesh.obj", obj(TRIANGLE + [(0.25, 0.25, 1)], [(0, 1, 2)], "p 4\n"))

    def audit(self, *arguments, status=3, mesh=True):
        done = self.run_program("audit", *arguments, *(["--mesh", self.mesh()] if mesh else []))
        self.assertEqual(done.returncode, status, done.stderr)
        return done.stdout

    def steps(self, *arguments, status=3, mesh=True):
        out = self.directory / "steps.json"
        self.audit(*arguments, "--json", out, status=status, mesh=mesh)
        return json.loads(out.read_text())

    def test_a_planted_passage_among_1000_frames_is_found(self):
        # The point wanders above the triangle, and is below it in frame 701 only.
        draw = random.Random(5)
        frames = heights([draw.uniform(0.5, 1.5) for _ in range(1000)])
        for point in range(3):  # the triangle moves a little, too
            for i, frame in enumerate(frames):
                x, y, _ = frame[point]
                frame[point] = (x, y, i / 65536)
        frames[700][3], frames[701][3] = (0.25, 0.25, 0.5), (0.25, 0.25, -0.5)
        for point in range(3):
            for i in (700, 701, 702):
                frames[i][point] = (*frames[i][point][:2], 0)
        frames[702][3] = (0.25, 0.25, 1.5)
        found = self.steps(self.write("run.npy", npy(frames)))
        self.assertEqual([s["step"] for s in found["steps"]], list(range(999)))
        bad = [s for s in found["steps"] if s["contacts"]]
        self.assertEqual([(s["step"], s["contacts"], s["low"], s["high"]) for s in bad],
                         [(700, 1, 0.5, 0.5), (701, 1, 0.25, 0.25)])
        self.assertEqual([s["depth"] for s in bad], [0.5, 1.5])
        self.assertTrue(all(s["crossing"] + s["touching"] + s["overlapping"] == 0 for s in found["steps"]))
        self.assertEqual((found["free"], found["shown"]), (False, 700))
        self.assertEqual([(p["kind"], p["vertices"], p["time"], p["motion"]) for p in found["first_pairs"]],
                         [("vertex_face", [3, 0, 1, 2], [0.5, 0.5], "approaches")])
        self.assertAlmostEqual(found["steps"][700]["least_distance"], 0.5, 14)
        # Without the planted frame, all steps are free.
        frames[701] = frames[700]
        text = self.audit(self.write("run.npy", npy(frames)), status=0)
        self.assertEqual(text, "999 of 999 steps are free\n")

    def test_formats_agree(self):
        frames = heights([1, 0.5, 0.25, -0.25])
        expected = self.steps(self.write("f8.npy", npy(frames)))["steps"]
        self.assertEqual([s["contacts"] for s in expected], [0, 0, 1])
        files = [self.write(f"{i}.npy", npy([frame], shape="(4, 3)")) for i, frame in enumerate(frames)]
        archive = {"positions": npy(frames, "<f4"), "other": npy([[(0, 0, 0)]], shape="(1, 3)")}
        for inputs in ([self.write("f4.npy", npy(frames, "<f4", version=2))],
                       [self.write("big.npy", npy(frames, ">f4"))], [self.write("big.npy", npy(frames, ">f8"))],
                       [self.write("run.npz", npz(archive))],
                       [self.write("one.npz", npz({"arr_0": npy(frames)}))], files,
                       [self.write("a.npy", npy(frames[:2])), self.write("b.npy", npy(frames[2:]))]):
            self.assertEqual(self.steps(*inputs)["steps"], expected)
        plys = [self.write(f"{i}.ply", ply(frame, [(0, 1, 2)])) for i, frame in enumerate(frames)]
        self.assertEqual(self.steps(*plys, "--unused-vertices", "points", mesh=False)["steps"], expected)

    def test_float32_is_taken_as_stored(self):
        # All at 0.1, rounded to float32; then the point stays one float above the triangle.
        above = struct.unpack("<f", struct.pack("<I", struct.unpack("<I", struct.pack("<f", 0.1))[0] + 1))[0]
        for end, contacts in ((0.1, 1), (above, 0)):
            frames = [[(x, y, 0.1) for x, y, _ in TRIANGLE] + [(0.25, 0.25, z)] for z in (1, end)]
            found = self.steps(self.write("run.npy", npy(frames, "<f4")), status=3 if contacts else 0)["steps"][0]
            self.assertEqual(found["contacts"], contacts)
            if contacts:
                self.assertEqual((found["high"], found["depth"]), (1, 0))

    def test_resume(self):
        run = self.write("run.npy", npy(heights([1, 0.5, -0.5, 0.5, 0.25, 0.75])))
        whole, parts = self.directory / "whole.csv", self.directory / "parts.csv"
        self.audit(run, "--csv", whole)
        lines = whole.read_text().splitlines()
        self.assertEqual(lines[0], HEADING)
        self.assertTrue(lines[1].startswith("0,0,0,0,0,,,,0.99999"), lines[1])  # a lower bound
        self.assertEqual(lines[2].split(",")[:7], ["1", "0", "0", "0", "1", "0.5", "0.5"])
        self.assertEqual(len(lines), 6)
        for count in (1, 2, 4, 5, 5):  # the last call repeats the last step only
            found = self.steps(run, "--csv", parts, "--resume", "--count", count, status=0 if count == 1 else 3)
            self.assertEqual(parts.read_text().splitlines(), lines[:count + 1])
            self.assertEqual(len(found["steps"]), count)
        self.audit(run, "--first", 3, "--csv", parts, status=0)
        self.assertEqual(parts.read_text().splitlines(), [HEADING, *lines[4:]])

    def test_resume_refuses_damaged_and_foreign_tables(self):
        run = self.write("run.npy", npy(heights([1, 0.5, -0.5, 0.5])))
        table = self.directory / "table.csv"
        self.audit(run, "--csv", table)
        good = table.read_text()
        lines = good.splitlines()
        for content, line in [
                ("step,contacts\n", 1), ("\n".join([lines[0], lines[2], ""]), 2),
                (good.replace("0,0,0,0,0,,,,", "0,0,0,0,0,,,"), 2), (good.replace("1,0,0,0,1", "1,0,0,0,01"), 3),
                (good + "\n", 5), (good.replace(",0.5,", ",x,"), 3),
                (good.replace("2,0,0,0,1", "2,0,0,0,2"), 4)]:  # the last is of other frames
            table.write_text(content)
            done = self.run_program("audit", run, "--mesh", self.mesh(), "--csv", table, "--resume")
            self.assertEqual(done.returncode, 1, content)
            self.assertIn(f"table.csv:{line}: ", done.stderr)
            self.assertEqual(table.read_text(), content)

    def test_resume_after_a_kill(self):
        """A table may end anywhere in the line that was being written."""
        run = self.write("run.npy", npy(heights([1, 0.5, -0.5, 0.5])))
        table = self.directory / "table.csv"
        self.audit(run, "--csv", table)
        whole = table.read_text()
        for size in {0, 1, len(HEADING), len(HEADING) + 1, *range(len(HEADING) + 2, len(whole), 7), len(whole) - 1}:
            table.write_text(whole[:size])
            self.audit(run, "--csv", table, "--resume")
            self.assertEqual(table.read_text(), whole, size)

    def test_faces_of_size_0_are_not_free(self):
        """Regression: audit called such a step free, certify did not."""
        flat = [(0, 0, 0), (0, 0, 0), (0, 1, 0), (1, 0, 0), (0, -1, 0)]
        faces = [(0, 1, 2), (0, 3, 4)]  # vertex 1 is at vertex 0, which both faces have
        moved = [(x, y, z + (i == 1)) for i, (x, y, z) in enumerate(flat)]
        frames = [self.write(f"{i}.ply", ply(p, faces)) for i, p in enumerate([flat, moved])]
        found = self.steps(*frames, mesh=False, status=3)
        self.assertEqual((found["free"], found["steps"][0]["touching"]), (False, 3))

    def test_start_and_page(self):
        pierced = [(0, 0, 0), (4, 0, 0), (0, 4, 0), (1, 1, -1), (1, 1, 1), (1.5, 1, 1)]
        lifted = [(x, y, z + 3 * (i > 2)) for i, (x, y, z) in enumerate(pierced)]
        frames = [self.write(f"{i}.ply", ply(p, [(2, 1, 0), (5, 4, 3)]))
                  for i, p in enumerate([lifted, pierced, pierced])]
        page = self.directory / "page.html"
        found = self.steps(*frames, "--view", page, mesh=False)
        self.assertEqual([(s["crossing"], s["contacts"] > 0) for s in found["steps"]], [(0, True), (1, False)])
        self.assertGreater(len(Page(page.read_text()).numbers("edge_edge", "I", 4)) +
                           len(Page(page.read_text()).numbers("vertex_face", "I", 4)), 0)
        found = self.steps(*frames, "--view", page, "--first", 1, mesh=False)
        self.assertEqual(found["shown"], 1)
        self.assertEqual(Page(page.read_text()).numbers("start_face_face", "I", 6), [(0, 1, 2, 3, 4, 5)])

    def test_bad_input(self):
        mesh, good = self.mesh(), heights([1, 0.5])
        for name, content, message in [
                ("a.npy", npy(good)[:-1], "expected those of 2 x 4 x 3 numbers"),
                ("a.npy", npy(good) + b"\0", "expected those of 2 x 4 x 3 numbers"),
                ("a.npy", npy(good, shape="(999999999999999, 4, 3)"), "expected those of"),
                ("a.npy", npy(good, order="True"), "Fortran"),
                ("a.npy", npy(heights([1, 2]), shape="(8, 3, 1)"), "expected float32 or float64 of shape"),
                ("a.npy", npy([[(1, 2, 3)]], "<i4"), "expected float32 or float64"),
                *[("a.npy", npy(good, shape=shape), "header is") for shape in (
                    "(-2, 4, 3)", "(2, 4, 3; 9)", "(2, 4, 3", "(1 2, 4, 3)", "(2, 4, 3), 'shape': (2, 4, 3)")],
                ("a.npy", npy(good, order="Falsehood"), "header is"),
                ("a.npy", npy(good)[:60], "header is damaged"),
                ("a.npy", b"", "not an array of NumPy"),
                ("a.npy", npy(heights([1, float("nan")])), "a.npy[1]: coordinate of vertex 3 is nan"),
                ("a.npy", npy([TRIANGLE, TRIANGLE]), "number of vertices is 3; expected 4"),
                ("a.npz", npz({"positions": npy(good)}, zipfile.ZIP_DEFLATED), "numpy.savez_compressed"),
                ("a.npz", npz({"a": npy(good), "b": npy(good)}), "expected one array, or one named positions"),
                ("a.npz", npz({"positions": npy(good)})[:-30], "not a ZIP archive"),
                ("a.npz", b"PK\5\6" + b"\xff" * 18, "4 GiB"),
                ("a.npz", npz({"positions": npy(good)}).replace(b"PK\1\2", b"PK\0\0"), "damaged directory"),
                ("a.npz", npz({"positions": npy(good)}).replace(npy(good)[-48:], npy(good)[-48:-1] + b"\x40"), "checksum"),
                ("a.npz", npz({"positions": npy(good)})[100:], "")]:
            with self.subTest(message=message):
                self.bad_input(message, "audit", self.write(name, content), "--mesh", mesh)
        run = self.write("run.npy", npy(good))
        self.bad_input("expected --mesh", "audit", run)
        self.bad_input("file does not exist", "audit", "no.npy", "--mesh", mesh)
        frame = self.write("0.ply", ply(BASE, [(0, 1, 2)]))
        self.bad_input("number of vertices is 6; expected 3", "audit", frame, self.write("1.ply", ply(BEFORE, FACES)))

    def test_bad_usage(self):
        run, mesh, out = self.write("run.npy", npy(heights([1, 0.5]))), self.mesh(), self.directory / "out"
        for arguments, message in [
                (["--resume"], "expected --csv OUT"), (["--resume", "--csv", "-"], "expected --csv OUT"),
                (["--first", 1], "--first is 1; expected 0 to 0"), (["--threads", -1], "--threads is -1; expected 0 to 4096"), (["--count", 0], "--count"),
                (["--view", "page.vtp"], "ends in .html"), (["--replay", "out"], "ends in .csv"),
                (["--csv", out, "--json", out], "expected a separate file"),
                (["--csv", run], "expected a separate file"), (["--csv", mesh], "expected a separate file")]:
            with self.subTest(arguments=arguments):
                self.assertIn(message, self.bad_usage("audit", run, "--mesh", mesh, *arguments))
        self.assertFalse(out.exists())


class Replay(ProgramTest):
    def replay(self, *arguments, status=0):
        """Returns the first pairs, and the first times of the files that were written."""
        out, result, times = (self.directory / name for name in ("first.csv", "out.json", "times"))
        done = self.run_program(*arguments, "--replay", out, "--json", result)
        self.assertEqual(done.returncode, status, done.stderr)
        found = {}
        for kind in ("vf", "ee"):
            file = self.directory / f"first-{kind}.csv"
            if file.exists():
                self.good("query", file, "--toi", times, *(["--separation", arguments[-1]]
                                                          if "--separation" in arguments else []))
                found[kind] = [tuple(map(float.fromhex, line.split(","))) for line in times.read_text().split()]
                file.unlink()
        return json.loads(result.read_text())["first_pairs"], found

    def test_the_first_pairs_replay(self):
        frames = self.triangles()
        first, times = self.replay("step", *frames)
        self.assertEqual([(p["kind"], p["vertices"], p["motion"]) for p in first],
                         [("vertex_face", [3, 0, 1, 2], "approaches")])
        self.assertEqual(first[0]["time"], [0.5, 0.5])
        self.assertAlmostEqual(first[0]["normal_velocity"][0], -2, 14)
        self.assertAlmostEqual(first[0]["distance_at_start"][0], 1, 14)
        self.assertEqual(times, {"vf": [(0.5, 0.5)]})
        self.assertIn("vf,3,0,1,2", self.good("step", *frames, "--replay", self.directory / "x.csv"))
        free = self.directory / "free.ply"
        self.assertEqual(self.replay("step", *frames, "--advance", free)[0], first)
        self.assertEqual(self.replay("audit", *frames, status=3), (first, times))
        # Within a distance of 1/2, the same pair is first at 1/4.
        near, times = self.replay("step", *frames, "--separation", "0.5")
        self.assertEqual([(p["kind"], p["motion"]) for p in near], [("vertex_face", "approaches")])
        self.assertEqual(times, {"vf": [(0.25, 0.25)]})
        # A free step has no first pairs.
        self.assertEqual(self.replay("step", *self.triangles(BEFORE, BEFORE)), ([], {}))

    def test_all_kinds(self):
        # A vertex meets an edge of a face: pairs of both kinds; then a rod and a point, and two points.
        before = BASE + [(0.5, 0, 1), (0.5, -0.25, 2), (0.5, 0.25, 2)]
        first, times = self.replay("step", *self.triangles(before, before[:3] + [(x, y, z - 2) for x, y, z in before[3:]]))
        self.assertEqual({p["kind"] for p in first}, {"vertex_face", "edge_edge"})
        self.assertEqual({t for of in times.values() for t in of}, {(0.5, 0.5)})
        self.assertEqual(sum(map(len, times.values())), len(first))

        def frames(z, more):
            return [self.write(f"{i}.obj", obj([(0, 0, 0), (1, 0, 0), (0.5, 0, at)], (), more))
                    for i, at in enumerate((1, z))]
        first, times = self.replay("step", *frames(-3, "l 1 2\np 3\n"))
        self.assertEqual(([p["kind"] for p in first], times), (["vertex_edge"], {"vf": [(0.25, 0.25)]}))
        points = [self.write(f"p{i}.obj", obj([(0, 0, 0), (0, 0, z)], (), "p 1\np 2\n")) for i, z in enumerate((1, -1))]
        first, times = self.replay("step", *points)
        self.assertEqual(([p["vertices"] for p in first], times), ([[0, 1]], {"vf": [(0.5, 0.5)]}))

    def test_touching_without_crossing(self):
        # A face tilts about the y axis while a vertex moves over it; they touch at t = 1/2.
        frames = [self.write(f"{i}.ply", ply([(0, 0, 0), (1, 0, s), (0, 1, 0), (0.5 - s / 4, 0.125, s / 2)], [(0, 1, 2)]))
                  for i, s in enumerate((1, -1))]
        first, _ = self.replay("step", *frames, "--unused-vertices", "points")
        self.assertEqual([p["motion"] for p in first], ["touches"])

    def test_bad_usage(self):
        frames, out = self.triangles(), self.directory / "x.csv"
        self.assertIn("expected exact", self.bad_usage("step", *frames, "--replay", out, "--method", "tight"))
        self.assertIn("ends in .csv", self.bad_usage("step", *frames, "--replay", "x"))
        other = self.directory / "x-vf.csv"
        self.assertIn("expected a separate file", self.bad_usage("step", *frames, "--replay", out, "--pairs", other))


if __name__ == "__main__":
    unittest.main()
