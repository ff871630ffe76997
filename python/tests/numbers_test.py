"""Predicates, roots and tracked arrays against fractions."""
import math
from fractions import Fraction

import numpy as np
import pytest

from errbound import predicates, roots, tracked

RANDOM = np.random.default_rng(3)


def points(count, dimension, arguments):
    """Random, degenerate, and degenerate but for last places."""
    whole = RANDOM.integers(-2, 3, (arguments, count, dimension)).astype(float)
    near = whole + RANDOM.integers(-1, 2, whole.shape) * 2.0**-52
    return np.concatenate([RANDOM.standard_normal(whole.shape), whole, near], axis=1)


def determinant(rows):
    if not rows:
        return Fraction(1)
    return sum((-1)**j * x * determinant([row[:j] + row[j + 1:] for row in rows[1:]])
               for j, x in enumerate(rows[0]))


def sign_of_lifted(arguments, lifted):
    last = [Fraction(x) for x in arguments[-1]]
    rows = [[Fraction(x) - y for x, y in zip(p, last)] for p in arguments[:-1]]
    if lifted:
        rows = [row + [sum(x * x for x in row)] for row in rows]
    value = determinant(rows)
    return (value > 0) - (value < 0)


@pytest.mark.parametrize("predicate, dimension, lifted, turned", [
    (predicates.orient2d, 2, False, 1), (predicates.orient3d, 3, False, 1),
    (predicates.incircle, 2, True, 1), (predicates.insphere, 3, True, 1)])
def test_predicates(predicate, dimension, lifted, turned):
    arguments = points(150, dimension, dimension + 1 + lifted)
    expected = [turned * sign_of_lifted([a.tolist() for a in row], lifted)
                for row in arguments.swapaxes(0, 1)]
    signs = predicate(*arguments)
    assert signs.dtype == np.int8 and set(expected) == {-1, 0, 1}
    np.testing.assert_array_equal(signs, expected)
    np.testing.assert_array_equal(predicate(*map(np.asfortranarray, arguments)), expected)
    assert [predicate(*arguments[:, i]) for i in range(450)] == expected
    single = predicate(arguments[0, 7], *arguments[1:])
    assert single[7] == expected[7] and single.shape == (450,)


def test_predicates_say_what_is_wrong():
    a = np.zeros((3, 2))
    with pytest.raises(ValueError, match=r"b: found shape \(3, 3\), expected \(n, 2\)"):
        predicates.orient2d(a, np.zeros((3, 3)), a)
    with pytest.raises(ValueError, match="c: row 1: found .*inf"):
        predicates.orient2d(a, a, [[0, 0], [0, math.inf], [0, 0]])
    with pytest.raises(ValueError, match="different numbers of points"):
        predicates.orient2d(a, a, a[:2])
    assert predicates.segments_intersect3d([0, 0, 0], [2, 2, 0], [0, 2, 0], [2, 0, 0]) == 1


def test_roots_by_hand():
    found = roots.isolate([-2.0, 0.0, 1.0], 0, 10)
    assert len(found) == 1 and found.low[0] < found.high[0] == math.nextafter(found.low[0], 2)
    low, high = found.interval(0, 1e-60)
    assert low * low < 2 < high * high and high - low <= Fraction(1e-60)
    assert found.sign_at([-1.5, 1.0]).tolist() == [-1]
    assert found.sign_at([Fraction(-2, 3), 0, Fraction(1, 3)]).tolist() == [0]
    assert roots.isolate([0, 0, 0]).everywhere and roots.count([0, 0]) == roots.INFINITELY_MANY
    double = roots.isolate([9, -6, 1])
    assert double.multiplicity.tolist() == [2] and double.low.tolist() == double.high.tolist() == [3]
    assert double.signs_taken() == (False, True, True)
    assert roots.common_factor([-2, 0, 1], [0, -2, 0, 1]) in ([-2, 0, 1], [2, 0, -1])


