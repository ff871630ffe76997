"""Tests with the real ipctk: step sizes are free and not too short, and the broad phase loses no pair."""
import gc
import math
import os
import random
import subprocess
import sys
from fractions import Fraction

import numpy as np
import pytest

ipctk = pytest.importorskip("ipctk", reason="ipctk is not installed (pip install ipctk)")
if ipctk:
    from errbound import ccd, io
    from errbound import ipctk as exact
    from errbound._planes import Planes


def sheet_over_ball(cells=12):
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
    if distance == 0:  # the toolkit takes half a minute otherwise
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
    # The toolkit's step may be shorter, because of a pair that does not meet.
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


def falling_point():
    """A point falls from z = 3 to 0.5 and meets another at z = 1: contact at t = 0.8."""
    before = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.2, 0.2, 1], [0.2, 0.2, 3]])
    after = before.copy()
    after[4, 2] = 0.5
    return before, after, np.array([[0, 1, 2]], np.int32)


def test_points_that_the_toolkit_passes_in_temporaries():
    """Regression: a broad phase with views gave 1. The toolkit builds it again, for points without edges, from arrays
    that it frees before it requests candidates."""
    before, after, faces = falling_point()
    mesh = mesh_of(before, faces)
    alone = ipctk.compute_collision_free_stepsize(mesh, before, after)
    by_ours = ipctk.compute_collision_free_stepsize(mesh, before, after, 0, exact.BroadPhase())
    ours = exact.compute_collision_free_stepsize(mesh, before, after)
    assert 0.7999 < alone <= by_ours <= ours < Fraction(8, 10)
    assert ours > 0.8 - 1e-12


FREED = """
import gc, sys
import numpy as np, ipctk
sys.path.insert(0, sys.argv[1])
from ipctk_test import MADE, exact, falling_point, mesh_of
for before, after, faces in [falling_point(), MADE[0]]:
    mesh = mesh_of(before, faces)
    print(ipctk.compute_collision_free_stepsize(mesh, before, after, 0, exact.BroadPhase()).hex())
    gc.collect()
"""


def test_freed_memory_is_not_read():
    """Step sizes do not change if the C library overwrites freed memory (MALLOC_PERTURB_)."""
    answers = {subprocess.run([sys.executable, "-c", FREED, os.path.dirname(__file__)], check=True, text=True,
                              capture_output=True, env={**os.environ, "MALLOC_PERTURB_": byte}).stdout
               for byte in ("0", "170")}
    assert len(answers) == 1 and answers.pop().count("0x") == 2


@pytest.mark.parametrize("kind", ["edge_edge", "face_vertex", "edge_vertex", "vertex_vertex", "edge_face", "face_face"])
def test_the_broad_phase_keeps_no_view(kind):
    before, after, faces = MADE[0]
    arrays = [np.asfortranarray(a) for a in (before, after, ipctk.edges(faces), faces)]
    expected, ours = exact.BroadPhase(), exact.BroadPhase()
    expected.build(*arrays, 0.05)
    found = sorted(getattr(expected, f"detect_{kind}_candidates")())
    overwritten = [np.array(a, order="F") for a in arrays]
    ours.build(*overwritten, 0.05)
    for array in overwritten:
        array[...] = 0
    del overwritten, array
    gc.collect()
    assert found and sorted(getattr(ours, f"detect_{kind}_candidates")()) == found


def test_one_broad_phase_for_meshes_in_turn():
    by_ours = exact.BroadPhase()
    for before, after, faces in [MADE[0], falling_point(), MADE[0]]:
        mesh = mesh_of(before, faces)
        fresh = ipctk.compute_collision_free_stepsize(mesh, before, after, 0, exact.BroadPhase())
        assert ipctk.compute_collision_free_stepsize(mesh, before, after, 0, by_ours) == fresh


class _Plane:
    """Same as ipctk.Hyperplane. The toolkit assumes normals of length 1."""

    def __init__(self, normal, offset):
        self.normal, self.offset = lambda: np.array(normal), lambda: offset


def with_planes(mesh, *planes):
    mesh.planes = [ipctk.Hyperplane(np.array(normal, float), np.array(origin, float)) for normal, origin in planes]
    return mesh


GROUND = ([0, 0, 1], [0, 0, 0])


def falling_triangle():
    before = np.array([[0, 0, 1], [1, 0, 1], [0, 1, 1.0]])
    return before, before - [0, 0, 2], np.array([[0, 1, 2]], np.int32)


