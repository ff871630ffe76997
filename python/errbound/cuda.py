"""Collision detection of arrays in the memory of a CUDA device: decide, first_time, step and Steps of errbound.ccd.

Wheels are built without CUDA. Where nvcc is, python/package.sh --cuda builds one with it.

Arguments are arrays of CuPy, JAX, Numba, PyTorch, or others with __dlpack__ or __cuda_array_interface__ (version 2 or
3), all on one device. Positions are float64 or float32, (n, 3), with strides >= 0. Vertex indices of queries are int32
or uint32, (n, 4), in contiguous rows or columns. They are not checked: an index out of range is undefined behaviour.
stream: the queue of the device's work, an int (cudaStream_t), an object of CuPy, PyTorch or cuda.core, or None for the
default stream. A call orders its work after that of the arrays' streams, and returns when its results are complete.
precision: the numbers that a method tries first, "float64" or "float32". Outcomes of "exact" do not depend on it.
Errors: as in errbound.ccd, and RuntimeError for errors of CUDA.
"""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from ._arrays import check_shape, checked_indices, end_time, option, restated

__all__ = ["Array", "Decisions", "FirstTimes", "Kind", "MethodName", "Pairs", "Precision", "StepResult", "Steps",
           "available", "decide", "first_time", "step"]

_cuda: Any = None
try:
    _cuda, _missing = import_module("errbound._cuda"), ""
except ImportError as _error:
    _missing = str(_error)

Kind = Literal["vertex_face", "edge_edge"]
MethodName = Literal["float", "safe", "tight", "safeccd", "safeccd-tight", "exact"]
Precision = Literal["float64", "float32"]
_REALS = "float64", "float32"
_ON_DEVICE = 2, 13  # DLPack's types of devices: CUDA's memory, managed or not
_CODES = {0: "int", 1: "uint", 2: "float", 4: "bfloat", 5: "complex", 6: "bool"}


def available() -> bool:
    """True if errbound is built with CUDA and there is a device."""
    return _cuda is not None and not _cuda.fault()


def _require_device() -> None:
    if _cuda is None:
        raise RuntimeError(f"errbound is built without CUDA ({_missing}); expected a build where nvcc is, by "
                           "python/package.sh --cuda in the source tree, or by pip install --no-binary errbound "
                           "--config-settings cmake.define.ERRBOUND_WITH_CUDA=ON errbound")
    if fault := _cuda.fault():
        raise RuntimeError(f"{fault}; expected a CUDA device")


