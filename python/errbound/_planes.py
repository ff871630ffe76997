"""First contact times of moving vertices and fixed planes, computed exactly with rational numbers."""
from __future__ import annotations

import math
import struct
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ._arrays import Doubles

_ROUNDING, _LEAST = 2.0**-50, 2.0**-1070  # relative and absolute error bounds of a sum of four products


def _approximate_root(square: Fraction) -> Fraction:
    """Returns the square root of a positive number with a relative error below 2^-70."""
    shift = max(0, 140 - square.numerator.bit_length() + square.denominator.bit_length()) // 2 + 1
    return Fraction(math.isqrt((square.numerator << 2 * shift) // square.denominator), 1 << shift)


def _double(bits: int) -> float:
    """Returns the non-negative double with these bits. The order of bits is the order of doubles."""
    value: float = struct.unpack("<d", struct.pack("<q", bits))[0]
    return value


def _last_true(holds: Callable[[float], bool], near: float) -> float:
    """Returns the largest double in [0, 1] up to which holds is true.

    Precondition: holds(0). Cost: twice the logarithm of the number of doubles between `near` and the result.
    """
    bits, one = struct.unpack("<q", struct.pack("<d", near))[0], struct.unpack("<q", struct.pack("<d", 1.0))[0]
    stride, low, high = 1, 0, one + 1
    if holds(near):
        low = bits
        while bits + stride <= one:
            if not holds(_double(bits + stride)):
                high = bits + stride
                break
            low, stride = bits + stride, 2 * stride
    else:
        high = bits
        while bits - stride > 0:
            if holds(_double(bits - stride)):
                low = bits - stride
                break
            high, stride = bits - stride, 2 * stride
    while high - low > 1:
        middle = (low + high) // 2
        if holds(_double(middle)):
            low = middle
        else:
            high = middle
    return _double(low)


class _Motion:
    """The plane's linear form along the path of one vertex, f(t) = f0 + (f1 - f0) t with f0 >= 0."""

    def __init__(self, plane: Plane, start: Any, end: Any) -> None:
        f0, f1 = plane.exact_form(start), plane.exact_form(end)
        self.f0, self.f1 = (f0, f1) if f0 >= 0 else (-f0, -f1)
        self.square = plane.square

    def first(self, distance: Fraction) -> float:
        """Returns the largest double <= the first t in [0, 1] within this distance of the plane, or infinity."""
        limit = distance * distance * self.square
        if self.f0 * self.f0 <= limit:
            return 0.0
        if self.f1 > 0 and self.f1 * self.f1 > limit:
            return math.inf

        def is_not_after(t: float) -> bool:
            f = self.f0 + (self.f1 - self.f0) * Fraction(t)
            return f >= 0 and f * f >= limit

        root = _approximate_root(limit) if limit else Fraction(0)
        return _last_true(is_not_after, min(max(float((self.f0 - root) / (self.f0 - self.f1)), 0.0), 1.0))


class Plane:
    """All x with normal . x + offset = 0. The normal may have any length."""

    def __init__(self, index: int, normal: ArrayLike, offset: float) -> None:
        self.normal, self.offset = np.array(normal, float), float(offset)
        if not np.isfinite([*self.normal, self.offset]).all() or not self.normal.any():
            raise ValueError(f"plane {index} has normal {self.normal.tolist()} and offset {self.offset}; "
                             "expected finite numbers and a normal other than 0")
        self.square = sum((Fraction(x)**2 for x in self.normal.tolist()), Fraction(0))

    def exact_form(self, position: Any) -> Fraction:
        return sum((Fraction(n) * Fraction(x) for n, x in zip(self.normal.tolist(), position)),
                   Fraction(self.offset))

    def form(self, positions: Doubles) -> tuple[Any, Any]:
        """Returns the linear form at each position in doubles, and a bound of its error."""
        size = np.abs(positions) @ np.abs(self.normal) + abs(self.offset)
        return positions @ self.normal + self.offset, _ROUNDING * size + _LEAST

    def length(self) -> float:
        """Returns an upper bound of the normal's length, with a relative error below 2^-49."""
        return math.hypot(*self.normal.tolist()) * (1 + _ROUNDING) + _LEAST

    def possible(self, start: Doubles, end: Doubles, distance: Any) -> Iterator[tuple[float, int]]:
        """Yields (time, vertex) for vertices that may come within a distance, in order of time.

        The distance is (n,) or one number. A vertex is farther away before its time. Vertices with equal motions
        across the plane are yielded once.
        """
        with np.errstate(over="ignore", invalid="ignore"):
            (f0, e0), (f1, e1) = self.form(start), self.form(end)
            width = np.asarray(distance) * self.length() * (1 + _ROUNDING) + _LEAST
            above = np.abs(f0) - e0 - width
            stays = (above > 0) & (np.where(f0 > 0, f1, -f1) - e1 > width)
            rows = np.flatnonzero(~stays)
            if not len(rows):
                return
            before = np.maximum(above, 0)[rows] / (np.abs(f1 - f0) + e0 + e1)[rows] * (1 - 2.0**-48)
        before = np.where(np.isfinite(before), before, 0.0)
        across, seen = self.normal != 0, set()
        ways = np.column_stack([start[rows][:, across], end[rows][:, across],
                                np.broadcast_to(distance, len(start))[rows]])
        for k in np.argsort(before, kind="stable").tolist():
            way = ways[k].tobytes()
            if way not in seen:
                seen.add(way)
                yield float(before[k]), int(rows[k])


class Planes:
    """Planes from which vertices that move from `start`, (n, 3), keep a distance."""

    def __init__(self, planes: Sequence[Any], start: Doubles, distance: float) -> None:
        self._planes = [Plane(i, p.normal(), p.offset()) for i, p in enumerate(planes)]
        self._start, self._distance = start, distance

    def first(self, end: Doubles) -> float:
        """Returns the largest double <= the first contact time of all vertices, or infinity."""
        distance, least = Fraction(self._distance), math.inf
        for plane in self._planes:
            for before, v in plane.possible(self._start, end, self._distance):
                if before > least:
                    break
                least = min(least, _Motion(plane, self._start[v].tolist(), end[v].tolist()).first(distance))
        return least

    def first_with_gap(self, end: Doubles, rescaling: float, max_gap: float) -> float:
        """Same as first, but each vertex keeps the fraction 1 - rescaling of its gap at the start, at most max_gap.

        If rounding leaves no gap, the time is multiplied by rescaling.
        """
        distance, least = Fraction(self._distance), math.inf
        for plane in self._planes:
            form, _ = plane.form(self._start)
            above = np.abs(form) / math.hypot(*plane.normal.tolist()) - self._distance
            gaps = np.clip((1 - rescaling) * above, 0, max_gap)
            gaps = np.where(np.isfinite(gaps), gaps, 0.0)
            for before, v in plane.possible(self._start, end, self._distance + gaps * (1 + _ROUNDING)):
                if before > least:
                    break
                motion = _Motion(plane, self._start[v].tolist(), end[v].tolist())
                time = motion.first(distance + Fraction(float(gaps[v])))
                if time == 0 or gaps[v] == 0:
                    time = rescaling * motion.first(distance)
                least = min(least, time)
        return least
