"""Results of errbound.ccd: small classes of named arrays."""
from __future__ import annotations

from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

Doubles = NDArray[np.float64]
Indices = NDArray[np.uint32]
Codes = NDArray[np.uint8]
Flags = NDArray[np.bool_]
Kind = Literal["vertex_face", "edge_edge", "vertex_edge", "vertex_vertex"]
MethodName = Literal["float", "safe", "tight", "sharp", "interval", "residual",
                     "bsc-exact", "safeccd", "safeccd-tight", "provot", "root-parity", "exact"]
Times = dict[str, dict[str, Doubles]]


class Outcome(IntEnum):
    """Outcome of a query. UNCERTAIN: a method other than "exact" could not decide; count it as a contact."""
    SEPARATE = 0
    COLLIDES = 1
    UNCERTAIN = 2


class Relation(IntEnum):
    """How two elements at rest meet. CROSSING: small motions do not separate them."""
    DISJOINT = 0
    TOUCHING = 1
    OVERLAPPING = 2
    CROSSING = 3


class Features(IntEnum):
    """The features that meet. VERTEX_FACE and EDGE_EDGE: in the interior of both."""
    VERTEX_FACE = 0
    EDGE_EDGE = 1
    VERTEX_EDGE = 2
    VERTEX_VERTEX = 3


class NormalSource(IntEnum):
    """The source of a normal (docs/collision-detection.md#contact-data)."""
    CROSS_PRODUCT = 0
    NEAREST_POINTS = 1
    RELATIVE_VELOCITY = 2
    NONE = 3


class Motion(IntEnum):
    """How features move on after a first contact. TOUCHES: on one side before and after, without crossing.

    APPROACHES: to the other side, or the normal velocity is certainly negative.
    SLIDES: the motion stays in the plane of the features; with distances, the normal velocity is 0 within its error.
    UNKNOWN: contact at the start, or no certain sign.
    """
    UNKNOWN = 0
    APPROACHES = 1
    TOUCHES = 2
    SLIDES = 3


@dataclass(frozen=True)
class Stage:
    """Counts of queries in one stage of "exact", and its seconds summed over threads."""
    name: str
    entered: int
    skipped: int
    separate: int
    collides: int
    seconds: float


@dataclass(frozen=True)
class Method:
    """The name, guarantee and source of a method."""
    name: str
    may_lose_collisions: bool
    may_report_false_collisions: bool
    promise: str
    source: str


def _first(time: tuple[float, float] | None) -> str:
    return "no first contact" if time is None else f"first contact at {time[0]:.6g}"


@dataclass(frozen=True, eq=False, repr=False)
class Decisions:
    """One outcome per query: uint8 (n,), values of Outcome. stages: with stages=True, else None."""
    outcome: Codes
    stages: list[Stage] | None = None

    def __repr__(self) -> str:
        uncertain = np.count_nonzero(self.outcome == Outcome.UNCERTAIN)
        return (f"<ccd.Decisions of {len(self.outcome)} queries: {np.count_nonzero(self.collides)} collide, "
                f"{uncertain} uncertain>")

    @property
    def collides(self) -> Flags:
        """True for queries that certainly collide, (n,)."""
        return np.asarray(self.outcome == Outcome.COLLIDES)

    @property
    def may_collide(self) -> Flags:
        """True for queries that are not certainly separate, (n,). Equals collides if the method is "exact"."""
        return np.asarray(self.outcome != Outcome.SEPARATE)


@dataclass(frozen=True, eq=False, repr=False)
class FirstTimes:
    """The first contact times in [0, t_max] of the k queries that collide, in order of rows.

    query: uint64 (k,), rows. low, high: float64 (k,). The first time is strictly between these adjacent doubles,
    or equals both. Arrays may be strided views.
    """
    query: NDArray[np.uint64]
    low: Doubles
    high: Doubles

    def __len__(self) -> int:
        return len(self.query)

    def __repr__(self) -> str:
        first = f", the first at {self.low.min():.6g}" if len(self) else ""
        return f"<ccd.{type(self).__name__} of {len(self)} queries{first}>"

    @property
    def at_start(self) -> Flags:
        """True for queries in contact at t = 0, (k,)."""
        return np.asarray(self.high == 0)


