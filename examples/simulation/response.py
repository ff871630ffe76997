"""A simulation without penetration: cloth, a rod and beads fall on a driven ball. Every step is certified free.

    python3 examples/simulation/response.py [FRAMES [FOLDER]]

Implicit springs propose positions (projective dynamics). Pairs nearer than GAP are pushed apart along their
normals. The package then moves the scene as far as is free. Writes the accepted positions and a
mesh, for `ccd audit`, and a page for a browser. Needs NumPy; SciPy makes it faster.
"""
import sys
from pathlib import Path

import numpy as np

import errbound
from errbound import ccd, io

try:
    from scipy.sparse import csc_matrix
    from scipy.sparse.linalg import factorized
except ImportError:
    factorized = None

H, GRAVITY, STIFFNESS = 1 / 60, np.array([0, 0, -9.8]), 2000.0  # s, m/s², N/m
THICKNESS = 0.004  # pairs do not come nearer, except nearer ones (ccd.AdvanceOptions, keep)
GAP = 0.008        # contacts push nearer pairs apart, to this distance


def grid(n, size, height):
    """A square sheet of n x n vertices."""
    x, y = np.meshgrid(np.linspace(-size, size, n), np.linspace(-size, size, n), indexing="ij")
    at = np.column_stack([x.ravel(), y.ravel(), np.full(n * n, height)])
    i = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    return at, np.vstack([np.column_stack([i, i + n, i + 1]), np.column_stack([i + 1, i + n, i + n + 1])])


def ball(n, radius):
    """A sphere of n rings of 2 n vertices, and two poles."""
    a, b = np.meshgrid(np.pi * np.arange(1, n + 1) / (n + 1), np.pi * np.arange(2 * n) / n, indexing="ij")
    rings = np.stack([np.sin(a) * np.cos(b), np.sin(a) * np.sin(b), np.cos(a)], axis=-1).reshape(-1, 3)
    i, j = (k.ravel() for k in np.meshgrid(np.arange(n - 1), np.arange(2 * n), indexing="ij"))
    last, top, bottom = (j + 1) % (2 * n), 2 * n * n, 2 * n * n + 1
    p, q, r, s = 2 * n * i + j, 2 * n * i + last, 2 * n * (i + 1) + j, 2 * n * (i + 1) + last
    ring, after = np.arange(2 * n), (np.arange(2 * n) + 1) % (2 * n)
    caps = [np.column_stack([np.full(2 * n, top), ring, after]),
            np.column_stack([np.full(2 * n, bottom), 2 * n * (n - 1) + after, 2 * n * (n - 1) + ring])]
    return radius * np.vstack([rings, [[0, 0, 1], [0, 0, -1]]]), np.vstack(
        [np.column_stack([p, r, q]), np.column_stack([q, r, s]), *caps])


