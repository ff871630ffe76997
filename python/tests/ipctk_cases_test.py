"""ipc-toolkit's cases for its narrow phases, restated, for the exact narrow phase.

The toolkit's expectations hold for real numbers. If the doubles of a case differ from these, the exact result may
differ; then a rational witness shows that there is no contact until the expected time.
"""
import math
import random
from fractions import Fraction
from itertools import product

import pytest

pytest.importorskip("ipctk", reason="ipctk is not installed (pip install ipctk)")
from errbound import ipctk as exact  # noqa: E402

EPSILON = 2.0**-23
FUNCTIONS = {"vv": "point_point_ccd", "ve": "point_edge_ccd", "vf": "point_triangle_ccd", "ee": "edge_edge_ccd"}
FIRST = {"vv": 1, "ve": 1, "vf": 1, "ee": 2}


def moved(points, motions):
    return [[x + dx for x, dx in zip(*both)] for both in zip(points, motions)]


def at(start, end, t):
    t = Fraction(t)
    return [[Fraction(x) + t * (Fraction(y) - Fraction(x)) for x, y in zip(*both)] for both in zip(start, end)]


def an_axis_separates(kind, frames):
    """True if on one axis, in all frames, all points of one feature are less than all of the other."""
    for axis, sign in product(range(len(frames[0][0])), (1, -1)):
        if all(max(sign * p[axis] for p in frame[:FIRST[kind]]) < min(sign * p[axis] for p in frame[FIRST[kind]:])
               for frame in frames):
            return True
    return False


def the_line_is_not_reached(start, end, t):
    """True if the cross product of point and edge in the plane, a quadratic polynomial, keeps its sign until t."""
    def cross(s):
        p, a, b = at(start, end, s)
        return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])

    t = Fraction(t)
    f0, f1, f2 = cross(0), cross(t / 2), cross(t)
    curvature, slope = 2 * (f0 - 2 * f1 + f2), -3 * f0 + 4 * f1 - f2  # f0 + slope s + curvature s^2, s = 2 x / 2
    lowest = [f0, f2]
    if curvature and 0 < -slope / (2 * curvature) < 1:
        lowest.append(f0 - slope * slope / (4 * curvature))
    return min(lowest) > 0 or max(lowest) < 0


def certainly_apart(kind, start, end, t):
    """True if a rational witness shows that there is no contact in [0, t].

    Features with linear motions are separated by an axis throughout if they are at both ends.
    """
    return an_axis_separates(kind, [at(start, end, 0), at(start, end, t)]) or (
        kind == "ve" and the_line_is_not_reached(start, end, t))


def perpendicular_points():
    for speed, shared, stretch in product((1 + 1e-6, 2.0, 4.0), range(5), (0.5, 0.0, -0.5)):
        yield ([[0, 1], [-1, 0], [1, 0]],
               [[0, -(3 - shared) * speed / 2], [-stretch, (shared - 1) * speed / 2],
                [stretch, (shared - 1) * speed / 2]], 1 / speed)


def random_points(count):
    """Yields rigid edges with a point that reaches a random point of the edge at a random time."""
    source = random.Random(1608)

    def vector():
        return [source.uniform(-10, 10) for _ in range(2)]

    for _ in range(count):
        a, b, p, motion, time, along = vector(), vector(), vector(), vector(), source.random(), source.random()
        target = [x + m * time + along * (y - x) for x, y, m in zip(a, b, motion)]
        yield [p, a, b], [[(x - y) / time for x, y in zip(target, p)], motion, motion], time


def point_edge_cases():
    fixed = [
        ([[0, 1], [-1, 0], [1, 0]], [[0, -1], [3, 0], [-3, 0]], 0.5),  # the edge is a point at 1/4
        ([[0, 1], [-1, 0], [1, 0]], [[0, -1], [0.5, 0], [-0.5, 0]], 0.5),
        ([[-1, 0], [1, -1], [1, 1]], [[1, 0], [-1, -1], [-1, 1]], 0.5),
        ([[0, 0], [0, 1], [0, 2]], [[0, 2], [0, 1], [0, 2]], 0.5),  # on the edge's line
        ([[0, 0], [1, 1], [1, -1]], [[1, 0], [1, 2], [1, -2]], 1.0),
        ([[1.11111, 0.5], [1, 0.5], [1, 0.75]], [[0.888889, 0.5], [1, 0.5], [1, 0.75]], 0.5),
        ([[0.5, 0], [-0.5, 0], [-1.5, 0]], [[-2.5, 0], [-1.5, 0], [-2.5, 0]], 0.5)]
    rotating = ([[0, 0.5], [-1, 0], [1, 0]],
                [[0, -1], [1.6730970740318298, 0.8025388419628143], [-1.616142749786377, -0.6420311331748962]],
                0.4482900963)
    for points, motions, time in [*perpendicular_points(), rotating, *random_points(100)]:
        fixed.append((points, moved(points, motions), time))
    for start, end, time in fixed:
        yield "ve", start, end, True, time
        yield "ve", [start[0], start[2], start[1]], [end[0], end[2], end[1]], True, time
    yield "ve", [[0, 1], [1, 0], [1, 2]], [[0, 2], [1, 1], [1, 3]], False, None  # in parallel


