"""Compares predicates, roots and tracked arrays with fractions."""
import math
import operator
import threading
from fractions import Fraction

import numpy as np
import pytest

from errbound import predicates, roots, tracked

RANDOM = np.random.default_rng(3)


def points(count, dimension, arguments):
    """Returns random, degenerate and almost degenerate points (up to last places)."""
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


def test_errors_of_predicates():
    a = np.zeros((3, 2))
    with pytest.raises(ValueError, match=r"shape of b is \(3, 3\); expected \(n, 2\)"):
        predicates.orient2d(a, np.zeros((3, 3)), a)
    with pytest.raises(ValueError, match="row 1 of c is .*inf"):
        predicates.orient2d(a, a, [[0, 0], [0, math.inf], [0, 0]])
    with pytest.raises(ValueError, match="numbers of points are .*; expected equal numbers"):
        predicates.orient2d(a, a, a[:2])
    assert predicates.segments_intersect3d([0, 0, 0], [2, 2, 0], [0, 2, 0], [2, 0, 0]) == 1


def test_intersections_by_hand():
    assert predicates.segments_intersect2d([0, 0], [2, 2], [0, 2], [2, 0]) == 1
    signs = predicates.triangle_intersects_triangle([0, 0, 0], [4, 0, 0], [0, 4, 0], [[1, 1, -1], [1, 1, 0], [1, 1, 1]],
                                                    [1, 1, 1], [9, 9, 1])
    assert signs.tolist() == [1, 0, -1]


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


