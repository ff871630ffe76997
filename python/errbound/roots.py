"""Real roots of polynomials, exactly: counted, isolated, compared. No tolerance anywhere.

Coefficients ascend, as in numpy.polynomial: [-2, 0, 1] is x^2 - 2. Floats are the exact numbers that
they are; whole numbers and fractions.Fraction may have any size. Intervals [a, b] are closed; their
ends are floats, infinite ones included.
"""
from __future__ import annotations

import math
import operator
from collections.abc import Sequence
from fractions import Fraction
from numbers import Rational
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._arrays import Doubles, check_finite, doubles, option

INFINITELY_MANY = -1
"""The number of roots of the polynomial that is zero."""

Coefficients = Sequence[Any] | NDArray[Any]


def _coefficients(name: str, p: Coefficients) -> Doubles | list[str]:
    """Doubles, or a positive multiple in whole numbers, in hexadecimal digits."""
    if not isinstance(p, (Sequence, np.ndarray)) or isinstance(p, (str, bytes)):
        raise TypeError(f"{name}: found {p!r}, expected a sequence of coefficients")
    if len(p) == 0:
        raise ValueError(f"{name}: found no coefficients, expected at least one")
    if isinstance(p, np.ndarray) or all(isinstance(c, (float, np.floating)) for c in p):
        array = doubles(name, p, (None,))
        check_finite(name, array)
        return array
    if not all(isinstance(c, (Rational, float, np.integer)) for c in p):
        raise TypeError(f"{name}: found {p!r}, expected floats, whole numbers or fractions")
    if not all(math.isfinite(c) for c in p if isinstance(c, (float, np.floating))):
        raise ValueError(f"{name}: found {p!r}, expected finite numbers")
    exact = [Fraction(int(c) if isinstance(c, np.integer) else c) for c in p]
    unit = math.lcm(*(c.denominator for c in exact))
    return [f"{int(c * unit):x}" for c in exact]


def _interval(a: float, b: float) -> tuple[float, float]:
    a, b = option("a", a, float), option("b", b, float)
    if not (a <= b and a < math.inf and b > -math.inf):
        raise ValueError(f"a, b: found [{a}, {b}], expected a <= b, with numbers between")
    return a, b


class Roots:
    """The distinct real roots of p in [a, b], ascending, each in an interval of its own.

    low, high: float64 (k,): the neighbouring doubles between which each root lies, or twice the double
    that it is (is_double). multiplicity: int64 (k,). everywhere: p is zero, and no root is listed.
    Not for two threads at once. Cost: microseconds at low degree (docs/polynomials.md).
    """

    def __init__(self, p: Coefficients, a: float = -math.inf, b: float = math.inf) -> None:
        self._interval = a, b = _interval(a, b)
        self._roots = _native.Roots(_coefficients("p", p), a, b)
        found = [self._roots.neighbouring_doubles(k) for k in range(len(self._roots))]
        ends = np.array(found, np.float64).reshape(-1, 2)
        self.low, self.high = ends[:, 0], ends[:, 1]
        self.is_double: NDArray[np.bool_] = self.low == self.high
        self.multiplicity = np.array([self._roots.multiplicity(k) for k in range(len(found))], np.int64)
        self.everywhere: bool = self._roots.everywhere()

    def __len__(self) -> int:
        return len(self._roots)

    def __repr__(self) -> str:
        a, b = self._interval
        if self.everywhere:
            return f"<roots.Roots of zero: everywhere in [{a}, {b}]>"
        return f"<roots.Roots: {len(self)} in [{a}, {b}], low={np.array2string(self.low, threshold=20)}>"

    def _check(self, k: int) -> int:
        k = operator.index(k)
        if not 0 <= k < len(self):
            raise IndexError(f"k: found {k}, expected 0 to {len(self) - 1}")
        return k

    def interval(self, k: int, width: float | None = None) -> tuple[Fraction, Fraction]:
        """An interval of at most that width, if given: root k is strictly inside, or is both ends."""
        if width is not None:
            width = option("width", width, float)
            if not 0 < width < math.inf:
                raise ValueError(f"width: found {width}, expected a positive finite number")
            self._roots.refine(self._check(k), width)
        low, high = (Fraction(int(n, 16)) * Fraction(2)**e
                     for n, e in self._roots.interval(self._check(k)))
        return low, high

    def sign_at(self, g: Coefficients) -> NDArray[np.int8]:
        """The signs, (k,), of another polynomial at each root."""
        c = _coefficients("g", g)
        return np.array([self._roots.sign_at(c, k) for k in range(len(self))], np.int8)

    def signs_taken(self) -> tuple[bool, bool, bool]:
        """Whether p is negative, zero, positive somewhere in [a, b]."""
        return self._roots.signs_on(*self._interval)


def isolate(p: Coefficients, a: float = -math.inf, b: float = math.inf) -> Roots:
    """The real roots of p in [a, b]."""
    return Roots(p, a, b)


def count(p: ArrayLike, a: float = -math.inf, b: float = math.inf) -> int | NDArray[np.int64]:
    """The number of distinct real roots in [a, b]; INFINITELY_MANY if p is zero.

    Of a float array (n, degree + 1), of each row: int64 (n,), without the interpreter's lock.
    """
    a, b = _interval(a, b)
    if isinstance(p, np.ndarray) and p.ndim == 2:
        rows = doubles("p", p, (None, None))
        check_finite("p", rows)
        return np.asarray(_native.count_of_rows(rows, a, b))
    found = _native.Roots(_coefficients("p", p), a, b)  # type: ignore[arg-type]
    return INFINITELY_MANY if found.everywhere() else len(found)


def common_factor(p: Coefficients, q: Coefficients) -> list[int]:
    """The greatest common divisor of both, primitive over the integers; coefficients ascend."""
    return [int(c, 16) for c in _native.common_factor(_coefficients("p", p), _coefficients("q", q))]
