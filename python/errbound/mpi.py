"""Steps of meshes that are spread over the ranks of MPI, by mpi4py's communicators.

Import it by name: it needs mpi4py, and an errbound built with the same MPI. Wheels are built without. In the source tree:
pip install --config-settings cmake.define.ERRBOUND_WITH_MPI=ON . mpi4py.

Each rank gives what it has: the numbers of its vertices in the whole mesh, (n,), any whole numbers from 0
that differ, positions (n, 3) before and after, faces (m, 3) and edges (k, 2) by row of these. A vertex may be
on several ranks, with the same positions; a face or an edge, too, and counts once. Results are those of
errbound.ccd of the whole mesh, whatever the number of ranks and who has what. All calls are collective; what
is wrong on one rank is raised on all.
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
    raise ImportError("errbound.mpi: found no mpi4py, expected it to be installed") from None
try:
    _mpi: Any = import_module("errbound._mpi")
except ImportError as missing:
    raise ImportError("errbound.mpi: found an errbound that was built without MPI, or not the MPI that it was "
                      "built with; build it where MPI is: pip install --no-binary errbound "
                      f"--config-settings cmake.define.ERRBOUND_WITH_MPI=ON errbound ({missing})") from None

from ._arrays import as_array, checked_indices, frames, option
from ._results import _listed
from .ccd import _OF_ADVANCE, _OF_RUN, _question

__all__ = ["AdvanceResult", "Pairs", "StepResult", "Work", "advance", "step"]

if _mpi.library_version() != MPI.Get_library_version().rstrip("\0"):
    raise ImportError(f"errbound.mpi: found mpi4py of {MPI.Get_library_version()!r}, expected that of "
                      f"{_mpi.library_version()!r}, which errbound was built with")

Numbers = NDArray[np.uint64]
_OF_STEP = {name: kind for name, kind in _OF_RUN.items() if name not in ("can_collide", "stages")}
_OF_FREE_STEP = {name: kind for name, kind in _OF_ADVANCE.items() if name != "can_collide"}


@dataclass(frozen=True, eq=False, repr=False)
class Pairs:
    """Pairs of the vertices' numbers, uint64, each list sorted, as errbound.ccd.Pairs."""
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
    """What a call took of this rank: elements it gave, and those that it held; bytes to other ranks."""
    elements_given: int
    elements_held: int
    bytes_sent: int
    seconds: float


@dataclass(frozen=True, eq=False)
class StepResult:
    """This rank's pairs (with gather: all on rank 0); first_contact and candidates of the whole step."""
    pairs: Pairs
    touching_at_start: Pairs
    times: dict[str, dict[str, NDArray[np.float64]]] | None
    first_contact: tuple[float, float] | None
    candidates: dict[str, int] | None
    work: Work


@dataclass(frozen=True, eq=False)
class AdvanceResult:
    """Positions (n, 3) and fractions (n,) of this rank's vertices; the rest is of the whole mesh."""
    positions: NDArray[np.float64]
    fraction: float
    fractions: NDArray[np.float64]
    first_contact: tuple[float, float] | None
    touching_at_start: Pairs
    near_at_start: Pairs
    work: Work


def _agreed(comm: MPI.Comm, make: Callable[[], Any]) -> Any:
    """make() on every rank; what it raises on one is raised on all, so that none waits for another."""
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


def _asked(comm: MPI.Comm, numbers: ArrayLike, before: ArrayLike, after: ArrayLike, faces: ArrayLike,
           edges: ArrayLike, known: dict[str, Any], options: dict[str, Any]) -> tuple[Any, Any]:
    if not isinstance(comm, MPI.Comm):
        raise TypeError(f"comm: found {comm!r}, expected a communicator of mpi4py")

    def make() -> tuple[Any, Any]:
        at_start, at_end = frames(before, after)
        vertices = len(at_start)
        of_vertices = as_array("numbers", numbers)
        if of_vertices.size and of_vertices.dtype.kind not in "iu":
            raise TypeError(f"numbers: found {of_vertices.dtype}, expected whole numbers")
        if of_vertices.shape != (vertices,):
            raise ValueError(f"numbers: found shape {of_vertices.shape}, expected ({vertices},) as before has rows")
        if of_vertices.size and of_vertices.min() < 0:
            raise ValueError(f"numbers: found {of_vertices.min()}, expected 0 or more")
        of_faces = checked_indices("faces", faces, 3, vertices)
        of_edges = checked_indices("edges", edges, 2, vertices)
        mesh = _mpi.Mesh(comm.py2f(), np.require(of_vertices, np.uint64, ["C", "A"]), at_start, at_end, of_faces,
                         of_edges)
        return mesh, _question(vertices, known, options)

    found: tuple[Any, Any] = _agreed(comm, make)
    return found


def step(comm: MPI.Comm, numbers: ArrayLike, before: ArrayLike, after: ArrayLike, faces: ArrayLike,
         edges: ArrayLike = (), *, gather: bool = False, **options: Any) -> StepResult:
    """The pairs of one step of the whole mesh that are not certainly separate.

    Each pair is returned on the lowest rank that has its first element; with gather, all on rank 0.
    Options: as errbound.ccd.Steps.run, but for can_collide and stages; groups, pinned and thickness are one
    a vertex of this rank. The same options on all ranks.
    """
    gather = option("gather", gather, bool)
    found = _mpi.step(*_asked(comm, numbers, before, after, faces, edges, _OF_STEP, options), gather)
    for name in "pairs", "touching_at_start":
        found[name] = Pairs(**found[name])
    return StepResult(**{**found, "work": Work(**found["work"])})


def advance(comm: MPI.Comm, numbers: ArrayLike, before: ArrayLike, after: ArrayLike, faces: ArrayLike,
            edges: ArrayLike = (), **options: Any) -> AdvanceResult:
    """The longest step of the whole mesh found to be free, bit for bit that of errbound.ccd.advance.

    Options: as errbound.ccd.Steps.advance, but for can_collide; islands of the same number are one on all
    ranks.
    """
    found = _mpi.advance(*_asked(comm, numbers, before, after, faces, edges, _OF_FREE_STEP, options))
    for name in "touching_at_start", "near_at_start":
        found[name] = Pairs(**found[name])
    return AdvanceResult(**{**found, "work": Work(**found["work"])})
