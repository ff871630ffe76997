"""Files of meshes (PLY, OBJ) and of stored queries (CSV), coordinates bit for bit.

FileError, a ValueError, names file, line or element, found and expected. Files are written whole or
not at all.
"""
from __future__ import annotations

import os
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._arrays import Doubles, Indices, check_finite, check_range, doubles, indices

FileError = _native.FileError


@dataclass(frozen=True, eq=False)
class Mesh:
    """One frame: vertices (n, 3) float64; faces (m, 3) and edges beside the faces' (k, 2), uint32."""
    vertices: Doubles
    faces: Indices
    edges: Indices


@dataclass(frozen=True, eq=False)
class Queries:
    """Stored queries (n, 8, 3) float64, as ccd.decide takes them; truth (n,) bool, or None."""
    queries: Doubles
    kind: str
    truth: NDArray[np.bool_] | None


def read_mesh(path: str | os.PathLike[str]) -> Mesh:
    """A PLY (ascii or binary) or OBJ file of triangles, edges and points."""
    return Mesh(*_native.read_mesh(os.fspath(path)))


def write_mesh(path: str | os.PathLike[str], vertices: ArrayLike, faces: ArrayLike,
               edges: ArrayLike = ()) -> None:
    """A binary PLY file in double precision. Indices out of range are an IndexError."""
    points = doubles("vertices", vertices, (None, 3))
    check_finite("vertices", points)
    of_faces, of_edges = indices("faces", faces, 3), indices("edges", edges, 2)
    check_range("faces", of_faces, len(points))
    check_range("edges", of_edges, len(points))
    _native.write_mesh(os.fspath(path), points, of_faces, of_edges)


def read_queries(path: str | os.PathLike[str], kind: str | None = None, *,
                 round: bool = False) -> Queries:
    """Vertex/face or edge/edge queries, eight rows each: four points at t = 0, then at t = 1.

    Rows are rationals, decimal or hexadecimal floats (docs/program.md); truth is their last column, or
    in the JSON file beside them. kind, "vertex_face" or "edge_edge", is told from the path if None. With
    round, numbers that no double equals are rounded instead of refused.
    """
    short = None if kind is None else {"vertex_face": "vf", "edge_edge": "ee"}.get(kind)
    if kind is not None and short is None:
        raise ValueError(f"kind: found {kind!r}, expected 'vertex_face' or 'edge_edge'")
    name, rows, truth = _native.read_queries(os.fspath(path), short, round)
    queries = rows.reshape(-1, 4, 2, 3).swapaxes(1, 2).reshape(-1, 8, 3)
    return Queries(queries, name, None if truth is None else truth.view(np.bool_))


def write_queries(path: str | os.PathLike[str], queries: ArrayLike,
                  truth: ArrayLike | None = None) -> None:
    """Queries (n, 8, 3) as rows of hexadecimal floats, exactly; truth (n,) as a fourth column."""
    array = doubles("queries", queries, (None, 8, 3))
    check_finite("queries", array)
    known = None if truth is None else np.asarray(truth, np.bool_)
    if known is not None and known.shape != array.shape[:1]:
        raise ValueError(f"truth: found shape {known.shape}, expected ({len(array)},)")
    lines = []
    for i, query in enumerate(array.tolist()):
        end = "" if known is None else f",{int(known[i])}"
        lines += [",".join(map(float.hex, row)) + end + "\n" for row in query]
    _native.write_text(os.fspath(path), "".join(lines))