class Scene:
    def __init__(self, cells=14):
        cloth, cloth_faces = grid(cells, 0.5, 0.35)
        sphere, sphere_faces = ball(9, 0.3)
        rod = np.column_stack([np.linspace(-0.4, 0.4, 21), np.full(21, 0.03), np.full(21, 0.5)])
        beads = np.array([[x, y, 0.42 + 0.03 * (x > 0)] for x in (-0.2, 0, 0.2) for y in (-0.15, 0.1)])
        floor = np.array([[-9, -9, -0.35], [9, -9, -0.35], [0, 9, -0.35]])
        self.x = np.vstack([cloth, rod, beads, sphere, floor])
        n, index = len(cloth), np.arange(len(self.x))
        self.driven = index >= len(self.x) - len(sphere) - 3
        self.ball = self.driven & (index < len(self.x) - 3)
        links = np.arange(20)[:, None] + [0, 1]
        self.faces = np.vstack([cloth_faces, sphere_faces + np.argmax(self.driven), index[None, -3:]])
        self.edges = links + n
        self.steps = ccd.Steps(self.faces, self.edges, vertices=len(self.x))
        # Springs along the cloth's edges, and along the rod, also between second neighbours, for its bending.
        sides = np.sort(np.vstack([cloth_faces[:, [0, 1]], cloth_faces[:, [1, 2]], cloth_faces[:, [2, 0]]]), axis=1)
        self.springs = np.vstack([np.unique(sides, axis=0), links + n, links[:-1] + [n, n + 1]])
        self.lengths = np.linalg.norm(np.diff(self.x[self.springs], axis=1)[:, 0], axis=1)
        self.mass = np.where(self.driven, np.inf, 0.001)
        self.v = np.zeros_like(self.x)
        self.solve = self.solver()
        self.saved, self.first, self.contacts = [self.x], self.x, 0

    def solver(self):
        """Returns a function that solves (M / h² + L) y = b for the free vertices, L of all springs."""
        free = ~self.driven
        matrix = np.diag(self.mass[free] / H**2)
        for i, j in self.springs:
            matrix[[i, j], [i, j]] += STIFFNESS
            matrix[[i, j], [j, i]] -= STIFFNESS
        if factorized is None:
            inverse = np.linalg.inv(matrix)
            return lambda b: inverse @ b
        each = factorized(csc_matrix(matrix))
        return lambda b: np.column_stack([each(column) for column in b.T])

    def find_contacts(self):
        """Returns the pairs within 2 GAP: four vertices, their weights of both signs, and normals."""
        near = self.steps.near_pairs(self.x, distance=2 * GAP, pinned=self.driven)
        found = []
        for kind, first in ("vertex_face", 1), ("edge_edge", 2), ("vertex_edge", 1), ("vertex_vertex", 1):
            pairs, data = getattr(near.pairs, kind).astype(int), near.data[kind]
            signs = np.where(np.arange(pairs.shape[1]) < first, 1, -1)
            more = ((0, 0), (0, 4 - pairs.shape[1]))
            found.append((np.pad(pairs, more, "edge"), np.pad(data.weights * signs, more), data.normal))
        self.contacts = sum(len(pairs) for pairs, _, _ in found)
        return [np.concatenate(parts) for parts in zip(*found)]

    def push_apart(self, y, contacts, sweeps=20):
        """Moves vertices so that the gap of each contact along its normal is at least GAP."""
        pairs, weights, normals = contacts
        per_mass = 1 / self.mass[pairs]
        stiffness = (per_mass * weights**2).sum(axis=1)
        for _ in range(sweeps):
            gap = np.einsum("ki,kic,kc->k", weights, y[pairs], normals)
            push = np.where(gap < GAP, (GAP - gap) / np.maximum(stiffness, 1e-30), 0)
            moves = (push[:, None] * per_mass * weights)[:, :, None] * normals[:, None, :]
            total, count = np.zeros_like(y), np.zeros(len(y))
            np.add.at(total, pairs, moves)
            np.add.at(count, pairs, (push[:, None] * weights != 0).astype(float))
            y = y + 1.2 * total / np.maximum(count, 1)[:, None]
        return y

    def accept(self, positions):
        """Stores positions if the step to them, as rounded, is certainly free."""
        found = self.steps.certify(self.x, positions, pinned=self.driven)
        assert found.is_free, found
        self.x = positions
        self.saved.append(positions)

    def drive(self, target):
        """Moves driven vertices towards their target, all by one fraction. Contacts carry free vertices along."""
        goal = np.where(self.driven[:, None], target, self.x)
        p = self.push_apart(goal, self.find_contacts()) - self.x
        free = self.steps.free_step(self.x, p, distance=THICKNESS, conservative=0.9, pinned=self.driven)
        self.accept(self.x + free.fraction * p)
        return free.fraction

    def fall(self):
        """Springs and gravity propose positions. Each vertex goes as far as is free."""
        start, free, contacts = self.x, ~self.driven, self.find_contacts()
        inertia = self.x + H * self.v + H**2 * GRAVITY
        y = np.where(free[:, None], inertia, self.x)
        for _ in range(6):
            ends = np.diff(y[self.springs], axis=1)[:, 0]
            ends *= (STIFFNESS * self.lengths / np.maximum(np.linalg.norm(ends, axis=1), 1e-12))[:, None]
            b = np.where(free, self.mass, 0)[:, None] / H**2 * inertia
            np.add.at(b, self.springs[:, 0], -ends)
            np.add.at(b, self.springs[:, 1], ends)
            y[free] = self.solve(b[free])
            y = self.push_apart(y, contacts)
        y = self.push_apart(y, contacts, sweeps=100)
        moved = self.steps.advance(start, y, each_vertex=True, distance=THICKNESS, pinned=self.driven)
        self.accept(moved.positions)
        self.v = np.where(free[:, None], 0.99 * (self.x - start) / H, 0)
        self.v[np.unique(contacts[0])] *= 0.8  # friction
        return moved.fractions


def simulate(frames, cells=14):
    """Yields the scene and each vertex's fraction of its proposed motion, after each frame."""
    scene = Scene(cells)
    for frame in range(frames):
        target = scene.x.copy()
        shift = 0.08 * np.sin(2 * np.pi * (frame + 1) / 60)
        target[scene.ball] = scene.first[scene.ball] + [shift, 0, abs(shift)]
        scene.drive(target)
        yield scene, scene.fall()


def main(frames=120, folder="out/response"):
    for frame, (scene, fractions) in enumerate(simulate(int(frames)), 1):
        if frame % 10 == 0:
            least = scene.steps.least_distance(scene.x, pinned=scene.driven)
            print(f"frame {frame}: {len(scene.saved) - 1} steps, all certified free; {scene.contacts} pairs near, "
                  f"least distance {least.low:.3g}; fractions: mean {fractions.mean():.3f}, least {fractions.min():.3g}")
    out = Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    np.save(out / "positions.npy", scene.saved)
    io.write_mesh(out / "mesh.ply", scene.first, scene.faces, scene.edges)
    last = [io.Mesh(x, scene.faces, scene.edges) for x in scene.saved[-2:]]
    page = errbound.show(*last, scene.steps.run(last[0].vertices, last[1].vertices, times=True), out / "last.html")
    print(f"{page}; ccd audit --mesh {out}/mesh.ply {out}/positions.npy")


if __name__ == "__main__":
    main(*sys.argv[1:])