def test_a_plane_stops_a_triangle():
    """Moves from z = 1 to -1 through the plane z = 0: contact at 0.5; 0.4 with the toolkit's gap."""
    before, after, faces = falling_triangle()
    mesh = with_planes(mesh_of(before, faces), GROUND)
    assert ipctk.compute_collision_free_stepsize(mesh, before, after) == 0.4
    ours = exact.compute_collision_free_stepsize(mesh, before, after)
    assert ours < 0.5 and 0.5 - ours < 1e-15
    assert not exact.is_step_collision_free(mesh, before, after)
    assert exact.is_step_collision_free(mesh, before, before + ours * (after - before))
    assert not exact.is_step_collision_free(mesh, before, before - [0, 0, 1])  # touches at the end
    assert exact.compute_collision_free_stepsize(mesh, before, before - [0, 0, 0.5]) == 1
    assert exact.compute_collision_free_stepsize(mesh, before, after, 0.25) == pytest.approx(0.375, abs=1e-15)
    candidates = ipctk.Candidates()
    candidates.build(mesh, np.asfortranarray(before), np.asfortranarray(after))
    assert exact.ExactNarrowPhase().compute_collision_free_stepsize(candidates, mesh, before, after) == ours
    for broad_phase in ipctk.BruteForce(), exact.BroadPhase():
        assert exact.compute_collision_free_stepsize(mesh, before, after, 0, broad_phase) == ours


def test_gaps_to_planes():
    before, after, faces = falling_triangle()
    mesh = with_planes(mesh_of(before, faces), GROUND)
    for rescaling, cap, height in ((0.75, math.inf, 0.25), (0.75, 0.125, 0.125), (1, 0.125, 0)):
        size = exact.compute_collision_free_stepsize(
            mesh, before, after, narrow_phase_ccd=exact.ExactNarrowPhase(rescaling, cap))
        assert size == pytest.approx((1 - height) / 2, abs=1e-15) and size <= (1 - height) / 2


def test_planes_that_vertices_touch_or_leave():
    before, after, faces = falling_triangle()
    beneath = before - [0, 0, 2]
    for plane in (GROUND, ([0, 0, -1], [0, 0, 0])):
        mesh = with_planes(mesh_of(before, faces), plane)
        assert exact.compute_collision_free_stepsize(mesh, before - [0, 0, 1], before) == 0  # touches at the start
        assert exact.compute_collision_free_stepsize(mesh, beneath, beneath - [0, 0, 1]) == 1
        assert not exact.is_step_collision_free(mesh, beneath, before)
    slanted = with_planes(mesh_of(before, faces), ([0.6, 0, 0.8], [0, 0, 0]), GROUND)
    assert 0 < exact.compute_collision_free_stepsize(slanted, before, after) < 0.5


def within(plane, way, distance, until):
    """True, exactly, if a vertex comes within the distance of the plane in [0, until]."""
    def form(x):
        return sum((Fraction(n) * Fraction(c) for n, c in zip(plane.normal().tolist(), x)), Fraction(plane.offset()))

    first = form(way[0])
    last = first + (form(way[1]) - first) * Fraction(until)
    square = Fraction(distance)**2 * sum(Fraction(n)**2 for n in plane.normal().tolist())
    return first * last <= 0 or min(first**2, last**2) <= square


def test_times_at_planes_are_exact():
    """Random, degenerate and extreme motions. Times are compared with rational numbers."""
    source, contacts = random.Random(48), 0
    numbers = (lambda: float(source.randint(-3, 3)), lambda: source.uniform(-1, 1),
               lambda: source.uniform(-1, 1) * 2.0**source.randint(-300, 300),
               lambda: source.choice([5e-324, -5e-324, 1e308, -1e308, 0.0, 1.0, 1 + 2**-52, 1e-310]))
    for _ in range(1000):
        number = source.choice(numbers)
        plane = _Plane([number() for _ in range(3)], number())
        if not plane.normal().any():
            continue
        ways = np.array([[[number() for _ in range(3)] for _ in range(2)] for _ in range(source.randint(1, 5))])
        distance = source.choice([0.0, abs(number())])
        low = Planes([plane], ways[:, 0], distance).first(ways[:, 1])
        if low == math.inf:
            assert not any(within(plane, way.tolist(), distance, 1) for way in ways)
            continue
        contacts += 1
        assert 0 <= low <= 1
        assert low == 0 or not any(within(plane, way.tolist(), distance, math.nextafter(low, 0)) for way in ways)
        assert any(within(plane, way.tolist(), distance, min(math.nextafter(low, 2), 1)) for way in ways)
    assert contacts > 500


