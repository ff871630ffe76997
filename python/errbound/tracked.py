"""Arrays of tracked numbers: values with a certified bound on their rounding error, under a chosen rule.

    x = tracked.array([0.1, 0.2]); y = x * x - 0.3 * x
    y.value, y.error, y.sign
    tracked.exp(-x**2).sum(), x @ y

The result of exact arithmetic is within error of value, under every rule except "none".
Rules: none, safe, tight (the default), sharp, interval, residual, affine, relative (docs/bound-rules.md).
explain splits the error of an array(..., explained=True) by operation and scope (docs/how-wrong.md).
"""
from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._arrays import as_array, is_real, nearest_double, option

UNCERTAIN = 2
"""The sign of a number whose sign is not certain."""


class Array:
    """An array with + - * / ** @ and abs. The other operand has the same rule and dtype, or is plain numbers.

    Shapes broadcast as in NumPy. Plain numbers that dtype does not represent get the error of their rounding.
    Division throws ValueError if the rule has none (safe). Indexing, slices and reshape copy. NumPy's functions do
    not accept these arrays; use those of this module. Pickled arrays keep value and error, but no other data of
    the rule.
    """
    __array_ufunc__ = None  # NumPy's arrays leave operators to this class

    def __init__(self, row: Any, shape: tuple[int, ...], rule: str, dtype: np.dtype[Any],
                 explained: bool = False) -> None:
        self._row, self.shape, self.rule, self.dtype, self.explained = row, shape, rule, dtype, explained

    def _made(self, row: Any, shape: tuple[int, ...] | None = None) -> Array:
        return Array(row, self.shape if shape is None else shape, self.rule, self.dtype, self.explained)

    def __reduce__(self) -> Any:
        return _from_pickle, (self.value, self.error, self.rule, self.dtype, self.explained)

    def __copy__(self) -> Array:
        return self  # arrays do not change

    def __deepcopy__(self, memo: Any) -> Array:
        return self

    def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
        raise TypeError("argument is a tracked array; expected a plain one, such as x.value, or a function of "
                        "errbound.tracked")

    @property
    def value(self) -> NDArray[Any]:
        """The results of plain floating-point arithmetic."""
        return self._row.values().reshape(self.shape)  # type: ignore[no-any-return]

    @property
    def error(self) -> NDArray[Any]:
        """Upper bounds of |value - exact value|. They may be infinite, but are never NaN."""
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

    def _taken(self, positions: NDArray[np.int64]) -> Array:
        row = self._row.taken(np.ascontiguousarray(positions, np.int64).reshape(-1))
        return self._made(row, positions.shape)

    def _positions(self) -> NDArray[np.int64]:
        return np.arange(len(self._row), dtype=np.int64).reshape(self.shape)

    def __getitem__(self, key: Any) -> Array:
        return self._taken(np.asarray(self._positions()[key]))

    def reshape(self, *shape: int) -> Array:
        """Returns a copy with this shape, as NumPy's reshape."""
        return self._taken(self._positions().reshape(*shape))

    def scale(self, exponent: int) -> Array:
        """Multiplies by 2^exponent: exact unless it underflows; the bound covers underflow."""
        return self._made(self._row.scaled(exponent))

    @property
    def ndim(self) -> int:
        return len(self.shape)

    @property
    def size(self) -> int:
        return math.prod(self.shape)

    @property
    def T(self) -> Array:
        """A copy with the axes reversed."""
        return self._taken(self._positions().T)

    def sum(self, axis: int | None = None, *, out: None = None) -> Array:
        """Returns the sum of all numbers, or along an axis, from first to last. out: for np.sum; must be None."""
        if out is not None:
            raise TypeError("out is given; expected none")
        positions = self._positions().reshape(-1) if axis is None else np.moveaxis(self._positions(), axis, -1)
        if positions.shape[-1] == 0:
            return self._like(np.zeros(positions.shape[:-1], self.dtype))
        return self._made(self._taken(positions)._row.sums(positions.shape[-1]), positions.shape[:-1])

    def __matmul__(self, other: Any) -> Array:
        return dot(self, other)

    def __rmatmul__(self, other: Any) -> Array:
        return dot(self._like(other), self)

    def __pow__(self, exponent: Any) -> Array:
        return pow(self, exponent)

    def __rpow__(self, base: Any) -> Array:
        return pow(self._like(base), self)

    def _like(self, other: Any) -> Array:
        return other if isinstance(other, Array) else array(other, rule=self.rule, dtype=self.dtype,
                                                            explained=self.explained)

    def _broadcast(self, shape: tuple[int, ...]) -> Array:
        return self if self.shape == shape else self._taken(np.broadcast_to(self._positions(), shape))

    def _with(self, other: Any, operation: str, swapped: bool = False) -> Array:
        other = self._like(other)
        shape = np.broadcast_shapes(self.shape, other.shape)
        a, b = (x._broadcast(shape) for x in ((other, self) if swapped else (self, other)))
        return self._made(a._row.combine(operation, b._row), shape)

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
        return _of_each("negative", self)

    def __pos__(self) -> Array:
        return self

    def __abs__(self) -> Array:
        return _of_each("abs", self)

    def __bool__(self) -> bool:
        raise TypeError("condition is a tracked array; expected its sign or its value")

    def __eq__(self, other: object) -> Any:
        raise _comparison("==")

    def __ne__(self, other: object) -> Any:
        raise _comparison("!=")

    def __lt__(self, other: Any) -> Any:
        raise _comparison("<")

    def __le__(self, other: Any) -> Any:
        raise _comparison("<=")

    def __gt__(self, other: Any) -> Any:
        raise _comparison(">")

    def __ge__(self, other: Any) -> Any:
        raise _comparison(">=")

    __hash__ = None  # type: ignore[assignment]


