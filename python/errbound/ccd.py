"""Exact continuous collision detection: which features of moving meshes touch, when first, and where.

Points move linearly over a step, t from 0 to 1. Touching counts as contact, also at t = 0 and t = 1. The method
"exact" decides every finite input correctly, with no tolerance. The kinds of queries are vertex_face (v f0 f1 f2),
edge_edge (a0 a1 b0 b1), vertex_edge (v e0 e1) and vertex_vertex (v w).

Queries are floats (n, 2k, 3), the k points at t = 0, then at t = 1 (copied once). With positions=(before, after),
(m, 3) each, they are vertex indices (n, k), which are not copied. Lengths have the unit of the positions.
threads: maximum number, 0 for one per core. Results do not depend on it.
"""
from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Literal, TypedDict, cast, overload

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from ._arrays import (Doubles, Indices, as_array, check_finite, check_range, check_shape, checked_indices, distance_option,
                      doubles, end_time, frames, frames_of, group_option, indices, option, pinned_option, restated,
                      thickness_option)
from ._results import (AdvanceResult, Certificate, Decisions, Features, FirstContacts, FirstTimes, Intersections,
                      IntersectionsOfKind, Kind, LeastDistance, Method, MethodName, Motion, NearPairs, Nearness,
                      NormalSource, Outcome, Pairs, Passages, Reason, Relation, Stage, StepResult, TimeDerivatives,
                      TimedStepResult, at_start, intersections_of, stages)

if TYPE_CHECKING:
    if sys.version_info >= (3, 11):
        from typing import Unpack
    else:
        from typing_extensions import Unpack

__all__ = ["AdvanceOptions", "AdvanceResult", "Certificate", "Decisions", "Features", "FilterOptions", "FirstContacts",
           "FirstTimes", "IntersectionOptions", "Intersections", "IntersectionsOfKind", "Kind", "LeastDistance",
           "Method", "MethodName", "Motion", "NearPairs", "Nearness", "NormalSource", "Outcome", "Pairs", "Passages",
           "Reason", "Relation", "RunOptions", "SearchOptions", "Stage", "StepResult", "Steps", "TimeDerivatives",
           "TimedStepResult", "UntimedOptions", "advance", "candidates", "certify", "decide", "first_contact",
           "first_time", "free_step", "instruction_sets", "intersections", "is_free", "least_distance", "methods",
           "near_pairs", "nearness", "reasons", "step", "time_derivatives", "touches_at_start"]

POINTS: dict[Kind, int] = {"vertex_face": 4, "edge_edge": 4, "vertex_edge": 3, "vertex_vertex": 2}

Positions = tuple[ArrayLike, ArrayLike]


class _Queries:
    """Checked queries. Errors of the library are reported with the argument and row that cause them."""

    def __init__(self, queries: ArrayLike, kind: Kind, positions: Positions | None) -> None:
        if kind not in POINTS:
            raise ValueError(f"kind is {kind!r}; expected one of {', '.join(POINTS)}")
        points = POINTS[kind]
        self.pairs: Indices | None = None
        self.frames: tuple[Doubles, Doubles] | None = None
        if positions is None:
            given = as_array("queries", queries)
            if given.ndim == 2 and given.shape[1] == points:
                raise ValueError(f"queries is an array of shape {given.shape} without positions=; expected "
                                 f"coordinates of shape (n, {2 * points}, 3), or vertex indices with positions="
                                 "(before, after)")
            self.stored = doubles("queries", queries, (None, 2 * points, 3))
            rows = self.stored.reshape(-1, 2, points, 3).swapaxes(1, 2).reshape(-1, 6 * points)
            self.native = _native.Queries(kind, np.require(rows, requirements="C"), None, None, None)
            self.vertices = 0
        else:
            self.frames = before, after = frames_of(positions)
            self.vertices = len(before)
            self.pairs = indices("queries", queries, points, self.vertices)
            self.native = _native.Queries(kind, None, self.pairs, before, after)

    def check_indices(self) -> None:
        if self.pairs is not None:
            check_range("queries", self.pairs, self.vertices)

    def call(self, run: Callable[[Any], Any]) -> Any:
        try:
            return run(self.native)
        except ValueError as error:
            self.check_indices()
            raise restated(error) from None

    def require_certain(self, outcome: Any) -> None:
        """Throws: ValueError if an outcome is uncertain; with "exact", only non-finite coordinates cause this."""
        if outcome.max(initial=0) < Outcome.UNCERTAIN:
            return
        row = int(np.argmax(outcome == Outcome.UNCERTAIN))
        self.refuse_coordinates(row)

    def refuse_coordinates(self, row: int) -> None:
        if self.frames is None:
            check_finite("queries", self.stored)
        else:
            for name, frame in zip(("before", "after"), self.frames):
                check_finite(name, frame, f"query {row}: ")

    def thickness(self, values: ArrayLike | None) -> Any:
        if values is not None and self.frames is None:
            raise ValueError("thickness is given without positions=; expected both for queries by vertex index, or "
                             "distance= for one number of all queries")
        return thickness_option(values, self.vertices)


