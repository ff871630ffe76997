"""Exact continuous collision detection: which features of moving meshes touch, when first, and where.

Points move linearly over a step, t from 0 to 1. Touching counts, t = 0 and t = 1 count; "exact" answers
every finite input right, with no tolerance. Queries are of four kinds: vertex_face (v f0 f1 f2),
edge_edge (a0 a1 b0 b1), vertex_edge (v e0 e1), vertex_vertex (v w).

Queries are given as floats (n, 2k, 3), the k points at t = 0, then at t = 1 (copied once); or, with
positions=(before, after), (m, 3) each, as vertex indices (n, k), which are read where they are. Lengths
are in the unit of the positions. threads: at most; 0: one per core. Answers do not depend on it.
"""
from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from ._arrays import (Doubles, Indices, as_array, check_finite, check_range, check_shape, doubles, frames,
                      indices, of_vertices, option)
from ._results import (AdvanceResult, Decisions, Features, FirstContacts, FirstTimes, Method,
                       NormalSource, Outcome, Pairs, Stage, StepResult, stages)

__all__ = ["AdvanceResult", "Decisions", "Features", "FirstContacts", "FirstTimes", "Method",
           "NormalSource", "Outcome", "Pairs", "Stage", "StepResult", "Steps", "advance",
           "candidates", "decide", "first_contact", "first_time", "instruction_sets", "methods",
           "step", "touches_at_start"]

POINTS = {"vertex_face": 4, "edge_edge": 4, "vertex_edge": 3, "vertex_vertex": 2}

Positions = tuple[ArrayLike, ArrayLike]


class _Questions:
    """Checked queries, and who is to blame if the library refuses them."""

    def __init__(self, queries: ArrayLike, kind: str, positions: Positions | None) -> None:
        if kind not in POINTS:
            raise ValueError(f"kind: found {kind!r}, expected one of {', '.join(POINTS)}")
        points = POINTS[kind]
        self.pairs: Indices | None = None
        self.frames: tuple[Doubles, Doubles] | None = None
        if positions is None:
            self.stored = doubles("queries", queries, (None, 2 * points, 3))
            rows = self.stored.reshape(-1, 2, points, 3).swapaxes(1, 2).reshape(-1, 6 * points)
            self.native = _native.Questions(kind, np.require(rows, requirements="C"), None, None, None)
            self.vertices = 0
        else:
            self.frames = before, after = frames(*positions)
            self.vertices = len(before)
            self.pairs = indices("queries", queries, points)
            self.native = _native.Questions(kind, None, self.pairs, before, after)

    def check_indices(self) -> None:
        if self.pairs is not None:
            check_range("queries", self.pairs.view(np.int32)
                        if self.vertices < 2**31 else self.pairs, self.vertices)

    def call(self, ask: Callable[[Any], Any]) -> Any:
        try:
            return ask(self.native)
        except ValueError:
            self.check_indices()
            raise

    def require_certain(self, outcome: Any) -> None:
        """"exact" is uncertain where a coordinate is not finite, and only there."""
        if outcome.max(initial=0) < Outcome.UNCERTAIN:
            return
        row = int(np.argmax(outcome == Outcome.UNCERTAIN))
        self.refuse_coordinates(row)

    def refuse_coordinates(self, row: int) -> None:
        if self.frames is None:
            check_finite("queries", self.stored)
        else:
            for name, frame in zip(("before", "after"), self.frames):
                check_finite(f"query {row}: {name}", frame)

    def thickness(self, values: ArrayLike | None) -> Any:
        if values is not None and self.frames is None:
            raise ValueError("thickness: found one, expected none without positions")
        return of_vertices("thickness", values, np.float64, self.vertices)


def methods() -> list[Method]:
    """All methods, with what each promises."""
    return [Method(*row) for row in _native.methods()]


def instruction_sets() -> list[str]:
    """What batches and steps have kernels for and this machine runs, the fastest last: that one is used."""
    return list(_native.instruction_sets())


