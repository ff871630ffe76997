# The program CCD_PROGRAM as users run it: exit statuses, messages, output files.
import csv
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["CCD_PROGRAM"]
SOURCE = pathlib.Path(__file__).resolve().parents[3]

# A vertex that falls through a triangle, and one that stays above it.
HIT = "1,4,1,4,1,1\n0,1,0,1,0,1\n1,1,0,1,0,1\n0,1,1,1,0,1\n" \
      "1,4,1,4,-1,1\n0,1,0,1,0,1\n1,1,0,1,0,1\n0,1,1,1,0,1\n"
MISS = HIT.replace("1,4,1,4,-1,1", "1,4,1,4,1,2")


def with_truth(rows, truth):
    return "".join(f"{row},{truth}\n" for row in rows.splitlines())


def ply(vertices, faces, vertex_count=None, face_count=None):
    lines = ["ply", "format ascii 1.0", f"element vertex {len(vertices) if vertex_count is None else vertex_count}",
             "property double x", "property double y", "property double z",
             f"element face {len(faces) if face_count is None else face_count}",
             "property list uchar int vertex_indices", "end_header"]
    lines += [" ".join(map(str, v)) for v in vertices]
    lines += [" ".join(map(str, (len(f), *f))) for f in faces]
    return "\n".join(lines) + "\n"


def obj(vertices, faces=(), more=""):
    """Returns the text of a mesh; `more` has lines of other elements."""
    return "".join("v %r %r %r\n" % v for v in vertices) + \
        "".join("f %d %d %d\n" % tuple(i + 1 for i in f) for f in faces) + more


def table_of(text):
    """Returns the cells of the last row with each first cell."""
    return {row.split()[0]: row.split()[1:] for row in text.splitlines() if row}


# Two triangles; the second falls through the first.
BASE = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
TOP = [(0.2, 0.2, 1), (0.4, 0.2, 1.125), (0.2, 0.4, 1.25)]
FACES = [(5, 4, 3), (0, 1, 2)]
BEFORE = BASE + TOP
AFTER = BASE + [(x, y, z - 2) for x, y, z in TOP]


class ProgramTest(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.directory = pathlib.Path(directory.name)

    def write(self, name, content):
        path = self.directory / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return str(path)

    def triangles(self, before=BEFORE, after=AFTER, faces=FACES):
        return [self.write("0.ply", ply(before, faces)), self.write("1.ply", ply(after, faces))]

    def run_program(self, *arguments):
        return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=120)

    def good(self, *arguments):
        done = self.run_program(*arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr, "")
        return done.stdout

    def bad_input(self, message, *arguments):
        before = sorted(self.directory.rglob("*"))
        out = self.directory / "bad.out"
        outputs = ["--json", out]
        if arguments[0] == "query" and "--method" in arguments:
            outputs += ["--verdicts", self.directory / "bad.verdicts"]
        if arguments[0] == "step":
            outputs += ["--pairs", self.directory / "bad.pairs"]
        done = self.run_program(*arguments, *outputs)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn(message, done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1)
        self.assertLess(len(done.stderr), 600)
        self.assertEqual(done.stdout, "")
        self.assertEqual(sorted(self.directory.rglob("*")), before)

    def bad_usage(self, *arguments):
        done = self.run_program(*arguments)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertNotEqual(done.stderr, "")
        return done.stderr


