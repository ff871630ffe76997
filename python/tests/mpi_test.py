"""Compares distributed meshes with errbound.ccd on the whole mesh. mpirun runs this file, with mpi4py."""
import os
import shutil
import subprocess
import sys

import numpy as np
import pytest

RANKS = (1, 2, 3)


def scene():
    n = 14
    x, y = np.meshgrid(np.arange(n) / n, np.arange(n) / n)
    sheets = [np.stack([x, y, level + 0.05 * np.sin(9 * x + level) * np.cos(7 * y)], -1).reshape(-1, 3)
              for level in (0.0, 0.4)]
    rods = np.array([[0.2, 0.2, 0.2], [0.3, 0.6, 0.25], [0.7, 0.4, 0.15], [0.52, 0.31, 0.1]])
    before = np.concatenate([*sheets, rods])
    after = before.copy()
    after[n * n:2 * n * n, 2] -= 0.5
    after[2 * n * n:] += [0.05, 0, -0.3]
    i = np.arange(n - 1)
    corner = (i[:, None] * n + i).ravel()
    faces = np.concatenate([np.stack([corner, corner + 1, corner + n], -1),
                            np.stack([corner + n + 1, corner + n, corner + 1], -1)])
    faces = np.concatenate([faces, faces + n * n])
    edges = np.array([[0, 1], [1, 2]]) + 2 * n * n
    return before, after, faces, edges


def share(comm, before, after, faces, edges):
    """Returns every size-th face and edge, with their vertices. The last rank has the point."""
    own_faces, own_edges = faces[comm.rank::comm.size], edges[comm.rank::comm.size]
    point = [len(before) - 1] if comm.rank == comm.size - 1 else []
    vertices = np.unique(np.concatenate([own_faces.ravel(), own_edges.ravel(), np.array(point, int)]))
    place = np.zeros(len(before), int)
    place[vertices] = np.arange(len(vertices))
    return vertices, before[vertices], after[vertices], place[own_faces], place[own_edges]


def expect_same_pairs(found, expected):
    for kind in ("vertex_face", "edge_edge", "vertex_edge", "vertex_vertex"):
        np.testing.assert_array_equal(getattr(found, kind), getattr(expected, kind))


def compare_steps(comm):
    from errbound import ccd, mpi
    whole = scene()
    before, after, faces, edges = whole
    part = share(comm, *whole)
    groups = np.arange(len(before)) % 3
    for options in ({}, {"times": True}, {"distance": 0.01, "count_candidates": True}):
        expected = ccd.step(before, after, faces, edges, **options)
        found = mpi.step(comm, *part, gather=True, **options)
        if comm.rank == 0:
            expect_same_pairs(found.pairs, expected.pairs)
        assert found.first_contact == expected.first_contact
        assert found.candidates == expected.candidates
        if options.get("times") and comm.rank == 0:
            for kind, times in expected.times.items():
                np.testing.assert_array_equal(found.times[kind]["low"], times["low"])
        here = mpi.step(comm, *part, **options)
        assert comm.allreduce(len(here.pairs)) == len(expected.pairs) > 0
        assert set(here.pairs.vertex_face[:, 0]) <= set(part[0])
        assert here.work.elements_given == len(part[3]) + len(part[4]) + (comm.rank == comm.size - 1)
    expected = ccd.step(before, after, faces, edges, groups=groups)
    found = mpi.step(comm, *part, gather=True, groups=groups[part[0]])
    if comm.rank == 0:
        expect_same_pairs(found.pairs, expected.pairs)


def compare_advances(comm):
    from errbound import ccd, mpi
    before, after, faces, edges = whole = scene()
    part = share(comm, *whole)
    islands = np.repeat([0, 1, 2, 3], [196, 196, 3, 1])
    for options in ({}, {"islands": islands}, {"distance": 0.005}):
        expected = ccd.advance(before, after, faces, edges, **options)
        own = {name: value[part[0]] if name == "islands" else value for name, value in options.items()}
        found = mpi.advance(comm, *part, **own)
        np.testing.assert_array_equal(found.positions, expected.positions[part[0]])
        np.testing.assert_array_equal(found.fractions, expected.fractions[part[0]])
        assert found.fraction == expected.fraction < 1
        assert found.first_contact == expected.first_contact


def refuse(comm):
    from errbound import mpi
    vertices, before, after, faces, edges = share(comm, *scene())
    is_last = comm.rank == comm.size - 1
    last = f"rank {comm.size - 1}: "
    bad = after.copy()
    bad[0, 0] = np.nan
    for expected, error, arguments, options in (
            (last + "vertex index in row 0 of faces is 1000000", IndexError,
             (vertices, before, after, np.array([[0, 1, 1000000]]) if is_last else faces, edges), {}),
            (last + "numbers is an array of float64", TypeError,
             (vertices * 1.0 if is_last else vertices, before, after, faces, edges), {}),
            ("rank 0: option is 'can_collide'", TypeError,
             (vertices, before, after, faces, edges), {"can_collide": lambda v, w: True}),
            (last, ValueError, (vertices, before, bad if is_last else after, faces, edges), {})):
        with pytest.raises(error) as raised:
            mpi.step(comm, *arguments, **options)
        assert str(raised.value).startswith(expected), raised.value
    with pytest.raises(TypeError, match="comm is 3"):
        mpi.step(3, vertices, before, after, faces, edges)


@pytest.mark.parametrize("ranks", RANKS)
def test_over_ranks(ranks):
    pytest.importorskip("mpi4py", reason="no mpi4py")
    if shutil.which("mpirun") is None:
        pytest.skip("no mpirun")
    try:
        import errbound._mpi  # noqa: F401
    except ImportError as error:
        pytest.skip(f"an errbound without MPI: {error}")
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                       OMPI_MCA_rmaps_base_oversubscribe="1")
    done = subprocess.run(["mpirun", "-n", str(ranks), sys.executable, "-m", "mpi4py", __file__],
                          capture_output=True, text=True, timeout=120, env=environment)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count("good") == ranks, done.stdout


if __name__ == "__main__":
    from mpi4py import MPI
    for check in (compare_steps, compare_advances, refuse):
        check(MPI.COMM_WORLD)
    print("good", flush=True)
