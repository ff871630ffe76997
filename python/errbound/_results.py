"""What errbound.ccd returns: small classes of named arrays."""
from __future__ import annotations

from dataclasses import dataclass
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
    """Of a query. UNCERTAIN: a method other than "exact" could not tell; count it as contact."""
    SEPARATE = 0
    COLLIDES = 1
    UNCERTAIN = 2


class Features(IntEnum):
    """Which features meet; VERTEX_FACE and EDGE_EDGE: inside both."""
    VERTEX_FACE = 0
    EDGE_EDGE = 1
    VERTEX_EDGE = 2
    VERTEX_VERTEX = 3


class NormalSource(IntEnum):
    """What a normal is: docs/collision-detection.md#contact-data."""
    CROSS_PRODUCT = 0
    NEAREST_POINTS = 1
    RELATIVE_VELOCITY = 2
    NONE = 3


@dataclass(frozen=True)
class Stage:
    """What a stage of "exact" did: numbers of queries, and seconds of all threads together."""
    name: str
    entered: int
    left_out: int
    separate: int
    collides: int
    seconds: float


@dataclass(frozen=True)
class Method:
    """A method by name, what it promises, and its source."""
    name: str
    may_lose_collisions: bool
    may_report_false_collisions: bool
    promise: str
    source: str


def _first(time: tuple[float, float] | None) -> str:
    return "no first contact" if time is None else f"first contact at {time[0]:.6g}"


@dataclass(frozen=True, eq=False, repr=False)
class Decisions:
    """One outcome a query, uint8 (n,), as Outcome numbers them; stages if they were asked for."""
    outcome: Codes
    stages: list[Stage] | None = None

    def __repr__(self) -> str:
        uncertain = np.count_nonzero(self.outcome == Outcome.UNCERTAIN)
        return (f"<ccd.Decisions of {len(self.outcome)} queries: {np.count_nonzero(self.collides)} collide, "
                f"{uncertain} uncertain>")

    @property
    def collides(self) -> Flags:
        """Which certainly collide, (n,)."""
        return np.asarray(self.outcome == Outcome.COLLIDES)

    @property
    def may_collide(self) -> Flags:
        """Which are not certainly separate, (n,): the same, if the method is "exact"."""
        return np.asarray(self.outcome != Outcome.SEPARATE)


@dataclass(frozen=True, eq=False, repr=False)
class FirstTimes:
    """The k queries that collide, ascending, with their first times in [0, t_max].

    query: uint64 (k,), their rows. low, high: float64 (k,): the first time is strictly between these
    neighbouring doubles, or is both. Arrays may be views with a stride.
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
        """Which hold at t = 0 already, (k,)."""
        return np.asarray(self.high == 0)


@dataclass(frozen=True, eq=False, repr=False)
class FirstContacts(FirstTimes):
    """The same, and how they meet (docs/collision-detection.md#contact-data), k rows each:

    features: uint8, as Features numbers them. points: uint8 (k, p), p the number of points of the query: the indices
    of those that meet, as many as features says, then 0. weights: (k, p), one for each point of the query, each off
    by at most weight_error. normal: (k, 3), of unit length from the second feature to the first, off by at most
    normal_error; normal_from, uint8, as NormalSource numbers it; sided, bool: whether it points to where
    the first feature was. normal_velocity: lengths a step, negative if they approach.
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
class Pairs:
    """Pairs of vertex indices, uint32, each list sorted: vertex_face (k, 4): v f0 f1 f2; edge_edge (k, 4):
    a0 a1 b0 b1; vertex_edge (k, 3): v e0 e1; vertex_vertex (k, 2)."""
    vertex_face: Indices
    edge_edge: Indices
    vertex_edge: Indices
    vertex_vertex: Indices

    def __len__(self) -> int:
        return sum(map(len, (self.vertex_face, self.edge_edge, self.vertex_edge, self.vertex_vertex)))

    def __repr__(self) -> str:
        return f"<ccd.Pairs, {_listed(self)}>"


def _listed(pairs: Any) -> str:
    """The numbers of pairs, of those kinds that there are."""
    kinds = {kind: len(getattr(pairs, kind))
             for kind in ("vertex_face", "edge_edge", "vertex_edge", "vertex_vertex")}
    counts = ", ".join(f"{count} {kind}" for kind, count in kinds.items() if count)
    return f"{sum(kinds.values())} pairs" + (f": {counts}" if counts else "")


@dataclass(frozen=True, eq=False, repr=False)
class StepResult:
    """The pairs of a step that are not certainly separate; what else was asked for, else None or empty.

    times: by kind, dictionaries of low and high, float64 (k,) as FirstTimes has them, in the order of
    pairs. first_contact: (low, high) of the earliest pair that does not touch at the start, or None; option
    times asks for it, too. touching_at_start: those that do, by the options initial_contact, first_contact, times.
    candidates: counts by kind. seconds: by phase.
    """
    pairs: Pairs
    touching_at_start: Pairs
    times: Times | None
    first_contact: tuple[float, float] | None
    candidates: dict[str, int] | None
    seconds: dict[str, float]
    threads: int
    stages: list[Stage] | None

    def __repr__(self) -> str:
        told = f"; {_first(self.first_contact)}" if self.times is not None or self.first_contact else ""
        return f"<ccd.StepResult, {_listed(self.pairs)}{told}; {self.seconds['total']:.3g} s>"


@dataclass(frozen=True, eq=False, repr=False)
class TimedStepResult(StepResult):
    """The result of a step with times=True: a StepResult whose times is not None."""
    times: Times


@dataclass(frozen=True, eq=False, repr=False)
class AdvanceResult:
    """Positions, float64 and of the shape of before, to which the step is certainly free, except for the pairs listed.

    fraction: the least of fractions, (n,), those of the way that each vertex goes. first_contact: (low,
    high) of the earliest contact on the whole way, or None.
    """
    positions: Doubles
    fraction: float
    fractions: Doubles
    first_contact: tuple[float, float] | None
    touching_at_start: Pairs
    near_at_start: Pairs

    def __repr__(self) -> str:
        return (f"<ccd.AdvanceResult of {len(self.positions)} vertices: fraction {self.fraction!r}, "
                f"{_first(self.first_contact)}; {len(self.touching_at_start)} pairs touching at the start>")


def stages(rows: Any) -> list[Stage] | None:
    return None if rows is None else [Stage(*row) for row in rows]