class Query(ProgramTest):
    def test_table_and_json_agree(self):
        file = self.write("vertex-face/data.csv", with_truth(HIT, 1) + with_truth(MISS, 0) + with_truth(MISS, 1))
        out = self.directory / "out.json"
        text = self.good("query", file, "--json", out)
        rows = [line.split() for line in text.splitlines()]
        self.assertEqual(rows[0], ["file", "kind", "method", "queries", "collisions", "FP", "FN", "ns/query"])
        results = json.loads(out.read_text())
        self.assertEqual([row[2] for row in rows[1:]], [r["method"] for r in results])
        self.assertIn("exact", [r["method"] for r in results])
        for row, result in zip(rows[1:], results):
            self.assertEqual(list(result), ["file", "kind", "method", "queries", "collisions",
                                            "false_positives", "false_negatives", "ns_per_query"])
            self.assertEqual(row[:7], [file, "vf", result["method"], "3", *(
                str(result[key]) for key in ("collisions", "false_positives", "false_negatives"))])
            self.assertGreater(result["ns_per_query"], 0)
        exact = next(r for r in results if r["method"] == "exact")
        self.assertEqual((exact["collisions"], exact["false_positives"], exact["false_negatives"]), (1, 0, 1))

    def test_without_truth(self):
        file = self.write("plain.csv", HIT)
        out = self.directory / "out.json"
        text = self.good("query", file, "--kind", "vf", "--method", "exact", "--json", out)
        self.assertEqual(text.splitlines()[1].split()[5:7], ["-", "-"])
        result = json.loads(out.read_text())[0]
        self.assertIsNone(result["false_positives"])
        self.assertIsNone(result["false_negatives"])

    def test_method_list_kind_and_several_files(self):
        first, second = self.write("a.csv", HIT), self.write("b.csv", MISS)
        text = self.good("query", "--kind", "ee", "--method", "exact,float", first, second)
        self.assertEqual([line.split()[:3] for line in text.splitlines()[1:]],
                         [[first, "ee", "exact"], [first, "ee", "float"],
                          [second, "ee", "exact"], [second, "ee", "float"]])

    def test_round(self):
        file = self.write("vf.csv", HIT.replace("1,4,1,4,1,1", "1,3,1,3,1,1"))
        self.bad_input("vf.csv:1: x is '1'/'3', which no double equals", "query", file)
        self.good("query", file, "--round")

    def test_ranges_together_make_the_whole_file(self):
        file = self.write("vf.csv", HIT + MISS + MISS + HIT + MISS)
        out = self.directory / "verdicts"

        def verdicts(*ranges):
            lines = ""
            for options in ranges:
                self.good("query", file, "--method", "exact", "--verdicts", out, *options)
                lines += out.read_text()
            return lines
        whole = verdicts(())
        self.assertEqual(whole, "1\n0\n0\n1\n0\n")
        self.assertEqual(verdicts(("--count", 2), ("--first", 2, "--count", 1),
                                  ("--first", 3, "--count", 100)), whole)
        self.bad_input("vf.csv: number of queries is 5; expected more than the first 5, which are skipped",
                       "query", file, "--first", 5)
        self.bad_usage("query", file, "--count", 0)

    def test_bad_input(self):
        """The test of the reader has more cases (tests/ccd/io)."""
        for name, content, message in [
                ("empty", "", "empty/vf.csv: file is empty; expected"),
                ("token", HIT.replace("1,4,1", "1,4,one", 1),
                 "token/vf.csv:1: numerator of y is 'one'; expected an integer"),
                ("garbage", bytes(range(256)) * 64, "garbage/vf.csv:1: line is")]:
            with self.subTest(name):
                self.bad_input(message, "query", self.write(f"{name}/vf.csv", content), "--method", "exact")
        self.bad_input("file does not exist", "query", self.directory / "none" / "vf.csv")
        self.bad_input("is a directory", "query", self.directory, "--kind", "vf")
        self.bad_input("path has no kind of query", "query", self.write("data.csv", HIT))
        self.bad_input("file does not exist", "query", self.write("good/vf.csv", HIT), self.directory / "vf.csv")
        self.write("s/mma_bool/1vf_mma_bool.json", "[true,true]")
        self.bad_input("number of truth values is 2; expected 1", "query", self.write("s/queries/1vf.csv", HIT))

    def test_one_output_by_two_names(self):
        file = self.write("vf.csv", HIT)
        out = self.directory / "folder" / "out"
        out.parent.mkdir()
        (self.directory / "link").symlink_to(out.parent)
        for name in os.path.relpath(out), self.directory / "link" / "out", out.parent / ".." / "folder" / "out":
            self.assertIn("is also an input or another output",
                          self.bad_usage("query", file, "--method", "exact", "--verdicts", out, "--json", name))
            self.assertFalse(out.exists())

    def test_bad_usage(self):
        file, out = self.write("vf.csv", HIT), self.directory / "out"
        for message, *arguments in (
                ("",), ("decide", "decide"), ("standard input is given twice", "step", "-", "-"), ("", "query"),
                ("--kind is 'vertex'; expected one of vf,ee", "query", file, "--kind", "vertex"),
                ("option is '--nope'; expected one that ccd query --help lists", "query", file, "--nope"),
                ("option is '--nope'; expected one that ccd query --help lists", "query", "--nope"),
                ("option is '--nope=1'; expected one that ccd --help lists", "--nope=1", "query", file),
                ("option is '--nope'; expected", "query", "more", "--first", -1, "--nope"),
                ("command is 'S'; expected one of query, ", "S", "--nope"),
                ("FILE is missing; ccd query --help lists the arguments", "query"),
                ("argument 'c' is one too many; ccd step --help lists", "step", "a", "b", "c"),
                ("--first is 1.5; expected 0 to ", "query", file, "--first", 1.5),
                ("value of --first is missing; expected ", "query", file, "--first"),
                ("--first is given 2 times; expected once", "query", file, "--first", 1, "--first", 1),
                ("--seed is '-1'; expected an integer from 0 to 2^64 - 1", "stress", "--seed", -1),
                ("--round is 'x'; expected no value", "query", file, "--round=x"),
                ("is 'magic'; expected one of", "query", file, "--method", "exact,magic"),
                ("", "query", file, "--method", "exact,"),
                ("standard input is given twice", "query", "-", "-", "--kind", "vf"),
                ("", "query", file, "--verdicts", out),
                ("", "query", file, "--method", "exact,float", "--verdicts", out),
                ("", "query", file, file, "--method", "exact", "--verdicts", out)):
            self.assertIn(message, self.bad_usage(*arguments))
        self.assertFalse(out.exists())