@dataclass(frozen=True, eq=False, repr=False)
class FirstContacts(FirstTimes):
    """First times with contact data (docs/collision-detection.md#contact-data), k rows each; p: points of a query.

    features: uint8, values of Features. points: uint8 (k, p), the indices of the points of these features, then 0.
    weights: (k, p), each with an error of at most weight_error. normal: (k, 3), a unit vector from the second
    feature to the first, with an error of at most normal_error. normal_from: uint8, values of NormalSource.
    sided: True if the normal points to the side from which the first feature came.
    normal_velocity: lengths per step, negative on approach.
    """
    features: Codes
    points: Codes
    weights: Doubles
    weight_error: Doubles
    normal: Doubles
    normal_error: Doubles
    normal_from: Codes
    sided: Flags
    normal_velocity: Doubles
    normal_velocity_error: Doubles


@dataclass(frozen=True, eq=False, repr=False)
class TimeDerivatives(FirstTimes):
    """First times with their derivatives by positions (docs/collision-detection.md#derivatives), k rows each.

    derivative: (k, 2, p, 3), steps per length, by the positions at t = 0, then at t = 1, of the query's p points; 0 if
    undefined. error: (k,), bounds the error of every component; infinite if undefined.
    """
    derivative: Doubles
    error: Doubles

    @property
    def defined(self) -> Flags:
        """True if the time is certainly differentiable, (k,)."""
        return np.isfinite(self.error)


@dataclass(frozen=True, eq=False, repr=False)
class Nearness:
    """Nearest features of k queries and their points (docs/collision-detection.md#nearest-points-and-distances).

    features: uint8 (k,), values of Features. points: uint8 (k, p), the indices of the points of these features, then 0.
    weights: (k, p): the weighted sum of each feature's points is its nearest point. normal: (k, 3), a unit vector from
    the second feature to the first; 0 with an infinite error if they touch. Each number is off by at most its error.
    """
    features: Codes
    points: Codes
    weights: Doubles
    weight_error: Doubles
    squared_distance: Doubles
    squared_distance_error: Doubles
    distance: Doubles
    distance_error: Doubles
    normal: Doubles
    normal_error: Doubles

    def __len__(self) -> int:
        return len(self.features)

    def __repr__(self) -> str:
        least = f", the least distance is {self.distance.min():.6g}" if len(self) else ""
        return f"<ccd.Nearness of {len(self)} queries{least}>"

    @property
    def touches(self) -> Flags:
        """True for features whose distance is exactly 0, (k,)."""
        return np.asarray((self.distance == 0) & (self.distance_error == 0))


@dataclass(frozen=True, eq=False, repr=False)
class Pairs:
    """Pairs by kind, as sorted rows of uint32 vertex indices.

    vertex_face (k, 4): v f0 f1 f2; edge_edge (k, 4): a0 a1 b0 b1; vertex_edge (k, 3): v e0 e1; vertex_vertex (k, 2).
    """
    vertex_face: Indices
    edge_edge: Indices
    vertex_edge: Indices
    vertex_vertex: Indices

    def __len__(self) -> int:
        return sum(map(len, (self.vertex_face, self.edge_edge, self.vertex_edge, self.vertex_vertex)))

    def __repr__(self) -> str:
        return f"<ccd.Pairs, {_listed(self)}>"


def _listed(pairs: Any) -> str:
    kinds = {kind: len(getattr(pairs, kind))
             for kind in ("vertex_face", "edge_edge", "vertex_edge", "vertex_vertex")}
    counts = ", ".join(f"{count} {kind}" for kind, count in kinds.items() if count)
    return f"{sum(kinds.values())} pairs" + (f": {counts}" if counts else "")


