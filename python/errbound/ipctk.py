"""Exact broad phase, narrow phase and step sizes for ipc-toolkit's Python package (pip install ipctk).

    import errbound.ipctk

    broad_phase = errbound.ipctk.BroadPhase()
    ipctk.compute_collision_free_stepsize(mesh, before, after, 0, broad_phase)  # exact broad phase only
    errbound.ipctk.compute_collision_free_stepsize(mesh, before, after)         # every pair, exactly
    errbound.ipctk.has_intersections(mesh, before)                              # the start, exactly
"""
from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from itertools import product
from operator import attrgetter
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native, ccd
from ._arrays import Doubles, Indices, check_finite, check_shape, distance_option, doubles, option
from ._planes import Planes

try:
    import ipctk  # type: ignore[import-not-found, import-untyped, unused-ignore]
except ImportError as error:
    raise ImportError("errbound.ipctk needs the package ipctk: pip install ipctk") from error

__all__ = ["BroadPhase", "ExactNarrowPhase", "compute_collision_free_stepsize", "has_intersections",
           "is_step_collision_free"]

_CanCollide = Callable[[int, int], bool]
_Rows = Mapping[ccd.Kind, Indices]
_FIRST_VERTICES: dict[ccd.Kind, int] = {"vertex_face": 1, "edge_edge": 2, "vertex_edge": 1, "vertex_vertex": 1}


def _steps(vertices: int, columns: int, edges: Any, faces: Any) -> ccd.Steps:
    if columns == 2:
        return ccd.Steps.in_plane(edges, vertices=vertices)
    return ccd.Steps(faces, edges, vertices=vertices)


def _in_space(positions: Doubles) -> Doubles:
    return np.pad(positions, ((0, 0), (0, 3 - positions.shape[1])))


def _may_collide(kind: ccd.Kind, rows: Indices, can_collide: _CanCollide) -> NDArray[np.bool_]:
    first, allowed = _FIRST_VERTICES[kind], np.zeros(len(rows), bool)
    for columns in product(range(first), range(first, rows.shape[1])):
        rest = np.flatnonzero(~allowed)
        if not len(rest):
            break
        allowed[rest] = [can_collide(v, w) for v, w in rows[rest][:, columns].tolist()]
    return allowed


class _Lookup:
    """Finds all elements with given vertices, in any order of these."""

    def __init__(self, elements: Any, vertices: int) -> None:
        self._vertices = vertices
        ordered = np.sort(np.asarray(elements), axis=1).astype(np.int64)
        self._firsts = np.unique(self._joined(ordered[:, 0], ordered[:, 1]))
        keys = self._keys(ordered)
        self._order = np.argsort(keys, kind="stable")
        self._sorted = keys[self._order]

    def _joined(self, high: Any, low: Any) -> Any:
        return high * self._vertices + low

    def _keys(self, rows: Any) -> Any:
        """Returns one number per row; -1 if no element has the row's first two vertices."""
        joined = self._joined(rows[:, 0], rows[:, 1])
        positions = np.searchsorted(self._firsts, joined)
        known = self._firsts[np.minimum(positions, len(self._firsts) - 1)] == joined
        keys = self._joined(positions, rows[:, 2]) if rows.shape[1] == 3 else positions
        return np.where(known, keys, -1)

    def __call__(self, rows: Any) -> tuple[Any, Any]:
        """Returns two arrays: positions in `rows`, and the index of an element with these vertices."""
        if not len(rows) or not len(self._sorted):
            return np.empty(0, np.int64), np.empty(0, np.int64)
        keys = self._keys(np.sort(rows, axis=1).astype(np.int64))
        begin, end = (np.searchsorted(self._sorted, keys, side) for side in ("left", "right"))
        counts = end - begin
        of_row = np.repeat(np.arange(len(rows)), counts)
        within = np.arange(len(of_row)) - np.repeat(np.cumsum(counts) - counts, counts)
        return of_row, self._order[begin[of_row] + within]


def _ids(candidates: Any, *names: str) -> list[Any]:
    return [np.fromiter(map(attrgetter(name), candidates), np.int64, len(candidates)) for name in names]


def _as_tuples(*columns: Any) -> list[tuple[int, ...]]:
    return list(zip(*(column.tolist() for column in columns)))


