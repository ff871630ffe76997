#!/usr/bin/env python3
"""Draws the colliding pairs of one step on the mesh, as a PNG. Requires matplotlib.

    python3 examples/demo/draw_pairs.py FRAME0.ply FRAME1.ply PAIRS.csv OUT.png

PAIRS.csv is written by `ccd step --pairs`: lines `vf,v,f0,f1,f2` and `ee,a0,a1,b0,b1`. The picture shows
the mesh at the end of the step, whole and enlarged where contacts are densest. A mark at the middle
of each pair's points is visible through the mesh.
"""

import struct
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # writes files; needs no display
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle

VIEW_DIRECTION = np.array([-0.55, -1.0, 0.62])  # from the scene to the eye; z is up
LIGHT_DIRECTION = np.array([-0.8, -0.5, 1.2])
VERTEX_FACE_COLOUR = "#d7301f"
EDGE_EDGE_COLOUR = "#0050d0"
PART_COLOURS = ((0.93, 0.87, 0.72), (0.55, 0.68, 0.84), (0.72, 0.82, 0.68))
ZOOM_RADIUS = 0.14  # half the side of the enlarged square, as a fraction of the scene's width

PLY_TYPES = {
    "char": "b", "int8": "b", "uchar": "B", "uint8": "B",
    "short": "h", "int16": "h", "ushort": "H", "uint16": "H",
    "int": "i", "int32": "i", "uint": "I", "uint32": "I",
    "float": "f", "float32": "f", "double": "d", "float64": "d",
}  # fmt: skip


class BadInput(Exception):
    """An error with a message for the user."""


def ply_header(path, lines):
    """Returns (byte order, "" for ascii; [(element, count, [(property, type or (count type, item type))])])."""
    order = None
    elements = []
    for line in lines:
        words = line.split()
        if not words or words[0] in ("comment", "obj_info"):
            continue
        if words[0] == "format":
            order = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}[words[1]]
        elif words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[0] == "property" and words[1] == "list":
            elements[-1][2].append((words[4], (PLY_TYPES[words[2]], PLY_TYPES[words[3]])))
        elif words[0] == "property":
            elements[-1][2].append((words[2], PLY_TYPES[words[1]]))
        else:
            raise BadInput(f"{path}: header line not understood: {line.strip()}")
    return order, elements


def ply_values(order, body):
    """Returns a function that reads the body's next value of a given type."""
    if order == "":
        words = iter(body.split())
        return lambda kind: (float if kind in "fd" else int)(next(words))
    position = 0

    def read(kind):
        nonlocal position
        (value,) = struct.unpack_from(order + kind, body, position)
        position += struct.calcsize(order + kind)
        return value

    return read


def read_ply(path):
    data = Path(path).read_bytes()
    head, marker, body = data.partition(b"end_header")
    lines = head.decode("ascii", "replace").split("\n")
    if lines[0].strip() != "ply" or not marker:
        raise BadInput(f"{path}: not a PLY file")
    order, elements = ply_header(path, lines[1:])
    read = ply_values(order, body[body.index(b"\n") + 1 :])

    vertices, faces = [], []
    for name, count, properties in elements:
        for _ in range(count):
            row = {}
            for key, kind in properties:
                if isinstance(kind, tuple):
                    row[key] = [read(kind[1]) for _ in range(read(kind[0]))]
                else:
                    row[key] = read(kind)
            if name == "vertex":
                vertices.append((row["x"], row["y"], row["z"]))
            elif name == "face":
                faces.append(row.get("vertex_indices") or row["vertex_index"])
    return np.array(vertices), faces


def read_pairs(path):
    pairs = {"vf": [], "ee": []}
    for number, line in enumerate(Path(path).read_text().splitlines(), 1):
        kind, *indices = line.split(",")
        if kind not in pairs or len(indices) != 4:
            raise BadInput(f"{path}, line {number} is '{line}'; expected vf or ee and 4 indices")
        pairs[kind].append([int(i) for i in indices])
    return pairs["vf"], pairs["ee"]


def parts(vertex_count, faces):
    """Returns the connected component of each vertex; 0 is the largest one."""
    parent = list(range(vertex_count))

    def root(i):
        while parent[i] != i:
            parent[i] = parent[parent[i]]
            i = parent[i]
        return i

    for face in faces:
        for i in face[1:]:
            parent[root(i)] = root(face[0])
    roots = [root(i) for i in range(vertex_count)]
    sizes = np.bincount(roots, minlength=vertex_count)
    rank = {r: k for k, r in enumerate(sorted(set(roots), key=lambda r: -sizes[r]))}
    return [rank[r] for r in roots]


def unit(v):
    return v / np.linalg.norm(v)


