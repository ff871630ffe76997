#!/usr/bin/env python3
"""Makes the bundled scene: one step of a cloth that falls over a ball and onto itself.

Writes frame0.ply and frame1.ply (binary little-endian, double coordinates, the same faces in both)
into a folder, by default scenes/cloth-over-ball next to this file:

    python3 examples/make_scene.py [FOLDER]

The folded cloth is simulated with position-based dynamics (Mueller et al. 2007) until its flap lands.
The last step is long and has no collision response, so that the cloth passes through the ball and
itself: collision detection must find these contacts. Rigidly moving plates next to the ball are in
contact, or within rounding of it: a hard case for methods that only bound their rounding error.

Uses only the standard library, and + - * / and sqrt, which IEEE 754 rounds correctly: all machines
write equal files.
"""

import math
import struct
import sys
from pathlib import Path

CLOTH_POINTS = 40  # along each side
SPACING = 0.06
BALL_RADIUS = 0.5
BALL_SUBDIVISIONS = 3
BALL_MARGIN = 0.025  # more than the sag of the flat faces below the sphere
SELF_DISTANCE = 0.05  # less than SPACING, so that neighbours do not push each other apart
GRAVITY = 9.81
TIME_STEP = 1 / 120
STEPS = 54
ITERATIONS = 12
LAST_TIME_STEP = 1 / 40
# The whole scene drifts in the last step, so that nothing is exactly at rest.
DRIFT = (0.03, 0.02, 0.0)


def make_ball():
    golden = (1 + math.sqrt(5)) / 2
    points = []
    for a, b in ((1, golden), (-1, golden), (1, -golden), (-1, -golden)):
        points += [(0.0, a, b), (a, b, 0.0), (b, 0.0, a)]
    # The points of a face of the icosahedron have pairwise distance 2.
    def near(i, j):
        return abs(sum((x - y) ** 2 for x, y in zip(points[i], points[j])) - 4) < 1e-9

    faces = []
    for i in range(12):
        for j in range(i + 1, 12):
            for k in range(j + 1, 12):
                if near(i, j) and near(j, k) and near(i, k):
                    p, q, r = points[i], points[j], points[k]
                    outward = (
                        p[0] * (q[1] * r[2] - q[2] * r[1])
                        + p[1] * (q[2] * r[0] - q[0] * r[2])
                        + p[2] * (q[0] * r[1] - q[1] * r[0])
                    )
                    faces.append((i, j, k) if outward > 0 else (i, k, j))

    for _ in range(BALL_SUBDIVISIONS):
        middle = {}

        def midpoint(i, j):
            key = (min(i, j), max(i, j))
            if key not in middle:
                middle[key] = len(points)
                p, q = points[i], points[j]
                points.append(((p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2))
            return middle[key]

        finer = []
        for i, j, k in faces:
            a, b, c = midpoint(i, j), midpoint(j, k), midpoint(k, i)
            finer += [(i, a, c), (a, j, b), (c, b, k), (a, b, c)]
        faces = finer
        points = [normalized(p) for p in points]
    return [
        (BALL_RADIUS * x, BALL_RADIUS * y, BALL_RADIUS + BALL_RADIUS * z) for x, y, z in points
    ], faces


def normalized(p):
    length = math.sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2])
    return (p[0] / length, p[1] / length, p[2] / length)


def make_cloth():
    n = CLOTH_POINTS
    flat = 24  # columns before the fold
    fold_columns = 6  # columns that make the half turn
    fold_radius_height = 0.26
    points = []
    for i in range(n):
        if i < flat:
            x, z = (i - 13) * SPACING, 0.0
        elif i < flat + fold_columns:
            # A half turn as a parabola: out and back while it climbs.
            u = (i - flat + 1) / (fold_columns + 1)
            x = (flat - 1 - 13) * SPACING + 0.6 * u * (1 - u)
            z = fold_radius_height * u
        else:
            x = (flat - 1 - 13 - (i - flat - fold_columns)) * SPACING
            z = fold_radius_height
        for j in range(n):
            y = (j - (n - 1) / 2) * SPACING
            # A slight twist and ripple, so that the folds do not come out symmetric.
            ripple = 0.01 * ((i * 7 + j * 3) % 5 - 2) / 2
            points.append([x + 0.04 * y, y - 0.07 * x, 1.12 + z + 0.05 * x * y + ripple])
    faces = []
    for i in range(n - 1):
        for j in range(n - 1):
            a, b, c, d = i * n + j, (i + 1) * n + j, (i + 1) * n + j + 1, i * n + j + 1
            # Alternating diagonals: the cloth has no preferred direction.
            faces += [(a, b, c), (a, c, d)] if (i + j) % 2 == 0 else [(a, b, d), (b, c, d)]
    return points, faces


