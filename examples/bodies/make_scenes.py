"""Writes scenes of bodies for `ccd bodies`: gears, a falling stack of boxes, a needle through a rotating ring.

Makes FOLDER/NAME/scene.json and its meshes, OBJ, for each NAME: gears, boxes, needle.
"""
import argparse
import json
import math
import pathlib


def prism(outline, height):
    """A closed mesh: the outline, star-shaped about 0 and counterclockwise in x, y, from z = 0 up to `height`."""
    n = len(outline)
    vertices = [(x, y, z) for z in (0, height) for x, y in outline] + [(0, 0, 0), (0, 0, height)]
    faces = []
    for i in range(n):
        j = (i + 1) % n
        faces += [(i, j, n + j), (i, n + j, n + i), (j, i, 2 * n), (n + i, n + j, 2 * n + 1)]
    return vertices, faces


def gear(teeth, pitch, tooth):
    """Trapezoid teeth of height 2 `tooth` about the pitch circle. A tooth is in the direction x."""
    outline = []
    for i in range(teeth):
        for part, radius in ((-.27, -1.1), (-.13, 1), (.13, 1), (.27, -1.1)):
            angle = 2 * math.pi * (i + part) / teeth
            outline.append(((pitch + radius * tooth) * math.cos(angle), (pitch + radius * tooth) * math.sin(angle)))
    return prism(outline, 1)


def box(x, y, z):
    corners = [(a * x, b * y, c * z) for c in (-.5, .5) for b in (-.5, .5) for a in (-.5, .5)]
    sides = (0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)
    return corners, [f for a, b, c, d in sides for f in ((a, b, c), (a, c, d))]


def ring(radius, tube, around, across):
    """A torus about the axis x."""
    vertices, faces = [], []
    for i in range(around):
        a = 2 * math.pi * i / around
        for j in range(across):
            b = 2 * math.pi * j / across
            r = radius + tube * math.cos(b)
            vertices.append((tube * math.sin(b), r * math.cos(a), r * math.sin(a)))
            k, across_next = (i + 1) % around * across, (j + 1) % across
            faces += [(i * across + j, k + j, k + across_next), (i * across + j, k + across_next, i * across + across_next)]
    return vertices, faces


def turned(angle, axis):
    """The quaternion w, x, y, z of a turn about a unit vector."""
    return [math.cos(angle / 2), *(math.sin(angle / 2) * c for c in axis)]


def gears():
    """Two gears turn by a tooth of the large one, in 20 steps. The small one turns 4 degrees too far, and jams."""
    frames, large, small = 21, 24, 12
    angles = [2 * math.pi / large * i / (frames - 1) for i in range(frames)]
    wrong = [math.radians(4) * i / (frames - 1) for i in range(frames)]
    z = (0, 0, 1)
    return {"large": gear(large, 6, .45), "small": gear(small, 3, .45), "base": box(20, 14, 1)}, {
        "skip": [["large", "base"], ["small", "base"]],
        "bodies": [
            {"name": "large", "mesh": "large.obj", "poses": [[0, 0, 0, *turned(a, z)] for a in angles]},
            {"name": "small", "mesh": "small.obj",
             "poses": [[9.1, 0, 0, *turned(math.pi + math.pi / small - 2 * a - e, z)] for a, e in zip(angles, wrong)]},
            {"name": "base", "mesh": "base.obj", "poses": [[4, 0, -.75, 1, 0, 0, 0]]}]}


def boxes():
    """Five boxes fall on a table. Each tumbles a little, and lands in the last steps."""
    frames, fall = 13, 2.5
    bodies = [{"name": "table", "mesh": "table.obj"}]
    for i in range(5):
        poses = []
        for k in range(frames):
            t = k / (frames - 1)
            poses.append([.1 * i, 0, .75 + 1.125 * i - fall * t * t + 2, *turned(.3 * (i - 2) * t, (.6, .8, 0))])
        bodies.append({"name": f"box {i}", "mesh": "box.obj", "poses": poses})
    return {"table": box(6, 6, .5), "box": box(1, 1, 1)}, {"times": [.25 * k for k in range(frames)], "bodies": bodies}


def needle():
    """A needle moves along x through a ring that makes half a turn about z, in 8 steps. It misses the tube by less than 0.02."""
    frames = 9
    at = [k / (frames - 1) for k in range(frames)]
    return {"needle": box(3, .04, .04), "ring": ring(1, .25, 48, 24)}, {"bodies": [
        {"name": "needle", "mesh": "needle.obj", "poses": [[6 * t - 3, .1, .69, 1, 0, 0, 0] for t in at]},
        {"name": "ring", "mesh": "ring.obj", "poses": [[0, 0, 0, *turned(math.pi * (t - .5), (0, 0, 1))] for t in at]}]}


def main():
    line = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    line.add_argument("folder", type=pathlib.Path)
    folder_of_all = line.parse_args().folder
    for make in gears, boxes, needle:
        folder = folder_of_all / make.__name__
        folder.mkdir(parents=True, exist_ok=True)
        meshes, scene = make()
        for name, (vertices, faces) in meshes.items():
            lines = [f"v {x!r} {y!r} {z!r}\n" for x, y, z in vertices]
            lines += [f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in faces]
            (folder / f"{name}.obj").write_text("".join(lines))
        (folder / "scene.json").write_text(json.dumps(scene) + "\n")


if __name__ == "__main__":
    main()
