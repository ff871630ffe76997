"""Real roots of polynomials: counted, isolated and compared exactly, without a tolerance.

Coefficients ascend, as in numpy.polynomial: [-2, 0, 1] is x^2 - 2. Floats are exact numbers. Integers and
fractions.Fraction may have any size. Intervals [a, b] are closed; their ends are floats and may be infinite.

max_operations and max_bytes limit the search, as errbound::root_limits does in C++: operations on 64-bit words,
about a nanosecond each, and estimated memory. A search that would exceed them throws LimitError.
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
from ._arrays import Doubles, check_finite, check_shape, doubles, option

LimitError = _native.LimitError

INFINITELY_MANY = -1
"""The number of roots of the zero polynomial."""

Coefficients = Sequence[Any] | NDArray[Any]


def _coefficients(name: str, p: Coefficients) -> Doubles | list[str]:
    """Returns doubles, or the hexadecimal digits of a positive multiple with integer coefficients."""
    if not isinstance(p, (Sequence, np.ndarray)) or isinstance(p, (str, bytes)):
        raise TypeError(f"{name} is {p!r}; expected a sequence of coefficients")
    if len(p) == 0:
        raise ValueError(f"{name} is empty; expected at least one coefficient")
    if isinstance(p, np.ndarray) and p.dtype.kind in "iuO":
        check_shape(name, p, (None,))
        p = p.tolist()
    if isinstance(p, np.ndarray) or all(isinstance(c, (float, np.floating)) for c in p):
        array = doubles(name, p, (None,))
        check_finite(name, array)
        return array
    if not all(isinstance(c, (Rational, float, np.integer)) and not isinstance(c, bool) for c in p):
        raise TypeError(f"{name} is {p!r}; expected floats, integers or fractions")
    if not all(math.isfinite(c) for c in p if isinstance(c, (float, np.floating))):
        raise ValueError(f"{name} is {p!r}; expected finite numbers")
    exact = [Fraction(int(c) if isinstance(c, np.integer) else c) for c in p]
    unit = math.lcm(*(c.denominator for c in exact))
    return [f"{int(c * unit):x}" for c in exact]


def _interval(a: float, b: float) -> tuple[float, float]:
    a, b = option("a", a, float), option("b", b, float)
    if not (a <= b and a < math.inf and b > -math.inf):
        raise ValueError(f"interval is [{a}, {b}]; expected a <= b, and a finite number in it")
    return a, b


def _limits(max_operations: int | None, max_bytes: int | None) -> list[int | None]:
    return [None if value is None else option(name, value, int, 2**64)
            for name, value in (("max_operations", max_operations), ("max_bytes", max_bytes))]


class Roots:
    """The distinct real roots of p in [a, b], ascending, each in a separate interval.

    low, high: float64 (k,), the adjacent doubles around each root, or both the root if it is a double (is_double,
    bool (k,)); computed when first read. multiplicity: int64 (k,). everywhere: True if p is zero; then no root is
    listed. A call from a second thread throws RuntimeError. Cost: microseconds at low degree (docs/polynomials.md).
    """

    def __init__(self, p: Coefficients, a: float = -math.inf, b: float = math.inf, *,
                 max_operations: int | None = None, max_bytes: int | None = None) -> None:
        self._interval = a, b = _interval(a, b)
        self._roots = _native.Roots(_coefficients("p", p), a, b, *_limits(max_operations, max_bytes))
        self._ends: Doubles | None = None
        self.multiplicity: NDArray[np.int64] = np.asarray(self._roots.multiplicities())
        self.everywhere: bool = self._roots.everywhere()

    def _neighbouring_doubles(self) -> Doubles:
        if self._ends is None:
            self._ends = np.asarray(self._roots.neighbouring_doubles())
        return self._ends

    @property
    def low(self) -> Doubles:
        return self._neighbouring_doubles()[:, 0]

    @property
    def high(self) -> Doubles:
        return self._neighbouring_doubles()[:, 1]

    @property
    def is_double(self) -> NDArray[np.bool_]:
        return np.asarray(self.low == self.high)

    def __len__(self) -> int:
        return len(self._roots)

    def __repr__(self) -> str:
        a, b = self._interval
        if self.everywhere:
            return f"<roots.Roots of zero: everywhere in [{a}, {b}]>"
        return f"<roots.Roots: {len(self)} in [{a}, {b}]>"

    def _check(self, k: int) -> int:
        k = operator.index(k)
        if not 0 <= k < len(self):
            raise IndexError(f"k is {k}; expected 0 to {len(self) - 1}" if len(self) else
                             f"k is {k}; expected no index, since there are no roots")
        return k

    def interval(self, k: int, width: float | None = None) -> tuple[Fraction, Fraction]:
        """Returns an interval with root k strictly inside, or equal to both ends; no wider than `width` if given."""
        k = self._check(k)
        if width is not None:
            width = option("width", width, float)
            if not 0 < width < math.inf:
                raise ValueError(f"width is {width}; expected a finite number > 0")
        low, high = (Fraction(int(n, 16)) * Fraction(2)**e for n, e in self._roots.interval(k, width))
        return low, high

    def sign_at(self, g: Coefficients) -> NDArray[np.int8]:
        """Returns the signs, (k,), of another polynomial at each root."""
        return np.asarray(self._roots.signs_at(_coefficients("g", g)))

    def signs_taken(self) -> tuple[bool, bool, bool]:
        """Returns three flags: p is negative, zero, positive somewhere in [a, b]."""
        return self._roots.occurring_signs()


def isolate(p: Coefficients, a: float = -math.inf, b: float = math.inf, *, max_operations: int | None = None,
            max_bytes: int | None = None) -> Roots:
    """Returns the real roots of p in [a, b]."""
    return Roots(p, a, b, max_operations=max_operations, max_bytes=max_bytes)


def count(p: ArrayLike, a: float = -math.inf, b: float = math.inf, *, max_operations: int | None = None,
          max_bytes: int | None = None) -> int | NDArray[np.int64]:
    """Returns the number of distinct real roots in [a, b]; INFINITELY_MANY if p is zero.

    For a float array (n, degree + 1), returns int64 (n,), one number per row. Limits apply to each row.
    """
    a, b = _interval(a, b)
    limits = _limits(max_operations, max_bytes)
    if isinstance(p, np.ndarray) and p.ndim == 2:
        rows = doubles("p", p, (None, None))
        check_finite("p", rows)
        return np.asarray(_native.count_of_rows(rows, a, b, *limits))
    return _native.count(_coefficients("p", p), a, b, *limits)  # type: ignore[arg-type]


def common_factor(p: Coefficients, q: Coefficients) -> list[int]:
    """Returns the greatest common divisor, primitive over the integers. Coefficients ascend."""
    return [int(c, 16) for c in _native.common_factor(_coefficients("p", p), _coefficients("q", q))]