def _comparison(operator: str) -> TypeError:
    return TypeError(f"comparison is x {operator} y of tracked numbers, which may be uncertain; expected "
                     f"(x - y).sign {operator} 0, where UNCERTAIN is {UNCERTAIN}, or x.value {operator} y.value for a "
                     "choice that may be wrong")


def _from_pickle(value: NDArray[Any], error: NDArray[Any], rule: str, dtype: Any, explained: bool) -> Array:
    return array(value, error, rule=rule, dtype=dtype, explained=explained)


def _first_array(name: str, *operands: Any) -> Array:
    for operand in operands:
        if isinstance(operand, Array):
            return operand
    raise TypeError(f"arguments of {name} are plain numbers; expected at least one tracked array")


def _of_each(name: str, x: Array) -> Array:
    x = _first_array(name, x)
    return x._made(x._row.function(name))


def _of_each_two(name: str, x: Any, y: Any) -> Array:
    return _first_array(name, x, y)._like(x)._with(y, name)


def sqrt(x: Array) -> Array:
    """Square roots; the error is infinite where x may be negative."""
    return _of_each("sqrt", x)


def cbrt(x: Array) -> Array:
    """Cube roots. Arguments may be negative."""
    return _of_each("cbrt", x)


def exp(x: Array) -> Array:
    """e^x"""
    return _of_each("exp", x)


def exp2(x: Array) -> Array:
    """2^x"""
    return _of_each("exp2", x)


def expm1(x: Array) -> Array:
    """e^x - 1"""
    return _of_each("expm1", x)


def log(x: Array) -> Array:
    """Natural logarithms; the error is infinite unless x is certainly positive."""
    return _of_each("log", x)


def log2(x: Array) -> Array:
    """Logarithms to base 2, as log."""
    return _of_each("log2", x)


def log10(x: Array) -> Array:
    """Logarithms to base 10, as log."""
    return _of_each("log10", x)


def log1p(x: Array) -> Array:
    """log(1 + x); the error is infinite unless x is certainly greater than -1."""
    return _of_each("log1p", x)


def sin(x: Array) -> Array:
    """Sines of angles in radians."""
    return _of_each("sin", x)


def cos(x: Array) -> Array:
    """Cosines of angles in radians."""
    return _of_each("cos", x)


def tan(x: Array) -> Array:
    """Tangents of angles in radians; the error is infinite where x may be at a pole."""
    return _of_each("tan", x)


def asin(x: Array) -> Array:
    """Angles in [-pi/2, pi/2]; the error is infinite unless x is certainly in [-1, 1]."""
    return _of_each("asin", x)


def acos(x: Array) -> Array:
    """Angles in [0, pi]; the error is infinite unless x is certainly in [-1, 1]."""
    return _of_each("acos", x)


