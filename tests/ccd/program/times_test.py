# Times, distances and free steps of the program `ccd`.
import json
import unittest

from program_test import BASE, BEFORE, FACES, HIT, MISS, ProgramTest, ply, with_truth

TOUCHING = HIT.replace("1,4,1,4,1,1", "1,4,1,4,0,1")


class QueryTimes(ProgramTest):
    def times(self, *options):
        file = self.write("vf.csv", HIT + MISS + TOUCHING)
        times, verdicts = self.directory / "times", self.directory / "verdicts"
        self.good("query", file, *options, "--toi", times, "--verdicts", verdicts)
        lines = times.read_text().splitlines()
        self.assertEqual(verdicts.read_text().split(), [str(int(line != "-")) for line in lines])
        return lines

    def test_times(self):
        self.assertEqual(self.times(), ["0x1p-1,0x1p-1", "-", "0x0p+0,0x0p+0"])
        self.assertEqual(self.times("--method", "exact", "--t-max", 1), self.times())

    def test_until_a_time(self):
        self.assertEqual(self.times("--t-max", 0.5), ["0x1p-1,0x1p-1", "-", "0x0p+0,0x0p+0"])
        self.assertEqual(self.times("--t-max", "0x1.fp-2"), ["-", "-", "0x0p+0,0x0p+0"])

    def test_distances(self):
        self.assertEqual(self.times("--separation", 0.5),
                         ["0x1p-2,0x1p-2", "0x1p+0,0x1p+0", "0x0p+0,0x0p+0"])
        self.assertEqual(self.times("--separation", 0.5, "--t-max", 0.75),
                         ["0x1p-2,0x1p-2", "-", "0x0p+0,0x0p+0"])
        self.assertEqual(self.times("--separation", 0), self.times())

    def test_brackets_are_two_neighbouring_doubles(self):
        file = self.write("vf.csv", HIT.replace("1,4,1,4,-1,1", "1,4,1,4,-2,1"))
        times = self.directory / "times"
        self.good("query", "--toi", times, file)
        self.assertEqual(times.read_text(), "0x1.5555555555555p-2,0x1.5555555555556p-2\n")

    def test_truth_of_contact_is_not_that_of_distances(self):
        file = self.write("vf.csv", with_truth(HIT, 1) + with_truth(MISS, 0))
        for option, expected in ([], ["0", "0"]), (["--separation", 1], ["-", "-"]), \
                (["--t-max", 0.1], ["-", "-"]), (["--t-max", 1], ["0", "0"]):
            text = self.good("query", file, "--method", "exact", *option)
            self.assertEqual(text.splitlines()[1].split()[5:7], expected)

    def test_bad_usage(self):
        file, out = self.write("vf.csv", HIT), self.directory / "out"
        for options, message in [
                (["--toi", out, "--method", "tight"], "--method is not exact; expected exact"),
                (["--separation", 1, "--method", "exact,tight"], "--method is not exact; expected exact"),
                (["--t-max", 1, "--method", "float"], "--method is not exact; expected exact"),
                (["--toi", out, file], "expected one FILE"),
                (["--separation", "-1"], "expected a number >= 0"),
                (["--separation", "nan"], "expected a finite number"),
                (["--separation", "0.1m"], "expected a number"),
                (["--t-max", 1.5], "expected a number from 0 to 1"),
                (["--t-max", "0x1.00000000000001p-1"], "which no double equals"),
                (["--toi", out, "--verdicts", out], "expected a separate file")]:
            with self.subTest(options=options):
                self.assertIn(message, self.bad_usage("query", file, *options))
        self.assertFalse(out.exists())


class StepTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.frames = self.triangles()

    def step(self, *arguments):
        pairs, times, out = (self.directory / name for name in ("pairs", "times", "json"))
        text = self.good("step", *arguments, "--pairs", pairs, "--toi", times, "--json", out)
        result = json.loads(out.read_text())
        title = "within at start" if "--separation" in arguments else "touching at start"
        self.assertIn(title, text)
        self.assertIn(f"\n{result['touching_at_start']:>{len(title)}}  ", text)
        return pairs.read_text().splitlines(), times.read_text().splitlines(), result


