"""Files of meshes (PLY, OBJ), of queries (CSV, HDF5) and for viewers (HTML, VTP, PVD). Coordinates are exact.

FileError, a ValueError, reports file, line or element, the value and the expected one. Files are written whole or
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
from ._results import Intersections, StepResult
from .ccd import POINTS, Kind

FileError = _native.FileError
StoredKind = Literal["vertex_face", "edge_edge"]


def _name(path: str | os.PathLike[str]) -> str:
    name = os.fsdecode(path)
    if "\0" in name or any("\ud800" <= c <= "\udfff" for c in name):
        raise FileError(f"path is {path!r}; expected a name without null characters, in UTF-8")
    return name


@dataclass(frozen=True, eq=False, repr=False)
class Mesh:
    """One frame: vertices (n, 3) float64; faces (m, 3) and additional edges (k, 2), uint32."""
    vertices: Doubles
    faces: Indices
    edges: Indices = field(default_factory=lambda: np.empty((0, 2), np.uint32))

    @property
    def unused_vertices(self) -> NDArray[np.intp]:
        """The vertices without faces and edges, ascending. A step treats them as points; skip_unused skips them."""
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
    """Reads a PLY (ascii or binary) or OBJ file of triangles, edges and points.

    With triangulate, a face with more than three corners is split into the triangles (c0, c1, c2), (c0, c2, c3), ...
    Throws: FileError, also for such a face without triangulate.
    """
    return Mesh(*_native.read_mesh(_name(path), option("triangulate", triangulate, bool)))


def write_mesh(path: str | os.PathLike[str], vertices: ArrayLike, faces: ArrayLike,
               edges: ArrayLike = ()) -> None:
    """Writes a binary PLY file, NAME.ply, in double precision. Throws: IndexError for indices out of range."""
    name = _name(path)
    if not name.lower().endswith(".ply"):
        raise ValueError(f"path is {name!r}; expected a name that ends in .ply")
    points = doubles("vertices", vertices, (None, 3))
    check_finite("vertices", points)
    of_faces = checked_indices("faces", faces, 3, len(points))
    of_edges = checked_indices("edges", edges, 2, len(points))
    _native.write_mesh(name, points, of_faces, of_edges)


def read_queries(path: str | os.PathLike[str], kind: StoredKind | None = None, *,
                 round: bool = False) -> Queries:
    """Reads vertex/face or edge/edge queries, eight rows each: four points at t = 0, then at t = 1.

    Rows are rationals, decimal or hexadecimal floats (docs/program.md). truth is their last column, or is read from
    the JSON file next to the CSV file. HDF5 stores, written by `ccd convert`, require h5py.
    kind: "vertex_face" or "edge_edge"; None: derived from the path.
    round: rounds numbers that no double equals; they are errors otherwise.
    """
    name = _name(path)
    if _is_store(name):
        return _read_store(name, kind)
    short = None if kind is None else {"vertex_face": "vf", "edge_edge": "ee"}.get(kind)
    if kind is not None and short is None:
        raise ValueError(f"kind is {kind!r}; expected 'vertex_face' or 'edge_edge'")
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
        return False  # the reader reports the error


def _read_store(name: str, kind: StoredKind | None) -> Queries:
    try:
        h5py: Any = import_module("h5py")
    except ImportError:
        raise FileError(f"{name} is an HDF5 file; expected CSV, or h5py installed (pip install h5py)") from None

    def dataset(of: str) -> Any:
        """Returns a dataset of the file, in chunks that fit in memory. Links are not followed."""
        if file.id.links.get_info(of.encode()).type != h5py.h5l.TYPE_HARD:
            raise ValueError(f"dataset {of} is a link; expected data in this file")
        if file[of].chunks is None or math.prod(file[of].chunks) * file[of].dtype.itemsize > 2**26:
            raise ValueError(f"dataset {of} has no chunks or larger ones; expected chunks of at most 64 MiB")
        return file[of]

    try:
        with h5py.File(name) as file:
            stored = bytes(file.attrs["kind"]).decode()
            truth = dataset("truth")[:] if file.id.links.exists(b"truth") else None
            rows = {of: dataset(of) for of in ("points", "queries", "first_point")}
            chunks = [_chunk(rows, c) for c in range(math.ceil(len(rows["queries"]) / 65536))]
    except (OSError, KeyError, IndexError, RuntimeError, TypeError, ValueError) as error:
        raise FileError(f"{name} is not a complete store of queries ({error})") from None
    if stored not in ("vertex_face", "edge_edge"):
        raise FileError(f"{name}: attribute kind is {stored!r}; expected 'vertex_face' or 'edge_edge'")
    if kind not in (None, stored):
        raise FileError(f"{name}: kind of queries is {stored}; expected {kind}")
    points = np.concatenate(chunks)
    queries = points.reshape(-1, 4, 2, 3).swapaxes(1, 2).reshape(-1, 8, 3)
    return Queries(queries, cast(StoredKind, stored), None if truth is None else truth.astype(bool))


def _chunk(file: dict[str, Any], c: int) -> NDArray[Any]:
    """Returns a chunk's points by query."""
    begin, end = map(int, file["first_point"][c:c + 2])
    return np.asarray(file["points"][begin:end][file["queries"][65536 * c:65536 * (c + 1)]])


