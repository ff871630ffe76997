"""Files of meshes (PLY, OBJ), of stored queries (CSV) and of steps to look at (HTML, VTP, PVD),
coordinates bit for bit.

FileError, a ValueError, names file, line or element, found and expected. Files are written whole or
not at all.
"""
from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any, Literal, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._arrays import Doubles, Indices, as_array, check_finite, checked_indices, doubles, frames, option
from ._results import StepResult
from .ccd import POINTS, Kind

FileError = _native.FileError
StoredKind = Literal["vertex_face", "edge_edge"]


def _name(path: str | os.PathLike[str]) -> str:
    name = os.fsdecode(path)
    if "\0" in name or any("\ud800" <= c <= "\udfff" for c in name):
        raise FileError(f"{path!r}: found a null character or one that is not of UTF-8, expected none")
    return name


@dataclass(frozen=True, eq=False, repr=False)
class Mesh:
    """One frame: vertices (n, 3) float64; faces (m, 3) and edges beside the faces' (k, 2), uint32."""
    vertices: Doubles
    faces: Indices
    edges: Indices = field(default_factory=lambda: np.empty((0, 2), np.uint32))

    @property
    def unused_vertices(self) -> NDArray[np.intp]:
        """The vertices that no face and no edge has, ascending. A step takes them as points, or skips them
        with skip_unused."""
        used = np.zeros(len(self.vertices), np.bool_)
        used[self.faces], used[self.edges] = True, True
        return np.flatnonzero(~used)

    def __repr__(self) -> str:
        unused = len(self.unused_vertices)
        return (f"<io.Mesh of {len(self.vertices)} vertices{f' ({unused} unused)' if unused else ''}, "
                f"{len(self.faces)} faces, {len(self.edges)} edges>")


@dataclass(frozen=True, eq=False, repr=False)
class Queries:
    """Stored queries (n, 8, 3) float64, as ccd.decide takes them; truth (n,) bool, or None."""
    queries: Doubles
    kind: StoredKind
    truth: NDArray[np.bool_] | None

    def __repr__(self) -> str:
        known = "without truth" if self.truth is None else f"of which {np.count_nonzero(self.truth)} collide"
        return f"<io.Queries: {len(self.queries)} {self.kind}, {known}>"


def read_mesh(path: str | os.PathLike[str], *, triangulate: bool = False) -> Mesh:
    """A PLY (ascii or binary) or OBJ file of triangles, edges and points.

    With triangulate, a face with more than three corners is split into the triangles (c0, c1, c2),
    (c0, c2, c3), ...; otherwise it is a FileError.
    """
    return Mesh(*_native.read_mesh(_name(path), option("triangulate", triangulate, bool)))


def write_mesh(path: str | os.PathLike[str], vertices: ArrayLike, faces: ArrayLike,
               edges: ArrayLike = ()) -> None:
    """A binary PLY file in double precision, NAME.ply. Indices out of range are an IndexError."""
    name = _name(path)
    if not name.lower().endswith(".ply"):
        raise ValueError(f"path: found {name!r}, expected a name that ends in .ply")
    points = doubles("vertices", vertices, (None, 3))
    check_finite("vertices", points)
    of_faces = checked_indices("faces", faces, 3, len(points))
    of_edges = checked_indices("edges", edges, 2, len(points))
    _native.write_mesh(name, points, of_faces, of_edges)


def read_queries(path: str | os.PathLike[str], kind: StoredKind | None = None, *,
                 round: bool = False) -> Queries:
    """Vertex/face or edge/edge queries, eight rows each: four points at t = 0, then at t = 1.

    Rows are rationals, decimal or hexadecimal floats (docs/program.md); truth is their last column, or
    in the JSON file beside them. Stores, as `ccd convert` makes them, are read by h5py, if it is installed. kind, "vertex_face" or "edge_edge", is told from the path if None. With
    round, numbers that no double equals are rounded instead of refused.
    """
    name = _name(path)
    if _is_store(name):
        return _read_store(name, kind)
    short = None if kind is None else {"vertex_face": "vf", "edge_edge": "ee"}.get(kind)
    if kind is not None and short is None:
        raise ValueError(f"kind: found {kind!r}, expected 'vertex_face' or 'edge_edge'")
    found, rows, truth = _native.read_queries(name, short, round)
    queries = rows.reshape(-1, 4, 2, 3).swapaxes(1, 2).reshape(-1, 8, 3)
    return Queries(queries, found, None if truth is None else truth.view(np.bool_))


def _is_store(name: str) -> bool:
    try:
        if not os.path.isfile(name):
            return False
        with open(name, "rb") as file:
            return file.read(8) == b"\x89HDF\r\n\x1a\n"
    except OSError:
        return False  # told by who reads it