def edge_edge_cases():
    for up, x in product((-1.0, 0.0, 1 - EPSILON, 1.0, 1 + EPSILON, 2.0),
                         (-1 - EPSILON, -1, -1 + EPSILON, -0.5, 0, 0.5, 1 - EPSILON, 1, 1 + EPSILON)):
        start = [[-1, -1, 0], [1, -1, 0], [x, 1, -1], [x, 1, 1]]
        for one, other in ((up, -up), (2 * up, 0)):
            expected = up >= 1 and -1 <= x <= 1
            yield "ee", start, moved(start, [[0, one, 0]] * 2 + [[0, other, 0]] * 2), expected, None
    for d in (1e-2, 1e-4, 1e-6, 1e-8):
        start = [[-1, -d / 2, 0], [1, -d / 2, 0], [0, d / 2, -1], [0, d / 2, 1]]
        motions = [[-1e-3, d, -1e-3], [1e-3, d, 1e-3], [1e-3, -d, 1e-3], [-1e-3, -d, -1e-3]]
        yield "ee", start, moved(start, motions), True, None
    x = -4.99999999958867e-07  # the edges pass each other at this distance
    yield ("ee", [[1, 0.50803125, 2.10835646075301e-18], [-2.38233935445388e-18, 0.50803125, 1], [x, 0.5, 0],
                  [x, 0.5, 1]],
           [[1, 0.47124375, 4.11078309465837e-18], [-2.8526707189104e-18, 0.47124375, 1], [x, 0.5, 0], [x, 0.5, 1]],
           True, None)


def point_triangle_cases():
    heights = (-1.0, 0.0, 0.5 - EPSILON, 0.5, 0.5 + EPSILON, 1.0, 2.0)
    for z, fall, drift, rise in product((0.0, -1.0), heights, (-EPSILON, 0.0, EPSILON), heights):
        start = [[0, 1, z], [-1, 0, 1], [1, 0, 1], [0, 0, -1]]
        expected = fall + rise >= 1 and z + drift >= -1
        yield "vf", start, moved(start, [[0, -fall, drift]] + [[0, rise, 0]] * 3), expected, None
    for y in (-EPSILON, 0, EPSILON):
        corners = [[0, 0, 0], [0, 1, 0], [1, 0, 0]]
        yield "vf", [[0, y, 0], *corners], [[0, y, 0], *moved(corners, [[0, 0, 1]] * 3)], y >= 0, None
    yield ("vf", [[0.1, 0.1, 0.1], [0, 0, 1], [1, 0, 1], [0, 1, 1]],
           [[0.1, 0.1, 0.1], [0, 0, 0], [0, 1, 0], [1, 0, 0]], True, None)


def cases():
    for case in [*point_edge_cases(), *edge_edge_cases(), *point_triangle_cases()]:
        yield case
        kind, start, end, expected, time = case
        if len(start[0]) == 2:
            yield kind, [[*p, 0] for p in start], [[*p, 0] for p in end], expected, time


def answer(narrow, kind, start, end):
    return getattr(narrow, FUNCTIONS[kind])(*start, *end)


def test_differences_are_explained_by_rational_numbers():
    narrow, checks, earlier, missed = exact.ExactNarrowPhase(), 0, 0, 0
    for kind, start, end, expected, time in cases():
        collides, toi = answer(narrow, kind, start, end)
        checks += 1 + (time is not None)
        if expected and not collides:
            assert certainly_apart(kind, start, end, 1), (kind, start, end)
            missed += 1
        if time is not None and toi > time:  # infinite: no contact
            in_plane = [[p[:2] for p in frame] for frame in (start, end)]
            assert certainly_apart(kind, *in_plane, time), (start, end, time)
            earlier += 1
        if collides and toi > 0:
            assert not (kind == "ve" and certainly_apart(kind, *([p[:2] for p in f] for f in (start, end)),
                                                         min(math.nextafter(toi, 2), 1)))
    print(f"{checks} checks, {checks - earlier - missed} as expected; {earlier} times rounded to before the contact, "
          f"{missed} contacts of other numbers than these doubles")
    assert checks > 1000 and earlier > 0 and missed > 0


def test_with_the_toolkits_gap_every_expected_contact_is_reported():
    """With a rescaling of 0.8 and max_gap 1e-4, pairs that come within the gap are reported, as by the toolkit."""
    narrow = exact.ExactNarrowPhase(0.8, 1e-4)
    for kind, start, end, expected, time in cases():
        collides, toi = answer(narrow, kind, start, end)
        assert collides or not expected, (kind, start, end)
        assert time is None or toi <= time, (start, end, time)


def test_points_within_a_distance():
    for dimension, distance in product((2, 3), (0, 1e-6, 1e-4)):
        start, end = [[0, 0, 0], [1, 1, 0]], [[1, 1, 1], [0, 0, 1]]
        collides, toi = exact.ExactNarrowPhase().point_point_ccd(
            *(p[:dimension] for p in start + end), min_distance=distance)
        assert collides and abs(toi - 0.5) < 1e-3 and toi <= 0.5
        assert 2 * (1 - 2 * Fraction(toi))**2 >= Fraction(distance)**2
