"""Steps of meshes that are distributed over MPI ranks, with mpi4py's communicators.

Wheels are built without MPI. Build errbound in the source tree, with the MPI of mpi4py:

    pip install --config-settings cmake.define.ERRBOUND_WITH_MPI=ON . mpi4py

Each rank passes the index in the whole mesh of each of its vertices, (n,), distinct integers >= 0; their positions
(n, 3) before and after; faces (m, 3) and edges (k, 2), whose indices are rows of these positions. Several ranks
may pass a vertex, with equal positions. Several ranks may pass a face or an edge; duplicates count once. Results
equal those of errbound.ccd for the whole mesh, for every distribution. All calls are collective.
An error on one rank is raised on all.
"""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

try:
    from mpi4py import MPI
except ImportError:
    raise ImportError("errbound.mpi needs the package mpi4py: pip install mpi4py") from None
try:
    _mpi: Any = import_module("errbound._mpi")
except ImportError as missing:
    raise ImportError("errbound is built without MPI, or its MPI is missing; expected a build with the installed MPI: "
                      "pip install --no-binary errbound "
                      f"--config-settings cmake.define.ERRBOUND_WITH_MPI=ON errbound ({missing})") from None

from ._arrays import as_array, checked_indices, frames, option
from ._results import Intersections, _listed, at_start, intersections_of
from .ccd import _OF_ADVANCE, _OF_INTERSECTIONS, _OF_RUN, _request

__all__ = ["AdvanceResult", "IntersectionResult", "Pairs", "StepResult", "Work", "advance", "intersections", "step"]

if _mpi.library_version() != MPI.Get_library_version().rstrip("\0"):
    raise ImportError(f"MPI of mpi4py is {MPI.Get_library_version()!r}; expected the one that errbound is built with, "
                      f"{_mpi.library_version()!r}")

Numbers = NDArray[np.uint64]
_OF_STEP = {name: kind for name, kind in _OF_RUN.items() if name not in ("can_collide", "stages")}
_OF_FREE_STEP = {name: kind for name, kind in _OF_ADVANCE.items() if name not in ("can_collide", "each_vertex")}
_AT_REST = {name: kind for name, kind in _OF_INTERSECTIONS.items()
            if name not in ("can_collide", "edge_faces", "merge_equal_positions")}


@dataclass(frozen=True, eq=False, repr=False)
class Pairs:
    """Same as errbound.ccd.Pairs, with uint64 numbers of vertices in the whole mesh."""
    vertex_face: Numbers
    edge_edge: Numbers
    vertex_edge: Numbers
    vertex_vertex: Numbers

    def __len__(self) -> int:
        return sum(map(len, (self.vertex_face, self.edge_edge, self.vertex_edge, self.vertex_vertex)))

    def __repr__(self) -> str:
        return f"<mpi.Pairs, {_listed(self)}>"


@dataclass(frozen=True)
class Work:
    """The work of this rank: elements passed by it, elements stored on it, bytes sent to other ranks, seconds."""
    elements_given: int
    elements_held: int
    bytes_sent: int
    seconds: float


@dataclass(frozen=True, eq=False)
class StepResult:
    """The pairs of this rank (with gather: all on rank 0); first_contact and candidates of the whole step."""
    pairs: Pairs
    touching_at_start: Pairs
    times: dict[str, dict[str, NDArray[np.float64]]] | None
    first_contact: tuple[float, float] | None
    candidates: dict[str, int] | None
    intersections_at_start: Intersections | None
    work: Work


@dataclass(frozen=True, eq=False)
class AdvanceResult:
    """Positions (n, 3) and fractions (n,) of this rank's vertices; other members describe the whole mesh."""
    positions: NDArray[np.float64]
    fraction: float
    fractions: NDArray[np.float64]
    first_contact: tuple[float, float] | None
    touching_at_start: Pairs
    near_at_start: Pairs
    first_pairs: Pairs
    intersections_at_start: Intersections | None
    work: Work


@dataclass(frozen=True, eq=False)
class IntersectionResult:
    """The intersections of this rank (with gather: all on rank 0), and their total number in the whole mesh."""
    pairs: Intersections
    total: int
    work: Work


