"""Steps of rigid and affine bodies."""
import numpy as np
import pytest

from errbound import ccd
from errbound.bodies import Bodies

CUBE = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
FACES = [[0, 1, 3], [0, 3, 2], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4],
         [1, 3, 7], [1, 7, 5]]
TRIANGLE = ([[0, 0, 0], [9, 0, 0], [0, 9, 0]], [[0, 1, 2]])


def pose(position=(0, 0, 0), q=(1, 0, 0, 0)):
    return [*position, *q]


def matrix(a=np.eye(3), p=(0, 0, 0)):
    m = np.eye(4)
    m[:3, :3], m[:3, 3] = a, p
    return m


def test_a_vertex_that_turns_meets_a_plane_at_an_exact_time():
    point = ([[5, 0, 0]], [])
    wall = ([[3, -9, -9], [3, 9, -9], [3, 0, 9]], [[0, 1, 2]])
    bodies = Bodies([point, wall])
    # A quarter of a turn about z: x = 5(1 - t^2)/(1 + t^2) is 3 at t = 1/2.
    found = bodies.run([pose(), pose()], [pose(q=(1, 0, 0, 1)), pose()])
    assert found.first_contact == (0.5, 0.5)
    assert found.pairs.vertex_face.tolist() == [[0, 1, 2, 3]]
    assert bodies.body_of(found.pairs.vertex_face).tolist() == [[0, 1, 1, 1]]
    assert found.times["vertex_face"]["low"].tolist() == [0.5]
    assert len(found.touching_at_start) == 0 and found.body_pairs == 1
    assert bodies.run([pose(), pose()], [pose(q=(1, 0, 0, 1)), pose()], t_max=0.25).first_contact is None
    assert bodies.run([pose(), pose()], [pose(q=(1, 0, 0, 1)), pose()], distance=2).first_contact is None
    assert "1 vertex_face; first contact at 0.5" in repr(found)


def test_motion_without_rotation_is_a_step_of_one_mesh():
    bodies = Bodies([(CUBE, FACES), (CUBE, FACES)])
    start, end = [pose(), pose((5, 0.25, 0.125))], [pose(), pose((2, 0.25, -0.5))]
    found = bodies.run(start, end)
    assert len(bodies) == 2 and bodies.first_vertex.tolist() == [0, 8, 16]
    faces = np.vstack([FACES, np.add(FACES, 8)])
    before, after = (np.vstack([CUBE + p[0][:3], CUBE + p[1][:3]]) for p in (start, end))
    expected = ccd.step(before, after, faces, times=True, groups=[0] * 8 + [1] * 8, between_groups=True)
    assert found.first_contact == expected.first_contact == (1, 1)
    for kind in ("vertex_face", "edge_edge"):
        assert np.array_equal(getattr(found.pairs, kind), getattr(expected.pairs, kind))
        assert np.array_equal(found.times[kind]["low"], expected.times[kind]["low"])
    affine = bodies.run(*([matrix(p=p[:3]) for p in poses] for poses in (start, end)))
    assert np.array_equal(affine.pairs.edge_edge, found.pairs.edge_edge)


def test_an_edge_inside_a_face_crosses_it_at_the_start():
    bodies = Bodies([([[1, 1, -1], [1, 1, 1]], [], [[0, 1]]), TRIANGLE])
    start, end = [pose(), pose()], [pose((5, 0, 0), (1, 0, 0, 1)), pose((5, 0, 0), (1, 0, 0, 1))]
    for call in bodies.run, bodies.advance:
        assert call(start, end).crossing_at_start is None
        assert call(start, end, check_start=True).crossing_at_start.tolist() == [[0, 1, 2, 3, 4]]
    lifted = [pose((0, 0, 1)), pose()]
    found = bodies.run(lifted, start, check_start=True)
    assert len(found.touching_at_start) == 1 and found.crossing_at_start.shape == (0, 5)