class BroadPhase(ipctk.BroadPhase):  # type: ignore[misc, unused-ignore]
    """Returns only pairs that come within twice the inflation radius of each other, decided exactly.

    Other pairs whose inflated boxes meet are skipped. Edge/face and face/face candidates, which the toolkit uses to
    find intersections, come from its default broad phase. Elements with a common vertex are not a pair.
    Memory and search structures are kept for the next step of the same mesh.
    """

    def __init__(self) -> None:
        super().__init__()
        self._elements: tuple[Any, Any, int, int] | None = None
        self._pairs_of: dict[str, Indices] = {}
        self._theirs: Any = None

    def name(self) -> str:
        return "errbound"

    def build(self, *arguments: Any) -> None:
        """Arguments: vertices (or vertices_t0, vertices_t1), edges, faces, inflation_radius.

        They are copied, since the toolkit passes views of arrays that it frees.
        """
        super().build(*arguments)  # stores the dimension and clears
        moving = np.ndim(arguments[2]) == 2 and len(arguments) >= 4 and np.ndim(arguments[3]) == 2
        edges, faces, *radius = arguments[2 if moving else 1:]
        self._before, self._after = (np.array(arguments[i], float, order="C") for i in (0, int(moving)))
        self._radius = float(radius[0]) if radius else 0.0
        self._set_elements(np.array(edges, np.int32).reshape(-1, 2), np.array(faces, np.int32).reshape(-1, 3))
        self._pairs_of, self._theirs = {}, None

    def clear(self) -> None:
        super().clear()
        self._pairs_of, self._theirs = {}, None

    def _set_elements(self, edges: Any, faces: Any) -> None:
        shape = len(self._before), self._before.shape[1]
        if self._elements is not None and self._elements[2:] == shape and all(
                np.array_equal(*pair) for pair in zip(self._elements, (edges, faces))):
            return
        self._elements = (edges, faces, *shape)
        self._edges, self._faces = edges, faces
        self._steps = _steps(*shape, edges, faces)
        self._edge_index, self._face_index = _Lookup(edges, shape[0]), _Lookup(faces, shape[0])

    def _pairs(self, kind: ccd.Kind) -> Indices:
        if not self._pairs_of:
            found = self._steps.run(self._before, self._after, distance=2 * self._radius).pairs
            self._pairs_of = {each: getattr(found, each) for each in _FIRST_VERTICES}
        rows = self._pairs_of[kind]
        return rows[_may_collide(kind, rows, self.can_vertices_collide)]

    def _default(self) -> Any:
        """Returns the toolkit's default broad phase, without a filter.

        The toolkit would call a filter from its own threads."""
        if self._theirs is None:
            self._theirs = ipctk.LBVH() if hasattr(ipctk, "LBVH") else ipctk.BVH()
            arrays = [np.asfortranarray(a) for a in (self._before, self._after, self._edges, self._faces)]
            self._theirs.build(*arrays, self._radius)
        return self._theirs

    def _decided(self, kind: ccd.Kind, rows: Any) -> NDArray[np.bool_]:
        positions = _in_space(self._before), _in_space(self._after)
        near = np.array(ccd.decide(rows, kind, positions=positions, distance=2 * self._radius).collides)
        near[near] = _may_collide(kind, rows[near], self.can_vertices_collide)
        return near

    def detect_edge_edge_candidates(self) -> list[tuple[int, ...]]:
        rows = self._pairs("edge_edge")
        of_row, first = self._edge_index(rows[:, :2])
        position, second = self._edge_index(rows[of_row, 2:])
        return _as_tuples(first[position], second)

    def detect_face_vertex_candidates(self) -> list[tuple[int, ...]]:
        rows = self._pairs("vertex_face")
        of_row, faces = self._face_index(rows[:, 1:])
        return _as_tuples(faces, rows[of_row, 0])

    def detect_edge_vertex_candidates(self) -> list[tuple[int, ...]]:
        edges, vertices = _ids(self._default().detect_edge_vertex_candidates(), "edge_id", "vertex_id")
        near = self._decided("vertex_edge", np.column_stack([vertices, self._edges[edges]]))
        return _as_tuples(edges[near], vertices[near])

    def detect_vertex_vertex_candidates(self) -> list[tuple[int, ...]]:
        first, second = _ids(self._default().detect_vertex_vertex_candidates(), "vertex0_id", "vertex1_id")
        near = self._decided("vertex_vertex", np.column_stack([first, second]))
        return _as_tuples(first[near], second[near])

    def _of_default(self, found: Any, first: str, second: str) -> list[tuple[int, ...]]:
        one, other = _ids(found, first, second)
        elements = self._edges if first == "edge_id" else self._faces
        allowed = [any(self.can_vertices_collide(v, w) for v, w in product(a, b))
                   for a, b in zip(elements[one].tolist(), self._faces[other].tolist())]
        return _as_tuples(one[allowed], other[allowed])

    def detect_edge_face_candidates(self) -> list[tuple[int, ...]]:
        return self._of_default(self._default().detect_edge_face_candidates(), "edge_id", "face_id")

    def detect_face_face_candidates(self) -> list[tuple[int, ...]]:
        return self._of_default(self._default().detect_face_face_candidates(), "face0_id", "face1_id")