class Step(ProgramTest):
    def test_pairs_and_json(self):
        pairs, out = self.directory / "pairs", self.directory / "json"
        text = self.good("step", *self.triangles(), "--pairs", pairs, "--json", out)
        lines = [line.split(",") for line in pairs.read_text().splitlines()]
        for kind in ("vf", "ee"):
            of_kind = [tuple(map(int, line[1:])) for line in lines if line[0] == kind]
            self.assertEqual(of_kind, sorted(set(of_kind)))
        # Each vertex of the falling triangle passes through the other. Indices of faces ascend.
        self.assertEqual([line for line in lines if line[0] == "vf"],
                         [["vf", str(v), "0", "1", "2"] for v in (3, 4, 5)])
        for kind, *indices in lines:
            i = list(map(int, indices))
            ordered = i[1:] == sorted(i[1:]) if kind == "vf" else \
                i[0] < i[1] and i[2] < i[3] and i[:2] < i[2:]
            self.assertTrue(ordered, (kind, i))
        result = json.loads(out.read_text())
        self.assertEqual(list(result), ["method", "candidates", "collisions", "seconds", "threads", "peak_memory_bytes"])
        self.assertEqual(result["method"], "exact")
        count = {name: sum(line[0] == kind for line in lines)
                 for name, kind in (("vertex_face", "vf"), ("edge_edge", "ee"))}
        self.assertEqual(result["collisions"], count)
        self.assertEqual(list(result["seconds"]), ["read", "prepare", "broad", "narrow", "sort", "total"])
        self.assertGreater(result["peak_memory_bytes"], 1 << 20)
        table = table_of(text)
        self.assertIsNone(result["candidates"])  # not counted
        self.assertEqual(table["vertex-face"], [str(count["vertex_face"])])
        self.assertEqual(table["edge-edge"], [str(count["edge_edge"])])

    def test_threads_methods_and_obj_agree(self):
        frames = [self.write("0.obj", obj(BEFORE, FACES)), self.write("1.ply", ply(AFTER, FACES))]
        expected = None
        for options in ([], ["--threads", 1], ["--threads", 3], ["--method", "exact"]):
            pairs = self.directory / "pairs"
            self.good("step", *frames, "--pairs", pairs, *options)
            expected = expected or pairs.read_text()
            self.assertEqual(pairs.read_text(), expected)

    def test_rods_and_points(self):
        """A rod falls through a face and another rod. A point falls onto the middle of that rod."""
        def frame(z):
            vertices = BASE + [(0.25, 0.25, z), (2, 0, z), (1, -1, 0), (1, 1, 0), (1, -0.5, z)]
            return obj(vertices, [(0, 1, 2)], "l 4 5\nl 6 7\np 8\n")
        frames = [self.write("0.obj", frame(1)), self.write("1.obj", frame(-1))]
        pairs, out = self.directory / "pairs", self.directory / "json"
        for method in ("exact", "tight"):
            text = self.good("step", *frames, "--method", method, "--pairs", pairs, "--json", out)
            lines = pairs.read_text().splitlines()
            self.assertEqual([line for line in lines if not line.startswith("ee")],
                             ["vf,3,0,1,2", "ve,7,5,6"])
            self.assertIn("ee,3,4,5,6", lines)
            result = json.loads(out.read_text())["collisions"]
            self.assertEqual(result, {"vertex_face": 1, "edge_edge": len(lines) - 2, "vertex_edge": 1})
            self.assertEqual(table_of(text)["vertex-edge"][-1], "1")

    def test_unused_vertices_stopped_steps(self):
        """Unused vertices fall through a triangle; two of them coincide."""
        def step(elements, *options):
            frames = [self.write(f"{z}.obj", obj(BASE + [(0.25, 0.25, z)] * 2, more=elements)) for z in (1, -1)]
            pairs, out, free = (self.directory / name for name in ("pairs", "json", "free.ply"))
            text = self.good("step", *frames, "--pairs", pairs, "--json", out, "--advance", free, *options)
            result = json.loads(out.read_text())
            self.good("step", frames[0], free)
            unused = result.get("unused_vertices")
            self.assertEqual("no face and no edge" in text, unused is not None)
            return pairs.read_text().split(), unused and (unused["count"], unused["skipped"]), result["advance"] == 1
        hits, skip = ["vf,3,0,1,2", "vf,4,0,1,2", "vv,3,4"], ["--unused-vertices", "skip"]
        for elements, options, expected in [
                ("f 1 2 3\n", [], ([], (2, True), True)), ("f 1 2 3\n", skip, ([], (2, True), True)),
                ("f 1 2 3\n", ["--unused-vertices", "points"], (hits, (2, False), False)),
                ("f 1 2 3\np 4 5\n", [], (hits, None, False)), ("f 1 2 3\nf 4 4 4\n", [], (hits[:1], (1, True), False)),
                ("", [], (hits[2:], (5, False), True)), ("", skip, ([], (5, True), True))]:
            with self.subTest(elements=elements, options=options):
                self.assertEqual(step(elements, *options), expected)

    def test_many_unused_vertices_at_one_place_filled_the_memory(self):
        frame = obj(BASE + [(9, 9, 9)] * 20000, [(0, 1, 2)])
        out = self.directory / "json"
        self.good("step", self.write("0.obj", frame), self.write("1.obj", frame), "--json", out)
        result = json.loads(out.read_text())
        self.assertEqual(result["unused_vertices"], {"count": 20000, "skipped": True})
        self.assertEqual(result["collisions"], {"vertex_face": 0, "edge_edge": 0})

    def test_polygons_are_split_alike_in_both_frames(self):
        def frames(faces):
            return self.triangles(*([(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0.5, 1.5, z)] for z in (1, -1)), faces)
        quad, fan = [(0, 1, 2, 3), (4, 4, 4)], [(0, 1, 2), (0, 2, 3), (4, 4, 4)]
        self.bad_input("vertices of a face is 4; expected 3 (the option triangulate splits polygons)",
                       "step", *frames(quad))
        pairs = self.directory / "pairs"
        for faces in quad, fan:
            self.good("step", *frames(faces), "--triangulate", "--pairs", pairs)
            self.assertEqual(pairs.read_text(), "vf,4,0,2,3\n")

    def test_instruction_sets_agree(self):
        frames = self.triangles()
        refused = self.bad_usage("step", *frames, "--instruction-set", "none-such")
        known = refused.split("expected one of ")[1].split(" (")[0].split(", ")
        self.assertEqual(known[0], "baseline")
        results = set()
        for name in known:
            pairs = self.directory / "pairs"
            self.good("step", *frames, "--pairs", pairs, "--instruction-set", name)
            results.add(pairs.read_text())
        self.assertEqual(len(results), 1)
        self.assertIn("vf,3,0,1,2", results.pop())

    def test_explain(self):
        frames = self.triangles()
        out = self.directory / "json"
        text = self.good("step", *frames, "--explain", "--json", out)
        result = json.loads(out.read_text())
        stages = result["stages"]
        self.assertEqual([s["stage"] for s in stages],
                         ["axes", "coplanarity", "inside", "subdivision", "integers", "unbounded"])
        candidates = sum(result["candidates"].values())
        collisions = sum(result["collisions"].values())
        self.assertEqual(sum(s["separate"] + s["collides"] for s in stages), candidates)
        self.assertEqual(sum(s["collides"] for s in stages), collisions)
        self.assertGreater(collisions, 0)
        rows = {row.split()[0]: row.split() for row in text.splitlines() if row}
        counts = [row.split() for row in text.splitlines() if row.startswith("vertex-face")][0]
        self.assertEqual(counts[1:], [str(result["candidates"]["vertex_face"]),
                                      str(result["collisions"]["vertex_face"])])
        for s in stages:
            self.assertEqual(rows[s["stage"]][1:5],
                             [str(s[k]) for k in ("entered", "skipped", "separate", "collides")])
            self.assertEqual(s["undecided"], s["entered"] - s["separate"] - s["collides"])
        self.assertEqual(result["pairs_of_mesh"], {"vertex_face": 12, "edge_edge": 15})
        # Six vertices, two faces and six edges: pairs that the boxes discard.
        self.assertIn("of the mesh  apart  candidates", text)
        of_boxes = [row.split() for row in text.splitlines() if row.startswith("edge-edge")][1]
        self.assertEqual(of_boxes[1:], ["15", str(15 - result["candidates"]["edge_edge"]),
                                        str(result["candidates"]["edge_edge"])])
        self.good("step", *frames, "--json", out)
        self.assertNotIn("stages", json.loads(out.read_text()))

    def test_outputs_replace_neither_inputs_nor_each_other(self):
        frame = pathlib.Path(self.write("frame.ply", ply(BEFORE, FACES)))
        before = frame.read_bytes()
        for outputs in (["--pairs", frame], ["--json", frame],
                        ["--pairs", self.directory / "o", "--json", self.directory / "o"]):
            self.assertIn("expected a separate file", self.bad_usage("step", frame, frame, *outputs))
        self.assertEqual(frame.read_bytes(), before)
        self.assertFalse((self.directory / "o").exists())

    def test_a_replaced_file_keeps_its_permissions(self):
        frame = self.write("frame.ply", ply(BEFORE, FACES))
        out = pathlib.Path(self.write("out.json", ""))
        out.chmod(0o600)
        self.good("step", frame, frame, "--json", out)
        self.assertEqual(out.stat().st_mode & 0o777, 0o600)

    def test_bad_input(self):
        """The tests of the readers have more cases (tests/ccd/io)."""
        good = self.write("good.ply", ply(BEFORE, FACES))
        for name, content, message in [
                ("garbage.ply", bytes(range(256)), "expected 'ply'"),
                ("garbage.obj", bytes(range(256)), "expected no control characters"),
                ("faces.ply", ply(BEFORE, FACES, face_count=3), "truncated, or a wrong count"),
                ("range.ply", ply(BEFORE, [(0, 1, 2), (3, 4, 6)]),
                 "face 1: vertex index is 6; expected less than 6"),
                ("nan.ply", ply([("nan", 0, 0)] + BEFORE[1:], FACES), "value is 'nan'"),
                ("topology.ply", ply(BEFORE, [(5, 4, 3), (0, 2, 1)]),
                 "vertices of face 1 are 0 2 1; expected 0 1 2 as in"),
                ("more.ply", ply(BEFORE + BASE, FACES), "number of vertices is 9; expected 6 as in"),
                ("mesh.stl", "solid\n", "expected .ply or .obj")]:
            with self.subTest(name):
                self.bad_input(message, "step", good, self.write("bad/" + name, content))
        self.bad_input("file does not exist", "step", good, self.directory / "none.ply")
        self.bad_input("is a directory", "step", good, self.directory)

    def test_bad_usage(self):
        frame = self.write("0.ply", ply(BEFORE, FACES))
        for arguments in ((), (frame, frame), (frame, "--method", "exact,float"), (frame, "--threads", "-1"),
                          (frame, "--threads", "many")):
            self.bad_usage("step", frame, *arguments)
        for option in (["--explain"], ["--instruction-set", "baseline"]):
            self.assertIn("expected exact",
                          self.bad_usage("step", frame, frame, "--method", "tight", *option))


