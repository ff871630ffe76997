"""Prints results of the package, bit for bit. Two builds of it must print equal lines.

Arguments: pairs of frames, FRAME0 FRAME1 and so on.
"""
import hashlib
import sys

import numpy as np

from errbound import ccd, io, predicates, roots, tracked


def report(what, *arrays):
    digest = hashlib.sha256()
    for array in arrays:
        digest.update(np.ascontiguousarray(array).tobytes())
    print(f"{what}: {', '.join(str(np.shape(a)) for a in arrays)} {digest.hexdigest()}")


def answer_step(name, before, after):
    positions = before.vertices, after.vertices
    for method in [m.name for m in ccd.methods() if m.name not in ("bsc-exact", "root-parity")]:
        found = ccd.step(*positions, before.faces, method=method)
        report(f"{name}: pairs by {method}", found.pairs.vertex_face, found.pairs.edge_edge)
    exact = ccd.step(*positions, before.faces, times=True)
    print(f"{name}: {len(exact.pairs)} pairs, the first at {exact.first_contact}")
    for kind in "vertex_face", "edge_edge":
        report(f"{name}: times of {kind}", exact.times[kind]["low"], exact.times[kind]["high"])
        pairs = getattr(exact.pairs, kind)[:20000]
        contacts = ccd.first_contact(pairs, kind, positions=positions)
        report(f"{name}: contacts of {kind}", contacts.low, contacts.high, contacts.normal, contacts.weights)
        near = ccd.first_time(pairs, kind, positions=positions, distance=1e-3)
        report(f"{name}: times within 0.001 of {kind}", near.low, near.high)


def answer_numbers():
    random = np.random.default_rng(1)
    points = random.standard_normal((5, 1000, 3))
    report("orient3d", predicates.orient3d(*points[:4]))
    report("insphere", predicates.insphere(*points))
    found = roots.isolate(random.integers(-9, 10, 40).tolist(), -100, 100)
    print("roots", [tuple(map(str, found.interval(i, 1e-30))) for i in range(len(found))])
    for rule in "tight", "safe", "sharp", "interval", "residual":
        x = tracked.array(points[0, :, 0], rule=rule)
        y = x * (1 - x) - 0.1 * x
        report(f"tracked by {rule}", y.value, y.error, y.sign)
        if rule != "safe":  # which has no division
            z = y / (x * x + 3)
            report(f"tracked quotients by {rule}", z.value, z.error, z.sign)


def main():
    print("instruction sets:", *ccd.instruction_sets())
    for first, second in zip(sys.argv[1::2], sys.argv[2::2]):
        answer_step(first, io.read_mesh(first), io.read_mesh(second))
    answer_numbers()


if __name__ == "__main__":
    main()