def methods() -> list[Method]:
    """Returns all methods with their guarantees."""
    return [Method(*row) for row in _native.methods()]


def instruction_sets() -> list[str]:
    """Returns the instruction sets that have kernels and run on this machine. The last is the fastest and is used."""
    return list(_native.instruction_sets())


def decide(queries: ArrayLike, kind: Kind, *, positions: Positions | None = None,
           method: MethodName = "exact", distance: float = 0, thickness: ArrayLike | None = None,
           threads: int = 0, stages: bool = False) -> Decisions:
    """Decides which queries collide, or come within a distance, at some t in [0, 1].

    distance applies to all queries. Alternatively thickness (m,) holds one number per vertex: the distance of a pair
    is the sum of its elements' thicknesses, and an element is as thick as its thickest vertex. Both require "exact".
    stages adds counts by stage of "exact". Other methods decide vertex_face and edge_edge, on one thread.

    Throws: IndexError for indices out of range, ValueError for coordinates that are not finite.
    """
    threads, distance = option("threads", threads, int), distance_option(distance)
    name, stages = option("method", method, str), option("stages", stages, bool)
    checked = _Queries(queries, kind, positions)
    near = checked.thickness(thickness)
    if name != "exact":
        if distance or near is not None:
            raise ValueError(f"method is {name!r}; expected 'exact' with distance= or thickness=")
        checked.check_indices()
        return Decisions(checked.call(lambda q: q.decide_by(name)))
    if distance or near is not None:
        if stages:
            raise ValueError("stages is True; expected False with distance= or thickness=")
        outcome, report = checked.call(lambda q: q.decide_within(distance, near, threads)), None
    else:
        outcome, report = checked.call(lambda q: q.decide(threads, stages, False))
    checked.require_certain(outcome)
    return Decisions(outcome, _stages(report))


def touches_at_start(queries: ArrayLike, kind: Kind, *, positions: Positions | None = None,
                     threads: int = 0) -> Decisions:
    """Decides which queries touch at t = 0. Throws: as decide."""
    threads = option("threads", threads, int)
    checked = _Queries(queries, kind, positions)
    outcome, _ = checked.call(lambda q: q.decide(threads, False, True))
    checked.require_certain(outcome)
    return Decisions(outcome)


def first_time(queries: ArrayLike, kind: Kind, *, positions: Positions | None = None,
               t_max: float = 1, distance: float = 0, thickness: ArrayLike | None = None,
               threads: int = 0) -> FirstTimes:
    """Computes the first times in [0, t_max] at which queries touch, or come within a distance. Throws: as decide."""
    threads, distance = option("threads", threads, int), distance_option(distance)
    t_max = end_time(t_max)
    checked = _Queries(queries, kind, positions)
    near = checked.thickness(thickness)
    found = checked.call(lambda q: q.first_times(t_max, distance, near, threads))
    _require_certain_times(checked, found)
    return FirstTimes(**found)


