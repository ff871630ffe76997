"""Conversion of arguments to contiguous arrays of the types that the extension needs, with checks."""
from __future__ import annotations

import math
import numbers
import re
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Doubles = NDArray[np.float64]
Indices = NDArray[np.uint32]


def as_array(name: str, values: Any) -> NDArray[Any]:
    """Converts values by NumPy. Accepts objects that have only __dlpack__.

    Throws: TypeError for a masked array, a mesh, or memory outside the host.
    """
    if isinstance(values, np.ma.MaskedArray):
        raise TypeError(f"{name} is a masked array; expected one without a mask")
    if hasattr(values, "vertices") and hasattr(values, "faces"):
        raise TypeError(f"{name} is {type(values).__name__}; expected an array, such as its vertices or its faces")
    if hasattr(values, "__dlpack__") and not hasattr(values, "__array__"):
        try:
            return np.asarray(np.from_dlpack(values))
        except (AttributeError, BufferError, RuntimeError, TypeError, ValueError) as error:
            raise TypeError(f"{name} is {type(values).__name__}, which NumPy cannot read ({error}); "
                            "expected an array in the host's memory") from None
    try:
        return np.asarray(values)
    except ValueError as error:  # rows of different lengths
        raise ValueError(f"{name}: {error}") from None


def exact_doubles(name: str, values: ArrayLike) -> NDArray[Any]:
    """Returns an array of any shape whose numbers float64 represents exactly: float64, float32, float16 or integers.

    Fractions, longdoubles and integers beyond int64 are converted if a double equals each of them.
    Throws: TypeError for items that are not real numbers (booleans included); ValueError with the row of a number
    that no double equals.
    """
    array = as_array(name, values)
    given = array
    if array.dtype == np.float64 and isinstance(values, Sequence):
        given = np.asarray(values, object)  # in a list with floats, NumPy rounds integers and accepts booleans
    large = array.dtype.kind in "iu" and array.dtype.itemsize == 8 and array.size > 0 and (
        array.max() > 2**53 or array.min() < -2**53)
    if array.dtype.kind in "fiu" and array.dtype.itemsize <= 8 and not large and given.dtype.kind != "O":
        return array
    items = given.reshape(-1).tolist() if given.dtype != np.longdouble else list(given.flat)
    wrong = [x for x in items if not is_real(x)]
    if array.dtype.kind not in "fiuO" or wrong:
        found = type(wrong[0]).__name__ if given.dtype.kind == "O" else array.dtype
        raise TypeError(f"{name} has items of type {found}; expected real numbers")
    converted = np.array([nearest_double(x) for x in items], np.float64)
    for i, (x, y) in enumerate(zip(items, converted.tolist())):
        if x != y and x == x:
            row = f"row {np.unravel_index(i, given.shape)[0]} of {name}" if given.shape else name
            raise ValueError(f"{row} is {x!s}; expected a number that a double equals")
    return converted.reshape(given.shape)


def is_real(value: Any) -> bool:
    return isinstance(value, numbers.Real) and not isinstance(value, (bool, np.bool_))


def nearest_double(value: Any) -> float:
    try:
        return float(value)
    except OverflowError:  # an integer or a fraction
        return math.inf if value > 0 else -math.inf


def doubles(name: str, values: ArrayLike, shape: tuple[int | None, ...]) -> Doubles:
    """Returns a C-contiguous float64 array of this shape (None: any length). Copies only if necessary."""
    array = exact_doubles(name, values)
    if array.shape == (0,) and len(shape) > 1 and shape[0] is None:
        array = array.reshape([length or 0 for length in shape])
    check_shape(name, array, shape)
    return np.require(array, np.float64, ["C", "A"])


def check_shape(name: str, array: NDArray[Any], shape: tuple[int | None, ...]) -> None:
    fits = array.ndim == len(shape) and all(n is None or n == found
                                            for n, found in zip(shape, array.shape))
    if not fits:
        expected = ", ".join("n" if n is None else str(n) for n in shape) + ("," if len(shape) == 1 else "")
        raise ValueError(f"shape of {name} is {array.shape}; expected ({expected})")


def indices(name: str, values: ArrayLike, columns: int, vertices: int) -> Indices:
    """Returns C-contiguous uint32 rows of vertex indices. Arrays of uint32 or int32 are not copied.

    Other types are checked against the number of vertices. A negative int32 becomes a large index,
    which check_range or the library rejects.
    """
    array = as_array(name, values)
    if array.size == 0:
        return np.empty((0, columns), np.uint32)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name} is an array of {array.dtype}; expected integers")
    check_shape(name, array, (None, columns))
    if array.dtype == np.int32:
        return np.require(array, np.int32, ["C", "A"]).view(np.uint32)
    if array.dtype.itemsize > 4 or array.dtype.kind == "i":
        check_range(name, array, vertices)
    return np.require(array, np.uint32, ["C", "A"])