class _Pairs:
    """Pairs that move from `start`, with a filter."""

    def __init__(self, start: Doubles, distance: float, rows: _Rows, can_collide: _CanCollide | None = None) -> None:
        self._start, self._distance, self._can_collide = start, distance, can_collide
        self._rows = {kind: each for kind, each in rows.items() if len(each)}

    def _allows(self, kind: ccd.Kind, row: int) -> bool:
        return self._can_collide is None or bool(
            _may_collide(kind, self._rows[kind][row:row + 1], self._can_collide)[0])

    def any(self) -> bool:
        return any(self._allows(kind, row) for kind, rows in self._rows.items() for row in range(len(rows)))

    def least(self, lows: Iterable[tuple[ccd.Kind, Any, Any]]) -> float:
        """Returns the least time of pairs that may collide. `lows`: kind, rows of pairs, and their times."""
        named = [(kind, rows, times) for kind, rows, times in lows if len(rows)]
        if not named:
            return math.inf
        times, rows = (np.concatenate([each[i] for each in named]) for i in (2, 1))
        kinds = np.repeat(np.arange(len(named)), [len(each[1]) for each in named])
        for i in np.argsort(times, kind="stable").tolist():
            if self._allows(named[kinds[i]][0], int(rows[i])):
                return float(times[i])
        return math.inf

    def first(self, end: Doubles) -> float:
        """Returns the largest double <= the first contact time of the motion to `end`, or infinity."""
        found = {kind: ccd.first_time(rows, kind, positions=(self._start, end), distance=self._distance)
                 for kind, rows in self._rows.items()}
        return self.least((kind, times.query, times.low) for kind, times in found.items())

    def meet(self, end: Doubles) -> bool:
        for kind, rows in self._rows.items():
            near = ccd.decide(rows, kind, positions=(self._start, end), distance=self._distance).collides
            if any(self._allows(kind, row) for row in np.flatnonzero(near).tolist()):
                return True
        return False

    def first_with_gap(self, end: Doubles, rescaling: float, max_gap: float, t_max: float) -> float:
        """Returns the narrow phase's least time in [0, t_max], or infinity."""
        least = math.inf
        for kind, rows in self._rows.items():
            queries = _native.Queries(kind, None, np.require(rows, np.uint32, ["C", "A"]), self._start, end)
            least = min(least, queries.least_time(self._distance, rescaling, max_gap, min(t_max, least),
                                                  lambda row, kind=kind: self._allows(kind, row)))
        return least


