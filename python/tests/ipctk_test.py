"""Beside the real ipctk: step sizes that are free and no shorter, and a broad phase that loses nothing."""
import numpy as np
import pytest

ipctk = pytest.importorskip("ipctk", reason="ipctk is not installed (pip install ipctk)")
if ipctk:
    from errbound import ccd, io
    from errbound import ipctk as exact


def sheet_over_ball(cells=12):
    """A sheet that falls onto a sphere, which it would pass through."""
    grid = np.linspace(-1, 1, cells + 1)
    x, y = (a.ravel() for a in np.meshgrid(grid, grid))
    sheet = np.column_stack([x, y, np.full_like(x, 0.71)])
    corner = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
    faces = np.vstack([np.column_stack([corner, corner + 1, corner + cells + 2]),
                       np.column_stack([corner, corner + cells + 2, corner + cells + 1])])
    angle, height = np.meshgrid(np.arange(10) * np.pi / 5, np.linspace(-0.6, 0.6, 5))
    radius = np.sqrt(0.5 - height.ravel()**2)
    ball = np.column_stack([radius * np.cos(angle.ravel()), radius * np.sin(angle.ravel()), height.ravel()])
    ring = np.arange(10)
    of_ball = np.vstack([np.column_stack([a, b, c]) for k in range(4) for a, b, c in (
        (10 * k + ring, 10 * k + (ring + 1) % 10, 10 * k + 10 + ring),
        (10 * k + 10 + ring, 10 * k + (ring + 1) % 10, 10 * k + 10 + (ring + 1) % 10))])
    before = np.vstack([sheet, ball])
    after = before.copy()
    after[:len(sheet), 2] -= 0.8 + 0.1 * np.sin(7 * x)
    return before, after, np.vstack([faces, of_ball + len(sheet)]).astype(np.int32)


def crossing_strips():
    """Two strips that turn through each other."""
    line = np.linspace(-1, 1, 9)
    strip = np.vstack([np.column_stack([line, np.full(9, -0.1), np.zeros(9)]),
                       np.column_stack([line, np.full(9, 0.1), np.zeros(9)])])
    k = np.arange(8)
    faces = np.vstack([np.column_stack([k, k + 1, k + 9]), np.column_stack([k + 1, k + 10, k + 9])])
    before = np.vstack([strip, strip[:, [1, 0, 2]] + [0, 0, 0.3]])
    after = before.copy()
    after[18:] = after[18:] * [1, 1, -1] + [0.05, 0, 0.1]
    return before, after, np.vstack([faces, faces + 18]).astype(np.int32)


MADE = [sheet_over_ball(), crossing_strips()]


def mesh_of(before, faces):
    return ipctk.CollisionMesh(np.asfortranarray(before), ipctk.edges(faces), faces)


def pairs_on_the_way(before, after, faces, distance=0.0):
    return len(ccd.step(before, after, faces, distance=distance).pairs)


@pytest.mark.parametrize("distance", [0.0, 1e-2])
@pytest.mark.parametrize("scene", range(len(MADE)))
def test_step_sizes(scene, distance):
    before, after, faces = MADE[scene]
    mesh = mesh_of(before, faces)
    ours = exact.compute_collision_free_stepsize(mesh, before, after, distance)
    assert 0 < ours < 1
    if distance == 0:  # else the peer takes half a minute
        assert ours >= ipctk.compute_collision_free_stepsize(mesh, before, after)
    assert pairs_on_the_way(before, before + ours * (after - before), faces, distance) == 0
    assert pairs_on_the_way(before, before + min(1, ours * 1.0001) * (after - before), faces, distance) > 0
    assert not exact.is_step_collision_free(mesh, before, after, distance)
    assert exact.is_step_collision_free(mesh, before, before + ours * (after - before), distance)
    assert exact.compute_collision_free_stepsize(mesh, before, before + 0.5 * ours * (after - before),
                                                 distance) == 1