def _read_store(name: str, kind: StoredKind | None) -> Queries:
    """A store of queries, whose layout docs/program.md has."""
    try:
        h5py: Any = import_module("h5py")
    except ImportError:
        raise FileError(f"{name}: found an HDF5 file, expected CSV, or h5py installed (pip install h5py)") from None
    def dataset(of: str) -> Any:
        """One of the file itself, in chunks that fit in memory. A link is not followed."""
        if file.id.links.get_info(of.encode()).type != h5py.h5l.TYPE_HARD:
            raise ValueError(f"dataset {of}: found a link to another place, expected it in this file")
        if file[of].chunks is None or math.prod(file[of].chunks) * file[of].dtype.itemsize > 2**26:
            raise ValueError(f"dataset {of}: found no chunks or larger ones, expected chunks of at most 64 MiB")
        return file[of]

    try:
        with h5py.File(name) as file:
            stored = bytes(file.attrs["kind"]).decode()
            truth = dataset("truth")[:] if file.id.links.exists(b"truth") else None
            rows = {of: dataset(of) for of in ("points", "queries", "first_point")}
            chunks = [_chunk(rows, c) for c in range(math.ceil(len(rows["queries"]) / 65536))]
    except (OSError, KeyError, IndexError, RuntimeError, TypeError, ValueError) as error:
        raise FileError(f"{name}: found no whole store of queries ({error})") from None
    if stored not in ("vertex_face", "edge_edge"):
        raise FileError(f"{name}: attribute kind: found {stored!r}, expected 'vertex_face' or 'edge_edge'")
    if kind not in (None, stored):
        raise FileError(f"{name}: found queries of kind {stored}, expected {kind}")
    points = np.concatenate(chunks)
    queries = points.reshape(-1, 4, 2, 3).swapaxes(1, 2).reshape(-1, 8, 3)
    return Queries(queries, cast(StoredKind, stored), None if truth is None else truth.astype(bool))


def _chunk(file: dict[str, Any], c: int) -> NDArray[Any]:
    """Return a chunk's points by query."""
    begin, end = map(int, file["first_point"][c:c + 2])
    return np.asarray(file["points"][begin:end][file["queries"][65536 * c:65536 * (c + 1)]])


def write_queries(path: str | os.PathLike[str], queries: ArrayLike,
                  truth: ArrayLike | None = None) -> None:
    """Queries (n, 8, 3) as rows of hexadecimal floats, exactly; truth (n,) as a fourth column.

    In CSV: `ccd convert` makes a store (.h5, .hdf5) of it; such a path is refused.
    """
    if _name(path).lower().endswith((".h5", ".hdf5")):
        raise ValueError(f"path is {_name(path)!r}; expected the name of a CSV file (`ccd convert` writes HDF5)")
    array = doubles("queries", queries, (None, 8, 3))
    check_finite("queries", array)
    if len(array) == 0:
        raise ValueError("queries: found none, expected one or more (an empty file is refused when it is read)")
    known = None if truth is None else as_array("truth", truth)
    if known is not None and known.size and (known.dtype.kind not in "biu" or (known != known.astype(bool)).any()):
        raise TypeError(f"truth is an array of {known.dtype}; expected booleans, or 0 and 1")
    if known is not None and known.shape != array.shape[:1]:
        raise ValueError(f"truth: found shape {known.shape}, expected ({len(array)},)")
    lines = []
    for i, query in enumerate(array.tolist()):
        end = "" if known is None else f",{int(known[i])}"
        lines += [",".join(map(float.hex, row)) + end + "\n" for row in query]
    _native.write_text(_name(path), "".join(lines))


def _checked_mesh(before: Mesh, after: Mesh) -> tuple[Doubles, Doubles, Indices, Indices]:
    """Both frames' positions, and their faces and edges."""
    for name, mesh in ("before", before), ("after", after):
        if not isinstance(mesh, Mesh):
            raise TypeError(f"{name}: found {type(mesh).__name__}, expected an io.Mesh")
    at_start, at_end = frames(before.vertices, after.vertices)
    check_finite("before", at_start)
    check_finite("after", at_end)
    faces = checked_indices("faces", before.faces, 3, len(at_start))
    edges = checked_indices("edges", before.edges, 2, len(at_start))
    for name, found, others in ("faces", faces, after.faces), ("edges", edges, after.edges):
        if not np.array_equal(found, checked_indices(name, others, found.shape[1], len(at_start))):
            raise ValueError(f"after: found other {name}, expected those of before")
    return at_start, at_end, faces, edges


def _checked_result(result: StepResult, vertices: int) -> tuple[dict[Kind, Indices], dict[Kind, Doubles]]:
    """Pairs by kind; times, rows of low and high, where there are any."""
    if not isinstance(result, StepResult):
        raise TypeError(f"result: found {type(result).__name__}, expected what ccd.step returns")
    pairs, times = {}, {}
    for kind, points in POINTS.items():
        pairs[kind] = checked_indices(f"result.pairs.{kind}", getattr(result.pairs, kind), points, vertices)
        if result.times is not None:
            times[kind] = np.column_stack([result.times[kind]["low"], result.times[kind]["high"]])
    return pairs, times


def write_view(path: str | os.PathLike[str], before: Mesh, after: Mesh, result: StepResult) -> None:
    """A step to look at, with times if result has them; the name's end says how.

    NAME.html: a page for a browser, whole in itself. For ParaView: NAME.vtp, the frame before, with each
    vertex's displacement; NAME.pvd, both frames, in NAME-0.vtp and NAME-1.vtp. What the arrays in them
    mean: docs/program.md. Faces and edges are the same in both frames, else ValueError; indices out of
    range are an IndexError.
    """
    at_start, at_end, faces, edges = _checked_mesh(before, after)
    pairs, times = _checked_result(result, len(at_start))
    _native.write_view(_name(path), at_start, at_end, faces, edges, pairs, times)


def write_pvd(path: str | os.PathLike[str], times: ArrayLike, files: Sequence[str | os.PathLike[str]]) -> None:
    """A series for ParaView: of files, as write_view's NAME.vtp, and the time of each.

    It holds the way to them from its own folder: move them together.
    """
    moments = doubles("times", times, (None,))
    if len(moments) != len(files):
        raise ValueError(f"files: found {len(files)}, expected {len(moments)}, one a time")
    check_finite("times", moments)
    folder = os.path.dirname(os.path.abspath(path))
    _native.write_pvd(_name(path), moments.tolist(), [os.path.relpath(file, folder) for file in files])
