# Files of `ccd step --view`, pages and files for ParaView, compared with the frames and with --toi.
# python/tests/page_test.py tests pages in a browser.
import base64
import math
import re
import struct
import unittest
import xml.etree.ElementTree as xml

from program_test import AFTER, BEFORE, FACES, SOURCE, ProgramTest, obj

SCENE = [SOURCE / f"examples/scenes/cloth-over-ball/frame{i}.ply" for i in (0, 1)]
KINDS = {"vf": ("vertex_face", 4), "ee": ("edge_edge", 4), "ve": ("vertex_edge", 3), "vv": ("vertex_vertex", 2)}
CODES = {"Float64": "d", "Int64": "q", "UInt32": "I", "Int8": "b"}

def rows(numbers, columns):
    return [tuple(numbers[i:i + columns]) for i in range(0, len(numbers), columns)]


class Page:
    """Returns the arrays of a page, as its script reads them."""

    def __init__(self, text):
        self.arrays = {}
        for name, data in re.findall(r'<script type="text/plain" id="array-(\w+)">([^<]*)</script>', text):
            self.arrays[name] = base64.b64decode(data, validate=True)

    def numbers(self, name, code, columns):
        data = self.arrays[name]
        return rows([n for n, in struct.iter_unpack("<" + code, data)], columns)

    def lines(self, with_times):
        found = []
        for short, (name, columns) in KINDS.items():
            pairs = self.numbers(name, "I", columns)
            times = self.numbers(name + "_times", "d", 2) if with_times else [()] * len(pairs)
            found += [",".join([short, *map(str, p), *map(float.hex, t)]) for p, t in zip(pairs, times, strict=True)]
        return found


class PolyData:
    """Returns the arrays of a VTK file by name."""

    def __init__(self, path):
        root = xml.parse(path).getroot()
        self.order = {"LittleEndian": "<", "BigEndian": ">"}[root.get("byte_order")]
        self.piece = root.find("PolyData/Piece")
        self.time = self.read(root.find("PolyData/FieldData/DataArray"))[0]
        self.point = {a.get("Name"): self.read(a) for a in self.piece.find("PointData")}
        self.cell = {a.get("Name"): self.read(a) for a in self.piece.find("CellData")}
        self.points = self.read(self.piece.find("Points/DataArray"))
        self.cells = [tuple(c) for kind in ("Verts", "Lines", "Polys") for c in self.cells_of(kind)]

    def read(self, array):
        code, columns = CODES[array.get("type")], int(array.get("NumberOfComponents", 1))
        data = base64.b64decode(array.text, validate=True)
        size, = struct.unpack_from(self.order + "Q", data)
        assert size == len(data) - 8
        numbers = [n for n, in struct.iter_unpack(self.order + code, data[8:])]
        return numbers if columns == 1 else rows(numbers, columns)

    def cells_of(self, kind):
        arrays = {a.get("Name"): self.read(a) for a in self.piece.find(kind)}
        offsets = [0, *arrays["offsets"]]
        assert len(offsets) - 1 == int(self.piece.get("NumberOf" + kind))
        assert offsets[-1] == len(arrays["connectivity"])
        return [arrays["connectivity"][i:j] for i, j in zip(offsets, offsets[1:])]


class Views(ProgramTest):
    def view(self, name, frames, *options):
        out, times = self.directory / name, self.directory / "times.csv"
        self.good("step", *frames, "--view", out, "--toi", times, *options)
        return out, times.read_text().split()

    def rods(self):
        """A rod above a point that falls past it, next to a face, and a point that meets the first."""
        corners = [(5, 0, 0), (6, 0, 0), (5, 1, 0), (0, 0, 0), (1, 0, 0)]
        return [self.write(f"rod{i}.obj", obj(corners + [(0.5, 0, z) for z in heights], [(0, 1, 2)], "l 4 5\n"))
                for i, heights in enumerate(((1, 2), (-1, -4)))]


class Pages(Views):
    def test_arrays_are_the_steps(self):
        out, lines = self.view("step.html", self.triangles())
        page = Page(out.read_text())
        self.assertEqual(page.numbers("before", "d", 3), [tuple(map(float, v)) for v in BEFORE])
        self.assertEqual(page.numbers("after", "d", 3), [tuple(map(float, v)) for v in AFTER])
        self.assertEqual(page.numbers("faces", "I", 3), FACES)
        self.assertEqual(page.numbers("edges", "I", 2), [])
        self.assertEqual(page.arrays["parts"], bytes([0, 0, 0, 1, 1, 1]))
        self.compare(page, lines)

    def test_lines_are_those_of_toi(self):
        for frames in self.rods(), SCENE:
            out, lines = self.view("step.html", frames, "--unused-vertices", "points")
            self.compare(Page(out.read_text()), lines)
            self.assertGreater(len(lines), 1)

    def compare(self, page, lines):
        def parsed(line):
            *pair, low, high = line.split(",")
            return pair, float.fromhex(low), float.fromhex(high)

        self.assertEqual([parsed(line) for line in page.lines(True)], [parsed(line) for line in lines])

    def test_without_times(self):
        out, pairs = self.directory / "step.html", self.directory / "pairs.csv"
        for method in "exact", "tight":
            self.good("step", *SCENE, "--method", method, "--view", out, "--pairs", pairs)
            page = Page(out.read_text())
            self.assertEqual(page.lines(False), pairs.read_text().split())
            self.assertEqual(page.arrays["edge_edge_times"], b"")

    def test_nothing_is_fetched_and_nothing_left_to_fill_in(self):
        text = self.view("step.html", SCENE)[0].read_text()
        self.assertFalse("{{" in text)
        self.assertEqual(re.findall(r'(?:src|href)="(?!data:,")', text), [])
        self.assertFalse("://" in text)

    def test_to_standard_output(self):
        frames = self.triangles()
        done = self.run_program("step", *frames, "--view", "-")
        self.assertEqual((done.returncode, done.stdout[:15]), (0, "<!doctype html>"))
        self.assertIn("vertex-face", done.stderr)