def decide(queries: ArrayLike, kind: str, *, positions: Positions | None = None,
           method: str = "exact", distance: float = 0, thickness: ArrayLike | None = None,
           threads: int = 0, stages: bool = False) -> Decisions:
    """Which queries collide, or come within a distance, at some t in [0, 1].

    distance, of all; or thickness (m,), one a vertex: the distance of a pair is then the sum of its two
    elements' thicknesses, each that of its thickest vertex. Both by "exact" alone. stages asks for what
    the stages of "exact" decided. Other methods decide vertex_face and edge_edge one by one, on one thread.

    Raises IndexError for indices out of range, ValueError for coordinates that are not finite.
    """
    threads, distance = option("threads", threads, int), option("distance", distance, float)
    method, stages = option("method", method, str), option("stages", stages, bool)
    asked = _Questions(queries, kind, positions)
    near = asked.thickness(thickness)
    if method != "exact":
        if distance or near is not None:
            raise ValueError(f"method: found {method!r}, expected 'exact' where a distance is asked for")
        asked.check_indices()
        return Decisions(asked.call(lambda q: q.decide_by(method)))
    if distance or near is not None:
        if stages:
            raise ValueError("stages: found True, expected False where a distance is asked for")
        outcome, report = asked.call(lambda q: q.decide_within(distance, near, threads)), None
    else:
        outcome, report = asked.call(lambda q: q.decide(threads, stages, False))
    asked.require_certain(outcome)
    return Decisions(outcome, _stages(report))


def touches_at_start(queries: ArrayLike, kind: str, *, positions: Positions | None = None,
                     threads: int = 0) -> Decisions:
    """Which queries touch already at t = 0. Raises as decide."""
    threads = option("threads", threads, int)
    asked = _Questions(queries, kind, positions)
    outcome, _ = asked.call(lambda q: q.decide(threads, False, True))
    asked.require_certain(outcome)
    return Decisions(outcome)


def first_time(queries: ArrayLike, kind: str, *, positions: Positions | None = None,
               t_max: float = 1, distance: float = 0, thickness: ArrayLike | None = None,
               threads: int = 0) -> FirstTimes:
    """Of the queries that touch, or come within a distance, in [0, t_max]: when first. Raises as decide."""
    threads, distance = option("threads", threads, int), option("distance", distance, float)
    t_max = option("t_max", t_max, float)
    asked = _Questions(queries, kind, positions)
    near = asked.thickness(thickness)
    found = asked.call(lambda q: q.first_times(t_max, distance, near, threads))
    _require_certain_times(asked, found)
    return FirstTimes(**found)


def first_contact(queries: ArrayLike, kind: str, *, positions: Positions | None = None,
                  t_max: float = 1, threads: int = 0) -> FirstContacts:
    """Of the queries that touch in [0, t_max]: when first, which features, where, along which normal.

    Cost: decide, and about a microsecond a contact. Raises as decide.
    """
    threads, t_max = option("threads", threads, int), option("t_max", t_max, float)
    asked = _Questions(queries, kind, positions)
    found = asked.call(lambda q: q.first_contacts(t_max, threads))
    _require_certain_times(asked, found)
    return FirstContacts(**found)


def _require_certain_times(asked: _Questions, found: dict[str, Any]) -> None:
    uncertain = found.pop("outcome") == Outcome.UNCERTAIN
    if uncertain.any():
        asked.refuse_coordinates(int(found["query"][np.argmax(uncertain)]))


_stages = stages


_OF_SEARCH = {"threads": int, "distance": float, "thickness": np.float64, "groups": np.int32,
              "between_groups": bool, "pinned": np.uint8, "can_collide": Callable}
_OF_RUN = {**_OF_SEARCH, "method": str, "times": bool, "first_contact": bool, "initial_contact": bool,
           "t_max": float, "stages": bool, "count_candidates": bool}
_OF_ADVANCE = {**_OF_SEARCH, "islands": np.int32}


def _question(vertices: int, known: dict[str, Any], options: dict[str, Any]) -> Any:
    """The options, each of the type that is known of it; NumPy's types are of one number a vertex."""
    asked = _native.StepQuestion()
    for name, value in options.items():
        if name not in known:
            raise TypeError(f"found option {name!r}, expected one of {', '.join(sorted(known))}")
        kind = known[name]
        if kind is Callable:
            if value is not None and not callable(value):
                raise TypeError(f"{name}: found {value!r}, expected a function of two vertices")
        elif not issubclass(kind, np.generic):
            value = option(name, value, kind)
        else:
            if name == "pinned" and value is not None:
                value = as_array(name, value) != 0
            value = of_vertices(name, value, kind, vertices)
        setattr(asked, name, value)
    return asked