def first_contact(queries: ArrayLike, kind: Kind, *, positions: Positions | None = None,
                  t_max: float = 1, threads: int = 0) -> FirstContacts:
    """Computes time, features, position and normal of the first contact in [0, t_max] of each query that touches.

    Cost: decide, plus about a microsecond per contact. Throws: as decide.
    """
    threads, t_max = option("threads", threads, int), end_time(t_max)
    checked = _Queries(queries, kind, positions)
    found = checked.call(lambda q: q.first_contacts(t_max, threads))
    _require_certain_times(checked, found)
    for name in "points", "weights":
        found[name] = found[name][:, :POINTS[kind]]
    return FirstContacts(**found)


def time_derivatives(queries: ArrayLike, kind: Kind, *, positions: Positions | None = None,
                     t_max: float = 1, threads: int = 0) -> TimeDerivatives:
    """Computes the first contact in [0, t_max] of each query that touches, and the derivative of its time.

    A derivative is undefined at the start, at the border of a feature and at multiple roots. Vertex/edge queries have
    derivatives if all z are equal, vertex/vertex queries never. Cost: as first_contact. Throws: as decide.
    """
    threads, t_max = option("threads", threads, int), end_time(t_max)
    checked = _Queries(queries, kind, positions)
    found = checked.call(lambda q: q.time_derivatives(t_max, threads))
    _require_certain_times(checked, found)
    found["derivative"] = found["derivative"].reshape(-1, 4, 2, 3).swapaxes(1, 2)[:, :, :POINTS[kind]]
    return TimeDerivatives(**found)


def nearness(queries: ArrayLike, kind: Kind, *, positions: Positions | ArrayLike | None = None,
             t: ArrayLike = 0, threads: int = 0) -> Nearness:
    """Computes nearest features and points, distances and normals at t in [0, 1], which may be one number per query.

    For positions at rest, pass positions=x, (m, 3), or queries (n, k, 3). Throws: as decide.
    """
    threads = option("threads", threads, int)
    if positions is None:
        given = as_array("queries", queries)
        if given.ndim == 3 and given.shape[1] == POINTS.get(kind):
            queries = np.concatenate((given, given), 1)
    frames_given: Any = positions
    if positions is not None and np.ndim(frames_given) == 2:
        frames_given = positions, positions
    checked = _Queries(queries, kind, frames_given)
    at = doubles("t", np.ravel(t), (None,))
    if not ((at >= 0) & (at <= 1)).all():
        raise ValueError(f"t is {at[np.argmin((at >= 0) & (at <= 1))]}; expected a number in [0, 1]")
    one = np.ndim(t) == 0
    found = checked.call(lambda q: q.nearness(at[0] if one else 0, None if one else at, threads))
    missing = ~found["weights"].any(axis=1)
    if missing.any():
        checked.refuse_coordinates(int(np.argmax(missing)))
    return _nearness(found, kind)


def _nearness(found: dict[str, Any], kind: Kind) -> Nearness:
    for name in "points", "weights":
        found[name] = found[name][:, :POINTS[kind]]
    return Nearness(**found)


def _require_certain_times(checked: _Queries, found: dict[str, Any]) -> None:
    uncertain = found.pop("outcome") == Outcome.UNCERTAIN
    if uncertain.any():
        checked.refuse_coordinates(int(found["query"][np.argmax(uncertain)]))


_stages = stages


class FilterOptions(TypedDict, total=False):
    """Options of all calls: the pairs to test, and threads.

    threads: maximum number; 0, the default: one per core.
    groups: integers (n,): tests only pairs between different groups.
    between_groups: False: only pairs within a group.
    pinned: flags (n,), one per vertex: skips pairs whose vertices are all pinned.
    skip_unused: True: skips vertices without faces and edges; by default they are points.
    can_collide: called with two vertices, one of each element. A pair is skipped if all calls return False. Slow;
    several threads call it, one at a time.
    """
    threads: int
    groups: ArrayLike | None
    between_groups: bool
    pinned: ArrayLike | None
    skip_unused: bool
    can_collide: Callable[[int, int], bool] | None


