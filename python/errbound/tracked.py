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
    """Operators + - * / on arrays of one rule and dtype, or with plain numbers, broadcast as NumPy's.

    Division by a rule that has none (safe) is a ValueError. Indexing, slices and reshape copy.
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

    def _with(self, other: Any, operation: str, swapped: bool = False) -> Array:
        if not isinstance(other, Array):
            other = array(other, rule=self.rule, dtype=self.dtype)
        shape = np.broadcast_shapes(self.shape, other.shape)
        a, b = (x if x.shape == shape else x._taken(np.broadcast_to(x._places(), shape))
                for x in ((other, self) if swapped else (self, other)))
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

    def __bool__(self) -> bool:
        raise TypeError("tracked: found an array as a condition, expected the sign of one")

    def __eq__(self, other: object) -> Any:
        raise TypeError("tracked: found ==, which may be uncertain, expected (x - y).sign == 0")

    __hash__ = None  # type: ignore[assignment]


def array(value: ArrayLike, error: ArrayLike = 0, *, rule: str = "tight", dtype: Any = None) -> Array:
    """Numbers known to lie within error of value (0: exactly), which is of any shape.

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
    flat = [np.ascontiguousarray(x, number).reshape(-1) for x in (values, errors)]
    return Array(_native.tracked_row(flat[0], flat[1], rule), values.shape, rule, number)