def three_terms(degree):
    p = np.zeros(degree + 1)
    p[[0, degree // 2, degree]] = -2, .5, 1
    return p


def test_roots_of_high_degree():
    """Regression: isolate took 22 s, since it computed adjacent doubles at once, with five million bits."""
    found = roots.isolate(three_terms(100000))
    assert len(found) == 2
    np.testing.assert_array_equal(found.high, np.nextafter(found.low, 2))
    expected = math.log((math.sqrt(33) - 1) / 4) / 50000
    np.testing.assert_allclose(np.log(abs(found.high)), expected, rtol=1e-9)
    low, high = found.interval(1, 1e-40)
    assert 0 < high - low <= Fraction(1e-40) and found.low[1] < low
    assert found.sign_at([0, 1]).tolist() == [-1, 1]


def test_limits_of_roots():
    hard = np.cos(np.arange(600.0) ** 2)
    for call in roots.isolate, roots.count, lambda p, **limits: roots.count(p[None], **limits):
        with pytest.raises(roots.LimitError, match="beyond its limits"):
            call(hard, max_operations=1000)
        with pytest.raises(roots.LimitError, match="beyond its limits"):
            call(hard, max_bytes=1000)
        with pytest.raises(ValueError, match="max_operations is -1"):
            call(hard, max_operations=-1)
    assert roots.count([-2, 0, 1], max_operations=1000, max_bytes=1000) == 2


def test_roots_do_not_hold_the_lock():
    """A thread counts while another searches. Calls of both on the same roots are refused while one runs."""
    refused, counted = [], 0
    for _ in range(200):  # a loaded machine may not run this thread while the other one works
        found = roots.isolate(three_terms(30000))
        working = threading.Thread(target=lambda: found.interval(0, 1e-300))
        working.start()
        while working.is_alive():
            counted += 1
            try:
                found.interval(0)
            except RuntimeError as error:
                refused.append(str(error))
        if counted > 0:
            break
    assert counted > 0 and set(refused) <= {"Roots: another call is under way; expected one call at a time"}


@pytest.mark.parametrize("p", [np.array([1, 0, -2**60 - 1]), [Fraction(1), 0, -2**60 - 1]])
def test_coefficients_of_any_size(p):
    low, high = roots.isolate(p, 0).interval(0, 1e-40)
    assert low**2 < Fraction(1, 2**60 + 1) < high**2


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("rule", ["safe", "tight", "sharp", "interval", "residual"])
def test_fma_roots_and_extremes(rule, dtype):
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
    assert unknown == np.inf and known == 0
    with pytest.raises(TypeError, match="arguments of sqrt are plain numbers; expected at least one tracked array"):
        tracked.sqrt(x)
    with pytest.raises(ValueError, match="two rules"):
        tracked.minimum(a, tracked.array(1.0, rule="none", dtype=dtype))


RULES = ["safe", "tight", "sharp", "interval", "residual", "affine", "relative"]


def fractions_of(x):
    return [Fraction(float(v)) for v in np.ravel(x)]


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize("rule", RULES)
def test_tracked_sums_and_products(rule, dtype):
    x, y = RANDOM.standard_normal((2, 6, 5)).astype(dtype)
    a, b = (tracked.array(v, rule=rule, dtype=dtype) for v in (x, y))
    p = [fractions_of(row) for row in x]
    q = [fractions_of(row) for row in y]
    mixed = (a + b) * (a - b) - 3 * a * a[:, :1] + a[0]
    assert mixed.shape == (6, 5) and len(mixed) == 6
    for found, exact in [
        (a.sum(), [sum(sum(row) for row in p)]), (np.sum(a, axis=0), [sum(row[j] for row in p) for j in range(5)]),
        (a.sum(1), [sum(row) for row in p]), (sum(a), [sum(row[j] for row in p) for j in range(5)]),
        (a @ y.T, [sum(u * v for u, v in zip(r, s)) for r in p for s in q]),
        (x @ a.T, [sum(u * v for u, v in zip(r, s)) for r in p for s in p]),
        (a[0] @ y[1], [sum(u * v for u, v in zip(p[0], q[1]))]), (a @ y[1], [sum(map(operator.mul, r, q[1])) for r in p]),
        (tracked.dot(y[2], a.T), [sum(u * v for u, v in zip(q[2], r)) for r in p]),
        (mixed, [(u + v) * (u - v) - 3 * u * r[0] + p[0][j] for r, t in zip(p, q) for j, (u, v) in enumerate(zip(r, t))]),
        (a**3, [v**3 for r in p for v in r]), (a**0, [1] * 30), (a**np.int8(2), [v**2 for r in p for v in r]),
    ]:
        assert found.size == len(exact) and found.dtype == dtype and found.rule == rule
        for value, error, sign, true in zip(fractions_of(found.value), np.ravel(found.error), np.ravel(found.sign), exact):
            assert not np.isfinite(error) or abs(value - true) <= Fraction(float(error))
            assert sign in (tracked.UNCERTAIN, (true > 0) - (true < 0))
    assert np.isfinite((abs(a) @ abs(y).T).error).all()
    assert (a @ y.T).shape == (6, 6) and (a[0] @ y[0]).shape == () and a.sum().shape == ()
    assert a[:, :0].sum(1).value.tolist() == [0] * 6 and (a[:, :0] @ y[:0, :2].reshape(0, 2)).value.tolist() == [[0, 0]] * 6
    with pytest.raises(ValueError, match=r"shapes are \(6, 5\) and \(6, 5\); expected"):
        a @ y


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("name, low, high", [
    ("exp", -5, 5), ("exp2", -5, 5), ("expm1", -5, 5), ("log", .1, 9), ("log2", .1, 9), ("log10", .1, 9),
    ("log1p", -.9, 9), ("sin", -9, 9), ("cos", -9, 9), ("tan", -1.5, 1.5), ("asin", -.9, .9), ("acos", -.9, .9),
    ("atan", -9, 9), ("sinh", -5, 5), ("cosh", -5, 5), ("tanh", -5, 5), ("asinh", -9, 9), ("acosh", 1.1, 9),
    ("atanh", -.9, .9), ("cbrt", -9, 9), ("sqrt", .1, 9)])
def test_tracked_functions(name, low, high, rule):
    numpys = {"asin": "arcsin", "acos": "arccos", "atan": "arctan", "asinh": "arcsinh", "acosh": "arccosh",
              "atanh": "arctanh"}.get(name, name)
    x = np.linspace(low, high, 101)
    for error in 0, 1e-9:
        found = getattr(tracked, name)(tracked.array(x, error, rule=rule))
        for inside in x, x - .999 * error, x + .999 * error:
            true = getattr(np, numpys)(inside.astype(np.longdouble))
            assert (abs(found.value - true) <= found.error + abs(true) * 1e-18).all()
    assert np.isfinite(found.error).sum() > 90 or rule == "relative"


def test_tracked_functions_of_two():
    x, y = RANDOM.uniform(.1, 9, (2, 50))
    a = tracked.array(x)
    wide = x.astype(np.longdouble)
    for found, true in (a**y, wide**y), (2.5**a, np.longdouble(2.5)**wide), (tracked.hypot(a, y), np.hypot(wide, y)), (
            tracked.atan2(y, a), np.arctan2(y.astype(np.longdouble), wide)), (tracked.pow(a, -2), wide**-2):
        assert (abs(found.value - true) <= found.error + abs(true) * 1e-18).all() and np.isfinite(found.error).all()
    assert not np.isfinite((tracked.array(-1.0)**0.5).error)


def test_affine_keeps_correlations():
    x = tracked.array([1.0, 2.0], 0.25, rule="affine")
    assert (x - x).error.tolist() == [0, 0] and ((x + 1) - (x - 1)).error.max() < 1e-15
    assert tracked.array([3.0], 1e-9, rule="relative").error[0] < 1.001e-9


@pytest.mark.parametrize("value, dtype, least", [
    (2**53 + 1, np.float64, 1), (0.1, np.float32, 1e-9), (np.longdouble(1) / 3, np.float64, 1e-17),
    (np.uint64(2**64 - 1), np.float64, 1), (2**24 + 1, np.float32, 1), (1e300, np.float32, np.inf),
    (2**64, np.float64, 0), (2**64 + 1, np.float64, 1), (-2**63 - 1, np.float32, 1), (10**400, np.float64, np.inf),
    (Fraction(1, 3), np.float64, 1e-17), (Fraction(1, 10**400), np.float64, 5e-324),
    (Fraction(1, 10**400), np.float32, 1e-45)])
def test_conversions_of_tracked_numbers_count(value, dtype, least):
    """Regression: rounded numbers counted as exact."""
    x = tracked.array(value, dtype=dtype)
    assert x.error >= least
    if np.isfinite(x.value):
        assert abs(Fraction(float(x.value)) - Fraction(*getattr(value, "item", lambda: value)().as_integer_ratio())) <= Fraction(float(x.error))
    assert tracked.array(0.0, 0.1, dtype=np.float32).error > 0.1
    assert tracked.array([2**60, 3], dtype=np.float64).error.tolist() == [0, 0]


def test_sequences_of_integers_and_fractions():
    """NumPy rounds the integers of such lists to float64."""
    for values in [2**53 + 1, .5], [2**64 - 1, -1], [Fraction(1, 3), 2]:
        x = tracked.array(values)
        assert all(abs(Fraction(v) - Fraction(given)) <= Fraction(e)
                   for v, given, e in zip(x.value.tolist(), values, x.error.tolist()))
    assert tracked.array([2**64]).error.tolist() == [0] and (tracked.array([1.0]) * 2**64).value.tolist() == [2.0**64]
    assert Fraction((tracked.array([0.0], [Fraction(1, 3)])).error[0]) >= Fraction(1, 3)
    for wrong in [True], ["1"], [1j], [None], [True, .5]:
        with pytest.raises(TypeError, match="expected (real )?numbers"):
            tracked.array(wrong)


def test_explanations():
    x = tracked.array([0.1, 0.2, 0.3], explained=True)
    with tracked.scope("squares"):
        squares = x * x
    with tracked.scope("mean"):
        mean = squares.sum() / 3
    found = tracked.explain(mean, "mean of squares")
    assert found.value == mean.value and found.error == mean.error
    assert [(c.operation, [s[0] for s in c.scopes]) for c in found.contributions] == [
        ("+", ["mean"]), ("*", ["squares"]), ("/", ["mean"])]
    assert found.contributions[0].scopes[0][1].endswith("numbers_test.py")
    assert sum(c.amount for c in found.contributions) == pytest.approx(found.error)
    assert str(found).startswith("mean of squares = 0.0466") and "squares (numbers_test.py:" in str(found)
    signed = tracked.explain((tracked.array([0.1, 3], rule="residual", explained=True) ** 2).sum())
    assert any(c.known for c in signed.contributions)
    plain = tracked.array([0.1, 0.2, 0.3])
    np.testing.assert_array_equal(squares.error, (plain * plain).error)
    with pytest.raises(ValueError, match="x is an array without explanations; expected one of array"):
        tracked.explain(plain[0])
    with pytest.raises(ValueError, match=r"shape of x is \(3,\); expected one number"):
        tracked.explain(x)
    for wrong in {"rule": "affine"}, {"dtype": np.float32}:
        with pytest.raises(ValueError, match="for an explained array"):
            tracked.array(1.0, explained=True, **wrong)


def test_tracked_operators():
    x = tracked.array([1.0, 2.0], error=[0, 0.5])
    np.testing.assert_array_equal((1 - x).value, [0, -1])
    np.testing.assert_array_equal((x - x).sign, [0, tracked.UNCERTAIN])
    np.testing.assert_array_equal((np.array([2.0, 4.0]) / x).value, [2, 2])
    np.testing.assert_array_equal((-x).scale(3).value, [-8, -16])
    assert x.reshape(2, 1).shape == (2, 1) and (x.reshape(2, 1) * x).shape == (2, 2)
    with pytest.raises(ValueError, match="no division"):
        tracked.array(1.0, rule="safe") / 3
    with pytest.raises(ValueError, match="rule is 'best'; expected one of none"):
        tracked.array(1.0, rule="best")
    with pytest.raises(ValueError, match="two rules"):
        x + tracked.array(1.0, rule="sharp")