def test_planes_and_coordinates_that_are_none():
    before, after, faces = falling_triangle()
    mesh = mesh_of(before, faces)
    mesh.planes = [ipctk.Hyperplane(np.zeros(3), np.zeros(3))]
    with pytest.raises(ValueError, match="plane 0 has normal"):
        exact.is_step_collision_free(mesh, before, after)
    with pytest.raises(ValueError, match="vertices_t1"):
        exact.is_step_collision_free(mesh_of(before, faces), before, np.full_like(after, np.nan))
    for wrong in (0, -1, 1.5, math.nan):
        with pytest.raises(ValueError, match="conservative_rescaling is"):
            exact.ExactNarrowPhase(wrong)
    with pytest.raises(ValueError, match="max_gap is 0"):
        exact.ExactNarrowPhase(0.8, 0)


@pytest.mark.parametrize("scene", range(len(MADE)))
def test_keyword_arguments_of_the_toolkit(scene):
    before, after, faces = MADE[scene]
    mesh = mesh_of(before, faces)
    ours = exact.compute_collision_free_stepsize(mesh, before, after)
    by_theirs = exact.compute_collision_free_stepsize(mesh, before, after, broad_phase=ipctk.BruteForce())
    assert by_theirs == ours
    gap = exact.compute_collision_free_stepsize(mesh, before, after,
                                                narrow_phase_ccd=exact.ExactNarrowPhase(0.8, 1e-4))
    wide = exact.compute_collision_free_stepsize(mesh, before, after, narrow_phase_ccd=exact.ExactNarrowPhase(0.5))
    assert 0 < wide < gap < ours
    there = before + gap * (after - before)
    assert pairs_on_the_way(before, there, faces, 0) == 0
    theirs = ipctk.TightInclusionCCD(conservative_rescaling=0.8)
    assert exact.compute_collision_free_stepsize(mesh, before, after, narrow_phase_ccd=theirs) \
        == ipctk.compute_collision_free_stepsize(mesh, before, after, 0, exact.BroadPhase(), theirs)
    for narrow in None, theirs, exact.ExactNarrowPhase(0.8, 1e-4):
        assert not exact.is_step_collision_free(mesh, before, after, narrow_phase_ccd=narrow)
        assert exact.is_step_collision_free(mesh, before, before + 0.5 * gap * (after - before),
                                            broad_phase=ipctk.BruteForce(), narrow_phase_ccd=narrow)


def test_a_capped_gap_is_kept_by_all_pairs():
    """Until the step's end each pair keeps the cap or a fifth of its first distance."""
    before, after, faces = crossing_strips()
    mesh, cap = mesh_of(before, faces), 1e-3
    size = exact.compute_collision_free_stepsize(mesh, before, after,
                                                 narrow_phase_ccd=exact.ExactNarrowPhase(0.8, cap))
    there = before + size * (after - before)
    assert pairs_on_the_way(before, there, faces, 0.999 * cap) == 0
    assert pairs_on_the_way(before, before + min(1, 1.001 * size) * (after - before), faces, cap) > 0


def test_candidates_by_the_exact_narrow_phase():
    before, after, faces = crossing_strips()
    mesh = mesh_of(before, faces)
    start, end = np.asfortranarray(before), np.asfortranarray(after)
    candidates = ipctk.Candidates()
    candidates.build(mesh, start, end)
    narrow = exact.ExactNarrowPhase()
    size = narrow.compute_collision_free_stepsize(candidates, mesh, start, end)
    assert size == exact.compute_collision_free_stepsize(mesh, start, end)
    assert not narrow.is_step_collision_free(candidates, mesh, start, end)
    assert narrow.is_step_collision_free(candidates, mesh, start, before + size * (after - before))
    threads = ipctk.get_num_threads()
    ipctk.set_num_threads(1)  # the toolkit holds the interpreter's lock while its threads call
    try:
        at_contact = candidates.compute_collision_free_stepsize(mesh, start, end, 0, narrow)
        assert size <= at_contact <= size + 1e-12
    finally:
        ipctk.set_num_threads(threads)


def test_a_filter_is_called_for_few_pairs():
    before, after, faces = crossing_strips()
    mesh, calls = mesh_of(before, faces), []

    def between_strips(v, w):
        calls.append((v, w))
        return (v < 18) != (w < 18)

    expected = exact.compute_collision_free_stepsize(mesh, before, after)
    mesh.can_collide = between_strips
    assert exact.compute_collision_free_stepsize(mesh, before, after) == expected
    assert len(calls) < 20
    gap = exact.ExactNarrowPhase(0.8)
    assert exact.compute_collision_free_stepsize(mesh, before, after, narrow_phase_ccd=gap) < expected
    assert len(calls) < 1000


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
