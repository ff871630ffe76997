"""First times that PyTorch and JAX differentiate, compared with ccd.time_derivatives."""
import math

import numpy as np
import pytest

from errbound import autodiff, ccd

RANDOM = np.random.default_rng(5)
KIND = "vertex_face"


def some_queries(dtype):
    """Returns queries with contacts, without, and with undefined derivatives (of contacts at a corner)."""
    queries = RANDOM.integers(-3, 4, (500, 8, 3)) + RANDOM.random((500, 8, 3)) / 4
    corner = np.zeros((8, 3))
    corner[[2, 6], 0] = corner[[3, 7], 1] = corner[0, 2] = 1
    corner[4, 2] = -1
    return np.concatenate((queries, [corner])).astype(dtype)


def expected_of(queries, by_times, undefined=math.nan):
    found = ccd.time_derivatives(queries, KIND)
    times, gradients = np.full(len(queries), np.inf), np.zeros(queries.shape)
    times[found.query] = found.low
    assert found.defined.any() and not found.defined[-1] and len(found) < len(queries)
    for row, derivative, defined in zip(found.query, found.derivative, found.defined):
        if by_times[row] != 0:
            gradients[row] = by_times[row] * derivative.reshape(8, 3) if defined else undefined
    return times.astype(queries.dtype), gradients


def compare(times, gradients, expected):
    assert times.dtype == gradients.dtype == expected[0].dtype
    np.testing.assert_array_equal(times, expected[0])
    np.testing.assert_allclose(gradients, expected[1], rtol=1e-6 if gradients.dtype == np.float32 else 1e-15)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_torch(dtype):
    torch = pytest.importorskip("torch", reason="torch is not installed (pip install torch)")
    queries = some_queries(dtype)
    by_times = RANDOM.integers(0, 3, len(queries)).astype(dtype)
    by_times[-1] = 1
    for undefined in (math.nan, 0.0):
        given = torch.tensor(queries, requires_grad=True)
        times = autodiff.first_times(given, KIND, undefined=undefined)
        times.backward(torch.tensor(by_times))
        compare(times.detach().numpy(), given.grad.numpy(), expected_of(queries, by_times, undefined))
    before = torch.tensor(queries[:, :4], requires_grad=True)
    both = torch.cat((before, torch.tensor(queries[:, 4:])), 1)
    autodiff.first_times(both, KIND, undefined=0)[:4].nan_to_num(posinf=0).sum().backward()
    assert before.grad.isfinite().all()


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_jax(dtype):
    jax = pytest.importorskip("jax", reason="jax is not installed (pip install jax)")
    with jax.enable_x64(dtype is np.float64):
        queries = some_queries(dtype)
        by_times = RANDOM.integers(0, 3, len(queries)).astype(dtype)
        by_times[-1] = 1
        for undefined in (math.nan, 0.0):
            def first_times(given):
                return autodiff.first_times(given, KIND, undefined=undefined)
            for run in (first_times, jax.jit(first_times)):
                times, pull = jax.vjp(run, jax.numpy.asarray(queries))
                (gradients,) = pull(jax.numpy.asarray(by_times))
                compare(np.asarray(times), np.asarray(gradients), expected_of(queries, by_times, undefined))


def test_other_arrays_are_refused():
    with pytest.raises(TypeError, match="queries is of type ndarray; expected a tensor of PyTorch or an array of JAX"):
        autodiff.first_times(some_queries(float), KIND)
