"""Decisions, times and contacts of queries, compared with known ones, with each other, and between call variants."""
import platform
import re
import threading
from pathlib import Path
from typing import get_args

import numpy as np
import pytest

from errbound import ccd

# A vertex that falls through a triangle: contact at t = 1/2 in (1/4, 1/4, 0).
FALLING = np.array([[[.25, .25, 1], [0, 0, 0], [1, 0, 0], [0, 1, 0],
                     [.25, .25, -1], [0, 0, 0], [1, 0, 0], [0, 1, 0]]])
RANDOM = np.random.default_rng(1)


def random_queries(count, points):
    """Returns queries with small integer coordinates: many are degenerate contacts."""
    return RANDOM.integers(-3, 4, (count, 2 * points, 3)).astype(float)


def as_pairs(queries):
    points = queries.shape[1] // 2
    before = queries[:, :points].reshape(-1, 3)
    after = queries[:, points:].reshape(-1, 3)
    return (before, after), np.arange(len(before)).reshape(-1, points)


@pytest.mark.parametrize("kind", ccd.POINTS)
def test_call_variants_agree(kind):
    queries = random_queries(3000, ccd.POINTS[kind])
    expected = ccd.decide(queries, kind).outcome
    assert 0 < (expected == 1).sum() < len(queries)
    positions, pairs = as_pairs(queries)
    for dtype in np.int32, np.int64, np.uint32, np.uint16:
        found = ccd.decide(pairs.astype(dtype), kind, positions=positions).outcome
        np.testing.assert_array_equal(found, expected)
    for order in "C", "F":
        for number in np.float32, np.float64, np.int8:
            some = np.asarray(queries, number, order=order)
            np.testing.assert_array_equal(ccd.decide(some, kind, threads=1).outcome, expected)
            some = tuple(np.asarray(p, number, order=order) for p in positions)
            np.testing.assert_array_equal(ccd.decide(pairs, kind, positions=some).outcome, expected)
    every_other = ccd.decide(queries[::2], kind).outcome
    np.testing.assert_array_equal(every_other, expected[::2])
    times = ccd.first_time(queries, kind)
    np.testing.assert_array_equal(times.query, np.flatnonzero(expected))
    np.testing.assert_array_equal(times.at_start, ccd.touches_at_start(queries, kind).collides[expected == 1])
    contacts = ccd.first_contact(pairs, kind, positions=positions)
    np.testing.assert_array_equal(contacts.low, times.low)
    np.testing.assert_array_equal(contacts.high, times.high)
    np.testing.assert_array_equal(ccd.decide(queries, kind, distance=1e-300).collides | (expected == 1),
                                  ccd.decide(queries, kind, distance=1e-300).collides)


def test_contact_by_hand():
    found = ccd.first_contact(FALLING, "vertex_face")
    assert found.query.tolist() == [0] and found.low.tolist() == found.high.tolist() == [0.5]
    assert found.features.tolist() == [ccd.Features.VERTEX_FACE]
    assert found.points.tolist() == [[0, 1, 2, 3]]
    np.testing.assert_allclose(found.weights, [[1, .5, .25, .25]], atol=found.weight_error[0])
    np.testing.assert_allclose(found.normal, [[0, 0, 1]], atol=found.normal_error[0])
    assert found.sided.tolist() == [True]
    np.testing.assert_allclose(found.normal_velocity, [-2], atol=found.normal_velocity_error[0])
    assert len(ccd.first_contact(FALLING, "vertex_face", t_max=0.25)) == 0
    within = ccd.first_time(FALLING, "vertex_face", distance=0.5)
    assert within.low.tolist() == within.high.tolist() == [0.25]


def test_time_derivatives_by_hand():
    found = ccd.time_derivatives(FALLING, "vertex_face")
    assert found.query.tolist() == [0] and found.low.tolist() == [0.5] and found.defined.tolist() == [True]
    up = np.array([0.25, -0.125, -0.0625, -0.0625])
    np.testing.assert_allclose(found.derivative, np.multiply.outer([[up, up]], [0, 0, 1]), rtol=0, atol=found.error[0])
    assert found.error[0] < 1e-15
    assert len(ccd.time_derivatives(FALLING, "vertex_face", t_max=0.25)) == 0


@pytest.mark.parametrize("kind, points", ccd.POINTS.items())
def test_time_derivatives_variants_agree(kind, points):
    queries = random_queries(3000, points) + RANDOM.random((3000, 2 * points, 3)) / 4
    if kind == "vertex_edge":
        queries[:, :, 2] = 0
    positions, pairs = as_pairs(queries)
    found = ccd.time_derivatives(queries, kind)
    for name, values in vars(ccd.time_derivatives(pairs, kind, positions=positions, threads=1)).items():
        np.testing.assert_array_equal(values, getattr(found, name), name)
    assert found.derivative.shape == (len(found), 2, points, 3)
    assert not found.derivative[~found.defined].any()
    assert found.defined.any() == (kind != "vertex_vertex")