def test_advance_ends_at_poses_that_are_free():
    bodies = Bodies([(CUBE * [4, 0.5, 0.5], FACES), (CUBE * [9, 0.25, 9], FACES)])
    start, end = [pose(), pose((0, 3.25, 0))], [pose(q=(1, 0, 0, 1)), pose((0, 3.25, 0))]
    free = bodies.advance(start, end)
    assert free.first_contact is not None and 0 < free.fraction <= free.first_contact[1]
    assert free.fraction > 0.999 * free.first_contact[0]
    assert len(bodies.run(start, free.poses).pairs) == 0
    assert len(bodies.run(free.poses, start).pairs) == 0
    half = bodies.advance(start, end, conservative=0.5)
    assert half.fraction == pytest.approx(free.fraction / 2)
    matrices = [matrix(), matrix(p=(0, 3.25, 0))], [matrix(p=(0, 9, 0)), matrix(p=(0, 3.25, 0))]
    moved = bodies.advance(*matrices)
    assert moved.poses.shape == (2, 4, 4) and moved.poses[0, 1, 3] == pytest.approx(2.5)
    assert len(bodies.run(matrices[0], moved.poses).pairs) == 0


def test_groups_and_skipped_pairs_are_not_tested():
    meshes = [(CUBE, FACES)] * 3
    start, end = [pose((4 * i, 0, 0)) for i in range(3)], [pose((2 * i, 0, 0)) for i in range(3)]
    pairs = {}
    for name, options in {"all": {}, "groups": {"groups": [7, 7, -1]}, "skip": {"skip": [(2, 1)]},
                          "both": {"groups": [7, 7, -1], "skip": [(2, 1), (0, 1)]}}.items():
        bodies = Bodies(meshes, **options)
        found = bodies.run(start, end).pairs
        pairs[name] = {tuple(sorted({int(b) for b in bodies.body_of(p)})) for p in found.edge_edge}
        assert (bodies.advance(start, end).fraction == 1) == (name == "both")
    assert pairs == {"all": {(0, 1), (1, 2)}, "groups": {(1, 2)}, "skip": {(0, 1)}, "both": set()}


@pytest.mark.parametrize("arguments, message", [
    (([pose()], [pose()]), r"shape of start is \(1, 7\); expected \(2, 7\)"),
    (([pose(), pose()], [pose(), pose(q=(0, 1, 0, 0))]), "motion of body 1: q0·q1 is 0; .*less than half a turn"),
    (([pose(), pose()], [matrix(), matrix()]), r"shape of end is \(2, 4, 4\); expected \(2, 7\), as of start"),
    (([matrix(), np.ones((4, 4))], [matrix(), matrix()]), r"last row of start\[1\] is \[1.0, 1.0, 1.0, 1.0\]"),
    (([pose(), pose((np.nan, 0, 0))], [pose(), pose()]), "row 1 of start is .*expected finite numbers"),
])
def test_bad_poses_are_refused(arguments, message):
    with pytest.raises(ValueError, match=message):
        Bodies([TRIANGLE, TRIANGLE]).run(*arguments)


def test_bad_meshes_and_options_are_refused():
    with pytest.raises(IndexError, match=r"vertex index in row 0 of faces of meshes\[1\] is 3; expected 0 to 2"):
        Bodies([TRIANGLE, (TRIANGLE[0], [[0, 1, 3]])])
    with pytest.raises(ValueError, match=r"length of meshes\[0\] is 1"):
        Bodies([(TRIANGLE[0],)])
    with pytest.raises(IndexError, match=r"body index in row 1 of skip is 2; expected 0 to 1"):
        Bodies([TRIANGLE, TRIANGLE], skip=[(0, 1), (2, 0)])
    with pytest.raises(ValueError, match=r"shape of groups is \(1,\); expected \(2,\)"):
        Bodies([TRIANGLE, TRIANGLE], groups=[1])
    with pytest.raises(TypeError, match="groups is an array of float64; expected integers"):
        Bodies([TRIANGLE, TRIANGLE], groups=[1.5, 2])
    bodies = Bodies([TRIANGLE])
    with pytest.raises(ValueError, match="conservative is 0.0"):
        bodies.advance([pose()], [pose()], conservative=0)
    with pytest.raises(ValueError, match="distance is -1.0"):
        bodies.run([pose()], [pose()], distance=-1)