def check_range(name: str, array: NDArray[Any], vertices: int) -> None:
    """Throws: IndexError for an index outside [0, vertices)."""
    if array.dtype == np.uint32 and vertices <= 2**31:
        array = array.view(np.int32)  # reports negative indices as such
    wrong = (array < 0) | (array >= vertices)
    if wrong.any():
        row = int(np.argwhere(wrong)[0][0])
        found = array[row][wrong[row]][0]
        expected = f"0 to {vertices - 1}" if vertices else "no index, since there are no vertices"
        raise IndexError(f"vertex index in row {row} of {name} is {found}; expected {expected}")


def checked_indices(name: str, values: ArrayLike, columns: int, vertices: int) -> Indices:
    found = indices(name, values, columns, vertices)
    check_range(name, found, vertices)
    return found


def restated(error: ValueError) -> ValueError:
    message = re.sub(r"^\w+(::\w+)+: ", "", str(error))
    return error if message == str(error) else ValueError(message)


def check_finite(name: str, array: Doubles, prefix: str = "") -> None:
    wrong = ~np.isfinite(array).all(axis=tuple(range(1, array.ndim)))
    if wrong.any():
        row = int(np.argmax(wrong))
        raise ValueError(f"{prefix}row {row} of {name} is {array[row].tolist()}; expected finite numbers")


def frames(before: ArrayLike, after: ArrayLike, columns: int = 3) -> tuple[Doubles, Doubles]:
    at_start = doubles("before", before, (None, columns))
    at_end = doubles("after", after, (None, columns))
    if len(at_start) != len(at_end):
        raise ValueError(f"number of vertices in after is {len(at_end)}; expected {len(at_start)}, as in before")
    return at_start, at_end


def frames_of(positions: Any) -> tuple[Doubles, Doubles]:
    if isinstance(positions, np.ndarray):
        fits, found = positions.ndim == 3 and len(positions) == 2, f"an array of shape {positions.shape}"
    elif isinstance(positions, Sequence):
        fits, found = len(positions) == 2, f"a sequence of {len(positions)} items"
    else:
        fits, found = False, type(positions).__name__
    if not fits:
        raise TypeError(f"positions is {found}; expected a pair (before, after)")
    return frames(positions[0], positions[1])


def option(name: str, value: Any, kind: type, end: int = 2**31) -> Any:
    """Returns an option converted to bool, int (in [0, end)), float or str. Accepts NumPy's scalars."""
    fits: Any = {bool: (bool, np.bool_), int: numbers.Integral, float: numbers.Real, str: str}[kind]
    if not isinstance(value, fits) or (kind is not bool and isinstance(value, bool)):
        expected = {bool: "True or False", int: "an integer", float: "a number", str: "a name"}[kind]
        raise TypeError(f"{name} is {value!r}; expected {expected}")
    if kind is int and not 0 <= value < end:
        raise ValueError(f"{name} is {value}; expected 0 to {end - 1}")
    converted = nearest_double(value) if kind is float else kind(value)
    if converted != value and value == value:
        raise ValueError(f"{name} is {value!r}; expected a number that a double equals")
    return converted


def end_time(value: Any) -> float:
    t_max: float = option("t_max", value, float)
    if not math.isfinite(t_max):
        raise ValueError(f"t_max is {t_max}; expected a finite number")
    return t_max


def distance_option(value: Any, name: str = "distance") -> float:
    distance: float = option(name, value, float)
    if not 0 <= distance < math.inf:
        raise ValueError(f"{name} is {distance}; expected a finite number >= 0")
    return distance


def thickness_option(values: ArrayLike | None, vertices: int) -> Any:
    if values is None:
        return None
    array = exact_doubles("thickness", values)
    if array.shape == ():
        raise ValueError(f"thickness is {values!r}; expected a number for each of {vertices} vertices, "
                         "or distance= for one number of all")
    check_shape("thickness", array, (vertices,))
    thickness = np.require(array, np.float64, ["C", "A"])
    if thickness.size:
        wrong = ~((thickness >= 0) & (thickness < math.inf))
        if wrong.any():
            row = int(np.argmax(wrong))
            raise ValueError(f"thickness of vertex {row} is {thickness[row]}; expected a finite number >= 0")
    return thickness


def pinned_option(values: ArrayLike | None, vertices: int) -> Any:
    if values is None:
        return None
    flags = as_array("pinned", values)
    if flags.shape != (vertices,):
        raise ValueError(f"shape of pinned is {flags.shape}; expected ({vertices},): a flag for each vertex, "
                         "not indices of pinned vertices")
    if flags.dtype.kind not in "biu" or (flags.astype(np.uint8) != flags).any() or (flags > 1).any():
        raise ValueError(f"pinned is an array of {flags.dtype} with other values than 0 and 1; expected flags")
    return np.require(flags, np.uint8, ["C", "A"])


def group_option(name: str, values: ArrayLike | None, vertices: int) -> Any:
    if values is None:
        return None
    array = as_array(name, values)
    check_shape(name, array, (vertices,))
    if array.size and array.dtype.kind not in "iu":
        raise TypeError(f"{name} is an array of {array.dtype}; expected integers")
    if array.size and not (-2**31 <= array.min() and array.max() < 2**31):
        raise ValueError(f"range of {name} is [{array.min()}, {array.max()}]; expected int32")
    return np.require(array, np.int32, ["C", "A"])