@pytest.mark.parametrize("kind, points", ccd.POINTS.items())
def test_weights_are_as_wide_as_the_pairs(kind, points):
    """Regression: they had four columns for all kinds and did not broadcast with pairs."""
    queries = random_queries(300, points)
    positions, pairs = as_pairs(queries)
    found = ccd.first_contact(pairs, kind, positions=positions)
    chosen = pairs[found.query]
    assert found.weights.shape == found.points.shape == chosen.shape and len(found) > 0
    at = (positions[0] + found.low[0] * (positions[1] - positions[0]))[chosen[0]]
    assert (found.weights[0][:, None] * at).shape == (points, 3)


def test_nearness_by_hand():
    at_start = ccd.nearness(FALLING, "vertex_face")
    assert at_start.features.tolist() == [ccd.Features.VERTEX_FACE]
    assert at_start.points.tolist() == [[0, 1, 2, 3]]
    np.testing.assert_allclose(at_start.weights, [[1, .5, .25, .25]], atol=at_start.weight_error[0])
    for found, distance, up in ((at_start, 1, 1), (ccd.nearness(FALLING[:, :4], "vertex_face"), 1, 1),
                                (ccd.nearness(FALLING, "vertex_face", t=0.25), .5, 1),
                                (ccd.nearness(FALLING, "vertex_face", t=[1]), 1, -1)):
        np.testing.assert_allclose(found.distance, distance, rtol=0, atol=found.distance_error[0])
        np.testing.assert_allclose(found.squared_distance, distance**2, rtol=0, atol=found.squared_distance_error[0])
        np.testing.assert_allclose(found.normal, [[0, 0, up]], atol=found.normal_error[0])
        assert found.distance_error[0] < 1e-13 and not found.touches[0]
    touching = ccd.nearness(FALLING, "vertex_face", t=0.5)
    assert touching.touches.tolist() == [True] and touching.normal_error[0] == np.inf


@pytest.mark.parametrize("kind, points", ccd.POINTS.items())
def test_nearness_variants_agree(kind, points):
    queries = random_queries(500, points)
    (before, after), pairs = as_pairs(queries)
    expected = ccd.nearness(queries, kind)
    assert expected.weights.shape == expected.points.shape == pairs.shape
    np.testing.assert_array_equal(expected.touches, ccd.touches_at_start(queries, kind).collides)
    times = RANDOM.random(len(queries))
    for found, same in ((ccd.nearness(pairs, kind, positions=before), expected),
                        (ccd.nearness(pairs, kind, positions=(before, after), threads=1), expected),
                        (ccd.nearness(pairs, kind, positions=after), ccd.nearness(queries, kind, t=1)),
                        (ccd.nearness(pairs, kind, positions=(before, after), t=times),
                         ccd.nearness(queries, kind, t=times))):
        for name, values in vars(found).items():
            np.testing.assert_array_equal(values, getattr(same, name), name)