def atan(x: Array) -> Array:
    """Angles in [-pi/2, pi/2]."""
    return _of_each("atan", x)


def sinh(x: Array) -> Array:
    """Hyperbolic sines."""
    return _of_each("sinh", x)


def cosh(x: Array) -> Array:
    """Hyperbolic cosines."""
    return _of_each("cosh", x)


def tanh(x: Array) -> Array:
    """Hyperbolic tangents."""
    return _of_each("tanh", x)


def asinh(x: Array) -> Array:
    """Inverse hyperbolic sines."""
    return _of_each("asinh", x)


def acosh(x: Array) -> Array:
    """Inverse hyperbolic cosines, not negative; the error is infinite unless x is certainly 1 or more."""
    return _of_each("acosh", x)


def atanh(x: Array) -> Array:
    """Inverse hyperbolic tangents; the error is infinite unless x is certainly between -1 and 1."""
    return _of_each("atanh", x)


def atan2(y: Any, x: Any) -> Array:
    """Angles of the points (x, y), in [-pi, pi]; the error is infinite where a point may be the origin."""
    return _of_each_two("atan2", y, x)


def hypot(x: Any, y: Any) -> Array:
    """Square roots of x^2 + y^2, without overflow on the way."""
    return _of_each_two("hypot", x, y)


def pow(x: Any, y: Any) -> Array:
    """x^y: products under the rule for an integer y, otherwise the system's pow.

    The error is infinite where x may be zero or negative and y is not an integer.
    """
    first = _first_array("pow", x, y)
    if isinstance(y, (int, np.integer)) and not isinstance(y, bool) and -2**31 <= y < 2**31:
        return first._made(first._row.power(int(y)))
    return _of_each_two("pow", x, y)


def minimum(x: Any, y: Any) -> Array:
    """The lesser of each two, by their values."""
    return _of_each_two("minimum", x, y)


def maximum(x: Any, y: Any) -> Array:
    """The greater of each two, by their values."""
    return _of_each_two("maximum", x, y)


def dot(x: Any, y: Any) -> Array:
    """Dot products and matrix products, as x @ y. Operands have one or two axes.

    Terms are summed from first to last. Some rules bound a whole product: tight, sharp and relative by the running
    error bound, residual by the compensated dot product.
    """
    first = _first_array("dot", x, y)
    a, b = first._like(x), first._like(y)
    if a.ndim not in (1, 2) or b.ndim not in (1, 2) or a.shape[-1] != b.shape[0]:
        raise ValueError(f"shapes are {a.shape} and {b.shape}; expected (n, k) or (k,), and (k, m) or (k,)")
    shape = a.shape[:-1] + b.shape[1:]
    if a.shape[-1] == 0:
        return first._like(np.zeros(shape, first.dtype))
    return first._made(a._row.dots(b.T._row, a.shape[-1]), shape)


def fma(x: Any, y: Any, z: Any) -> Array:
    """x y + z, rounded once."""
    first = _first_array("fma", x, y, z)
    all_three = [first._like(each) for each in (x, y, z)]
    shape = np.broadcast_shapes(*(each.shape for each in all_three))
    a, b, c = (each._broadcast(shape) for each in all_three)
    return first._made(a._row.fused(b._row, c._row), shape)


@dataclass(frozen=True)
class Contribution:
    """A term of an error. amount: at least 0; known: the part of (exact - value) whose sign is known, with it.

    operation: + - * / scale, the name of a function, input (the error of an input), or the rest (terms too small to
    keep). scopes: name, file and line of each scope, outermost first.
    """
    amount: float
    known: float
    operation: str
    scopes: tuple[tuple[str, str, int], ...]


@dataclass(frozen=True)
class Explanation:
    """The terms of the error of one number, largest first. str() is a table (docs/how-wrong.md)."""
    name: str
    rule: str
    value: float
    error: float
    contributions: tuple[Contribution, ...]
    _table: str

    def __str__(self) -> str:
        return self._table