class Quoted(ProgramTest):
    """docs/measured.md quotes the program's output for the bundled scene, except times."""

    def pairs(self, method):
        frames = [SOURCE / "examples/scenes/cloth-over-ball" / f"frame{i}.ply" for i in (0, 1)]
        out, lines = self.directory / "step.json", self.directory / "pairs.csv"
        counted = ["--explain"] if method == "exact" else []
        self.good("step", *frames, "--method", method, *counted, "--json", out, "--pairs", lines)
        return json.loads(out.read_text())["candidates"], set(lines.read_text().split())

    def test_bundled_scene(self):
        text = (SOURCE / "docs/measured.md").read_text().split("## The bundled scene")[1]
        block = text.split("```")[1]
        _, truth = self.pairs("exact")
        rows = [line.split() for line in block.splitlines() if line and not line.startswith((" ", "m"))]
        self.assertEqual([row[0] for row in rows], ["float", "safe", "tight", "exact"])
        for method, *counts, _ in rows:
            candidates, found = self.pairs(method)
            of_kind = {kind: sum(pair.startswith(kind) for pair in found) for kind in ("vf", "ee")}
            self.assertEqual([int(count) for count in counts],
                             [candidates["vertex_face"], of_kind["vf"],
                              candidates["edge_edge"], of_kind["ee"],
                              len(found - truth), len(truth - found)], method)