def _agreed(comm: MPI.Comm, make: Callable[[], Any]) -> Any:
    """Returns make(). An exception on one rank is raised on all, so that none waits for another."""
    failure: Exception | None = None
    made = None
    try:
        made = make()
    except (ValueError, TypeError, IndexError) as error:
        failure = error
    for rank, failed in enumerate(comm.allgather(failure)):
        if failed is not None:
            raise type(failed)(f"rank {rank}: {failed}")
    return made


def _checked(comm: MPI.Comm, numbers: ArrayLike, before: ArrayLike, after: ArrayLike, faces: ArrayLike,
             edges: ArrayLike, known: dict[str, Any], options: dict[str, Any]) -> tuple[Any, Any]:
    if not isinstance(comm, MPI.Comm):
        raise TypeError(f"comm is {comm!r}; expected a communicator of mpi4py")

    def make() -> tuple[Any, Any]:
        at_start, at_end = frames(before, after)
        vertices = len(at_start)
        of_vertices = as_array("numbers", numbers)
        if of_vertices.size and of_vertices.dtype.kind not in "iu":
            raise TypeError(f"numbers is an array of {of_vertices.dtype}; expected integers")
        if of_vertices.shape != (vertices,):
            raise ValueError(f"shape of numbers is {of_vertices.shape}; expected ({vertices},), one per row of before")
        if of_vertices.size and of_vertices.min() < 0:
            raise ValueError(f"minimum of numbers is {of_vertices.min()}; expected numbers >= 0")
        of_faces = checked_indices("faces", faces, 3, vertices)
        of_edges = checked_indices("edges", edges, 2, vertices)
        mesh = _mpi.Mesh(comm.py2f(), np.require(of_vertices, np.uint64, ["C", "A"]), at_start, at_end, of_faces,
                         of_edges)
        return mesh, _request(vertices, known, options)

    found: tuple[Any, Any] = _agreed(comm, make)
    return found


def step(comm: MPI.Comm, numbers: ArrayLike, before: ArrayLike, after: ArrayLike, faces: ArrayLike,
         edges: ArrayLike = (), *, gather: bool = False, **options: Any) -> StepResult:
    """Finds the pairs of one step of the whole mesh that are not certainly separate.

    Each pair is returned on the lowest rank that has its first element; with gather, all on rank 0.
    Options: as errbound.ccd.Steps.run, except can_collide and stages, and equal on all ranks. groups, pinned and
    thickness have one item per vertex of this rank.
    """
    gather = option("gather", gather, bool)
    found = _mpi.step(*_checked(comm, numbers, before, after, faces, edges, _OF_STEP, options), gather)
    for name in "pairs", "touching_at_start":
        found[name] = Pairs(**found[name])
    found["intersections_at_start"] = at_start(found["intersections_at_start"])
    return StepResult(**{**found, "work": Work(**found["work"])})


def advance(comm: MPI.Comm, numbers: ArrayLike, before: ArrayLike, after: ArrayLike, faces: ArrayLike,
            edges: ArrayLike = (), **options: Any) -> AdvanceResult:
    """Computes the longest step of the whole mesh found to be free, bit for bit that of errbound.ccd.advance.

    Options: as errbound.ccd.Steps.advance, except can_collide and each_vertex. Island numbers are common to all ranks.
    """
    found = _mpi.advance(*_checked(comm, numbers, before, after, faces, edges, _OF_FREE_STEP, options))
    for name in "first_pairs", "touching_at_start", "near_at_start":
        found[name] = Pairs(**found[name])
    found["intersections_at_start"] = at_start(found["intersections_at_start"])
    return AdvanceResult(**{**found, "work": Work(**found["work"])})


def intersections(comm: MPI.Comm, numbers: ArrayLike, positions: ArrayLike, faces: ArrayLike, edges: ArrayLike = (),
                  *, gather: bool = False, **options: Any) -> IntersectionResult:
    """Finds the elements of the whole mesh that intersect at rest, as errbound.ccd.intersections.

    Each pair is returned on the lowest rank that has its first vertex; with gather, all on rank 0.
    Options: segments and FilterOptions, except can_collide; equal on all ranks.
    """
    gather = option("gather", gather, bool)
    found = _mpi.intersections(*_checked(comm, numbers, positions, positions, faces, edges, _AT_REST, options), gather)
    return IntersectionResult(intersections_of(found["pairs"]), found["total"], Work(**found["work"]))
