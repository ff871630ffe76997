"""Exact continuous collision detection of bodies that turn: rigid and affine motion between two poses.

Poses are an array (n, 7), a row for each body: x y z of the position, then w x y z of a quaternion q. A pose means the
rotation q/|q| about the body's origin, then the translation, without rounding. Between two poses the position moves
linearly. The quaternion is interpolated linearly and normalised, along the shorter arc (docs/collision-detection.md).
Affine poses are matrices (n, 4, 4) with the last row 0 0 0 1, interpolated linearly. "Exact" is about the poses as
given: no vertex is rounded. Bodies whose poses are equal rest; two resting bodies are not tested.
"""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._arrays import (Doubles, Indices, as_array, check_finite, check_shape, checked_indices, distance_option, doubles,
                      end_time, option, restated)
from ._results import Pairs, Times, _first, _listed

__all__ = ["BodyAdvance", "BodyStep", "Bodies"]


@dataclass(frozen=True, eq=False, repr=False)
class BodyStep:
    """The pairs of elements of different bodies that touch, or come within the distance.

    Vertices are numbered consecutively over all bodies.

    times: by kind, dictionaries of low and high, float64 (k,), as in ccd.FirstTimes, in the order of pairs.
    first_contact: (low, high) of the earliest pair that does not touch at t = 0, or None. first_pairs: the pairs with
    that time. crossing_at_start (option check_start): edges that go through the inside of another body's face at t = 0,
    (k, 5): e0 e1 f0 f1 f2. candidates: counts by kind. body_pairs: the number of two bodies whose swept boxes touch.
    """
    pairs: Pairs
    times: Times
    touching_at_start: Pairs
    first_contact: tuple[float, float] | None
    first_pairs: Pairs
    candidates: dict[str, int]
    body_pairs: int
    crossing_at_start: Indices | None = None

    def __repr__(self) -> str:
        return f"<bodies.BodyStep, {_listed(self.pairs)}; {_first(self.first_contact)}>"


@dataclass(frozen=True, eq=False, repr=False)
class BodyAdvance:
    """The poses up to which all bodies can move without contact, except that of the pairs in touching_at_start.

    poses: in the form of start, (n, 7) or (n, 4, 4). Start the next step from exactly these: with quaternions that you
    normalise, nothing is certified. fraction: of the way of all bodies. first_contact: (low, high) of the earliest
    contact on the whole way, or None; first_pairs: the pairs with that time. crossing_at_start: as in BodyStep.
    """
    poses: Doubles
    fraction: float
    first_contact: tuple[float, float] | None
    first_pairs: Pairs
    touching_at_start: Pairs
    crossing_at_start: Indices | None = None

    def __repr__(self) -> str:
        return f"<bodies.BodyAdvance of {len(self.poses)} bodies: fraction {self.fraction!r}, {_first(self.first_contact)}>"


def _groups_of(groups: ArrayLike | None, bodies: int) -> NDArray[np.int32]:
    """Returns numbers from 0, or an empty array without groups."""
    if groups is None:
        return np.empty(0, np.int32)
    array = as_array("groups", groups)
    check_shape("groups", array, (bodies,))
    if array.size and array.dtype.kind not in "iu":
        raise TypeError(f"groups is an array of {array.dtype}; expected integers")
    return np.unique(array, return_inverse=True)[1].astype(np.int32)


def _skipped(skip: ArrayLike, bodies: int) -> NDArray[np.int32]:
    """Returns sorted pairs, the lesser body first."""
    pairs = as_array("skip", skip)
    if pairs.size == 0:
        return np.empty((0, 2), np.int32)
    check_shape("skip", pairs, (None, 2))
    if pairs.dtype.kind not in "iu":
        raise TypeError(f"skip is an array of {pairs.dtype}; expected integers")
    wrong = (pairs < 0) | (pairs >= bodies)
    if wrong.any():
        row = int(np.argwhere(wrong)[0][0])
        raise IndexError(f"body index in row {row} of skip is {pairs[row][wrong[row]][0]}; expected 0 to {bodies - 1}")
    return np.unique(np.sort(pairs, axis=1), axis=0).astype(np.int32)