class Device(ProgramTest):
    """Runs with CUDA and a device, without a device, and in builds without CUDA."""

    def device(self):
        frames = self.triangles()
        pairs = self.directory / "pairs"
        done = self.run_program("step", *frames, "--device", "cuda", "--pairs", pairs)
        if done.returncode == 0:
            found = pairs.read_text()
            self.good("step", *frames, "--pairs", pairs)
            self.assertEqual(found, pairs.read_text())
            self.same_on_device("step", *frames)
            return None
        self.assertFalse(pairs.exists())
        self.assertEqual(done.stdout, "")
        self.assertEqual(done.stderr.count("\n"), 1)
        expected = {1: "ccd: CUDA: ", 2: "this build has no CUDA"}
        self.assertIn(expected[done.returncode], done.stderr)
        return done.returncode

    def same_on_device(self, *arguments):
        host, device = (self.run_program(*arguments, "--toi", "-", *on) for on in ([], ["--device", "cuda"]))
        self.assertEqual((device.returncode, device.stdout), (0, host.stdout), device.stderr)

    def test_step_and_query(self):
        error = self.device()
        file = self.write("vf.csv", HIT)
        for t_max in ([], ["--t-max", "0.5"]):
            done = self.run_program("query", file, "--kind", "vf", "--device", "cuda", "--toi", "-", *t_max)
            self.assertEqual(done.returncode, error or 0, done.stderr)
            if error is None:
                self.same_on_device("query", file, "--kind", "vf", *t_max)
        for precision in ([], ["--precision", "float32"], ["--precision", "float64"]):
            done = self.run_program("query", file, "--kind", "vf", "--device", "cuda", *precision)
            self.assertEqual(done.returncode, error or 0, done.stderr)
            if error is None:
                self.assertEqual(len(done.stdout.splitlines()), 1 + 6)

    def test_bad_usage(self):
        file = self.write("vf.csv", HIT)
        self.bad_usage("query", file, "--device", "abacus")
        self.bad_usage("query", file, "--device", "cuda", "--precision", "float16")
        self.assertIn("expected cuda with", self.bad_usage("query", file, "--precision", "float32"))
        frames = self.triangles()
        if self.device() is None:
            self.assertIn("--method is 'provot' with --device cuda",
                          self.bad_usage("query", file, "--device", "cuda", "--method", "provot"))
            self.bad_usage("step", *frames, "--device", "cuda", "--explain")
            self.bad_usage("step", *frames, "--device", "cuda", "--threads", "2")
            for distance in (["step", *frames], ["query", file, "--kind", "vf"]):
                self.assertIn("expected cpu with",
                              self.bad_usage(*distance, "--device", "cuda", "--separation", "1"))