def explain(x: Array, name: str = "result") -> Explanation:
    """Returns the sources of the error of x, an explained array with one number. name: printed in the table."""
    x, name = _first_array("explain", x), option("name", name, str)
    if x.size != 1:
        raise ValueError(f"shape of x is {x.shape}; expected one number, such as x[0]")
    _, rule, value, error, table, parts = x._row.explained_at(0, name)
    contributions = tuple(Contribution(amount, known, operation, tuple(scopes))
                          for amount, known, operation, scopes in parts)
    return Explanation(name, rule, value, error, contributions, table)


class scope:
    """A named region of the program for explanations: `with tracked.scope("mean"): ...`.

    Explanations list its operations separately. Scopes nest. Each thread has its own scopes.
    """

    def __init__(self, name: str) -> None:
        caller = sys._getframe(1)
        self._scope = _native.Scope(option("name", name, str), caller.f_code.co_filename, caller.f_lineno)

    def __enter__(self) -> scope:
        self._scope.enter()
        return self

    def __exit__(self, *_: object) -> None:
        self._scope.leave()


def _with_conversion(name: str, values: ArrayLike) -> tuple[NDArray[Any], NDArray[Any]]:
    """Returns values as an array, and bounds of the errors of their conversion to float64.

    Integers of any size and fractions are converted. Sequences are converted item by item, since NumPy would round
    integers among floats.
    """
    array = as_array(name, values)
    given = array
    if array.dtype == np.float64 and isinstance(values, Sequence):
        given = np.asarray(values, object)
    if given.dtype.kind != "O":
        if array.dtype.kind not in "fiu":
            raise TypeError(f"{name} is an array of {array.dtype}; expected numbers")
        return array, np.zeros(array.shape)
    items = given.reshape(-1).tolist()
    wrong = [x for x in items if not is_real(x)]
    if wrong:
        raise TypeError(f"{name} has items of type {type(wrong[0]).__name__}; expected real numbers")
    doubles = [nearest_double(x) for x in items]
    errors = [0.0 if x == y or x != x else math.ulp(y) for x, y in zip(items, doubles)]
    return np.array(doubles, np.float64).reshape(given.shape), np.array(errors, np.float64).reshape(given.shape)


def _rounded_to(number: np.dtype[Any], values: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    with np.errstate(over="ignore", invalid="ignore"):
        rounded = values.astype(number)
        exact = (rounded == values) | np.isnan(rounded)
        if values.dtype.kind in "iu" and not exact.all():
            exact &= False  # NumPy compares integers as doubles
        elif values.dtype.kind in "iu" and values.dtype.itemsize * 8 > np.finfo(number).nmant:
            exact = rounded.astype(object) == values.astype(object)
        return rounded, np.where(exact, number.type(0), np.spacing(np.abs(rounded)))


def array(value: ArrayLike, error: ArrayLike = 0, *, rule: str = "tight", dtype: Any = None,
          explained: bool = False) -> Array:
    """Returns an array of numbers within error of value (0: exact; infinity or NaN: unknown), of any shape.

    dtype: float64 or float32; by default that of value. A value that dtype does not represent is rounded, and its
    error grows by a unit in the last place. explained: enables explain, for float64 and the rules tight and residual;
    operations then take about a hundred times as long.
    """
    (values, given), rule = _with_conversion("value", value), option("rule", rule, str)
    explained = option("explained", explained, bool)
    number = np.dtype(dtype or (np.float32 if values.dtype == np.float32 else np.float64))
    if number not in (np.float32, np.float64):
        raise TypeError(f"dtype is {number}; expected float64 or float32")
    errors, given_error = (np.broadcast_to(x, values.shape) for x in _with_conversion("error", error))
    if (errors < 0).any():
        raise ValueError(f"error is {errors.min()}; expected numbers >= 0")
    if explained and number != np.float64:
        raise ValueError(f"dtype is {number}; expected float64 for an explained array")
    rounded, conversion = _rounded_to(number, values)
    bound, rounding = _rounded_to(number, errors)
    with np.errstate(over="ignore", invalid="ignore"):
        for more in rounding, conversion, *_rounded_to(number, given), *_rounded_to(number, given_error):
            bound = np.where(more == 0, bound, np.nextafter(bound + more, number.type(math.inf)))
    flat = [np.ascontiguousarray(x, number).reshape(-1) for x in (rounded, bound)]
    make = _native.explained_row if explained else _native.tracked_row
    return Array(make(flat[0], flat[1], rule), values.shape, rule, number, explained)