def test_near_pairs_and_least_distance():
    faces = np.arange(60).reshape(-1, 3)
    x = RANDOM.integers(0, 9, (60, 3)).astype(float)
    near = ccd.near_pairs(x, faces, distance=1.5)
    expected = ccd.step(x, x, faces, distance=1.5).pairs
    least = ccd.least_distance(x, faces)
    assert len(near) == len(expected) > 0
    for kind in ccd.POINTS:
        pairs = getattr(near.pairs, kind)
        np.testing.assert_array_equal(pairs, getattr(expected, kind))
        found, data = ccd.nearness(pairs, kind, positions=x), near.data[kind]
        for name, values in vars(found).items():
            np.testing.assert_array_equal(values, getattr(data, name), name)
        assert (data.distance + data.distance_error >= least.low).all()
    assert least.low <= least.data.distance[0] <= least.high
    of_pair = ccd.nearness([least.vertices], least.kind, positions=x)
    assert of_pair.distance[0] == least.data.distance[0]
    none = ccd.least_distance([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    assert none.low == none.high == np.inf and none.kind is None and none.data is None
    flat = ccd.Steps.in_plane([[0, 1]], vertices=3)
    assert flat.least_distance([[0, 0], [2, 0], [1, 3]]).data.features.tolist() == [ccd.Features.VERTEX_EDGE]
    assert len(flat.near_pairs([[0, 0], [2, 0], [1, 3]], distance=3)) == 1


def test_names_of_types_are_those_of_the_library():
    assert sorted(get_args(ccd.MethodName)) == sorted(m.name for m in ccd.methods())
    assert list(get_args(ccd.Kind)) == list(ccd.POINTS)


def test_instruction_sets():
    """If processor detection failed at compile time, only the slowest kernels would run."""
    about = Path("/proc/cpuinfo")
    if platform.machine() != "x86_64" or not about.exists():
        pytest.skip("not Linux on x86-64")
    flags = set(re.search(r"^flags\s*: (.*)", about.read_text(), re.MULTILINE)[1].split())
    needed = {"avx2": {"avx2", "fma"},
              "avx512": {"avx512f", "avx512dq", "avx512vl", "avx512bw", "avx512cd"}}
    assert ccd.instruction_sets() == ["baseline", *(s for s, of in needed.items() if of <= flags)]


def test_methods():
    queries = random_queries(2000, 4)
    exact = ccd.decide(queries, "edge_edge").collides
    for method in ccd.methods():
        found = ccd.decide(queries, "edge_edge", method=method.name)
        assert method.may_lose_collisions or (found.may_collide >= exact).all(), method
        assert method.may_report_false_collisions or (found.may_collide <= exact).all(), method


def test_stages_count_every_query():
    stages = ccd.decide(random_queries(1000, 4), "vertex_face", stages=True).stages
    assert [s.name for s in stages][0] == "axes"
    assert sum(s.separate + s.collides for s in stages) == 1000


def test_empty():
    assert len(ccd.decide(np.empty((0, 8, 3)), "vertex_face").outcome) == 0
    assert len(ccd.first_contact([], "edge_edge", positions=([[0, 0, 0]], [[0, 0, 0]]))) == 0


def with_nan():
    wrong = np.repeat(FALLING, 3, axis=0)
    wrong[2, 5, 1] = np.nan
    return wrong


@pytest.mark.parametrize("call, error, message", [
    (lambda: ccd.decide(FALLING, "vf"), ValueError, "kind is 'vf'; expected one of vertex_face"),
    (lambda: ccd.decide(FALLING[:, :6], "vertex_face"), ValueError,
     r"shape of queries is \(1, 6, 3\); expected \(n, 8, 3\)"),
    (lambda: ccd.decide(FALLING.astype(complex), "vertex_face"), TypeError, "queries has items of type complex128; expected real numbers"),
    (lambda: ccd.decide(with_nan(), "vertex_face"), ValueError, "row 2 of queries is .*nan"),
    (lambda: ccd.first_time(with_nan(), "vertex_face"), ValueError, "row 2 of queries is .*nan"),
    (lambda: ccd.decide(FALLING, "vertex_face", method="best"), ValueError,
     "method is 'best'; expected one of float"),
    (lambda: ccd.decide(FALLING, "vertex_face", distance=-1), ValueError, "-1"),
    (lambda: ccd.first_time(FALLING, "vertex_face", t_max=np.inf), ValueError, "t_max"),
    (lambda: ccd.nearness(with_nan(), "vertex_face", t=1), ValueError, "row 2 of queries is .*nan"),
    (lambda: ccd.nearness(FALLING, "vertex_face", t=2), ValueError, r"t is 2.0; expected a number in \[0, 1\]"),
    (lambda: ccd.nearness(FALLING, "vertex_face", t=[0, 1]), ValueError, "number of times is 2; expected 1"),
    (lambda: ccd.near_pairs([[0, 0, np.nan]], []), ValueError, "nan"),
])
def test_errors_name_the_argument(call, error, message):
    with pytest.raises(error, match=message):
        call()


@pytest.mark.parametrize("dtype, index", [(np.int32, -1), (np.int64, -1), (np.int64, 2**40),
                                          (np.uint32, 12), (np.int32, 12)])
@pytest.mark.parametrize("method", ["exact", "tight"])
def test_indices_out_of_range(dtype, index, method):
    positions, pairs = as_pairs(np.repeat(FALLING, 3, axis=0))
    pairs = pairs.astype(dtype)
    pairs[1, 2] = index
    with pytest.raises(IndexError, match=f"vertex index in row 1 of queries is {index}; expected 0 to"):
        ccd.decide(pairs, "vertex_face", positions=positions, method=method)


def test_threads_of_python_run_side_by_side():
    queries = random_queries(20000, 4)
    expected = ccd.decide(queries, "vertex_face").outcome
    found = [None] * 4

    def decide(i):
        found[i] = ccd.decide(queries, "vertex_face", threads=1).outcome

    threads = [threading.Thread(target=decide, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for outcome in found:
        np.testing.assert_array_equal(outcome, expected)