class Stress(ProgramTest):
    def test_table_csv_and_json_agree(self):
        folder, out = self.directory / "new" / "stress", self.directory / "out.json"
        text = self.good("stress", "--quick", "--queries", 3, "--method", "float,exact",
                         "--family", "double-root,not-finite", "--out", folder, "--json", out)
        rows = list(csv.DictReader((folder / "stress.csv").read_text().splitlines()))
        self.assertEqual(list(rows[0]), [
            "family", "knob_name", "knob", "kind", "method", "queries", "collisions",
            "false_positives", "false_negatives", "uncertain", "ns_per_query"])
        results = json.loads(out.read_text())
        self.assertEqual(len(rows), len(results))
        for row, result in zip(rows, results):
            self.assertEqual(row["knob"], "-inf" if result["knob"] is None else str(result["knob"])
                             .removesuffix(".0"))
            for key in ("family", "knob_name", "kind", "method", "queries", "collisions",
                        "false_positives", "false_negatives", "uncertain"):
                self.assertEqual(row[key], str(result[key]))
            self.assertGreater(float(row["ns_per_query"]), 0)
        self.assertEqual({r["kind"] for r in rows}, {"vf", "ee"})
        self.assertIn("-inf", [r["knob"] for r in rows if r["family"] == "double-root"])
        table = [line.split() for line in text.splitlines() if line.startswith("double-root")]
        for line, method in zip(table, ("float", "exact")):
            of_method = [r for r in rows if (r["family"], r["method"]) == ("double-root", method)]
            sums = [str(sum(int(r[key]) for r in of_method)) for key in
                    ("queries", "collisions", "false_positives", "false_negatives", "uncertain")]
            self.assertEqual(line[1:7], [method, *sums])
        self.assertEqual(text.splitlines()[-1],
                         "promised: no false negative by exact; no false positive by exact; "
                         "no answer from NaN or infinity by all: kept")

    def test_same_seed_same_counts(self):
        def counts(*options):
            out = self.directory / "out.json"
            self.good("stress", "--quick", "--queries", 8, "--method", "float,tight", "--family",
                      "offset", "--json", out, *options)
            return [{k: v for k, v in r.items() if k != "ns_per_query"}
                    for r in json.loads(out.read_text())]
        self.assertEqual(counts("--threads", 1), counts("--seed", 1))
        self.assertNotEqual(counts(), counts("--seed", 2))

    def test_bad_input_and_usage(self):
        self.assertIn("is 'none'; expected one of scale,",
                      self.bad_usage("stress", "--family", "scale,none"))
        self.bad_usage("stress", "--method", "magic")
        self.bad_usage("stress", "--queries", 0)
        for seed in -1, 2**64, "1e3":
            self.assertIn("expected an integer", self.bad_usage("stress", "--seed", seed))
        self.bad_usage("stress", "--threads", -1)
        self.bad_usage("stress", "--out", self.directory / "o", "--json",
                       self.directory / "o" / "stress.csv")
        self.assertEqual(os.listdir(self.directory), [])
        file = self.write("file", "old")
        self.bad_input("file: cannot be made", "stress", "--out", file)
        self.assertEqual(pathlib.Path(file).read_text(), "old")