def test_roots_of_products():
    for _ in range(40):
        expected = sorted(set(RANDOM.integers(-9, 10, 6).tolist()))
        p = [Fraction(1)]
        for r in expected:
            p = [a - r * b for a, b in zip([0, *p], [*p, 0])]
        found = roots.isolate(p)
        assert found.low.tolist() == found.high.tolist() == expected
        assert roots.count([float(c) for c in p], -3, 4) == sum(-3 <= r <= 4 for r in expected)
        big = roots.isolate([c * 10**400 for c in p])
        assert big.low.tolist() == expected
    rows = RANDOM.standard_normal((200, 6))
    assert roots.count(rows).tolist() == [roots.count(row) for row in rows]


def test_roots_say_what_is_wrong():
    with pytest.raises(ValueError, match=r"a, b: found \[2.0, 1.0\]"):
        roots.count([1.0, 1.0], 2, 1)
    with pytest.raises(ValueError, match="p: row 1: found nan"):
        roots.isolate([1.0, math.nan])
    with pytest.raises(TypeError, match="p: found"):
        roots.isolate(["1"])


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("rule", ["safe", "tight", "sharp", "interval", "residual"])
def test_tracked_bounds_hold(rule, dtype):
    x, y = RANDOM.standard_normal((2, 4, 25)).astype(dtype)
    a, b = tracked.array(x, rule=rule), tracked.array(y, rule=rule)
    z = (a + b) * (a - b) - 3 * a * a[:, :1] + a[0]
    assert z.shape == (4, 25) and z.dtype == dtype and len(z) == 4
    for i, j in np.ndindex(z.shape):
        p, q, r, s = (Fraction(float(v)) for v in (x[i, j], y[i, j], x[i, 0], x[0, j]))
        exact = (p + q) * (p - q) - 3 * p * r + s
        value, error = Fraction(float(z.value[i, j])), Fraction(float(z.error[i, j]))
        assert abs(value - exact) <= error
        if z.sign[i, j] != tracked.UNCERTAIN:
            assert z.sign[i, j] == (exact > 0) - (exact < 0)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("rule", ["safe", "tight", "sharp", "interval", "residual"])
def test_tracked_functions(rule, dtype):
    x, y, z = RANDOM.standard_normal((3, 4, 25)).astype(dtype)
    a, b, c = (tracked.array(v, rule=rule) for v in (x, y, z))
    fused, least, most = tracked.fma(a, b, c), tracked.minimum(a * b, c), tracked.maximum(z, a * b)
    root = tracked.sqrt(abs(a * b))
    for i, j in np.ndindex(x.shape):
        p, q, r = (Fraction(float(v[i, j])) for v in (x, y, z))
        for found, exact in (fused, p * q + r), (least, min(p * q, r)), (most, max(p * q, r)):
            assert abs(Fraction(float(found.value[i, j])) - exact) <= Fraction(float(found.error[i, j]))
        value, error = Fraction(float(root.value[i, j])), Fraction(float(root.error[i, j]))
        assert max(value - error, 0)**2 <= abs(p * q) <= (value + error)**2
    np.testing.assert_array_equal(root.value, np.sqrt(abs(x * y)))
    assert tracked.fma(a[0], 1, b).shape == (4, 25)
    unknown, known = tracked.sqrt(tracked.array([-1, 4], rule=rule)).error
    assert not np.isfinite(unknown) and known == 0
    with pytest.raises(TypeError, match="sqrt: found no tracked array"):
        tracked.sqrt(x)
    with pytest.raises(ValueError, match="two rules"):
        tracked.minimum(a, tracked.array(1.0, rule="none", dtype=dtype))


def test_tracked_operators():
    x = tracked.array([1.0, 2.0], error=[0, 0.5])
    np.testing.assert_array_equal((1 - x).value, [0, -1])
    np.testing.assert_array_equal((x - x).sign, [0, tracked.UNCERTAIN])
    np.testing.assert_array_equal((np.array([2.0, 4.0]) / x).value, [2, 2])
    np.testing.assert_array_equal((-x).scale(3).value, [-8, -16])
    assert x.reshape(2, 1).shape == (2, 1) and (x.reshape(2, 1) * x).shape == (2, 2)
    with pytest.raises(ValueError, match="no division"):
        tracked.array(1.0, rule="safe") / 3
    with pytest.raises(ValueError, match="rule: found 'best'"):
        tracked.array(1.0, rule="best")
    with pytest.raises(ValueError, match="two rules"):
        x + tracked.array(1.0, rule="sharp")