@dataclass(frozen=True, eq=False, repr=False)
class IntersectionsOfKind:
    """The k intersections of one kind, sorted: uint32 vertices (k, m), both elements ascending, and their relations.

    In errbound.mpi, vertices are uint64 numbers.

    relation: uint8, values of Relation. segment: (k, 2, 3), the ends of the common segment of crossing pairs, each
    coordinate with an error of at most error (k, 2); NaN for other pairs, and with segments=False.
    """
    vertices: NDArray[Any]
    relation: Codes
    segment: Doubles
    error: Doubles

    def __len__(self) -> int:
        return len(self.vertices)


@dataclass(frozen=True, eq=False, repr=False)
class Intersections:
    """The pairs of elements of a mesh at rest that intersect, by kind (IntersectionsOfKind).

    Columns of vertices: face_face a0 a1 a2 b0 b1 b2; edge_face e0 e1 f0 f1 f2 (edges of no face); vertex_face
    v f0 f1 f2 (vertices of no face and edge); edge_edge a0 a1 b0 b1; vertex_edge v e0 e1; vertex_vertex v w.
    edge_faces: (k, 5), with edge_faces=True: all edges, of faces or not, and faces that share a point and no vertex.
    """
    face_face: IntersectionsOfKind
    edge_face: IntersectionsOfKind
    vertex_face: IntersectionsOfKind
    edge_edge: IntersectionsOfKind
    vertex_edge: IntersectionsOfKind
    vertex_vertex: IntersectionsOfKind
    edge_faces: Indices | None = None
    seconds: float | None = None

    @property
    def by_kind(self) -> dict[str, IntersectionsOfKind]:
        """The members of the six kinds, by name."""
        return {kind: getattr(self, kind) for kind in INTERSECTION_KINDS}

    def count(self, relation: Relation) -> int:
        """The number of pairs, of all kinds, with this relation."""
        return sum(int(np.count_nonzero(of.relation == relation)) for of in self.by_kind.values())

    def __len__(self) -> int:
        return sum(map(len, self.by_kind.values()))

    def __repr__(self) -> str:
        counts = ", ".join(f"{self.count(r)} {r.name.lower()}" for r in Relation if self.count(r))
        return f"<ccd.Intersections, {len(self)} pairs{': ' if counts else ''}{counts}>"


INTERSECTION_KINDS = ("face_face", "edge_face", "vertex_face", "edge_edge", "vertex_edge", "vertex_vertex")


def intersections_of(found: Any) -> Intersections:
    def of_kind(arrays: Any) -> IntersectionsOfKind:
        return IntersectionsOfKind(**{**arrays, "segment": arrays["segment"].reshape(-1, 2, 3)})

    members: dict[str, Any] = {name: of_kind(value) if name in INTERSECTION_KINDS else value
                               for name, value in found.items()}
    return Intersections(**members)


def at_start(found: Any) -> Intersections | None:
    return None if found is None else intersections_of(found)


@dataclass(frozen=True, eq=False, repr=False)
class NearPairs:
    """The pairs of a mesh at rest within a distance. data: by kind, in the order of pairs."""
    pairs: Pairs
    data: dict[str, Nearness]

    def __len__(self) -> int:
        return len(self.pairs)

    def __repr__(self) -> str:
        return f"<ccd.NearPairs, {_listed(self.pairs)}>"


@dataclass(frozen=True, eq=False)
class LeastDistance:
    """Bounds of the least distance of the pairs of a mesh at rest, and a nearest pair with its data.

    Without pairs, the bounds are infinite, and kind, vertices and data are None.
    """
    low: float
    high: float
    kind: Kind | None
    vertices: tuple[int, ...] | None
    data: Nearness | None