class Picture:
    """Projects the mesh along VIEW_DIRECTION, with shaded faces sorted from back to front."""

    def __init__(self, vertices, faces):
        eye = unit(VIEW_DIRECTION)
        right = unit(np.cross([0.0, 0.0, 1.0], eye))
        up = np.cross(eye, right)
        self.plane = vertices @ np.column_stack([right, up])
        depth = vertices @ eye
        self.faces = sorted(faces, key=lambda f: depth[f].mean())
        part = parts(len(vertices), faces)
        light = unit(LIGHT_DIRECTION)
        self.colours = []
        for f in self.faces:
            normal = np.cross(vertices[f[1]] - vertices[f[0]], vertices[f[2]] - vertices[f[0]])
            length = np.linalg.norm(normal)
            normal = normal / length if length > 0 else eye
            if normal @ eye < 0:  # both sides of cloth are visible
                normal = -normal
            shade = 0.55 + 0.45 * max(0.0, normal @ light)
            base = PART_COLOURS[min(part[f[0]], len(PART_COLOURS) - 1)]
            self.colours.append([shade * c for c in base])

    def draw(self, axes, vf, ee, large):
        axes.add_collection(
            PolyCollection(
                [self.plane[f] for f in self.faces],
                facecolors=self.colours,
                edgecolors=(0.25, 0.25, 0.25, 0.55),
                linewidths=0.5 if large else 0.2,
            )
        )
        if large:  # features are large enough to draw
            axes.add_collection(
                PolyCollection(
                    [self.plane[p[1:]] for p in vf],
                    facecolors="none",
                    edgecolors=VERTEX_FACE_COLOUR,
                    linewidths=1.2,
                    zorder=3,
                )
            )
            edges = [self.plane[e] for p in ee for e in (p[:2], p[2:])]
            axes.add_collection(
                LineCollection(edges, colors=EDGE_EDGE_COLOUR, linewidths=1.2, zorder=3)
            )
        size = 34 if large else 12
        for pairs, colour, marker, order in (
            (ee, EDGE_EDGE_COLOUR, "s", 4),
            (vf, VERTEX_FACE_COLOUR, "o", 5),
        ):
            if pairs:
                at = self.middles(pairs)
                axes.scatter(at[:, 0], at[:, 1], s=size, c=colour, marker=marker,
                             edgecolors="white", linewidths=0.5, zorder=order)  # fmt: skip
        axes.set_aspect("equal")
        axes.set_xticks([])
        axes.set_yticks([])

    def middles(self, pairs):
        return np.array([self.plane[p].mean(axis=0) for p in pairs])


def densest(middles, radius):
    """Returns the mark with the most marks in the square of this half side around it."""
    near = [(np.abs(middles - m).max(axis=1) < radius).sum() for m in middles]
    return middles[int(np.argmax(near))]


def draw(frame0, frame1, pairs_path, out):
    before, faces = read_ply(frame0)
    after, faces1 = read_ply(frame1)
    if faces != faces1 or before.shape != after.shape:
        raise BadInput(f"{frame1}: not the same mesh as {frame0}")
    vf, ee = read_pairs(pairs_path)
    if max((i for p in vf + ee for i in p), default=0) >= len(after):
        raise BadInput(f"{pairs_path}: a vertex index is not in the mesh ({len(after)} vertices)")

    picture = Picture(after, faces)
    figure, (whole, near) = plt.subplots(
        1, 2, figsize=(15, 7.4), gridspec_kw={"width_ratios": [1.25, 1]}
    )
    picture.draw(whole, vf, ee, large=False)
    whole.autoscale_view()
    whole.set_title("the whole mesh at the end of the step", fontsize=11)
    picture.draw(near, vf, ee, large=True)
    if vf or ee:
        radius = ZOOM_RADIUS * np.ptp(picture.plane[:, 0])
        x, y = densest(picture.middles(vf + ee), radius)
        near.set_xlim(x - radius, x + radius)
        near.set_ylim(y - radius, y + radius)
        whole.add_patch(
            Rectangle((x - radius, y - radius), 2 * radius, 2 * radius, fill=False,
                      edgecolor="black", linewidth=1.2, zorder=6)
        )  # fmt: skip
        near.set_title("where contacts are densest (the square on the left)", fontsize=11)
    else:
        near.autoscale_view()

    travelled = np.linalg.norm(after - before, axis=1).max()
    figure.suptitle(
        f"{len(vf)} vertex/face and {len(ee)} edge/edge pairs collide within the step\n"
        f"{len(after)} vertices, {len(faces)} faces; the fastest vertex travels {travelled:.3g}",
        fontsize=13,
    )
    figure.legend(
        handles=[
            Line2D([], [], color=VERTEX_FACE_COLOUR, marker="o", markeredgecolor="white",
                   label=f"vertex/face ({len(vf)}): the face and the middle of the pair"),
            Line2D([], [], color=EDGE_EDGE_COLOUR, marker="s", markeredgecolor="white",
                   label=f"edge/edge ({len(ee)}): both edges and the middle of the pair"),
        ],
        loc="lower center", ncol=2, frameon=False, fontsize=11,
    )  # fmt: skip
    figure.subplots_adjust(left=0.02, right=0.98, top=0.86, bottom=0.08, wspace=0.05)
    figure.savefig(out, dpi=110)


def main():
    if len(sys.argv) != 5:
        print("usage: draw_pairs.py FRAME0.ply FRAME1.ply PAIRS.csv OUT.png", file=sys.stderr)
        return 2
    try:
        draw(*sys.argv[1:])
    except (BadInput, OSError, KeyError, ValueError, StopIteration, struct.error) as error:
        print(f"draw_pairs.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
