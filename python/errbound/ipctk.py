"""For ipc-toolkit's Python package (pip install ipctk): its broad phase, and its two questions about
steps, answered exactly.

    import errbound.ipctk

    broad_phase = errbound.ipctk.BroadPhase()
    ipctk.compute_collision_free_stepsize(mesh, before, after, 0, broad_phase)  # only pairs that meet
    errbound.ipctk.compute_collision_free_stepsize(mesh, before, after)         # or all of it, exactly
"""
from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import ccd
from ._results import StepResult

try:
    import ipctk  # type: ignore[import-not-found, import-untyped, unused-ignore]
except ImportError as error:
    raise ImportError("errbound.ipctk needs the package ipctk: pip install ipctk") from error

__all__ = ["BroadPhase", "compute_collision_free_stepsize", "is_step_collision_free"]

_CanCollide = Callable[[int, int], bool]
_FIRST_VERTICES = {"vertex_face": 1, "edge_edge": 2, "vertex_edge": 1, "vertex_vertex": 1}


def _steps(vertices: int, columns: int, edges: Any, faces: Any) -> ccd.Steps:
    if columns == 2:
        return ccd.Steps.in_plane(edges, vertices=vertices)
    return ccd.Steps(faces, edges, vertices=vertices)


def _may_collide(kind: str, pair: Any, can_collide: _CanCollide) -> bool:
    """As the toolkit has it: if some vertex of one element may collide with some of the other."""
    first = _FIRST_VERTICES[kind]
    return any(can_collide(int(v), int(w)) for v, w in product(pair[:first], pair[first:]))


class _Lookup:
    """Numbers of elements by their vertices; of elements that are given twice, all."""

    def __init__(self, elements: Any) -> None:
        self._numbers: dict[tuple[int, ...], list[int]] = {}
        for number, element in enumerate(np.sort(np.asarray(elements), axis=1).tolist()):
            self._numbers.setdefault(tuple(element), []).append(number)

    def __call__(self, vertices: Any) -> list[int]:
        return self._numbers.get(tuple(sorted(int(v) for v in vertices)), [])


class BroadPhase(ipctk.BroadPhase):  # type: ignore[misc, unused-ignore]
    """Hands on only pairs that come within twice the inflation radius of each other, exactly.

    Boxes that are inflated by a radius meet where their elements come within twice the radius, and
    in many other places; those are left out. Pairs of faces and edges, and of two faces, which the
    toolkit asks to find intersections, are those of its own default. Elements with a common vertex
    are no pair.
    """

    def __init__(self) -> None:
        super().__init__()
        self._inner = ipctk.LBVH() if hasattr(ipctk, "LBVH") else ipctk.BVH()
        self._found: StepResult | None = None

    def name(self) -> str:
        return "errbound"

    def build(self, *arguments: Any) -> None:
        """(vertices, edges, faces, inflation_radius), or (vertices_t0, vertices_t1, edges, faces,
        inflation_radius)."""
        moving = np.ndim(arguments[2]) == 2 and len(arguments) >= 4 and np.ndim(arguments[3]) == 2
        before, after = arguments[0], arguments[1 if moving else 0]
        edges, faces, *rest = arguments[2 if moving else 1:]
        self._before, self._after = np.asarray(before, float), np.asarray(after, float)
        self._edges, self._faces = np.asarray(edges).reshape(-1, 2), np.asarray(faces).reshape(-1, 3)
        self._distance = 2 * float(rest[0]) if rest else 0.0
        super().build(*arguments)  # notes the dimension, and clears
        self._inner.can_vertices_collide = self.can_vertices_collide
        self._inner.build(*arguments)
        self._found = None

    def clear(self) -> None:
        self._inner.clear()
        self._found = None

    def _pairs(self, kind: str) -> Iterator[Any]:
        """Of the whole mesh, found once, those that the mesh lets collide."""
        if self._found is None:
            steps = _steps(len(self._before), self._before.shape[1], self._edges, self._faces)
            self._found = steps.run(self._before, self._after, distance=self._distance)
        for pair in getattr(self._found.pairs, kind):
            if _may_collide(kind, pair, self.can_vertices_collide):
                yield pair

    def _decided(self, kind: str, pairs: list[tuple[int, int]], rows: Any) -> list[tuple[int, int]]:
        """Those of the default's pairs whose elements, `rows` of vertices, come near enough."""
        if not pairs:
            return []
        before, after = self._before, self._after
        if before.shape[1] == 2:
            before, after = (np.pad(x, ((0, 0), (0, 1))) for x in (before, after))
        near = ccd.decide(rows, kind, positions=(before, after), distance=self._distance).collides
        return [pair for pair, is_near in zip(pairs, near) if is_near]

    def detect_edge_edge_candidates(self) -> list[tuple[int, int]]:
        number = _Lookup(self._edges)
        return [(i, j) for pair in self._pairs("edge_edge")
                for i, j in product(number(pair[:2]), number(pair[2:]))]

    def detect_face_vertex_candidates(self) -> list[tuple[int, int]]:
        number = _Lookup(self._faces)
        return [(i, int(pair[0])) for pair in self._pairs("vertex_face") for i in number(pair[1:])]

    def detect_edge_vertex_candidates(self) -> list[tuple[int, int]]:
        pairs = [(c.edge_id, c.vertex_id) for c in self._inner.detect_edge_vertex_candidates()]
        return self._decided("vertex_edge", pairs, [(v, *self._edges[e]) for e, v in pairs])

    def detect_vertex_vertex_candidates(self) -> list[tuple[int, int]]:
        pairs = [(c.vertex0_id, c.vertex1_id) for c in self._inner.detect_vertex_vertex_candidates()]
        return self._decided("vertex_vertex", pairs, pairs)

    def detect_edge_face_candidates(self) -> list[tuple[int, int]]:
        return [(c.edge_id, c.face_id) for c in self._inner.detect_edge_face_candidates()]

    def detect_face_face_candidates(self) -> list[tuple[int, int]]:
        return [(c.face0_id, c.face1_id) for c in self._inner.detect_face_face_candidates()]