class _Mesh:
    """All pairs of a mesh that may collide, in motions from `start`."""

    def __init__(self, mesh: Any, start: Doubles, distance: float) -> None:
        self._start, self._distance, self._can_collide = start, distance, mesh.can_collide
        self._columns = int(mesh.dim)
        self._steps = _steps(len(start), self._columns, mesh.edges, mesh.faces)
        self._near = self._pairs({})  # pairs of the last step

    def _pairs(self, found: Any) -> _Pairs:
        rows = {kind: getattr(found, kind) for kind in _FIRST_VERTICES} if found else {}
        return _Pairs(self._start, self._distance, rows, self._can_collide)

    def _frames(self, end: Doubles) -> tuple[Doubles, Doubles]:
        return self._start[:, :self._columns], end[:, :self._columns]

    def first(self, end: Doubles) -> float:
        found = self._steps.run(*self._frames(end), distance=self._distance, times=True)
        assert found.times is not None
        self._near = self._pairs(found.pairs)
        lows = [(kind, found.times[kind]["low"]) for kind in _FIRST_VERTICES]
        return self._near.least((kind, np.arange(len(low)), low) for kind, low in lows)

    def meet(self, end: Doubles) -> bool:
        """True if some pair collides in the motion to `end`. Tests the pairs of the last step first."""
        if self._near.meet(end):
            return True
        self._near = self._pairs(self._steps.run(*self._frames(end), distance=self._distance).pairs)
        return self._near.any()

    def first_with_gap(self, end: Doubles, rescaling: float, max_gap: float, t_max: float) -> float:
        """Returns the narrow phase's least time in [0, t_max] of pairs whose swept boxes meet, or infinity."""
        distance = self._distance + (max_gap if max_gap < math.inf else 0.0)
        if t_max < 1:  # the end is rounded
            shorter_end = self._start + t_max * (end - self._start)
            largest = max(np.abs(self._start).max(initial=0), np.abs(end).max(initial=0))
            distance = (distance + 2.0**-46 * float(largest) + 2.0**-1070) * (1 + 2.0**-50)
        else:
            shorter_end = end
        found = self._steps.candidates(*self._frames(shorter_end), distance=distance)
        return self._pairs(found).first_with_gap(end, rescaling, max_gap, t_max)


class ExactNarrowPhase(ipctk.NarrowPhaseCCD):  # type: ignore[misc, unused-ignore]
    """The exact narrow phase. docs/collision-detection.md compares it with the toolkit's.

    conservative_rescaling, in (0, 1]: if less than 1, each pair keeps a gap up to the time of impact. The gap is the
    fraction 1 - conservative_rescaling of its distance above min_distance at the start, at most max_gap > 0.

    Pass it as narrow_phase_ccd= to this module's functions, or call it for one pair or for candidates.
    Before passing it to the toolkit's own functions, call ipctk.set_num_threads(1): they call it from their threads
    while they hold the interpreter's lock, and otherwise deadlock.
    """

    def __init__(self, conservative_rescaling: float = 1.0, max_gap: float = math.inf) -> None:
        super().__init__()
        self.conservative_rescaling = option("conservative_rescaling", conservative_rescaling, float)
        self.max_gap = option("max_gap", max_gap, float)
        for name, value, end in (("conservative_rescaling", self.conservative_rescaling, 1), ("max_gap", self.max_gap,
                                                                                              math.inf)):
            if not 0 < value <= end:
                raise ValueError(f"{name} is {value}; expected a number > 0 and <= {end}")

    def _result(self, kind: ccd.Kind, start: Any, end: Any, min_distance: float, tmax: float) -> tuple[bool, float]:
        points = np.zeros((len(start), 2, 3))
        points[:, 0, :len(start[0])], points[:, 1, :len(end[0])] = start, end
        time = _native.Queries(kind, points.reshape(1, -1), None, None, None).least_time(
            min_distance, self.conservative_rescaling, self.max_gap, tmax, None)
        return time < math.inf, time

    def point_point_ccd(self, p0_t0: ArrayLike, p1_t0: ArrayLike, p0_t1: ArrayLike, p1_t1: ArrayLike,
                        min_distance: float = 0.0, tmax: float = 1.0) -> tuple[bool, float]:
        return self._result("vertex_vertex", (p0_t0, p1_t0), (p0_t1, p1_t1), min_distance, tmax)

    def point_edge_ccd(self, p_t0: ArrayLike, e0_t0: ArrayLike, e1_t0: ArrayLike, p_t1: ArrayLike, e0_t1: ArrayLike,
                       e1_t1: ArrayLike, min_distance: float = 0.0, tmax: float = 1.0) -> tuple[bool, float]:
        return self._result("vertex_edge", (p_t0, e0_t0, e1_t0), (p_t1, e0_t1, e1_t1), min_distance, tmax)

    def point_triangle_ccd(self, p_t0: ArrayLike, t0_t0: ArrayLike, t1_t0: ArrayLike, t2_t0: ArrayLike,
                           p_t1: ArrayLike, t0_t1: ArrayLike, t1_t1: ArrayLike, t2_t1: ArrayLike,
                           min_distance: float = 0.0, tmax: float = 1.0) -> tuple[bool, float]:
        return self._result("vertex_face", (p_t0, t0_t0, t1_t0, t2_t0), (p_t1, t0_t1, t1_t1, t2_t1),
                            min_distance, tmax)

    def edge_edge_ccd(self, ea0_t0: ArrayLike, ea1_t0: ArrayLike, eb0_t0: ArrayLike, eb1_t0: ArrayLike,
                      ea0_t1: ArrayLike, ea1_t1: ArrayLike, eb0_t1: ArrayLike, eb1_t1: ArrayLike,
                      min_distance: float = 0.0, tmax: float = 1.0) -> tuple[bool, float]:
        return self._result("edge_edge", (ea0_t0, ea1_t0, eb0_t0, eb1_t0), (ea0_t1, ea1_t1, eb0_t1, eb1_t1),
                            min_distance, tmax)

    def is_step_collision_free(self, candidates: Any, mesh: Any, vertices_t0: ArrayLike, vertices_t1: ArrayLike,
                               min_distance: float = 0.0) -> bool:
        """Same as candidates.is_step_collision_free. Tests the candidates, and all vertices against planes."""
        return _Step(mesh, vertices_t0, vertices_t1, min_distance, self, candidates).is_free()

    def compute_collision_free_stepsize(self, candidates: Any, mesh: Any, vertices_t0: ArrayLike,
                                        vertices_t1: ArrayLike, min_distance: float = 0.0) -> float:
        """Same as candidates.compute_collision_free_stepsize, for the candidates and for vertices against planes."""
        return _Step(mesh, vertices_t0, vertices_t1, min_distance, self, candidates).size()


