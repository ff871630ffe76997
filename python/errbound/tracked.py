"""Arrays of tracked numbers: values with a certified bound on their rounding error, under a chosen rule.

    x = tracked.array([0.1, 0.2]); y = x * x - 0.3 * x
    y.value, y.error, y.sign

The number that exact arithmetic would have given is within error of value, under every rule but "none".
Rules: none, safe, tight (the default), sharp, interval, residual (docs/bound-rules.md).
"""
from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._arrays import as_array, option

UNCERTAIN = 2
"""What sign says where the bound does not exclude zero, nor the value is known to be zero."""


class Array:
    """Operators + - * / and abs on arrays of one rule and dtype, or with plain numbers, broadcast as NumPy's.

    Division by a rule that has none (safe) is a ValueError. Indexing, slices and reshape copy. Python's sum adds
    along the first axis; there is no power, and NumPy's functions are not for these arrays: sqrt, fma, minimum,
    maximum of this module are.
    """
    __array_ufunc__ = None  # so that NumPy's arrays leave operators to this class

    def __init__(self, row: Any, shape: tuple[int, ...], rule: str, dtype: np.dtype[Any]) -> None:
        self._row, self.shape, self.rule, self.dtype = row, shape, rule, dtype

    @property
    def value(self) -> NDArray[Any]:
        """What plain arithmetic would have computed."""
        return self._row.values().reshape(self.shape)  # type: ignore[no-any-return]

    @property
    def error(self) -> NDArray[Any]:
        """Upper bounds of |value - exact value|; infinity or NaN where nothing is known."""
        return self._row.errors().reshape(self.shape)  # type: ignore[no-any-return]

    @property
    def sign(self) -> NDArray[np.int8]:
        """Certain signs -1, 0, 1, or UNCERTAIN."""
        return self._row.signs().reshape(self.shape)  # type: ignore[no-any-return]

    def __len__(self) -> int:
        return self.shape[0]

    def __repr__(self) -> str:
        with np.printoptions(threshold=20):
            return f"tracked.array(value={self.value!r}, error={self.error!r}, rule={self.rule!r})"

    def _taken(self, places: NDArray[np.int64]) -> Array:
        row = self._row.taken(np.ascontiguousarray(places, np.int64).reshape(-1))
        return Array(row, places.shape, self.rule, self.dtype)

    def _places(self) -> NDArray[np.int64]:
        return np.arange(len(self._row), dtype=np.int64).reshape(self.shape)

    def __getitem__(self, key: Any) -> Array:
        return self._taken(np.asarray(self._places()[key]))

    def reshape(self, *shape: int) -> Array:
        """A copy of that shape, as NumPy's reshape has it."""
        return self._taken(self._places().reshape(*shape))

    def scale(self, exponent: int) -> Array:
        """Times 2^exponent: exact unless it underflows, which the bound then covers."""
        return Array(self._row.scaled(exponent), self.shape, self.rule, self.dtype)

    def _like(self, other: Any) -> Array:
        return other if isinstance(other, Array) else array(other, rule=self.rule, dtype=self.dtype)

    def _broadcast(self, shape: tuple[int, ...]) -> Array:
        return self if self.shape == shape else self._taken(np.broadcast_to(self._places(), shape))

    def _with(self, other: Any, operation: str, swapped: bool = False) -> Array:
        other = self._like(other)
        shape = np.broadcast_shapes(self.shape, other.shape)
        a, b = (x._broadcast(shape) for x in ((other, self) if swapped else (self, other)))
        return Array(getattr(a._row, operation)(b._row), shape, self.rule, self.dtype)

    def __add__(self, other: Any) -> Array:
        return self._with(other, "add")

    def __radd__(self, other: Any) -> Array:
        return self._with(other, "add", swapped=True)

    def __sub__(self, other: Any) -> Array:
        return self._with(other, "subtract")

    def __rsub__(self, other: Any) -> Array:
        return self._with(other, "subtract", swapped=True)

    def __mul__(self, other: Any) -> Array:
        return self._with(other, "multiply")

    def __rmul__(self, other: Any) -> Array:
        return self._with(other, "multiply", swapped=True)

    def __truediv__(self, other: Any) -> Array:
        return self._with(other, "divide")

    def __rtruediv__(self, other: Any) -> Array:
        return self._with(other, "divide", swapped=True)

    def __neg__(self) -> Array:
        return Array(self._row.negated(), self.shape, self.rule, self.dtype)

    def __pos__(self) -> Array:
        return self

    def __abs__(self) -> Array:
        return Array(self._row.absolute(), self.shape, self.rule, self.dtype)

    def __bool__(self) -> bool:
        raise TypeError("tracked: found an array as a condition, expected the sign of one")

    def __eq__(self, other: object) -> Any:
        raise TypeError("tracked: found ==, which may be uncertain, expected (x - y).sign == 0")

    __hash__ = None  # type: ignore[assignment]


def _first_array(name: str, *operands: Any) -> Array:
    for operand in operands:
        if isinstance(operand, Array):
            return operand
    raise TypeError(f"{name}: found no tracked array, expected at least one")


def sqrt(x: Array) -> Array:
    """Square roots; nothing is known (error is infinity or NaN) where x may be negative."""
    x = _first_array("sqrt", x)
    return Array(x._row.root(), x.shape, x.rule, x.dtype)


def minimum(x: Any, y: Any) -> Array:
    """The lesser of each two, by their values."""
    return _first_array("minimum", x, y)._like(x)._with(y, "minimum")


def maximum(x: Any, y: Any) -> Array:
    """The greater of each two, by their values."""
    return _first_array("maximum", x, y)._like(x)._with(y, "maximum")


def fma(x: Any, y: Any, z: Any) -> Array:
    """x y + z, rounded once."""
    first = _first_array("fma", x, y, z)
    all_three = [first._like(each) for each in (x, y, z)]
    shape = np.broadcast_shapes(*(each.shape for each in all_three))
    a, b, c = (each._broadcast(shape) for each in all_three)
    return Array(a._row.fused(b._row, c._row), shape, first.rule, first.dtype)


def array(value: ArrayLike, error: ArrayLike = 0, *, rule: str = "tight", dtype: Any = None) -> Array:
    """Numbers known to lie within error of value (0: exactly; infinity or NaN: anywhere), of any shape.

    dtype: float64 or float32, that of value by default. A value that it does not hold is rounded, as
    NumPy does, and counts as the exact number then.
    """
    values, rule = as_array("value", value), option("rule", rule, str)
    number = np.dtype(dtype or (np.float32 if values.dtype == np.float32 else np.float64))
    if number not in (np.float32, np.float64):
        raise TypeError(f"dtype: found {number}, expected float64 or float32")
    if values.dtype.kind not in "fiu":
        raise TypeError(f"value: found {values.dtype}, expected numbers")
    errors = np.broadcast_to(as_array("error", error), values.shape)
    if (errors < 0).any():
        raise ValueError(f"error: found {errors.min()}, expected none that is negative")
    flat = [np.ascontiguousarray(x, number).reshape(-1) for x in (values, errors)]
    return Array(_native.tracked_row(flat[0], flat[1], rule), values.shape, rule, number)