def write_queries(path: str | os.PathLike[str], queries: ArrayLike,
                  truth: ArrayLike | None = None) -> None:
    """Writes queries (n, 8, 3) as CSV rows of hexadecimal floats, exactly; truth (n,) is a fourth column.

    `ccd convert` writes HDF5 stores. Throws: ValueError for a path that ends in .h5 or .hdf5.
    """
    if _name(path).lower().endswith((".h5", ".hdf5")):
        raise ValueError(f"path is {_name(path)!r}; expected the name of a CSV file (`ccd convert` writes HDF5)")
    array = doubles("queries", queries, (None, 8, 3))
    check_finite("queries", array)
    if len(array) == 0:
        raise ValueError("number of queries is 0; expected one or more (empty files cannot be read)")
    known = None if truth is None else as_array("truth", truth)
    if known is not None and known.size and (known.dtype.kind not in "biu" or (known != known.astype(bool)).any()):
        raise TypeError(f"truth is an array of {known.dtype}; expected booleans, or 0 and 1")
    if known is not None and known.shape != array.shape[:1]:
        raise ValueError(f"shape of truth is {known.shape}; expected ({len(array)},)")
    lines = []
    for i, query in enumerate(array.tolist()):
        end = "" if known is None else f",{int(known[i])}"
        lines += [",".join(map(float.hex, row)) + end + "\n" for row in query]
    _native.write_text(_name(path), "".join(lines))


def _checked_mesh(before: Mesh, after: Mesh) -> tuple[Doubles, Doubles, Indices, Indices]:
    for name, mesh in ("before", before), ("after", after):
        if not isinstance(mesh, Mesh):
            raise TypeError(f"{name} is {type(mesh).__name__}; expected an io.Mesh")
    at_start, at_end = frames(before.vertices, after.vertices)
    check_finite("before", at_start)
    check_finite("after", at_end)
    faces = checked_indices("faces", before.faces, 3, len(at_start))
    edges = checked_indices("edges", before.edges, 2, len(at_start))
    for name, found, others in ("faces", faces, after.faces), ("edges", edges, after.edges):
        if not np.array_equal(found, checked_indices(name, others, found.shape[1], len(at_start))):
            raise ValueError(f"{name} of after differ; expected those of before")
    return at_start, at_end, faces, edges


def _checked_result(result: StepResult, vertices: int) -> tuple[dict[Kind, Indices], dict[Kind, Doubles]]:
    if not isinstance(result, StepResult):
        raise TypeError(f"result is {type(result).__name__}; expected a ccd.StepResult")
    pairs, times = {}, {}
    for kind, points in POINTS.items():
        pairs[kind] = checked_indices(f"result.pairs.{kind}", getattr(result.pairs, kind), points, vertices)
        if result.times is not None:
            times[kind] = np.column_stack([result.times[kind]["low"], result.times[kind]["high"]])
    return pairs, times


def _checked_intersections(found: Intersections | None, vertices: int) -> dict[str, tuple[Any, Any, Any]]:
    if found is None:
        return {}
    return {kind: (checked_indices(f"result.intersections_at_start.{kind}", of.vertices, of.vertices.shape[1], vertices),
                   of.relation, of.segment.reshape(-1, 6)) for kind, of in found.by_kind.items()}


def write_view(path: str | os.PathLike[str], before: Mesh, after: Mesh, result: StepResult) -> None:
    """Writes a step for a viewer, with times if result has them. The file's extension selects the format.

    NAME.html: a self-contained page for a browser. For ParaView: NAME.vtp, the frame before with displacements, or
    NAME.pvd, both frames in NAME-0.vtp and NAME-1.vtp. Their arrays are described in docs/program.md.
    Throws: ValueError if faces or edges of the frames differ; IndexError for indices out of range.
    """
    at_start, at_end, faces, edges = _checked_mesh(before, after)
    pairs, times = _checked_result(result, len(at_start))
    _native.write_view(_name(path), at_start, at_end, faces, edges, pairs, times,
                       _checked_intersections(result.intersections_at_start, len(at_start)))


def write_pvd(path: str | os.PathLike[str], times: ArrayLike, files: Sequence[str | os.PathLike[str]]) -> None:
    """Writes a series for ParaView: files such as write_view's NAME.vtp, with a time each.

    Paths are relative to the folder of the series. Move all of them together.
    """
    moments = doubles("times", times, (None,))
    if len(moments) != len(files):
        raise ValueError(f"number of files is {len(files)}; expected {len(moments)}, one per time")
    check_finite("times", moments)
    folder = os.path.dirname(os.path.abspath(path))
    _native.write_pvd(_name(path), moments.tolist(), [os.path.relpath(file, folder) for file in files])