class SearchOptions(FilterOptions, total=False):
    """FilterOptions (threads, groups, between_groups, pinned, skip_unused, can_collide), and the distance of steps.

    distance: finds pairs that come within it, instead of pairs that touch.
    thickness: (n,), one per vertex, instead of distance: as decide.
    """
    distance: float
    thickness: ArrayLike | None


class IntersectionOptions(FilterOptions, total=False):
    """FilterOptions (threads, groups, between_groups, pinned, skip_unused, can_collide), and:

    segments: False: skips the common segments of crossing pairs.
    edge_faces: fills edge_faces of the result.
    merge_equal_positions: vertices with equal positions count as the first of them.
    """
    segments: bool
    edge_faces: bool
    merge_equal_positions: bool


class UntimedOptions(SearchOptions, total=False):
    """The options of a step except times.

    method: the name of one of methods(). Only "exact", the default, supports times, distances and t_max.
    first_contact: fills first_contact and touching_at_start.
    initial_contact: fills touching_at_start, the pairs that touch at t = 0.
    t_max: the step is tested in [0, t_max]; 1 by default.
    stages, count_candidates: fill stages, candidates.
    check_start: fills intersections_at_start; a third to half of the time of a step.
    adjacent_rods: tests rods with a common vertex, too, as vertex_edge pairs; not with distances.
    """
    method: MethodName
    adjacent_rods: bool
    check_start: bool
    first_contact: bool
    initial_contact: bool
    t_max: float
    stages: bool
    count_candidates: bool


class RunOptions(UntimedOptions, total=False):
    """All options of a step: SearchOptions, UntimedOptions, and times.

    times: fills times, first_contact and touching_at_start of the result.
    """
    times: bool


class AdvanceOptions(SearchOptions, total=False):
    """The pairs to keep apart (SearchOptions), and the vertices that share a fraction.

    islands: integers (n,): the vertices of an island share one fraction, and so do islands that meet. The default is
    one island with all vertices. Islands skip no pairs; groups do.
    each_vertex: gives each vertex its own fraction, limited by planes between the elements that meet. It goes at
        least as far as its island would.
    conservative: the share of the way to the first contact that is used, in (0, 1]; 0.8 leaves a gap for barriers.
    keep: pairs that start within 1.001 times the required distance may approach, but keep this share, in [0, 1), of
        their distance at the start. 0.1 by default; with 0, a pair that starts just above the required distance stops
        its island.
    check_start: fills intersections_at_start.
    """
    islands: ArrayLike | None
    each_vertex: bool
    conservative: float
    keep: float
    check_start: bool


_OF_FILTER = {"threads": int, "groups": np.ndarray, "between_groups": bool, "pinned": np.ndarray, "skip_unused": bool,
              "can_collide": Callable}
_OF_SEARCH = {**_OF_FILTER, "distance": float, "thickness": np.ndarray}
_OF_INTERSECTIONS = {**_OF_FILTER, "segments": bool, "edge_faces": bool, "merge_equal_positions": bool}
_OF_RUN = {**_OF_SEARCH, "method": str, "times": bool, "first_contact": bool, "initial_contact": bool,
           "t_max": float, "stages": bool, "count_candidates": bool, "check_start": bool,
           "adjacent_rods": bool}
_OF_ADVANCE = {**_OF_SEARCH, "islands": np.ndarray, "each_vertex": bool, "conservative": float, "keep": float,
               "check_start": bool}

_OF_FREE_STEP = {name: kind for name, kind in _OF_ADVANCE.items() if name not in ("islands", "each_vertex")}


