"""Predicates: exact signs of geometric expressions, for every finite input.

Arguments are arrays of points, (n, d), or single points, (d,), which are broadcast. Results are int8 signs -1, 0, 1
of shape (n,), or one int if all arguments are single points.
Throws: ValueError with the row of a coordinate that is not finite.
Cost: a few times the plain expression in general position; microseconds, with integers, for degenerate points.
Arrays are copied unless they are C-contiguous float64. Single points are copied if other arguments are arrays.
Signs are Shewchuk's; CGAL's orient3d is the opposite.
"""
from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._arrays import as_array, check_finite, doubles

Signs = NDArray[np.int8] | int


def _signs(predicate: str, dimension: int, **points: ArrayLike) -> Signs:
    arrays = {}
    for name, values in points.items():
        array = as_array(name, values)
        shape = (dimension,) if array.ndim == 1 else (None, dimension)
        arrays[name] = doubles(name, array, shape)
    lengths = {len(a) for a in arrays.values() if a.ndim == 2}
    if len(lengths) > 1:
        found = ", ".join(f"{name} {len(a)}" for name, a in arrays.items() if a.ndim == 2)
        raise ValueError(f"{predicate}: numbers of points are {found}; expected equal numbers")
    count = lengths.pop() if lengths else 1
    rows = [np.ascontiguousarray(np.broadcast_to(a, (count, dimension))) for a in arrays.values()]
    signs: NDArray[np.int8] = getattr(_native, predicate)(rows)
    if signs.max(initial=0) > 1:
        for name, array in zip(arrays, rows):
            check_finite(name, array)
    return signs if any(a.ndim == 2 for a in arrays.values()) else int(signs[0])


def orient2d(a: ArrayLike, b: ArrayLike, c: ArrayLike) -> Signs:
    """Returns 1 where a, b, c turn left (counterclockwise), -1 right, 0 if collinear. Points (n, 2) or (2,)."""
    return _signs("orient2d", 2, a=a, b=b, c=c)


def orient3d(a: ArrayLike, b: ArrayLike, c: ArrayLike, d: ArrayLike) -> Signs:
    """Returns 1 where d is below the plane of a, b, c, which turn left seen from above; 0 if coplanar. Points (n, 3)
    or (3,)."""
    return _signs("orient3d", 3, a=a, b=b, c=c, d=d)


def incircle(a: ArrayLike, b: ArrayLike, c: ArrayLike, d: ArrayLike) -> Signs:
    """Returns 1 where d is inside the circle through a, b, c, which turn left; -1 outside. Points (n, 2) or (2,)."""
    return _signs("incircle", 2, a=a, b=b, c=c, d=d)


def insphere(a: ArrayLike, b: ArrayLike, c: ArrayLike, d: ArrayLike, e: ArrayLike) -> Signs:
    """Returns 1 where e is inside the sphere through a, b, c, d with orient3d > 0. Points (n, 3) or (3,)."""
    return _signs("insphere", 3, a=a, b=b, c=c, d=d, e=e)


def power_incircle(a: ArrayLike, b: ArrayLike, c: ArrayLike, d: ArrayLike) -> Signs:
    """Returns incircle of weighted points x, y, w: circles of squared radius w. (n, 3) or (3,)."""
    return _signs("power_incircle", 3, a=a, b=b, c=c, d=d)


def power_insphere(a: ArrayLike, b: ArrayLike, c: ArrayLike, d: ArrayLike, e: ArrayLike) -> Signs:
    """Returns insphere of weighted points x, y, z, w: spheres of squared radius w. (n, 4) or (4,)."""
    return _signs("power_insphere", 4, a=a, b=b, c=c, d=d, e=e)


def compare_distances2d(p: ArrayLike, a: ArrayLike, b: ArrayLike) -> Signs:
    """Returns -1 where p is nearer to a than to b, 0 at equal distances. Points (n, 2) or (2,)."""
    return _signs("compare_distances2d", 2, p=p, a=a, b=b)


def compare_distances3d(p: ArrayLike, a: ArrayLike, b: ArrayLike) -> Signs:
    """Returns -1 where p is nearer to a than to b, 0 at equal distances. Points (n, 3) or (3,)."""
    return _signs("compare_distances3d", 3, p=p, a=a, b=b)


def segments_intersect2d(a: ArrayLike, b: ArrayLike, c: ArrayLike, d: ArrayLike) -> Signs:
    """Returns 1 where closed segments ab and cd cross inside both, 0 if they touch otherwise, -1 apart. Points (n, 2)
    or (2,)."""
    return _signs("segments_intersect2d", 2, a=a, b=b, c=c, d=d)


def segments_intersect3d(a: ArrayLike, b: ArrayLike, c: ArrayLike, d: ArrayLike) -> Signs:
    """Returns 1 where closed segments ab and cd cross inside both, 0 if they touch otherwise, -1 apart. Points (n, 3)
    or (3,)."""
    return _signs("segments_intersect3d", 3, a=a, b=b, c=c, d=d)


def segment_intersects_triangle(p: ArrayLike, q: ArrayLike, a: ArrayLike, b: ArrayLike,
                                c: ArrayLike) -> Signs:
    """Returns 1 where closed segment pq and triangle abc cross inside both, 0 if they touch otherwise, -1 apart."""
    return _signs("segment_intersects_triangle", 3, p=p, q=q, a=a, b=b, c=c)


def triangle_intersects_triangle(a: ArrayLike, b: ArrayLike, c: ArrayLike, p: ArrayLike, q: ArrayLike,
                                 r: ArrayLike) -> Signs:
    """Returns 1 where closed triangles abc and pqr cross, 0 if they touch or overlap, -1 apart."""
    return _signs("triangle_intersects_triangle", 3, a=a, b=b, c=c, p=p, q=q, r=r)


def orient2d_line_line(a: ArrayLike, b: ArrayLike, c: ArrayLike, d: ArrayLike, q: ArrayLike,
                       r: ArrayLike) -> Signs:
    """Returns orient2d of the point where lines ab and cd meet, q and r; 0 if the lines are parallel."""
    return _signs("orient2d_line_line", 2, a=a, b=b, c=c, d=d, q=q, r=r)


def orient3d_line_plane(a: ArrayLike, b: ArrayLike, p: ArrayLike, q: ArrayLike, r: ArrayLike,
                        s: ArrayLike, t: ArrayLike, u: ArrayLike) -> Signs:
    """Returns orient3d of the point where line ab meets plane pqr, s, t and u; 0 if these are parallel."""
    return _signs("orient3d_line_plane", 3, a=a, b=b, p=p, q=q, r=r, s=s, t=t, u=u)


def compare_x_line_line(a: ArrayLike, b: ArrayLike, c: ArrayLike, d: ArrayLike, e: ArrayLike,
                        f: ArrayLike, g: ArrayLike, h: ArrayLike) -> Signs:
    """Compares x of the points where lines ab and cd, and ef and gh, meet; 0 if either does not exist."""
    return _signs("compare_x_line_line", 2, a=a, b=b, c=c, d=d, e=e, f=f, g=g, h=h)