class ForParaView(Views):
    def shares(self, cells, lines):
        pairs = []
        for line in lines:
            short, *fields = line.split(",")
            vertices, first = [int(f) for f in fields[:-2]], 2 if short == "ee" else 1
            pairs.append((set(vertices[:first]), set(vertices[first:]), float.fromhex(fields[-2])))
        for cell in cells:
            own = [low for a, b, low in pairs if a <= set(cell) or b <= set(cell)]
            yield len(own), min(own, default=math.nan)

    def check(self, data, frame, lines):
        vertices = len(frame[0])
        self.assertEqual(data.points[:vertices], frame[int(data.time)])
        self.assertEqual(data.point["displacement"][:vertices],
                         [tuple(b - a for a, b in zip(p, q)) for p, q in zip(*frame)])
        of_mesh = [i for i, pair in enumerate(data.cell["pair"]) if pair < 0]
        contacts = [i for i, pair in enumerate(data.cell["pair"]) if pair >= 0]
        for i, (count, low) in zip(of_mesh, self.shares([data.cells[i] for i in of_mesh], lines), strict=True):
            self.assertEqual(data.cell["pairs"][i], count)
            self.assertEqual(repr(data.cell["toi"][i]), repr(low))  # NaN, too
            self.assertEqual(data.cell["kind"][i], -1)
        self.assertEqual([data.cell["pair"][i] for i in contacts], list(range(len(lines))))
        for i, line in zip(contacts, lines, strict=True):
            short, *_, low, _ = line.split(",")
            self.assertEqual(list(KINDS)[data.cell["kind"][i]], short)
            self.assertEqual(data.cell["toi"][i], float.fromhex(low))
            self.assertGreaterEqual(data.cells[i][0], vertices)

    def test_triangles(self):
        out, lines = self.view("step.vtp", self.triangles())
        data = PolyData(out)
        self.check(data, ([tuple(map(float, v)) for v in BEFORE], [tuple(map(float, v)) for v in AFTER]), lines)
        self.assertEqual(data.cells[-2:], FACES)
        # The vertex (0.2, 0.2) falls from 1 to -1 and meets the face at t = 1/2.
        self.assertEqual(lines[0], "vf,3,0,1,2,0x1p-1,0x1p-1")
        self.assertEqual(data.points[6], (0.2, 0.2, 0.0))
        self.assertEqual(data.point["normal"][6], (0.0, 0.0, 1.0))

    def test_rods_and_points(self):
        frames = self.rods()
        out, lines = self.view("step.vtp", frames, "--unused-vertices", "points")
        data = PolyData(out)
        before = data.points[:7]
        after = [(x, y, {5: -1.0, 6: -4.0}.get(i, 0.0)) for i, (x, y, _) in enumerate(before)]
        self.check(data, (before, after), lines)
        # Each point passes the rod, and the upper point passes the lower one.
        self.assertEqual([line.split(",")[0] for line in lines], ["ve", "ve", "vv"])
        self.assertEqual(data.cells[:2], [(5,), (6,)])
        for found, height in zip(data.points[7:], (0, 0, 0.5), strict=True):
            self.assertEqual(found[:2], (0.5, 0))
            self.assertAlmostEqual(found[2], height, places=15)

    def test_series_of_a_scene(self):
        out, lines = self.view("step.pvd", SCENE)
        listed = [(e.get("timestep"), e.get("file")) for e in xml.parse(out).getroot().iter("DataSet")]
        self.assertEqual(listed, [("0", "step-0.vtp"), ("1", "step-1.vtp")])
        page = Page(self.view("step.html", SCENE)[0].read_text())
        frame = page.numbers("before", "d", 3), page.numbers("after", "d", 3)
        for _, name in listed:
            self.check(PolyData(self.directory / name), frame, lines)

    def test_within_a_distance_and_without_times(self):
        frames = self.triangles()
        out, _ = self.view("near.vtp", frames, "--separation", "0.25")
        data = PolyData(out)
        self.assertEqual(data.point["normal"][6], (0.0, 0.0, 0.0))  # only contacts have normals
        self.good("step", *frames, "--view", out)
        data = PolyData(out)
        self.assertTrue(all(map(math.isnan, data.cell["toi"])))
        middle = [sum(BEFORE[v][a] for v in (3, 0, 1, 2)) / 4 for a in range(3)]
        for found, expected in zip(data.points[6], middle):
            self.assertAlmostEqual(found, expected, places=15)


class Refusals(Views):
    def test_other_names(self):
        frames = self.triangles()
        for name in "step.obj", "step", ".html":
            message = self.bad_usage("step", *frames, "--view", self.directory / name)
            self.assertIn("expected a name that ends in .html, .vtp or .pvd", message)
        for name in "a\nb.pvd", "a\x1b[31m.pvd":
            message = self.bad_usage("step", *frames, "--view", self.directory / name)
            self.assertIn("expected a name without control characters", message)
            self.assertNotIn("\x1b", message)
        message = self.bad_usage("step", *frames, "--view", self.directory / "s.pvd", "--pairs", self.directory / "s-1.vtp")
        self.assertIn("s-1.vtp", message)

    def test_a_file_of_a_series_is_a_folder(self):
        frames = self.triangles()
        (self.directory / "step-1.vtp").mkdir()
        self.bad_input("step-1.vtp", "step", *frames, "--view", self.directory / "step.pvd")


if __name__ == "__main__":
    unittest.main()