class Array:
    """An array in device memory, which it owns. Readers need no stream, since it is complete.

    cupy.asarray(x), torch.from_dlpack(x) and numba.cuda.as_cuda_array(x) do not copy it. Its memory is freed with the
    last reader. Freeing waits for the device, so queued work may use it.
    """

    def __init__(self, memory: Any, dtype: str, columns: tuple[int, ...] = (), offset: int = 0, row: int = 0) -> None:
        self._memory, self._offset, self.dtype = memory, offset, np.dtype(dtype)
        row = row or self.dtype.itemsize * math.prod(columns)
        self.shape: tuple[int, ...] = (memory.bytes // row, *columns)
        self._strides = (row, self.dtype.itemsize)[:len(self.shape)]

    def __len__(self) -> int:
        return self.shape[0]

    def __repr__(self) -> str:
        return f"<cuda.Array of shape {self.shape}, {self.dtype}, on device {self._memory.device}>"

    @property
    def __cuda_array_interface__(self) -> dict[str, Any]:
        address = self._memory.address + self._offset if len(self) else 0
        return {"shape": self.shape, "typestr": self.dtype.str, "data": (address, False), "strides": self._strides,
                "version": 3, "stream": None}

    def __dlpack_device__(self) -> tuple[int, int]:
        return _ON_DEVICE[0], self._memory.device

    def __dlpack__(self, *, stream: Any = None, max_version: tuple[int, int] | None = None,
                   dl_device: tuple[int, int] | None = None, copy: bool | None = None) -> Any:
        if copy or dl_device not in (None, self.__dlpack_device__()):
            raise BufferError(f"copy is {copy}, dl_device is {dl_device}; expected no copy, and the array's device")
        size, code = self.dtype.itemsize, {"u": 1, "f": 2}[self.dtype.kind]
        return _cuda.capsule_of(self._memory, self._offset, self.shape, [n // size for n in self._strides], code,
                                8 * size)

    def numpy(self) -> NDArray[Any]:
        """Returns a copy on the host."""
        if not len(self):
            return np.empty(self.shape, self.dtype)
        host = np.empty(self._memory.bytes, np.uint8)
        _cuda.read(self._memory.device, self._memory.address, host)
        return np.ndarray(self.shape, self.dtype, host, self._offset, self._strides)


@dataclass(frozen=True, eq=False)
class Decisions:
    """One outcome per query: uint8 (n,), values of errbound.ccd.Outcome.

    After "exact", UNCERTAIN marks queries with a coordinate that is not finite.
    """
    outcome: Array


@dataclass(frozen=True, eq=False)
class FirstTimes:
    """The first contact times of the k queries that collide in [0, 1], in order of rows.

    query: uint32 (k,), rows. low, high: float64 (k,), as in errbound.ccd.FirstTimes. outcome: uint8 (k,), COLLIDES;
    SEPARATE if the first time is after t_max; UNCERTAIN if a coordinate is not finite.
    """
    query: Array
    outcome: Array
    low: Array
    high: Array

    def __len__(self) -> int:
        return len(self.query)


@dataclass(frozen=True, eq=False)
class Pairs:
    """Pairs by kind, as sorted rows of uint32 vertex indices, (k, 4)."""
    vertex_face: Array
    edge_edge: Array

    def __len__(self) -> int:
        return len(self.vertex_face) + len(self.edge_edge)


@dataclass(frozen=True, eq=False)
class StepResult:
    """The pairs of a step that are not certainly separate. Members are as in errbound.ccd.StepResult."""
    pairs: Pairs
    touching_at_start: Pairs
    times: dict[str, dict[str, Array]] | None
    first_contact: tuple[float, float] | None
    candidates: dict[str, int]


def _columns_of_times(memory: Any) -> dict[str, Array]:
    """Returns views of an array of ccd::first_time: an outcome, low, high, 24 bytes."""
    return {"outcome": Array(memory, "uint8", (), 0, 24), "low": Array(memory, "float64", (), 8, 24),
            "high": Array(memory, "float64", (), 16, 24)}


def _is_on_device(values: Any) -> bool:
    if hasattr(values, "__dlpack_device__"):
        return values.__dlpack_device__()[0] in _ON_DEVICE
    return hasattr(values, "__dlpack__") or hasattr(values, "__cuda_array_interface__")


class _Input:
    """A checked argument: its memory on a device, and the object that owns it. Strides are in items."""
    shape: tuple[int, ...]
    strides: tuple[int, ...]

    def __init__(self, name: str, values: Any, stream: int, columns: int, dtypes: Sequence[str]) -> None:
        _require_device()
        if not _is_on_device(values):
            raise TypeError(f"{name} is {type(values).__name__} in the host's memory; expected an array on a CUDA "
                            "device, or errbound.ccd for arrays on the host")
        self.name = name
        if hasattr(values, "__dlpack__"):
            self._import_capsule(values, stream)
        else:
            self._import_interface(values, values.__cuda_array_interface__, stream)
        self.ndim = len(self.shape)
        check_shape(name, self, (None, columns))  # type: ignore[arg-type]
        if self.dtype not in dtypes:
            raise TypeError(f"{name} is an array of {self.dtype}; expected {' or '.join(dtypes)}")
        self.itemsize = np.dtype(self.dtype).itemsize
        if len(self) and (self.address % self.itemsize or not self.address):
            raise ValueError(f"address of {name} is {self.address:#x}; expected a multiple of {self.itemsize}, not 0")
        if len(self) == 1:
            self.strides = columns, self.strides[1]
        if len(self) and min(self.strides) < 0:
            raise ValueError(f"strides of {name} are {self.strides} items; expected numbers >= 0")

    def __len__(self) -> int:
        return self.shape[0]

    def _import_capsule(self, values: Any, stream: int) -> None:
        is_ordered = True
        try:
            capsule = values.__dlpack__(stream=stream or 1)  # 1: the default stream
        except TypeError:  # a producer that does not know streams
            capsule, is_ordered = values.__dlpack__(), False
        self._owner = _cuda.Imported(capsule)
        kind, self.device, self.address, (code, bits, lanes), shape, strides = self._owner.description()
        self.shape, self.strides = tuple(shape), tuple(strides)
        self.dtype = f"{_CODES.get(code, code)}{bits}" + f" x {lanes}" * (lanes != 1)
        if kind not in _ON_DEVICE:
            raise TypeError(f"DLPack's device type of {self.name} is {kind}; expected {_ON_DEVICE[0]}, a CUDA device")
        if not is_ordered:
            _cuda.wait(self.device, 0)

    def _import_interface(self, values: Any, found: dict[str, Any], stream: int) -> None:
        producer, mask, of = found.get("stream"), found.get("mask"), f"__cuda_array_interface__ of {self.name}"
        if found["version"] < 2 or producer == 0 or mask is not None:
            raise ValueError(f"{of} has version {found['version']}, stream {producer}, mask {mask}; expected version 2 "
                             "or 3, a stream other than 0, no mask")
        dtype, self._owner, self.shape = np.dtype(found["typestr"]), values, tuple(found["shape"])
        self.dtype = dtype.name if dtype.isnative else dtype.str
        steps = found.get("strides") or [dtype.itemsize * math.prod(self.shape[i + 1:]) for i in range(len(self.shape))]
        if any(step % dtype.itemsize for step in steps):
            raise ValueError(f"strides of {self.name} are {steps} bytes; expected multiples of {dtype.itemsize}")
        self.strides = tuple(step // dtype.itemsize for step in steps)
        self.address = found["data"][0] or 0
        self.device = _cuda.device_of(self.address) if self.address and 0 not in self.shape else None
        if self.device == -1:
            raise ValueError(f"address of {self.name} is {self.address:#x}; expected one in device memory")
        if producer not in (None, stream or 1) and self.device is not None:
            _cuda.wait(self.device, producer)


class _Call:
    """Checked arguments of a call. It keeps the arrays."""

    def __init__(self, before: Any, after: Any, method: str, precision: str, stream: Any) -> None:
        for name, value, known in ("method", method, get_args(MethodName)), ("precision", precision, _REALS):
            if value not in known:
                raise ValueError(f"{name} is {value!r}; expected one of {', '.join(known)}")
        if hasattr(stream, "__cuda_stream__"):
            stream = stream.__cuda_stream__()[1]
        stream = getattr(stream, "cuda_stream", getattr(stream, "ptr", stream))
        self.stream: int = option("stream", 0 if stream is None else stream, int, 2**64)
        self.inputs = [_Input("before", before, self.stream, 3, _REALS), _Input("after", after, self.stream, 3, _REALS)]
        at_start, at_end = self.inputs
        self.vertices, self._options = len(at_start), (method, precision == "float32")
        if len(at_end) != self.vertices:
            raise ValueError(f"number of vertices in after is {len(at_end)}; expected {self.vertices}, as in before")
        if at_end.dtype != at_start.dtype:
            raise TypeError(f"after is an array of {at_end.dtype}; expected {at_start.dtype}, as in before")

    def device(self) -> int:
        found = [x for x in self.inputs if x.device is not None]  # empty arrays may be nowhere
        for x in found:
            if x.device != found[0].device:
                raise ValueError(f"device of {x.name} is {x.device}; expected {found[0].device}, as of {found[0].name}")
        return found[0].device if found else 0

    def run(self, call: Callable[..., Any], *arguments: Any) -> Any:
        frames = [[x.address + k * x.strides[1] * x.itemsize for k in range(3)] + [x.strides[0]]
                  for x in self.inputs[:2]]
        request = _cuda.Request(self.device(), self.stream, *self._options, *frames,
                                self.inputs[0].dtype == "float32", self.vertices)
        try:
            return call(request, *arguments)
        except ValueError as error:
            raise restated(error) from None


def _run_on_queries(call: str, queries: Any, kind: str, positions: Any, method: str, precision: str, stream: Any,
                    *arguments: Any) -> Any:
    """Runs the extension's function whose name is `call` and the kind."""
    if kind not in get_args(Kind):
        raise ValueError(f"kind is {kind!r}; expected one of {', '.join(get_args(Kind))}")
    if not isinstance(positions, (tuple, list)) or len(positions) != 2:
        raise TypeError(f"positions is {type(positions).__name__}; expected a pair (before, after)")
    checked = _Call(positions[0], positions[1], method, precision, stream)
    pairs = _Input("queries", queries, checked.stream, 4, ("int32", "uint32"))
    is_in_rows = pairs.strides == (4, 1) and pairs.address % 16 == 0
    if len(pairs) and not is_in_rows and pairs.strides != (1, len(pairs)):
        raise ValueError(f"queries have strides {pairs.strides} at address {pairs.address:#x}; expected contiguous "
                         "rows at a multiple of 16, or contiguous columns")
    checked.inputs.append(pairs)
    return checked.run(getattr(_cuda, f"{call}_{kind}"), pairs.address, len(pairs), not is_in_rows, *arguments)


def decide(queries: Any, kind: Kind, *, positions: tuple[Any, Any], method: MethodName = "exact",
           precision: Precision = "float64", stream: Any = None) -> Decisions:
    """Decides which queries collide at some t in [0, 1]."""
    return Decisions(Array(_run_on_queries("decide", queries, kind, positions, method, precision, stream), "uint8"))


def first_time(queries: Any, kind: Kind, *, positions: tuple[Any, Any], t_max: float = 1,
               stream: Any = None) -> FirstTimes:
    """Computes the first times in [0, t_max] at which queries touch. Cost: decide, and a time for each contact."""
    found, times = _run_on_queries("first_times", queries, kind, positions, "exact", "float64", stream, end_time(t_max))
    return FirstTimes(Array(found, "uint32"), **_columns_of_times(times))


class Steps:
    """Steps of one mesh on one device. Keeps its faces and its memory from step to step.

    faces: (m, 3), integers on the host or on a device; vertices: their number. All edges are those of faces. Throws:
    ValueError if more than one vertex is on no edge. A call from a second thread throws RuntimeError.
    """

    def __init__(self, faces: Any, *, vertices: int) -> None:
        _require_device()
        self.vertices = option("vertices", vertices, int, 2**32)
        if _is_on_device(faces):
            given = _Input("faces", faces, 0, 3, ("int32", "uint32", "int64", "uint64"))
            if len(given) and given.strides != (3, 1):
                raise ValueError(f"strides of faces are {given.strides} items; expected (3, 1)")
            faces = np.empty(given.shape, given.dtype)
            _cuda.read(given.device or 0, given.address, faces.reshape(-1).view(np.uint8))
        in_order = np.sort(checked_indices("faces", faces, 3, self.vertices))  # as in pairs on the host
        points = self.vertices - len(np.unique(in_order[in_order[:, 0] != in_order[:, 2]]))
        if points > 1:
            raise ValueError(f"number of vertices on no edge is {points}; expected at most 1, since pairs of "
                             "such vertices are not found")
        self._steps = _cuda.Steps(in_order, self.vertices)
        self._device: int | None = None

    def run(self, before: Any, after: Any, *, method: MethodName = "exact", precision: Precision = "float64",
            stream: Any = None, initial_contact: bool = False, first_contact: bool = False, times: bool = False,
            t_max: float = 1) -> StepResult:
        """Finds the pairs that are not certainly separate in the step from before to after, (n, 3) each.

        Options: as errbound.ccd.RunOptions. Throws: ValueError for coordinates that are not finite.
        """
        checked = _Call(before, after, method, precision, stream)
        if checked.vertices != self.vertices:
            raise ValueError(f"number of vertices in before is {checked.vertices}; expected {self.vertices}")
        if self._device not in (None, checked.device()):
            raise ValueError(f"device of before is {checked.device()}; expected {self._device}, as in the first call")
        flags = [option(name, value, bool) for name, value in (
            ("initial_contact", initial_contact), ("first_contact", first_contact), ("times", times))]
        self._device = checked.device()
        of_vertices, of_edges, contact, lists = checked.run(self._steps.run, *flags, end_time(t_max))
        pairs = [Array(memory, "uint32", (4,)) for memory in lists[:4]]
        columns = {kind: _columns_of_times(memory) for kind, memory in zip(get_args(Kind), lists[4:])}
        return StepResult(Pairs(*pairs[:2]), Pairs(*pairs[2:]), columns if times else None, contact,
                          {"vertex_face": of_vertices, "edge_edge": of_edges})


def step(before: Any, after: Any, faces: Any, **options: Any) -> StepResult:
    """Same as Steps.run, for one step of the mesh with these faces, (m, 3). Options: those of Steps.run."""
    return Steps(faces, vertices=len(_Input("before", before, 0, 3, _REALS))).run(before, after, **options)