@dataclass(frozen=True, eq=False, repr=False)
class StepResult:
    """The pairs of a step that are not certainly separate. Members without their option are None or empty.

    times: by kind, dictionaries of low and high, float64 (k,), as in FirstTimes, in the order of pairs.
    first_contact (options first_contact, times): (low, high) of the earliest pair that does not touch at t = 0.
    first_pairs: the pairs with that time.
    touching_at_start (options initial_contact, first_contact, times): pairs that touch at t = 0.
    candidates: counts by kind. seconds: by phase.
    intersections_at_start (option check_start): the mesh's intersections at t = 0, without segments.
    """
    pairs: Pairs
    touching_at_start: Pairs
    times: Times | None
    first_contact: tuple[float, float] | None
    first_pairs: Pairs
    candidates: dict[str, int] | None
    seconds: dict[str, float]
    threads: int
    stages: list[Stage] | None
    intersections_at_start: Intersections | None

    def __repr__(self) -> str:
        contact = f"; {_first(self.first_contact)}" if self.times is not None or self.first_contact else ""
        return f"<ccd.StepResult, {_listed(self.pairs)}{contact}; {self.seconds['total']:.3g} s>"


@dataclass(frozen=True, eq=False, repr=False)
class TimedStepResult(StepResult):
    """A StepResult with times=True: its times is not None."""
    times: Times


@dataclass(frozen=True, eq=False, repr=False)
class Passages(FirstContacts):
    """First contacts of the pairs of one kind, how they move on, and how deep; query has the rows of the pairs.

    motion: uint8, values of Motion. depth: float64 (k,), how far the contact points have moved past each other along the
    normal at t = 1. Its error is at most depth_error. It is 0 with an infinite error for contacts without a side, such as
    those at the start.
    """
    motion: Codes
    depth: Doubles
    depth_error: Doubles


@dataclass(frozen=True, eq=False, repr=False)
class Certificate:
    """The pairs in contact in a step, and the elements that intersect at its start. passages: by kind, as step.pairs."""
    step: TimedStepResult
    passages: dict[Kind, Passages]

    @property
    def is_free(self) -> bool:
        """True if the mesh does not intersect itself at any time of the step."""
        return len(self.step.pairs) == 0 and not self.step.intersections_at_start

    def __repr__(self) -> str:
        at_start = self.step.intersections_at_start
        return (f"<ccd.Certificate, {'free' if self.is_free else 'not free'}: {len(at_start) if at_start else 0} "
                f"intersections at the start, {_listed(self.step.pairs)} in contact>")


@dataclass(frozen=True)
class Reason:
    """A pair that limits a step: its vertices, the bracket of its time, its motion and its distance at the start.

    normal_velocity: lengths per step, negative on approach. query: (8, 3), of the kind stored_kind, for io.write_queries:
    the pair alone. The face of a vertex_edge or vertex_vertex pair has equal corners.
    """
    kind: Kind
    vertices: tuple[int, ...]
    time: tuple[float, float]
    motion: Motion
    normal_velocity: float
    normal_velocity_error: float
    distance_at_start: float
    distance_at_start_error: float
    stored_kind: Literal["vertex_face", "edge_edge"]
    query: Doubles = field(repr=False, compare=False)


@dataclass(frozen=True, eq=False, repr=False)
class AdvanceResult:
    """The positions up to which the step is certainly free of contact, except for the listed pairs.

    positions: float64, with the shape of before. fractions: (n,), the fraction of its path that each vertex moves;
    fraction: the least. first_contact: (low, high) of the earliest contact in the whole step, or None; first_pairs: the
    pairs with that time, which limit the step. near_at_start: pairs that are near at t = 0 and
    keep only the share of the option keep.
    intersections_at_start (option check_start): elements that intersect at t = 0; they may move on through each other.
    """
    positions: Doubles
    fraction: float
    fractions: Doubles
    first_contact: tuple[float, float] | None
    first_pairs: Pairs
    touching_at_start: Pairs
    near_at_start: Pairs
    intersections_at_start: Intersections | None = None

    def __repr__(self) -> str:
        return (f"<ccd.AdvanceResult of {len(self.positions)} vertices: fraction {self.fraction!r}, "
                f"{_first(self.first_contact)}; {len(self.touching_at_start)} pairs touching at the start>")


def stages(rows: Any) -> list[Stage] | None:
    return None if rows is None else [Stage(*row) for row in rows]