class Bodies:
    """Bodies with meshes in their own coordinates. Keeps their trees from step to step.

    meshes: a sequence of (vertices, faces) or (vertices, faces, edges), for each body: (m, 3) coordinates, and indices
    (k, 3) and (k, 2) into them. A call from a second thread throws RuntimeError.
    groups: integers (n,), one per body: tests only bodies of different groups against each other.
    skip: pairs of bodies (k, 2) that are not tested against each other, such as bodies that a joint connects.
    """

    def __init__(self, meshes: Sequence[Sequence[ArrayLike]], *, groups: ArrayLike | None = None,
                 skip: ArrayLike = ()) -> None:
        shapes = []
        first = [0]
        for i, mesh in enumerate(meshes):
            if len(mesh) not in (2, 3):
                raise ValueError(f"length of meshes[{i}] is {len(mesh)}; expected (vertices, faces) or "
                                 "(vertices, faces, edges)")
            vertices = doubles(f"vertices of meshes[{i}]", mesh[0], (None, 3))
            check_finite(f"vertices of meshes[{i}]", vertices)
            faces = checked_indices(f"faces of meshes[{i}]", mesh[1], 3, len(vertices))
            edges = checked_indices(f"edges of meshes[{i}]", mesh[2] if len(mesh) == 3 else (), 2, len(vertices))
            shapes.append((vertices, faces, edges))
            first.append(first[-1] + len(vertices))
        count = len(shapes)
        self._bodies = _native.Bodies(shapes, _groups_of(groups, count), _skipped(skip, count))
        self.first_vertex: NDArray[np.int64] = np.array(first, np.int64)
        """The number of each body's first vertex; the last is the number of all vertices."""

    def __len__(self) -> int:
        return len(self.first_vertex) - 1

    def __repr__(self) -> str:
        return f"<bodies.Bodies: {len(self)} bodies of {self.first_vertex[-1]} vertices>"

    def body_of(self, vertices: ArrayLike) -> NDArray[np.int64]:
        """Returns the body of each vertex of a result, an array of the same shape."""
        found: NDArray[np.int64] = np.searchsorted(self.first_vertex, np.asarray(vertices), side="right") - 1
        return found

    def _poses(self, name: str, values: ArrayLike) -> Doubles:
        if as_array(name, values).ndim != 3:
            poses = doubles(name, values, (None, 7))
        else:
            poses = doubles(name, values, (None, 4, 4))
            wrong = (poses[:, 3] != (0, 0, 0, 1)).any(axis=1)
            if wrong.any():
                row = int(np.argmax(wrong))
                raise ValueError(f"last row of {name}[{row}] is {poses[row, 3].tolist()}; expected [0, 0, 0, 1]")
            poses = np.ascontiguousarray(poses[:, :3].reshape(len(poses), 12))
        check_shape(name, poses, (len(self), poses.shape[1]))
        check_finite(name, poses)
        return poses

    def _ways(self, start: ArrayLike, end: ArrayLike) -> tuple[Doubles, Doubles]:
        at_start, at_end = self._poses("start", start), self._poses("end", end)
        if at_start.shape != at_end.shape:
            raise ValueError(f"shape of end is {np.shape(end)}; expected {np.shape(start)}, as of start")
        return at_start, at_end

    def run(self, start: ArrayLike, end: ArrayLike, *, distance: float = 0, t_max: float = 1,
            check_start: bool = False, threads: int = 0) -> BodyStep:
        """Returns the pairs that touch, or come within `distance`, in [0, t_max], with first times.

        start, end: the bodies' poses at t = 0 and t = 1, (n, 7) or (n, 4, 4). check_start: fills crossing_at_start. An
        edge inside another body's face during the whole step is in no pair. Throws: ValueError with the body if its
        two orientations differ by half a turn or nearly so: use poses between them.
        """
        ways = self._ways(start, end)
        try:
            found = self._bodies.run(*ways, distance_option(distance), end_time(t_max),
                                     option("check_start", check_start, bool), option("threads", threads, int))
        except ValueError as error:
            raise restated(error) from None
        for name in "pairs", "first_pairs", "touching_at_start":
            found[name] = Pairs(**found[name])
        return BodyStep(**found)

    def advance(self, start: ArrayLike, end: ArrayLike, *, distance: float = 0, conservative: float = 1,
                check_start: bool = False, threads: int = 0) -> BodyAdvance:
        """Returns the poses of the longest common step that was found to be free of contact.

        conservative: the share of the way to the first contact (or distance) that is used, in (0, 1]. Otherwise as run.
        """
        ways = self._ways(start, end)
        share: float = option("conservative", conservative, float)
        if not (math.isfinite(share) and 0 < share <= 1):
            raise ValueError(f"conservative is {share}; expected a number in (0, 1]")
        try:
            found = self._bodies.advance(*ways, distance_option(distance), share,
                                         option("check_start", check_start, bool), option("threads", threads, int))
        except ValueError as error:
            raise restated(error) from None
        for name in "first_pairs", "touching_at_start":
            found[name] = Pairs(**found[name])
        if found["poses"].shape[1] == 12:
            matrices = np.tile(np.eye(4), (len(self), 1, 1))
            matrices[:, :3] = found["poses"].reshape(-1, 3, 4)
            found["poses"] = matrices
        return BodyAdvance(**found)