def _checked_option(name: str, value: Any, kind: Any, vertices: int) -> Any:
    """Returns a checked option for the extension. Options of kind ndarray have one number per vertex."""
    if name == "t_max":
        return end_time(value)
    if name == "distance":
        return distance_option(value)
    if name == "thickness":
        return thickness_option(value, vertices)
    if name == "pinned":
        return pinned_option(value, vertices)
    if kind is Callable:
        if value is not None and not callable(value):
            raise TypeError(f"{name} is {value!r}; expected a function of two vertices")
        return value
    return group_option(name, value, vertices) if kind is np.ndarray else option(name, value, kind)


def _request(vertices: int, known: dict[str, Any], options: Mapping[str, Any]) -> Any:
    request = _native.StepRequest()
    for name, value in options.items():
        if name not in known:
            raise TypeError(f"option is {name!r}; expected one of {', '.join(sorted(known))}")
        setattr(request, name, _checked_option(name, value, known[name], vertices))
    if not options.get("between_groups", True) and options.get("groups") is None:
        raise ValueError("between_groups is False without groups; expected both or neither")
    return request


class Steps:
    """Steps of one mesh. Keeps faces, edges, their order and its memory from step to step.

    faces: (m, 3); edges: (k, 2), in addition to those of faces; vertices: their number. Vertices without edges are
    points. A call from a second thread throws RuntimeError. Memory: up to nine times that of two meshes.
    """

    def __init__(self, faces: ArrayLike, edges: ArrayLike = (), *, vertices: int) -> None:
        self.vertices, self._columns = option("vertices", vertices, int, 2**32), 3
        of_faces = checked_indices("faces", faces, 3, self.vertices)
        of_edges = checked_indices("edges", edges, 2, self.vertices)
        self._steps = _native.Steps(of_faces, of_edges, self.vertices)

    @classmethod
    def in_plane(cls, edges: ArrayLike, *, vertices: int) -> Steps:
        """Returns Steps of edges and points in the plane. Positions are (n, 2), copied once."""
        made = cls.__new__(cls)
        made.vertices, made._columns = option("vertices", vertices, int, 2**32), 2
        made._steps = _native.Steps.in_plane(checked_indices("edges", edges, 2, made.vertices), made.vertices)
        return made

    def __repr__(self) -> str:
        return f"<ccd.Steps of {self.vertices} vertices{', in the plane' if self._columns == 2 else ''}>"

    def _frames(self, before: ArrayLike, after: ArrayLike) -> tuple[Doubles, Doubles]:
        found = frames(before, after, self._columns)
        check_shape("before", found[0], (self.vertices, self._columns))
        if self._columns == 3:
            return found
        return np.pad(found[0], ((0, 0), (0, 1))), np.pad(found[1], ((0, 0), (0, 1)))

    def _call(self, call: Callable[[Doubles, Doubles, Any], Any], before: ArrayLike, after: ArrayLike,
              known: dict[str, Any], options: Mapping[str, Any]) -> Any:
        frames = self._frames(before, after)
        request = _request(self.vertices, known, options)
        try:
            return call(*frames, request)
        except ValueError as error:
            for name, frame in zip(("before", "after"), frames):
                check_finite(name, frame[:, :self._columns])
            raise restated(error) from None

    @overload
    def run(self, before: ArrayLike, after: ArrayLike, *, times: Literal[True],
            **options: Unpack[UntimedOptions]) -> TimedStepResult: ...

    @overload
    def run(self, before: ArrayLike, after: ArrayLike, **options: Unpack[RunOptions]) -> StepResult: ...

    def run(self, before: ArrayLike, after: ArrayLike, **options: Unpack[RunOptions]) -> StepResult:
        """Finds the pairs that are not certainly separate in the step from before to after, (n, 3) each.

        Options: RunOptions. Returns a TimedStepResult if times=True.
        Throws: ValueError with frame and row of a coordinate that is not finite.
        """
        return _step_result(self._call(self._steps.run, before, after, _OF_RUN, options))

    def certify(self, before: ArrayLike, after: ArrayLike, **options: Unpack[FilterOptions]) -> Certificate:
        """Certifies that the step from before to after, (n, 3) each, is free, or finds all contacts and their depths.

        Positions may be float32, as they are stored: they are converted exactly. Options: FilterOptions.
        """
        def certified(at_start: Doubles, at_end: Doubles, request: Any) -> Any:
            request.times = request.check_start = True
            return self._steps.certify(at_start, at_end, request)

        found = self._call(certified, before, after, _OF_FILTER, options)
        passages = {kind: _passages(found["passages"][kind], kind) for kind in POINTS}
        return Certificate(cast(TimedStepResult, _step_result(found["step"])), passages)

    def candidates(self, before: ArrayLike, after: ArrayLike, **options: Unpack[SearchOptions]) -> Pairs:
        """Returns all pairs whose swept boxes touch, for a custom narrow phase. Options: SearchOptions."""
        found = self._call(self._steps.candidates, before, after, _OF_SEARCH, options)
        return Pairs(**found)

    def near_pairs(self, positions: ArrayLike, **options: Unpack[SearchOptions]) -> NearPairs:
        """Finds the pairs at rest within a distance or thickness (SearchOptions), 0 by default, with their data."""
        found = self._call(lambda at, _, request: self._steps.near_pairs(at, request), positions, positions, _OF_SEARCH,
                           options)
        return NearPairs(Pairs(**found["pairs"]), {kind: _nearness(found["data"][kind], kind) for kind in POINTS})

    def least_distance(self, positions: ArrayLike, **options: Unpack[SearchOptions]) -> LeastDistance:
        """Computes the least distance of the pairs at rest. Options: SearchOptions, but distances are ignored."""
        found = self._call(lambda at, _, request: self._steps.least_distance(at, request), positions, positions,
                           _OF_SEARCH, options)
        kind: Kind = found["kind"]
        if not found["high"] < float("inf"):
            return LeastDistance(found["low"], found["high"], None, None, None)
        vertices = tuple(found["vertices"][0, :POINTS[kind]].tolist())
        return LeastDistance(found["low"], found["high"], kind, vertices, _nearness(found["data"], kind))

    def advance(self, before: ArrayLike, after: ArrayLike, **options: Unpack[AdvanceOptions]) -> AdvanceResult:
        """Computes the longest step found to be free from before towards after, to rounded positions.

        Options: AdvanceOptions, SearchOptions. Pairs skipped by groups, pinned or can_collide may pass through
        each other.
        """
        return self._free(self._call(self._steps.advance, before, after, _OF_ADVANCE, options))

    def free_step(self, x: ArrayLike, p: ArrayLike, **options: Unpack[AdvanceOptions]) -> AdvanceResult:
        """Computes alpha, the result's fraction, such that the step to x + alpha * p is free.

        This holds as NumPy computes the positions (two roundings), and with fused multiply-add.

        Options: AdvanceOptions except islands and each_vertex, SearchOptions. With barriers, use conservative=0.8.
        """
        return self._free(self._call(self._steps.free_step, x, p, _OF_FREE_STEP, options))

    def _free(self, found: Any) -> AdvanceResult:
        for name in "first_pairs", "touching_at_start", "near_at_start":
            found[name] = Pairs(**found[name])
        found["intersections_at_start"] = at_start(found["intersections_at_start"])
        if self._columns == 2:
            found["positions"] = np.ascontiguousarray(found["positions"][:, :2])
        return AdvanceResult(**found)

    def _at_rest(self, positions: ArrayLike, first_only: bool, options: Mapping[str, Any]) -> Intersections:
        at = doubles("positions", positions, (self.vertices, self._columns))
        request = _request(self.vertices, _OF_INTERSECTIONS, options)
        request.first_only = first_only
        try:
            return intersections_of(self._steps.intersections(np.pad(at, ((0, 0), (0, 3 - self._columns))), request))
        except ValueError as error:
            check_finite("positions", at)
            raise restated(error) from None

    def intersections(self, positions: ArrayLike, **options: Unpack[IntersectionOptions]) -> Intersections:
        """Finds the elements that intersect at positions (n, 3), exactly; in the plane edges and points, (n, 2).

        Two elements intersect if they share a point outside the vertices and edges that both have by index.
        Options: IntersectionOptions, FilterOptions.
        Throws: ValueError with the row of a position that is not finite.
        """
        return self._at_rest(positions, False, options)

    def is_free(self, positions: ArrayLike, **options: Unpack[IntersectionOptions]) -> bool:
        """True if no two elements intersect. Stops at the first pair."""
        return len(self._at_rest(positions, True, {**options, "segments": False, "edge_faces": False})) == 0


