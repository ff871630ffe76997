"""Divide-and-truncate along planes, as published, next to each_vertex: free steps, and how far vertices go.

usage: truncation.py [--frames 40] [--meshes 1000] [SCENE...]   (folders with two frames of a mesh, in them or in their folder frames)

Steps are the proposals of examples/simulation/response.py, random meshes that start next to contacts, both also scaled
by 2^-40 and 2^40, and those of the scenes. Truncation starts from our nearest features, evaluates planes in the precision of the positions, and has its
published tolerances. An unfree step has a pair in contact, by exact, on the way to the positions as rounded, except
pairs that touch at the start.
"""
import argparse
import pathlib
import sys

import numpy as np

from errbound import ccd, io

sys.path.append(str(pathlib.Path(__file__).parents[2] / "examples" / "simulation"))
import response

SAFETY, NEAR, SLOW, EARLY, PARALLEL = 0.9, 1e-10, 1e-15, 1e-10, 1e-3


def truncated(steps, x, dx, reach, pinned):
    """Returns the factor of each vertex. No vertex moves by more than half of `reach`, so other pairs cannot meet."""
    kind_of = x.dtype.type
    length = np.linalg.norm(dx, axis=1)
    factor = np.minimum(1, np.divide(kind_of(SAFETY * reach / 2), length, out=np.ones_like(length), where=length > 0))
    near = steps.near_pairs(x, distance=float(reach), pinned=pinned)
    for kind, first in ("vertex_face", 1), ("edge_edge", 2), ("vertex_edge", 1), ("vertex_vertex", 1):
        pairs = getattr(near.pairs, kind).astype(int)
        if not len(pairs):
            continue
        weights = near.data[kind].weights.astype(x.dtype)
        at, move = x[pairs], dx[pairs]
        one, two = (np.einsum("ki,kic->kc", weights[:, part], at[:, part]) for part in (slice(first), slice(first, None)))
        apart = one - two
        distance = np.linalg.norm(apart, axis=1)
        n = apart / np.maximum(distance, np.finfo(x.dtype).tiny)[:, None]
        along = np.einsum("kic,kc->ki", move, n)
        approach = np.concatenate([-along[:, :first], along[:, first:]], axis=1)
        fastest = np.maximum(0, approach[:, :first].max(axis=1)), np.maximum(0, approach[:, first:].max(axis=1))
        both = fastest[0] + fastest[1]
        share = np.where(both > 0, fastest[1] / np.where(both > 0, both, 1), kind_of(0.5))
        plane = two + share[:, None] * apart
        room = np.einsum("kic,kc->ki", at - plane[:, None], n) * np.where(np.arange(pairs.shape[1]) < first, 1, -1)
        time = room / np.where(np.abs(along) > SLOW, approach, np.inf)
        skipped = distance < NEAR
        if kind == "edge_edge":
            a, b = at[:, 1] - at[:, 0], at[:, 3] - at[:, 2]
            sine = np.linalg.norm(np.cross(a, b), axis=1)
            lengths = np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1)
            skipped |= (sine < PARALLEL * lengths) & (both < PARALLEL * distance)
        cut = (approach > SLOW) & (time > EARLY) & (time < 1 / SAFETY) & ~skipped[:, None]
        np.minimum.at(factor, pairs[cut], (kind_of(SAFETY) * time)[cut])
    return factor


class Tally:
    def __init__(self, name):
        self.name, self.steps, self.unfree, self.pairs = name, 0, 0, 0
        self.sums = np.zeros(3)

    def add(self, steps, x, y, reach, pinned):
        dx = y - x
        factor = truncated(steps, x, dx, reach, pinned)
        end = x + factor[:, None] * dx
        way = steps.run(x, end, pinned=pinned, initial_contact=True)
        wrong = len(way.pairs) - len(way.touching_at_start)
        moving = np.any(dx != 0, axis=1)
        ours = steps.advance(x, y, each_vertex=True, pinned=pinned)
        again = steps.run(x, ours.positions, pinned=pinned)
        assert len(again.pairs) <= len(way.touching_at_start)
        one = steps.advance(x, y, pinned=pinned).fraction
        self.steps += 1
        self.unfree += wrong > 0
        self.pairs += wrong
        self.sums += factor[moving].mean(), ours.fractions[moving].mean(), one

    def __str__(self):
        by_planes, each, one = self.sums / max(self.steps, 1)
        return (f"{self.name:28} {self.steps:6} {self.unfree:7} {self.pairs:9} {by_planes:10.4f} {each:12.4f} "
                f"{one:13.4f}")


def proposals(frames):
    """Yields the steps, positions at the start, and proposed positions of the response."""
    found = []
    advance = ccd.Steps.advance

    def recorded(self, before, after, **options):
        found.append((self, before, after, options["pinned"]))
        return advance(self, before, after, **options)

    ccd.Steps.advance = recorded
    try:
        for _ in response.simulate(frames):
            pass
    finally:
        ccd.Steps.advance = advance
    return found


def random_step(seed):
    """A random mesh of faces and rods that has moved up to a contact, or a part of that way, and a new motion."""
    random = np.random.default_rng(seed)
    x, goal = (np.repeat(random.uniform(-1, 1, (8, 3)), 3, axis=0) + random.uniform(-0.3, 0.3, (24, 3)) for _ in "xy")
    steps = ccd.Steps(np.arange(18).reshape(6, 3), [[18, 19], [19, 20], [21, 22]], vertices=24)
    pinned = np.zeros(24, bool)
    if not steps.is_free(x):
        return None
    x = steps.advance(x, goal, conservative=1 - random.choice([0, 1e-9, 1e-6, 1e-3])).positions
    return steps, x, x + random.choice([1e-3, 0.1, 1]) * random.uniform(-1, 1, (24, 3)), pinned


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", type=pathlib.Path)
    parser.add_argument("--frames", type=int, default=40)
    parser.add_argument("--meshes", type=int, default=1000)
    chosen = parser.parse_args()
    print(f"{'':28} {'steps':>6} {'unfree':>7} {'pairs':>9} {'by planes':>10} {'each_vertex':>12} {'one fraction':>13}")
    np.seterr(over="ignore")
    for name, ways, reach in (("response", proposals(chosen.frames), 2 * response.GAP),
                              ("random", list(filter(None, map(random_step, range(chosen.meshes)))), 4)):
        for dtype in np.float64, np.float32:
            for exponent in (-40, 0, 40):
                tally = Tally(f"{name}, {dtype.__name__}, 2^{exponent}")
                for steps, x, y, pinned in ways:
                    x, y = (np.ldexp(at, exponent).astype(dtype) for at in (x, y))
                    if steps.is_free(x, pinned=pinned):  # rounding to floats can make it intersect
                        tally.add(steps, x, y, np.ldexp(reach, exponent), pinned)
                print(tally, flush=True)
    for scene in chosen.scenes:
        frames = sorted(scene.glob("*.ply")) or sorted((scene / "frames").glob("*.ply"))
        before, after = (io.read_mesh(path) for path in frames)
        steps = ccd.Steps(before.faces, before.edges, vertices=len(before.vertices))
        edge = np.linalg.norm(before.vertices[before.faces[:, 0]] - before.vertices[before.faces[:, 1]], axis=1).mean()
        for dtype in np.float64, np.float32:
            tally = Tally(f"{scene.name}, {dtype.__name__}")
            tally.add(steps, before.vertices.astype(dtype), after.vertices.astype(dtype), edge / 2,
                      np.zeros(len(before.vertices), bool))
            print(tally, flush=True)


if __name__ == "__main__":
    main()