@pytest.mark.parametrize("scene", range(len(MADE)))
def test_the_toolkit_by_our_broad_phase(scene):
    before, after, faces = MADE[scene]
    mesh = mesh_of(before, faces)
    theirs = ipctk.compute_collision_free_stepsize(mesh, before, after)
    by_ours = ipctk.compute_collision_free_stepsize(mesh, before, after, 0, exact.BroadPhase())
    # A pair that does not meet may have made theirs shorter.
    assert theirs <= by_ours <= exact.compute_collision_free_stepsize(mesh, before, after)
    assert ipctk.is_step_collision_free(mesh, before, before, 0, exact.BroadPhase())
    assert not ipctk.is_step_collision_free(mesh, before, after, 0, exact.BroadPhase())


@pytest.mark.parametrize("radius", [0.0, 0.02])
@pytest.mark.parametrize("scene", range(len(MADE)))
def test_candidates_are_those_that_come_near(scene, radius):
    before, after, faces = MADE[scene]
    edges = ipctk.edges(faces)
    ours, theirs = exact.BroadPhase(), ipctk.BruteForce()
    for at_end in after, before:
        for broad_phase in ours, theirs:
            broad_phase.build(np.asfortranarray(before), np.asfortranarray(at_end), edges, faces, radius)
        for kind, first, second in (("edge_edge", edges, edges), ("face_vertex", faces, None)):
            found = set(getattr(ours, f"detect_{kind}_candidates")())
            all_pairs = [tuple(c) if not hasattr(c, "edge0_id") and not hasattr(c, "face_id") else
                         (c.edge0_id, c.edge1_id) if kind == "edge_edge" else (c.face_id, c.vertex_id)
                         for c in getattr(theirs, f"detect_{kind}_candidates")()]
            rows = [(*first[i], *second[j]) if second is not None else (j, *first[i]) for i, j in all_pairs]
            near = ccd.decide(rows, "edge_edge" if second is not None else "vertex_face",
                              positions=(before, at_end), distance=2 * radius).collides
            expected = {tuple(sorted(p)) if second is not None else p for p, n in zip(all_pairs, near) if n}
            assert {tuple(sorted(p)) if second is not None else p for p in found} == expected
    ours.clear()


def test_the_plane():
    before = np.array([[0, 0], [1, 0], [0.5, 1], [0.5, 2.0]])
    edges = np.array([[0, 1], [2, 3]], np.int32)
    after = before - [[0, 0], [0, 0], [0, 1.5], [0, 1.5]]
    mesh = ipctk.CollisionMesh(np.asfortranarray(before), edges, np.zeros((0, 3), np.int32))
    step = exact.compute_collision_free_stepsize(mesh, before, after)
    assert step < 2 / 3 and step == pytest.approx(2 / 3, abs=1e-12)
    assert step >= ipctk.compute_collision_free_stepsize(mesh, before, after)
    by_ours = ipctk.compute_collision_free_stepsize(mesh, before, after, 0, exact.BroadPhase())
    assert 0 < by_ours <= step


def test_contact_at_the_start_and_pairs_that_may_not_collide():
    before, after, faces = crossing_strips()
    touching = before.copy()
    touching[18:, 2] = 0
    assert exact.compute_collision_free_stepsize(mesh_of(touching, faces), touching, after) == 0
    mesh = mesh_of(before, faces)
    mesh.can_collide = lambda v, w: (v < 18) == (w < 18)
    assert exact.is_step_collision_free(mesh, before, after)
    assert exact.compute_collision_free_stepsize(mesh, before, after) == 1


def test_stored_scenes(shared_data):
    folders = [f for f in sorted(shared_data.rglob("*")) if f.is_dir() and len(list(f.glob("*.ply"))) == 2]
    assert folders
    for folder in folders:
        first, second = (io.read_mesh(path) for path in sorted(folder.glob("*.ply")))
        if len(first.faces) > 30000:
            continue  # the peer takes minutes
        before, faces = first.vertices, first.faces.astype(np.int32)
        mesh = mesh_of(before, faces)
        ours = exact.compute_collision_free_stepsize(mesh, before, second.vertices)
        theirs = ipctk.compute_collision_free_stepsize(mesh, before, second.vertices)
        assert ours >= theirs
        there = before + ours * (second.vertices - before)
        assert ours == 0 or pairs_on_the_way(before, there, faces) == 0
