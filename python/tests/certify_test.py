"""Certificates of steps, and reasons why a step is short."""
import numpy as np
import pytest

from errbound import ccd, io

TRIANGLE = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
FACES = [[0, 1, 2]]


def frame(z, dtype=np.float64):
    return np.array([*TRIANGLE, [0.25, 0.25, z]], dtype)


def test_free_and_not_free():
    free = ccd.certify(frame(1), frame(0.5), FACES)
    assert free.is_free and len(free.passages["vertex_face"]) == 0
    assert repr(free) == "<ccd.Certificate, free: 0 intersections at the start, 0 pairs in contact>"
    found = ccd.certify(frame(0.5), frame(-1.5), FACES)
    assert not found.is_free and found.step.pairs.vertex_face.tolist() == [[3, 0, 1, 2]]
    passage = found.passages["vertex_face"]
    assert (passage.low[0], passage.high[0], passage.motion[0]) == (0.25, 0.25, ccd.Motion.APPROACHES)
    assert abs(passage.depth[0] - 1.5) <= passage.depth_error[0] < 1e-14
    assert passage.points.shape == (1, 4) and passage.normal.tolist() == [[0, 0, 1]]
    contact = ccd.first_contact([[3, 0, 1, 2]], "vertex_face", positions=(frame(0.5), frame(-1.5)))
    assert passage.normal_velocity == contact.normal_velocity and passage.query.tolist() == contact.query.tolist()


def test_intersections_at_the_start():
    pierced = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, -1], [1, 1, 1], [1.5, 1, 1]], float)
    found = ccd.certify(pierced, pierced + [0, 0, 3], [[2, 1, 0], [5, 4, 3]])
    assert not found.is_free and len(found.step.pairs) == 0
    assert len(found.step.intersections_at_start) == 1


def test_adjacent_rods_fold():
    def at(y):
        return np.array([[0, 0, 0], [4, 0, 0], [1, y, 0]], float)

    rods = [[0, 1], [1, 2]]
    found = ccd.certify(at(1), at(-1), (), rods)
    assert not found.is_free and found.step.pairs.vertex_edge.tolist() == [[2, 0, 1]]
    assert len(ccd.step(at(1), at(-1), (), rods).pairs) == 0
    assert len(ccd.step(at(1), at(-1), (), rods, adjacent_rods=True).pairs) == 1
    assert ccd.advance(at(1), at(-1), (), rods).fraction < 0.5 and ccd.certify(at(1), at(0.5), (), rods).is_free


def test_float32_is_converted_exactly():
    before, after = frame(1, np.float32), frame(0.1, np.float32)
    before[:3, 2] = after[:3, 2] = 0.1
    assert len(ccd.certify(before, after, FACES).step.pairs) == 1
    after[3, 2] = np.nextafter(after[3, 2], np.float32(1))
    assert ccd.certify(before, after, FACES).is_free


def test_options_and_errors():
    assert ccd.certify(frame(1), frame(-1), FACES, skip_unused=True).is_free
    with pytest.raises(TypeError, match="option is 'distance'"):
        ccd.certify(frame(1), frame(-1), FACES, distance=1)
    with pytest.raises(ValueError, match="row 3 of after"):
        ccd.certify(frame(1), frame(np.nan), FACES)
    with pytest.raises(ValueError, match="number of vertices in after is 3"):
        ccd.certify(frame(1), frame(1)[:3], FACES)


def test_reasons_replay(tmp_path):
    before, after = frame(1), frame(-1)
    for result in (ccd.advance(before, after, FACES), ccd.step(before, after, FACES, first_contact=True)):
        (reason,) = ccd.reasons(result, before, after)
        assert (reason.kind, reason.vertices, reason.time) == ("vertex_face", (3, 0, 1, 2), (0.5, 0.5))
        assert reason.motion is ccd.Motion.APPROACHES
        assert abs(reason.normal_velocity + 2) <= reason.normal_velocity_error < 1e-14
        assert abs(reason.distance_at_start - 1) <= reason.distance_at_start_error < 1e-14
        io.write_queries(tmp_path / "first-vf.csv", [reason.query])
        again = io.read_queries(tmp_path / "first-vf.csv")
        assert again.kind == reason.stored_kind
        assert ccd.first_time(again.queries, again.kind).low.tolist() == [0.5]
    near = ccd.step(before, after, FACES, first_contact=True, distance=0.5)
    (reason,) = ccd.reasons(near, before, after, distance=0.5)
    assert (reason.time, reason.motion) == ((0.25, 0.25), ccd.Motion.APPROACHES)
    assert ccd.reasons(ccd.advance(before, before, FACES), before, before) == []
    with pytest.raises(IndexError, match="result.first_pairs.vertex_face"):
        ccd.reasons(near, before[:3], after[:3])


def test_reasons_of_points_and_in_the_plane():
    points = [np.array([[0, 0, 0], [0, 0, z]], float) for z in (1, -1)]
    (reason,) = ccd.reasons(ccd.advance(*points, []), *points)
    assert (reason.kind, reason.vertices, reason.stored_kind) == ("vertex_vertex", (0, 1), "vertex_face")
    assert ccd.decide([reason.query], reason.stored_kind).collides.all()
    steps = ccd.Steps.in_plane([[0, 1]], vertices=3)
    before, after = np.array([[0, 0], [1, 0], [0.5, 1]]), np.array([[0, 0], [1, 0], [0.5, -1]])
    (reason,) = ccd.reasons(steps.advance(before, after), before, after)
    assert (reason.kind, reason.time, reason.motion) == ("vertex_edge", (0.5, 0.5), ccd.Motion.APPROACHES)
    assert not steps.certify(before, after).is_free
