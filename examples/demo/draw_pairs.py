#!/usr/bin/env python3
"""Draws the colliding pairs of one step on the mesh, as a PNG. Requires matplotlib.

    python3 examples/demo/draw_pairs.py FRAME0.ply FRAME1.ply PAIRS.csv OUT.png

PAIRS.csv is written by `ccd step --pairs`: lines `vf,v,f0,f1,f2` and `ee,a0,a1,b0,b1`. The picture shows
the mesh at the end of the step, whole and enlarged where contacts are densest. A mark at the middle
of each pair's points is visible through the mesh.
"""
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # writes files; needs no display
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from meshes import bodies_of, read_ply  # noqa: E402

VIEW_DIRECTION = np.array([-0.55, -1.0, 0.62])  # from the scene to the eye; z is up
LIGHT_DIRECTION = np.array([-0.8, -0.5, 1.2])
COLOURS = {"vf": "#d7301f", "ee": "#0050d0"}
PART_COLOURS = np.array([(0.93, 0.87, 0.72), (0.55, 0.68, 0.84), (0.72, 0.82, 0.68)])
ZOOM_RADIUS = 0.14  # half the side of the enlarged square, as a fraction of the scene's width


def read_pairs(path):
    pairs = {"vf": [], "ee": []}
    for line in Path(path).read_text().splitlines():
        kind, *indices = line.split(",")
        pairs[kind].append([int(i) for i in indices])
    return pairs


def unit(v):
    return v / np.linalg.norm(v)


class Picture:
    """Projects the mesh along VIEW_DIRECTION, with shaded faces sorted from back to front."""

    def __init__(self, vertices, faces, pairs):
        eye, light = unit(VIEW_DIRECTION), unit(LIGHT_DIRECTION)
        right = unit(np.cross([0.0, 0.0, 1.0], eye))
        self.plane = vertices @ np.column_stack([right, np.cross(eye, right)])
        self.faces = faces[np.argsort((vertices @ eye)[faces].mean(axis=1), kind="stable")]
        self.pairs = {kind: self.plane[listed] for kind, listed in pairs.items() if listed}
        a, b, c = (vertices[self.faces[:, i]] for i in range(3))
        normal = np.cross(b - a, c - a)
        normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
        normal *= np.where(normal @ eye < 0, -1, 1)[:, None]  # both sides of cloth are visible
        part = bodies_of(faces, len(vertices))
        rank = np.argsort(np.argsort(-np.bincount(part), kind="stable"))  # 0: the largest part
        base = PART_COLOURS[np.minimum(rank[part[self.faces[:, 0]]], len(PART_COLOURS) - 1)]
        self.colours = base * (0.55 + 0.45 * np.maximum(0, normal @ light))[:, None]

    def draw(self, axes, large):
        axes.add_collection(PolyCollection(self.plane[self.faces], facecolors=self.colours,
                                           edgecolors=(0.25, 0.25, 0.25, 0.55), linewidths=0.5 if large else 0.2))
        if large and "vf" in self.pairs:  # features are large enough to draw
            axes.add_collection(PolyCollection(self.pairs["vf"][:, 1:], facecolors="none", edgecolors=COLOURS["vf"],
                                               linewidths=1.2, zorder=3))
        if large and "ee" in self.pairs:
            axes.add_collection(LineCollection(self.pairs["ee"].reshape(-1, 2, 2), colors=COLOURS["ee"], linewidths=1.2,
                                               zorder=3))
        for kind, marker, order in ("ee", "s", 4), ("vf", "o", 5):
            if kind in self.pairs:
                axes.scatter(*self.pairs[kind].mean(axis=1).T, s=34 if large else 12, c=COLOURS[kind], marker=marker,
                             edgecolors="white", linewidths=0.5, zorder=order)
        axes.set_aspect("equal")
        axes.set_xticks([])
        axes.set_yticks([])

    def densest(self, radius):
        """Returns the mark with the most marks in the square of this half side around it."""
        marks = np.concatenate([pairs.mean(axis=1) for pairs in self.pairs.values()])
        near = [(np.abs(marks - mark).max(axis=1) < radius).sum() for mark in marks]
        return marks[np.argmax(near)]


def main(frame0, frame1, pairs_path, out):
    before, (after, faces, _) = read_ply(frame0)[0], read_ply(frame1)
    pairs = read_pairs(pairs_path)
    vf, ee = len(pairs["vf"]), len(pairs["ee"])
    picture = Picture(after, faces, pairs)
    figure, (whole, near) = plt.subplots(1, 2, figsize=(15, 7.4), gridspec_kw={"width_ratios": [1.25, 1]})
    picture.draw(whole, large=False)
    whole.autoscale_view()
    whole.set_title("the whole mesh at the end of the step", fontsize=11)
    picture.draw(near, large=True)
    if picture.pairs:
        radius = ZOOM_RADIUS * np.ptp(picture.plane[:, 0])
        x, y = picture.densest(radius)
        near.set_xlim(x - radius, x + radius)
        near.set_ylim(y - radius, y + radius)
        whole.add_patch(Rectangle((x - radius, y - radius), 2 * radius, 2 * radius, fill=False, edgecolor="black",
                                  linewidth=1.2, zorder=6))
        near.set_title("where contacts are densest (the square on the left)", fontsize=11)
    else:
        near.autoscale_view()

    travelled = np.linalg.norm(after - before, axis=1).max()
    figure.suptitle(f"{vf} vertex/face and {ee} edge/edge pairs collide within the step\n"
                    f"{len(after)} vertices, {len(faces)} faces; the fastest vertex travels {travelled:.3g}", fontsize=13)
    figure.legend(
        handles=[Line2D([], [], color=COLOURS["vf"], marker="o", markeredgecolor="white",
                        label=f"vertex/face ({vf}): the face and the middle of the pair"),
                 Line2D([], [], color=COLOURS["ee"], marker="s", markeredgecolor="white",
                        label=f"edge/edge ({ee}): both edges and the middle of the pair")],
        loc="lower center", ncol=2, frameon=False, fontsize=11)
    figure.subplots_adjust(left=0.02, right=0.98, top=0.86, bottom=0.08, wspace=0.05)
    figure.savefig(out, dpi=110)


if __name__ == "__main__":
    if len(sys.argv) != 5:
        sys.exit("usage: draw_pairs.py FRAME0.ply FRAME1.ply PAIRS.csv OUT.png")
    main(*sys.argv[1:])