def _listed_rows(candidates: Any, edges: Any, faces: Any) -> _Rows:
    vertex, edge = (_ids(candidates.ev_candidates, name)[0] for name in ("vertex_id", "edge_id"))
    first, second = _ids(candidates.ee_candidates, "edge0_id", "edge1_id")
    of_face, face = _ids(candidates.fv_candidates, "vertex_id", "face_id")
    edges, faces = np.asarray(edges).reshape(-1, 2), np.asarray(faces).reshape(-1, 3)
    rows: dict[ccd.Kind, list[Any]] = {"vertex_edge": [vertex, edges[edge]], "edge_edge": [edges[first], edges[second]],
            "vertex_face": [of_face, faces[face]],
            "vertex_vertex": list(_ids(candidates.vv_candidates, "vertex0_id", "vertex1_id"))}
    return {kind: np.column_stack(columns).astype(np.uint32) for kind, columns in rows.items()}


class _Step:
    """One step of a toolkit's mesh, with its planes: all pairs, or candidates."""

    def __init__(self, mesh: Any, before: ArrayLike, after: ArrayLike, min_distance: float,
                 narrow: ExactNarrowPhase, candidates: Any = None) -> None:
        distance, shape = distance_option(min_distance, "min_distance"), (int(mesh.num_vertices), int(mesh.dim))
        frames = [doubles(name, values, (None, None))
                  for name, values in (("vertices_t0", before), ("vertices_t1", after))]
        for name, frame in zip(("vertices_t0", "vertices_t1"), frames):
            check_shape(name, frame, shape)
            check_finite(name, frame)
        self._start, self._end = (_in_space(frame) for frame in frames)
        self._gap = narrow.conservative_rescaling, narrow.max_gap
        self._planes = Planes(getattr(mesh, "planes", ()), self._start, distance)
        self._pairs: Any = _Mesh(mesh, self._start, distance) if candidates is None else _Pairs(
            self._start, distance, _listed_rows(candidates, mesh.edges, mesh.faces))

    def _first(self) -> float:
        time: float = min(self._planes.first(self._end), self._pairs.first(self._end))
        if self._gap[0] < 1 and time > 0:
            t_max = min(time, 1.0)
            time = min(time, self._planes.first_with_gap(self._end, *self._gap),
                       self._pairs.first_with_gap(self._end, *self._gap, t_max))
        return time

    def _meets(self, end: Doubles) -> bool:
        return self._planes.first(end) < math.inf or self._pairs.meet(end)

    def is_free(self) -> bool:
        return self._first() == math.inf if self._gap[0] < 1 else not self._meets(self._end)

    def size(self) -> float:
        size = self._first()
        if size == math.inf:
            return 1.0
        # The rounded end of a step to the contact may itself be in contact. Then the step is shortened.
        less = 2.0**-52
        while size > 0:
            if not self._meets(self._start + size * (self._end - self._start)):
                return size
            size, less = size * (1 - less), 2 * less
        return 0.0