class Steps:
    """Steps of one mesh: keeps faces and edges, their order and its memory from step to step.

    faces: (m, 3); edges: (k, 2), those beside the faces' own; vertices: their number. Vertices on no edge
    are points. One call at a time: RuntimeError from a second thread. Memory: about ten times that of
    the two frames.
    """

    def __init__(self, faces: ArrayLike, edges: ArrayLike = (), *, vertices: int) -> None:
        of_faces, of_edges = indices("faces", faces, 3), indices("edges", edges, 2)
        check_range("faces", of_faces, vertices)
        check_range("edges", of_edges, vertices)
        self.vertices, self._columns = vertices, 3
        self._steps = _native.Steps(of_faces, of_edges, vertices)

    @classmethod
    def in_plane(cls, edges: ArrayLike, *, vertices: int) -> Steps:
        """Of edges and points in the plane: positions are (n, 2), copied once."""
        of_edges = indices("edges", edges, 2)
        check_range("edges", of_edges, vertices)
        made = cls.__new__(cls)
        made.vertices, made._columns = vertices, 2
        made._steps = _native.Steps.in_plane(of_edges, vertices)
        return made

    def __repr__(self) -> str:
        return f"<ccd.Steps of {self.vertices} vertices{', in the plane' if self._columns == 2 else ''}>"

    def _frames(self, before: ArrayLike, after: ArrayLike) -> tuple[Doubles, Doubles]:
        found = frames(before, after, self._columns)
        check_shape("before", found[0], (self.vertices, self._columns))
        if self._columns == 3:
            return found
        return np.pad(found[0], ((0, 0), (0, 1))), np.pad(found[1], ((0, 0), (0, 1)))

    def run(self, before: ArrayLike, after: ArrayLike, **options: Any) -> StepResult:
        """The pairs of the step from before to after, (n, 3) each, that are not certainly separate.

        Options: method ("exact"); threads (0: one per core); times, first_contact, initial_contact: fill
        times, first_contact, touching_at_start; t_max (1); distance, or thickness (n,): as decide;
        stages, count_candidates: fill stages, candidates. Filter: groups, whole numbers (n,), of which
        pairs between are looked at, or within, if between_groups is False; pinned (n,): pairs of which
        all vertices are pinned are left out; can_collide(v, w), slow, from several threads in turn.
        Raises ValueError that names frame, vertex and axis of a coordinate that is not finite.
        """
        at_start, at_end = self._frames(before, after)
        found = self._steps.run(at_start, at_end, _question(self.vertices, _OF_RUN, options))
        for name in "pairs", "touching_at_start":
            found[name] = Pairs(**found[name])
        found["stages"] = _stages(found["stages"])
        return StepResult(**found)

    def candidates(self, before: ArrayLike, after: ArrayLike, **options: Any) -> Pairs:
        """All pairs whose swept boxes touch, for a narrow phase of one's own; options of the filter, threads
        and distances as run's."""
        at_start, at_end = self._frames(before, after)
        asked = _question(self.vertices, _OF_SEARCH, options)
        return Pairs(**self._steps.candidates(at_start, at_end, asked))

    def advance(self, before: ArrayLike, after: ArrayLike, **options: Any) -> AdvanceResult:
        """The longest step found to be free from before towards after, with positions rounded already.

        Options: threads, distance, thickness and the filter as run's; islands, whole numbers (n,): vertices
        of one island go by one fraction, and so do islands that meet; by default all are one.
        """
        at_start, at_end = self._frames(before, after)
        found = self._steps.advance(at_start, at_end, _question(self.vertices, _OF_ADVANCE, options))
        for name in "touching_at_start", "near_at_start":
            found[name] = Pairs(**found[name])
        return AdvanceResult(**found)


def _steps_of(before: ArrayLike, faces: ArrayLike, edges: ArrayLike) -> Steps:
    return Steps(faces, edges, vertices=len(doubles("before", before, (None, 3))))


def step(before: ArrayLike, after: ArrayLike, faces: ArrayLike, edges: ArrayLike = (),
         **options: Any) -> StepResult:
    """One step alone: Steps(faces, edges, vertices=len(before)).run(before, after, **options)."""
    return _steps_of(before, faces, edges).run(before, after, **options)


def candidates(before: ArrayLike, after: ArrayLike, faces: ArrayLike, edges: ArrayLike = (),
               **options: Any) -> Pairs:
    """The candidates of one step alone, as Steps.candidates."""
    return _steps_of(before, faces, edges).candidates(before, after, **options)


def advance(before: ArrayLike, after: ArrayLike, faces: ArrayLike, edges: ArrayLike = (),
            **options: Any) -> AdvanceResult:
    """How far one step is free, as Steps.advance."""
    return _steps_of(before, faces, edges).advance(before, after, **options)