def _step_result(found: Any) -> StepResult:
    for name in "pairs", "first_pairs", "touching_at_start":
        found[name] = Pairs(**found[name])
    found["stages"] = _stages(found["stages"])
    found["intersections_at_start"] = at_start(found["intersections_at_start"])
    return StepResult(**found) if found["times"] is None else TimedStepResult(**found)


def _passages(found: dict[str, Any], kind: Kind) -> Passages:
    for name in "points", "weights":
        found[name] = found[name][:, :POINTS[kind]]
    return Passages(query=np.arange(len(found["low"]), dtype=np.uint64), **found)


def _steps_of(before: ArrayLike, faces: ArrayLike, edges: ArrayLike) -> Steps:
    return Steps(faces, edges, vertices=len(doubles("before", before, (None, 3))))


@overload
def step(before: ArrayLike, after: ArrayLike, faces: ArrayLike, edges: ArrayLike = (), *, times: Literal[True],
         **options: Unpack[UntimedOptions]) -> TimedStepResult: ...


@overload
def step(before: ArrayLike, after: ArrayLike, faces: ArrayLike, edges: ArrayLike = (),
         **options: Unpack[RunOptions]) -> StepResult: ...


def step(before: ArrayLike, after: ArrayLike, faces: ArrayLike, edges: ArrayLike = (),
         **options: Unpack[RunOptions]) -> StepResult:
    """Finds the pairs that are not certainly separate in one step from before to after, (n, 3) each.

    faces: (m, 3); edges: (k, 2), in addition to those of faces. Options: RunOptions (method, times, first_contact,
    initial_contact, t_max, stages, count_candidates) and SearchOptions (threads, distance, thickness, groups,
    between_groups, pinned, skip_unused, can_collide). For many steps of one mesh, use Steps.run.
    """
    return _steps_of(before, faces, edges).run(before, after, **options)