def cloth_constraints():
    """Returns (i, j, rest length, stiffness): stretch and shear at full stiffness, bending much softer."""
    n = CLOTH_POINTS
    diagonal = SPACING * math.sqrt(2)
    constraints = []
    for i in range(n):
        for j in range(n):
            for di, dj, rest, stiffness in (
                (1, 0, SPACING, 1.0),
                (0, 1, SPACING, 1.0),
                (1, 1, diagonal, 0.5),
                (1, -1, diagonal, 0.5),
                (2, 0, 2 * SPACING, 0.02),
                (0, 2, 2 * SPACING, 0.02),
            ):
                if i + di < n and 0 <= j + dj < n:
                    constraints.append((i * n + j, (i + di) * n + j + dj, rest, stiffness))
    return constraints


def project_constraints(points, constraints):
    for i, j, rest, stiffness in constraints:
        p, q = points[i], points[j]
        dx, dy, dz = q[0] - p[0], q[1] - p[1], q[2] - p[2]
        length = math.sqrt(dx * dx + dy * dy + dz * dz)
        if length == 0:
            continue
        s = 0.5 * stiffness * (length - rest) / length
        p[0] += s * dx
        p[1] += s * dy
        p[2] += s * dz
        q[0] -= s * dx
        q[1] -= s * dy
        q[2] -= s * dz


def push_out_of_ball_and_floor(points, previous):
    reach = BALL_RADIUS + BALL_MARGIN
    for p, before in zip(points, previous):
        x, y, z = p[0], p[1], p[2] - BALL_RADIUS
        square = x * x + y * y + z * z
        touching = False
        if square < reach * reach:
            s = reach / math.sqrt(square)
            p[0], p[1], p[2] = s * x, s * y, BALL_RADIUS + s * z
            touching = True
        if p[2] < BALL_MARGIN:
            p[2] = BALL_MARGIN
            touching = True
        if touching:  # friction removes part of the motion of this step
            for axis in range(3):
                p[axis] += 0.1 * (before[axis] - p[axis])


def push_layers_apart(points):
    """Keeps points of different layers SELF_DISTANCE apart, as small balls on a grid."""
    cells = {}
    for i, p in enumerate(points):
        key = tuple(math.floor(c / SELF_DISTANCE) for c in p)
        cells.setdefault(key, []).append(i)
    around = [(a, b, c) for a in (-1, 0, 1) for b in (-1, 0, 1) for c in (-1, 0, 1)]
    for (cx, cy, cz), members in cells.items():
        for a, b, c in around:
            for j in cells.get((cx + a, cy + b, cz + c), ()):
                for i in members:
                    if i >= j:
                        continue
                    p, q = points[i], points[j]
                    dx, dy, dz = q[0] - p[0], q[1] - p[1], q[2] - p[2]
                    square = dx * dx + dy * dy + dz * dz
                    if 0 < square < SELF_DISTANCE * SELF_DISTANCE:
                        s = 0.5 * (SELF_DISTANCE / math.sqrt(square) - 1)
                        p[0] -= s * dx
                        p[1] -= s * dy
                        p[2] -= s * dz
                        q[0] += s * dx
                        q[1] += s * dy
                        q[2] += s * dz


