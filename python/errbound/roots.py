"""Real roots of polynomials, exactly: counted, isolated, compared. No tolerance anywhere.

Coefficients ascend, as in numpy.polynomial: [-2, 0, 1] is x^2 - 2. Floats are the exact numbers that
they are; whole numbers and fractions.Fraction may have any size. Intervals [a, b] are closed; their
ends are floats, infinite ones included.

Calls release the interpreter's lock, and Ctrl-C ends them. max_operations and max_bytes limit the search of
roots, as errbound::root_limits in C++: operations on words of 64 bits, about a nanosecond each, and memory of the
rows of numbers held at a time, estimated. A search that would go beyond them raises LimitError.
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
"""The number of roots of the polynomial that is zero."""

Coefficients = Sequence[Any] | NDArray[Any]


def _coefficients(name: str, p: Coefficients) -> Doubles | list[str]:
    """Doubles, or a positive multiple in whole numbers, in hexadecimal digits."""
    if not isinstance(p, (Sequence, np.ndarray)) or isinstance(p, (str, bytes)):
        raise TypeError(f"{name}: found {p!r}, expected a sequence of coefficients")
    if len(p) == 0:
        raise ValueError(f"{name}: found no coefficients, expected at least one")
    if isinstance(p, np.ndarray) and p.dtype.kind in "iuO":
        check_shape(name, p, (None,))
        p = p.tolist()
    if isinstance(p, np.ndarray) or all(isinstance(c, (float, np.floating)) for c in p):
        array = doubles(name, p, (None,))
        check_finite(name, array)
        return array
    if not all(isinstance(c, (Rational, float, np.integer)) and not isinstance(c, bool) for c in p):
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


def _limits(max_operations: int | None, max_bytes: int | None) -> list[int | None]:
    return [None if value is None else option(name, value, int, 2**64)
            for name, value in (("max_operations", max_operations), ("max_bytes", max_bytes))]


class Roots:
    """The distinct real roots of p in [a, b], ascending, each in an interval of its own.

    low, high: float64 (k,): the neighbouring doubles between which each root lies, or twice the double
    that it is (is_double, bool (k,)); computed when first read. multiplicity: int64 (k,). everywhere: p is zero, and no
    root is listed. For one call at a time: a second thread's raises RuntimeError. Cost: microseconds at low degree
    (docs/polynomials.md).
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
                             f"k is {k}; expected none, as there are no roots")
        return k

    def interval(self, k: int, width: float | None = None) -> tuple[Fraction, Fraction]:
        """An interval of at most that width, if given: root k is strictly inside, or is both ends."""
        k = self._check(k)
        if width is not None:
            width = option("width", width, float)
            if not 0 < width < math.inf:
                raise ValueError(f"width is {width}; expected a finite number > 0")
        low, high = (Fraction(int(n, 16)) * Fraction(2)**e for n, e in self._roots.interval(k, width))
        return low, high

    def sign_at(self, g: Coefficients) -> NDArray[np.int8]:
        """The signs, (k,), of another polynomial at each root."""
        return np.asarray(self._roots.signs_at(_coefficients("g", g)))

    def signs_taken(self) -> tuple[bool, bool, bool]:
        """Whether p is negative, zero, positive somewhere in [a, b]."""
        return self._roots.occurring_signs()


def isolate(p: Coefficients, a: float = -math.inf, b: float = math.inf, *, max_operations: int | None = None,
            max_bytes: int | None = None) -> Roots:
    """The real roots of p in [a, b]."""
    return Roots(p, a, b, max_operations=max_operations, max_bytes=max_bytes)


def count(p: ArrayLike, a: float = -math.inf, b: float = math.inf, *, max_operations: int | None = None,
          max_bytes: int | None = None) -> int | NDArray[np.int64]:
    """The number of distinct real roots in [a, b]; INFINITELY_MANY if p is zero.

    Of a float array (n, degree + 1), of each row: int64 (n,); limits are those of a row.
    """
    a, b = _interval(a, b)
    limits = _limits(max_operations, max_bytes)
    if isinstance(p, np.ndarray) and p.ndim == 2:
        rows = doubles("p", p, (None, None))
        check_finite("p", rows)
        return np.asarray(_native.count_of_rows(rows, a, b, *limits))
    return _native.count(_coefficients("p", p), a, b, *limits)  # type: ignore[arg-type]


def common_factor(p: Coefficients, q: Coefficients) -> list[int]:
    """The greatest common divisor of both, primitive over the integers; coefficients ascend."""
    return [int(c, 16) for c in _native.common_factor(_coefficients("p", p), _coefficients("q", q))]