def certify(before: ArrayLike, after: ArrayLike, faces: ArrayLike, edges: ArrayLike = (),
            **options: Unpack[FilterOptions]) -> Certificate:
    """Same as Steps.certify, for one step: free, or the pairs in contact, when and how deep.

    Options: FilterOptions (threads, groups, between_groups, pinned, skip_unused, can_collide).
    """
    return _steps_of(before, faces, edges).certify(before, after, **options)


def reasons(result: StepResult | AdvanceResult, before: ArrayLike, after: ArrayLike, *, distance: float = 0,
            thickness: ArrayLike | None = None) -> list[Reason]:
    """Returns the pairs that limit a step: result.first_pairs, how they move on, and their distance at the start.

    before, after, distance and thickness are those of the call that returned result (after free_step: x and x + p).
    A StepResult needs the option first_contact or times.
    """
    at_start, at_end = (doubles(name, values, (None, np.shape(values)[-1] if np.ndim(values) else 0))
                        for name, values in (("before", before), ("after", after)))
    at_start, at_end = (np.pad(at, ((0, 0), (0, max(0, 3 - at.shape[1])))) for at in (at_start, at_end))
    rows = frames(at_start, at_end)
    pairs: Any = tuple(checked_indices(f"result.first_pairs.{kind}", getattr(result.first_pairs, kind), points,
                                       len(rows[0])) for kind, points in POINTS.items())
    if result.first_contact is None:
        return []
    check_finite("before", rows[0])
    check_finite("after", rows[1])
    found = _native.reasons(pairs, *rows, *result.first_contact, distance_option(distance),
                            thickness_option(thickness, len(rows[0])))

    def reason(kind: Kind, vertices: tuple[int, ...], motion: int, velocity: float,
               velocity_error: float, distance_at_start: float, distance_error: float) -> Reason:
        used = vertices[:POINTS[kind]]
        four = list(used) + [used[-1]] * (4 - len(used))
        stored: Literal["vertex_face", "edge_edge"] = "edge_edge" if kind == "edge_edge" else "vertex_face"
        return Reason(kind, used, cast("tuple[float, float]", result.first_contact), Motion(motion), velocity,
                      velocity_error, distance_at_start, distance_error, stored,
                      np.concatenate([frame[four] for frame in rows]))

    return [reason(*one) for one in found]