def _exact_step(mesh: Any, before: ArrayLike, after: ArrayLike, min_distance: float, broad_phase: Any,
                narrow: ExactNarrowPhase) -> _Step:
    candidates = None
    if broad_phase is not None and not isinstance(broad_phase, BroadPhase):
        kept = narrow.max_gap if narrow.conservative_rescaling < 1 and narrow.max_gap < math.inf else 0.0
        candidates = ipctk.Candidates()
        candidates.build(mesh, np.asfortranarray(before), np.asfortranarray(after), (min_distance + kept) / 2,
                         broad_phase)
    return _Step(mesh, before, after, min_distance, narrow, candidates)


def _theirs(function: Any, mesh: Any, before: ArrayLike, after: ArrayLike, min_distance: float, broad_phase: Any,
            narrow: Any) -> Any:
    return function(mesh, np.asfortranarray(before), np.asfortranarray(after), min_distance,
                    BroadPhase() if broad_phase is None else broad_phase, narrow)


def is_step_collision_free(mesh: Any, vertices_t0: ArrayLike, vertices_t1: ArrayLike, min_distance: float = 0.0,
                           broad_phase: Any = None, narrow_phase_ccd: Any = None) -> bool:
    """True if the linear motion from vertices_t0 to vertices_t1 is free of contact, decided exactly.

    No two elements touch or come within min_distance, nor a vertex and a plane of the mesh.

    broad_phase: one of the toolkit's; then only its candidates are tested, instead of all pairs.
    narrow_phase_ccd: ExactNarrowPhase() by default; with another type, calls the toolkit's function with BroadPhase().
    """
    narrow = ExactNarrowPhase() if narrow_phase_ccd is None else narrow_phase_ccd
    arguments = mesh, vertices_t0, vertices_t1, min_distance, broad_phase, narrow
    if not isinstance(narrow, ExactNarrowPhase):
        return bool(_theirs(ipctk.is_step_collision_free, *arguments))
    return _exact_step(*arguments).is_free()


def compute_collision_free_stepsize(mesh: Any, vertices_t0: ArrayLike, vertices_t1: ArrayLike,
                                    min_distance: float = 0.0, broad_phase: Any = None,
                                    narrow_phase_ccd: Any = None) -> float:
    """Returns the largest step size in [0, 1] found to be free; 0 if there is contact at the start.

    It is free in the sense of is_step_collision_free from vertices_t0 to vertices_t0 + step * (vertices_t1 -
    vertices_t0), as NumPy rounds this expression.

    Arguments: as is_step_collision_free. ExactNarrowPhase(0.8, 1e-4) keeps a gap as well. With a finite max_gap all
    pairs keep it, otherwise only pairs whose swept boxes meet before the first contact.
    Cost: two steps of ccd.Steps; a gap adds the cost of the candidates.
    """
    narrow = ExactNarrowPhase() if narrow_phase_ccd is None else narrow_phase_ccd
    arguments = mesh, vertices_t0, vertices_t1, min_distance, broad_phase, narrow
    if not isinstance(narrow, ExactNarrowPhase):
        return float(_theirs(ipctk.compute_collision_free_stepsize, *arguments))
    return _exact_step(*arguments).size()


_FIRST_AT_REST = {"face_face": 3, "edge_face": 2, "vertex_face": 1, "edge_edge": 2, "vertex_edge": 1,
                  "vertex_vertex": 1}


def has_intersections(mesh: Any, vertices: ArrayLike) -> bool:
    """True if elements of the mesh intersect at rest, decided exactly as in ccd.intersections.

    Unlike the toolkit's function, it also tests faces with a common vertex or edge, coplanar faces, and points.
    Pairs that mesh.can_collide excludes do not count.
    """
    shape = int(mesh.num_vertices), int(mesh.dim)
    positions = doubles("vertices", vertices, (None, None))
    check_shape("vertices", positions, shape)
    found = _steps(*shape, mesh.edges, mesh.faces).intersections(positions, segments=False)
    return any(
        mesh.can_collide(v, w)
        for kind, pairs in found.by_kind.items()
        for row in pairs.vertices.tolist()
        for v, w in product(row[:_FIRST_AT_REST[kind]], row[_FIRST_AT_REST[kind]:]) if v != w)