class StepTimes(StepTest):
    def test_lines_are_those_of_pairs_with_times(self):
        pairs, times, result = self.step(*self.frames)
        fields = [line.rsplit(",", 2) for line in times]
        self.assertEqual([pair for pair, _, _ in fields], pairs)
        brackets = [[float.fromhex(t) for t in both] for _, *both in fields]
        # The lowest vertex falls from 1 to -1 through the floor.
        self.assertEqual(brackets[pairs.index("vf,3,0,1,2")], [0.5, 0.5])
        self.assertEqual(result["first_contact"], min(brackets))
        self.assertEqual(result["touching_at_start"], 0)

    def test_touching_at_the_start(self):
        before = [(x, y, 0) if i == 3 else (x, y, z) for i, (x, y, z) in enumerate(BEFORE)]
        _, times, result = self.step(self.write("touching.ply", ply(before, FACES)), self.frames[1])
        self.assertIn("vf,3,0,1,2,0x0p+0,0x0p+0", times)
        self.assertEqual(result["touching_at_start"], 1)
        self.assertGreater(result["first_contact"][0], 0)

    def test_no_contact(self):
        self.assertIsNone(self.step(self.frames[0], self.frames[0])[2]["first_contact"])

    def test_json_without_times(self):
        out = self.directory / "json"
        self.good("step", *self.frames, "--json", out)
        for field in ("touching_at_start", "first_contact", "advance"):
            self.assertNotIn(field, json.loads(out.read_text()))

    def test_distances(self):
        pairs, times, _ = self.step(*self.frames, "--separation", 0.5)
        self.assertIn("vf,3,0,1,2,0x1p-2,0x1p-2", times)
        still = self.step(self.frames[0], self.frames[0], "--separation", 1)
        self.assertIn("vf,3,0,1,2", still[0])
        self.assertEqual(still[2]["touching_at_start"], len(still[0]))
        self.assertEqual(self.step(self.frames[0], self.frames[0], "--separation", 0.9)[0], [])

    def test_until_a_time(self):
        # The lowest vertex reaches the floor at t = 1/2.
        self.assertIn("vf,3,0,1,2", self.step(*self.frames, "--t-max", 0.5)[0])
        before = self.step(*self.frames, "--t-max", "0x1.fp-2")
        self.assertNotIn("vf,3,0,1,2", before[0])
        self.assertEqual([line.rsplit(",", 2)[0] for line in before[1]], before[0])
        self.assertEqual(self.step(*self.frames, "--t-max", 1)[:2], self.step(*self.frames)[:2])

    def test_bad_usage(self):
        out = self.directory / "out"
        for options, message in [
                (["--toi", out, "--method", "tight"], "--method is tight; expected exact"),
                (["--advance", "-", "--method", "tight"], "--method is tight; expected exact"),
                (["--separation", 1, "--method", "float"], "--method is float; expected exact"),
                (["--advance", out], "expected a name that ends in .ply"),
                (["--separation", 1, "--explain"], "expected contact, since"),
                (["--t-max", 2], "expected a number from 0 to 1"),
                (["--t-max", 1, "--method", "float"], "--method is float; expected exact"),
                (["--t-max", 0.5, "--advance", "-"], "expected the whole step"),
                (["--separation", "inf"], "expected a finite number"),
                (["--advance", self.frames[0]], "expected a separate file"),
                (["--advance", "-", "--toi", "-"], "expected a separate file")]:
            with self.subTest(options=options):
                self.assertIn(message, self.bad_usage("step", *self.frames, *options))
        self.assertFalse(out.exists())


class Advance(StepTest):
    def advance(self, before, after, *options):
        out, result = self.directory / "free.ply", self.directory / "free.json"
        self.good("step", before, after, "--advance", out, "--json", result, *options)
        pairs, _, again = self.step(before, out, *options)
        result = json.loads(result.read_text())
        self.assertEqual(len(pairs), again["touching_at_start"])
        self.assertLessEqual(len(pairs), result["touching_at_start"])
        first = result["first_contact"]
        self.assertGreaterEqual(result["advance"], 0.99 * (first[0] if first else 1))
        return result

    def test_falls_to_the_floor(self):
        result = self.advance(*self.frames)
        self.assertEqual(result["first_contact"], [0.5, 0.5])
        self.assertLess(result["advance"], 0.5)

    def test_all_the_way(self):
        higher = self.write("2.ply", ply(BASE + [(x, y, z - 0.5) for x, y, z in BEFORE[3:]], FACES))
        self.assertEqual(self.advance(self.frames[0], higher)["advance"], 1)

    def test_keeps_a_distance(self):
        self.assertEqual(self.advance(*self.frames, "--separation", 0.5)["first_contact"],
                         [0.25, 0.25])

    def test_what_is_near_at_the_start_keeps_a_tenth(self):
        result = self.advance(*self.frames, "--separation", 4)
        for time in result["first_contact"]:
            self.assertAlmostEqual(time, 0.45)
        self.assertGreater(result["near_at_start"], 0)
        self.assertEqual(result["near_at_start"], result["touching_at_start"])
        self.assertLess(result["advance"], 0.5)

    def test_frames_of_rods_keep_them(self):
        rods = "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 1 0 1\nl 1 2\nl 3 4\n"
        before = self.write("0.obj", rods)
        result = self.advance(before, self.write("1.obj", rods.replace("0 1\n", "0 -1\n")))
        self.assertEqual(result["first_contact"], [0.5, 0.5])


if __name__ == "__main__":
    unittest.main()