class _Step:
    """Steps of a toolkit's mesh, with the pairs that it lets collide."""

    def __init__(self, mesh: Any, before: ArrayLike, min_distance: float) -> None:
        self.before, self.distance = np.asarray(before, float), float(min_distance)
        self._can_collide = mesh.can_collide
        self._steps = _steps(len(self.before), self.before.shape[1], mesh.edges, mesh.faces)

    def first(self, after: Any) -> float:
        """The least double at or before the first contact; infinite if there is none."""
        found = self._steps.run(self.before, after, distance=self.distance, times=True)
        assert found.times is not None
        return min((float(low) for kind in _FIRST_VERTICES
                    for pair, low in zip(getattr(found.pairs, kind), found.times[kind]["low"])
                    if _may_collide(kind, pair, self._can_collide)), default=np.inf)


def is_step_collision_free(mesh: Any, vertices_t0: ArrayLike, vertices_t1: ArrayLike,
                           min_distance: float = 0.0) -> bool:
    """Whether no two elements touch, or come within min_distance, on the straight way from
    vertices_t0 to vertices_t1: no tolerance, no false alarm."""
    return _Step(mesh, vertices_t0, min_distance).first(np.asarray(vertices_t1, float)) == np.inf


def compute_collision_free_stepsize(mesh: Any, vertices_t0: ArrayLike, vertices_t1: ArrayLike,
                                    min_distance: float = 0.0) -> float:
    """The largest step size found to be free, from 0 to 1: on the way from vertices_t0 to
    vertices_t0 + step * (vertices_t1 - vertices_t0), rounded as NumPy does, no two elements touch or
    come within min_distance. 0 if some do so at the start."""
    step = _Step(mesh, vertices_t0, min_distance)
    after = np.asarray(vertices_t1, float)
    size = step.first(after)
    if size == np.inf:
        return 1.0
    # The end of a step to the contact itself is rounded, and may be one: a little less then.
    less = 2.0**-52
    while size > 0:
        if step.first(step.before + size * (after - step.before)) == np.inf:
            return size
        size, less = size * (1 - less), 2 * less
    return 0.0
