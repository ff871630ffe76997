"""First times of contact that PyTorch or JAX can differentiate.

    times = autodiff.first_times(torch.cat((before[pairs], after[pairs]), 1), "vertex_face")
    times[times.isfinite()].sum().backward()  # fills before.grad, after.grad
"""
from __future__ import annotations

import functools
import math
import sys
from typing import Any

import numpy as np

from . import ccd
from ._arrays import Doubles

__all__ = ["first_times"]


def first_times(queries: Any, kind: ccd.Kind, *, t_max: float = 1, undefined: float = math.nan) -> Any:
    """Returns the first times of contact of queries (n, 2k, 3), as ccd.first_time's low, (n,); infinite without contact.

    queries is a tensor of PyTorch or an array of JAX, in any precision; the result has its dtype and device. Gradients
    are those of ccd.time_derivatives, 0 without contact, and `undefined` in all components of undefined derivatives.
    Computes on the CPU. Throws: as ccd.decide; TypeError for other arrays.
    """
    torch, jax = sys.modules.get("torch"), sys.modules.get("jax")
    if torch is not None and isinstance(queries, torch.Tensor):
        return _torch_function().apply(queries, kind, t_max, undefined)
    if jax is not None and isinstance(queries, jax.Array):
        return _jax_function(kind, t_max, undefined)(queries)
    raise TypeError(f"queries is of type {type(queries).__name__}; expected a tensor of PyTorch or an array of JAX")


def _times_and_gradients(queries: Any, kind: ccd.Kind, t_max: float, undefined: float) -> tuple[Doubles, Doubles]:
    found = ccd.time_derivatives(queries, kind, t_max=t_max)
    times, gradients = np.full(len(queries), math.inf), np.zeros(queries.shape)
    times[found.query] = found.low
    defined = np.where(found.defined[:, None, None, None], found.derivative, undefined)
    gradients[found.query] = defined.reshape(-1, *queries.shape[1:])
    return times, gradients


@functools.cache
def _torch_function() -> Any:
    import torch

    class FirstTimes(torch.autograd.Function):  # type: ignore[misc, unused-ignore]
        @staticmethod
        def forward(ctx: Any, queries: Any, kind: ccd.Kind, t_max: float, undefined: float) -> Any:
            found = _times_and_gradients(queries.detach().cpu().numpy(), kind, t_max, undefined)
            times, gradients = (torch.from_numpy(x).to(queries) for x in found)
            ctx.save_for_backward(gradients)
            return times

        @staticmethod
        @torch.autograd.function.once_differentiable  # type: ignore[untyped-decorator, unused-ignore]
        def backward(ctx: Any, by_times: Any) -> Any:
            (gradients,) = ctx.saved_tensors
            by_time = by_times[:, None, None]
            return torch.where(by_time == 0, torch.zeros_like(gradients), by_time * gradients), None, None, None

    return FirstTimes


@functools.cache
def _jax_function(kind: ccd.Kind, t_max: float, undefined: float) -> Any:
    import jax
    import jax.numpy as jnp

    def forward(queries: Any) -> Any:
        def compute(values: Any) -> Any:
            found = _times_and_gradients(np.asarray(values), kind, t_max, undefined)
            return tuple(x.astype(values.dtype) for x in found)

        shapes = tuple(jax.ShapeDtypeStruct(shape, queries.dtype) for shape in (queries.shape[:1], queries.shape))
        return jax.pure_callback(compute, shapes, queries, vmap_method="sequential")

    def backward(gradients: Any, by_times: Any) -> Any:
        by_time = by_times[:, None, None]
        return (jnp.where(by_time == 0, 0, by_time * gradients),)

    times = jax.custom_vjp(lambda queries: forward(queries)[0])
    times.defvjp(forward, backward)
    return times