def simulate_cloth(points):
    constraints = cloth_constraints()
    velocity = [[0.0, 0.0, -1.0] for _ in points]
    for _ in range(STEPS):
        previous = [list(p) for p in points]
        for p, v in zip(points, velocity):
            v[2] -= GRAVITY * TIME_STEP
            for axis in range(3):
                p[axis] += TIME_STEP * v[axis]
        for _ in range(ITERATIONS):
            project_constraints(points, constraints)
        push_layers_apart(points)
        push_out_of_ball_and_floor(points, previous)
        for p, before, v in zip(points, previous, velocity):
            for axis in range(3):
                v[axis] = 0.995 * (p[axis] - before[axis]) / TIME_STEP
    after = [
        [
            p[0] + LAST_TIME_STEP * v[0],
            p[1] + LAST_TIME_STEP * v[1],
            p[2] + LAST_TIME_STEP * (v[2] - GRAVITY * LAST_TIME_STEP),
        ]
        for p, v in zip(points, velocity)
    ]
    return points, after


def make_plates():
    """Returns layers of separate square plates in tilted planes, each slightly above the last.

    Every plate moves by the same drift, so nothing comes nearer to anything. But the plates of a
    layer are coplanar up to rounding, and layers are a few ulps to a micrometre apart: whether two
    touch is beyond the reach of floating-point arithmetic with an error bound, while exact
    arithmetic decides it. The last two layers are level and, at multiples of 1/64, touch exactly.
    """
    points, faces = [], []

    def plate(corner, u, v):
        first = len(points)
        for s, t in ((0, 0), (1, 0), (1, 1), (0, 1)):
            points.append(tuple(c + s * a + t * b for c, a, b in zip(corner, u, v)))
        faces.extend([(first, first + 1, first + 2), (first, first + 2, first + 3)])

    size, pitch = 0.11, 0.12
    height = 0.0
    for layer, gap in enumerate((0.0, 4e-16, 1e-12, 1e-6)):
        height += gap
        for i in range(3):
            for j in range(3):
                # The plane is tilted by the angle with cosine 0.8 and sine 0.6; each layer is
                # shifted within it, so that corners lie over faces and edges cross.
                along, across = pitch * i + 0.03 * layer, pitch * j + 0.02 * layer
                corner = (
                    1.35 + 0.8 * along - 0.6 * height,
                    -0.75 + across,
                    0.05 + 0.6 * along + 0.8 * height,
                )
                plate(corner, (0.8 * size, 0.0, 0.6 * size), (0.0, size, 0.0))
    for layer in range(2):
        for i in range(2):
            shift = layer * 3 / 64
            plate((1.375 + shift + i / 8, 0.25 + shift, 0.0625), (7 / 64, 0, 0), (0, 7 / 64, 0))
    return points, faces


def write_ply(path, points, faces):
    header = (
        "ply\nformat binary_little_endian 1.0\n"
        "comment a cloth falling over a ball and onto itself, made by examples/make_scene.py\n"
        f"element vertex {len(points)}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"element face {len(faces)}\n"
        "property list uchar int vertex_indices\nend_header\n"
    )
    body = b"".join(struct.pack("<3d", *p) for p in points)
    body += b"".join(struct.pack("<B3i", 3, *f) for f in faces)
    path.write_bytes(header.encode("ascii") + body)


def main():
    default = Path(__file__).resolve().parent / "scenes" / "cloth-over-ball"
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else default
    ball, ball_faces = make_ball()
    cloth, cloth_faces = make_cloth()
    plates, plate_faces = make_plates()
    cloth_before, cloth_after = simulate_cloth(cloth)

    faces = list(ball_faces)
    faces += [tuple(len(ball) + k for k in f) for f in cloth_faces]
    faces += [tuple(len(ball) + len(cloth) + k for k in f) for f in plate_faces]
    before = ball + cloth_before + plates
    after = [tuple(c + d for c, d in zip(p, DRIFT)) for p in ball + cloth_after + plates]

    folder.mkdir(parents=True, exist_ok=True)
    write_ply(folder / "frame0.ply", before, faces)
    write_ply(folder / "frame1.ply", after, faces)
    print(f"{folder}: {len(before)} vertices, {len(faces)} faces")


if __name__ == "__main__":
    main()