class Validate(ProgramTest):
    def setUp(self):
        super().setUp()
        if "validate" not in self.good("--help"):
            self.skipTest("built without MPFR")

    def test_tables_and_json(self):
        file, out = self.write("vf.csv", HIT), self.directory / "out.json"
        text = self.good("validate", file, "--rules", "tight,safe", "--json", out)
        self.assertTrue(text.endswith("\nno violations\n"), text)
        found = json.loads(out.read_text())
        self.assertEqual([(c["part"], c["rule"], c["cases"]) for c in found["counts"]],
                         [(file, "tight", 1), (file, "safe", 1)])
        quantities = {t["quantity"] for t in found["tightness"]}
        self.assertLessEqual({"k0", "3 k1", "3 k2", "k3", "Y'(0)", "Y''(1)", "G"}, quantities)

    def test_bad_input_and_usage(self):
        self.bad_input("vf.csv:1", "validate", self.write("vf.csv", "1,x\n"))
        file = self.write("vf.csv", HIT)
        self.bad_usage("validate")
        self.bad_usage("validate", "-", "-")
        self.bad_usage("validate", file, "--json", file)
        self.assertIn("--rules is 'loose'", self.bad_usage("validate", file, "--rules", "loose"))
        self.assertEqual(pathlib.Path(file).read_text(), HIT)


class Methods(ProgramTest):
    def test_methods(self):
        text = self.good("methods")
        for name in ("float", "safe", "tight", "sharp", "interval", "residual", "bsc-exact",
                     "provot", "root-parity", "exact"):
            self.assertRegex(text, rf"(?m)^{name} ")
        self.bad_usage("methods", "more")

    def test_help(self):
        self.assertIn("query", self.good("--help"))
        for command in ("query", "step", "stress", "methods"):
            self.good(command, "--help")


if __name__ == "__main__":
    unittest.main()