def candidates(before: ArrayLike, after: ArrayLike, faces: ArrayLike, edges: ArrayLike = (),
               **options: Unpack[SearchOptions]) -> Pairs:
    """Same as Steps.candidates, for one step."""
    return _steps_of(before, faces, edges).candidates(before, after, **options)


def near_pairs(positions: ArrayLike, faces: ArrayLike, edges: ArrayLike = (),
               **options: Unpack[SearchOptions]) -> NearPairs:
    """Same as Steps.near_pairs, for one frame: the pairs at rest within a distance, with their data."""
    return _steps_of(positions, faces, edges).near_pairs(positions, **options)


def least_distance(positions: ArrayLike, faces: ArrayLike, edges: ArrayLike = (),
                   **options: Unpack[SearchOptions]) -> LeastDistance:
    """Same as Steps.least_distance, for one frame."""
    return _steps_of(positions, faces, edges).least_distance(positions, **options)


def advance(before: ArrayLike, after: ArrayLike, faces: ArrayLike, edges: ArrayLike = (),
            **options: Unpack[AdvanceOptions]) -> AdvanceResult:
    """Same as Steps.advance, for one step: returns free positions and their fraction of the step.

    Options: AdvanceOptions (islands: vertices that share a fraction) and SearchOptions (threads, distance, thickness;
    pairs skipped by groups, between_groups, pinned, skip_unused or can_collide may pass through each other).
    """
    return _steps_of(before, faces, edges).advance(before, after, **options)


def free_step(x: ArrayLike, p: ArrayLike, faces: ArrayLike, edges: ArrayLike = (),
              **options: Unpack[AdvanceOptions]) -> AdvanceResult:
    """Same as Steps.free_step, for one step: alpha, the result's fraction, such that x + alpha * p is free.

    Options: AdvanceOptions (conservative, keep, check_start) and SearchOptions (threads, distance, thickness).
    """
    return _steps_of(x, faces, edges).free_step(x, p, **options)


def intersections(positions: ArrayLike, faces: ArrayLike, edges: ArrayLike = (),
                  **options: Unpack[IntersectionOptions]) -> Intersections:
    """Finds the elements of a mesh at rest that intersect, exactly: faces, edges of no face, unused vertices.

    positions: (n, 3); faces: (m, 3); edges: (k, 2). Options: IntersectionOptions (segments, edge_faces,
    merge_equal_positions) and FilterOptions (threads, groups, between_groups, pinned, skip_unused, can_collide).
    For many frames of one mesh, use Steps.intersections.
    """
    return Steps(faces, edges, vertices=len(doubles("positions", positions, (None, 3)))).intersections(
        positions, **options)


def is_free(positions: ArrayLike, faces: ArrayLike, edges: ArrayLike = (),
            **options: Unpack[IntersectionOptions]) -> bool:
    """True if no two elements of a mesh at rest intersect. Options: as intersections. Stops at the first pair."""
    return Steps(faces, edges, vertices=len(doubles("positions", positions, (None, 3)))).is_free(positions, **options)
