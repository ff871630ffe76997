"""Compares errbound.cuda with errbound.ccd, on arrays of device memory that ctypes makes by CUDA's runtime.

ERRBOUND_CUDA_RUNTIME is the runtime: libcudart, or the library of the emulator (tests/ccd/cuda/emulator).
"""
import ctypes
import ctypes.util
import gc
import itertools
import os
import unittest
import weakref
from unittest import mock

import numpy as np

from errbound import ccd, cuda

TO_DEVICE, TO_HOST = 1, 2  # cudaMemcpyKind
KINDS = "vertex_face", "edge_edge"


class Tensor(ctypes.Structure):
    _fields_ = [("data", ctypes.c_void_p), ("device_type", ctypes.c_int32), ("device", ctypes.c_int32),
                ("ndim", ctypes.c_int32), ("code", ctypes.c_uint8), ("bits", ctypes.c_uint8),
                ("lanes", ctypes.c_uint16), ("shape", ctypes.POINTER(ctypes.c_int64)),
                ("strides", ctypes.POINTER(ctypes.c_int64)), ("byte_offset", ctypes.c_uint64)]


class ManagedTensor(ctypes.Structure):
    _fields_ = [("tensor", Tensor), ("context", ctypes.c_void_p), ("delete", ctypes.c_void_p)]


class Attributes(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("device", ctypes.c_int), ("pointers", ctypes.c_void_p * 2),
                ("reserved", ctypes.c_long * 8)]


new_capsule, pointer_of, rename = (ctypes.pythonapi[f"PyCapsule_{name}"] for name in ("New", "GetPointer", "SetName"))
new_capsule.restype = ctypes.py_object
new_capsule.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p]
pointer_of.restype = ctypes.c_void_p
pointer_of.argtypes = [ctypes.py_object, ctypes.c_char_p]
rename.argtypes = [ctypes.py_object, ctypes.c_char_p]
Deleter = ctypes.CFUNCTYPE(None, ctypes.c_void_p)
exported = {}  # capsules that are not deleted: address: (tensor, array)
delete = Deleter(lambda address: exported.pop(address) and None)


class Runtime:
    """CUDA's runtime. A call that fails raises RuntimeError."""

    def __init__(self, path):
        self._library = ctypes.CDLL(path)

    def call(self, name, *arguments):
        error = getattr(self._library, name)(*arguments)
        if error:
            raise RuntimeError(f"{name} fails with error {error}")

    def malloc(self, size):
        p = ctypes.c_void_p()
        self.call("cudaMalloc", ctypes.byref(p), ctypes.c_size_t(size))
        return p.value or 0

    def copy(self, to, source, size, kind, stream=None):
        self.call("cudaMemcpyAsync", ctypes.c_void_p(to), ctypes.c_void_p(source), ctypes.c_size_t(size), kind,
                  ctypes.c_void_p(stream))

    def wait(self, stream=None):
        self.call("cudaStreamSynchronize", ctypes.c_void_p(stream))

    def new_stream(self):
        stream = ctypes.c_void_p()
        self.call("cudaStreamCreate", ctypes.byref(stream))
        return stream.value

    def is_allocated(self, address):
        found = Attributes()
        self.call("cudaPointerGetAttributes", ctypes.byref(found), ctypes.c_void_p(address))
        return found.type == 2


path = os.environ.get("ERRBOUND_CUDA_RUNTIME") or ctypes.util.find_library("cudart")
runtime = Runtime(path) if path and cuda.available() else None
on_device = unittest.skipUnless(runtime, "no errbound with CUDA, no device, or no ERRBOUND_CUDA_RUNTIME")


class DeviceArray:
    """A copy of a NumPy array with its strides. Work that writes it is on `stream`, and pending if there is one."""

    def __init__(self, values, stream=None, device_type=2, gap=0):
        self.host, self.stream, self.device_type, self.dtype = values, stream, device_type, values.dtype
        low, high = np.lib.array_utils.byte_bounds(values) if values.size else (0, 0)
        self.offset = values.ctypes.data - low + gap if values.size else 0
        self._memory = runtime.malloc(gap + high - low)
        runtime.copy(self._memory + gap, low, high - low, TO_DEVICE, stream)
        if stream is None:
            runtime.wait()

    def __del__(self):
        runtime.call("cudaFree", ctypes.c_void_p(self._memory))


class WithInterface(DeviceArray):
    version = 3
    changes = {}

    @property
    def __cuda_array_interface__(self):
        found = {"shape": self.host.shape, "typestr": self.dtype.str,
                 "data": (self._memory + self.offset if self.host.size else 0, True), "version": self.version,
                 "strides": None if self.host.flags.c_contiguous else self.host.strides}
        if self.version == 3:
            found["stream"] = self.stream
        return {**found, **self.changes}


class WithOldInterface(WithInterface):
    version = 2


class WithCapsule(DeviceArray):
    last_stream = None  # of the last call

    def __dlpack_device__(self):
        return self.device_type, 0

    def __dlpack__(self, *, stream=None):
        self.last_stream = stream
        if self.stream is not None and stream != self.stream:
            runtime.wait(self.stream)
        return self.capsule()

    def capsule(self):
        n, size = self.host.ndim, self.host.dtype.itemsize
        made = ManagedTensor()
        strides = (ctypes.c_int64 * n)(*(s // size for s in self.host.strides))
        strides = None if self.host.flags.c_contiguous else strides
        shape = (ctypes.c_int64 * n)(*self.host.shape)
        made.tensor = Tensor(self._memory, self.device_type, 0, n, {"i": 0, "u": 1, "f": 2}[self.dtype.kind], 8 * size,
                             1, shape, strides, self.offset)
        made.delete = ctypes.cast(delete, ctypes.c_void_p)
        address = ctypes.addressof(made)
        exported[address] = made, shape, strides, self
        return new_capsule(address, b"dltensor", None)


class WithOldCapsule(DeviceArray):
    """A producer without streams and without __dlpack_device__."""

    def __dlpack__(self):
        return WithCapsule.capsule(self)


PRODUCERS = WithCapsule, WithInterface, WithOldInterface, WithOldCapsule


def read(array):
    """Returns what __dlpack__ and __cuda_array_interface__ describe, which must be equal."""
    interface = array.__cuda_array_interface__
    address, _ = interface["data"]
    dtype = np.dtype(interface["typestr"])
    assert interface["version"] == 3 and interface["stream"] is None and interface["shape"] == array.shape
    size = (len(array) - 1) * interface["strides"][0] + dtype.itemsize * np.prod(array.shape[1:], dtype=int)
    host = np.zeros(max(size, 0), np.uint8)
    if len(array):
        runtime.copy(host.ctypes.data, address, size, TO_HOST)
        runtime.wait()
    capsule = array.__dlpack__(stream=7, max_version=(1, 0), dl_device=array.__dlpack_device__(), copy=False)
    made = ManagedTensor.from_address(pointer_of(capsule, b"dltensor"))
    tensor = made.tensor
    assert ((tensor.data or 0) + tensor.byte_offset == address or not len(array)) and tensor.device_type == 2
    assert (tensor.shape[:tensor.ndim], tensor.bits) == (list(array.shape), 8 * dtype.itemsize)
    assert [n * dtype.itemsize for n in tensor.strides[:tensor.ndim]] == list(interface["strides"])
    assert "iuf"[tensor.code] == dtype.kind and tensor.lanes == 1
    rename(capsule, b"used_dltensor")
    Deleter(made.delete)(ctypes.addressof(made))
    found = np.ndarray(array.shape, dtype, host, 0, interface["strides"])
    np.testing.assert_array_equal(found, array.numpy())
    return found


def random_queries(count, dtype, seed=1):
    """Returns positions of 40 vertices at both ends, and pairs of them; a third of the vertices has a coarse grid."""
    random = np.random.default_rng(seed)
    before, after = random.uniform(-1, 1, (2, 40, 3)).astype(dtype)
    before[::3], after[::3] = np.round(before[::3]), np.round(after[::3])
    pairs = np.array([random.permutation(40)[:4] for _ in range(count)], np.uint32).reshape(-1, 4)
    return before, after, pairs


def sheets(n, dtype=float):
    x, y = np.meshgrid(np.arange(n) / n, np.arange(n) / n)
    before = np.concatenate([np.stack([x, y, z + 0.05 * np.sin(9 * x + z) * np.cos(7 * y)], -1).reshape(-1, 3)
                             for z in (0.0, 0.4)]).astype(dtype)
    after = before.copy()
    after[n * n:, 2] -= 0.5
    i = np.arange(n - 1)
    a = (i[:, None] * n + i).ravel()
    faces = np.concatenate([np.stack([a, a + 1, a + n], -1), np.stack([a + n + 1, a + n, a + 1], -1)])
    return before, after, np.concatenate([faces, faces + n * n])


@on_device
class Answers(unittest.TestCase):
    def test_decisions_are_the_hosts(self):
        makers = itertools.cycle(PRODUCERS)
        for dtype, kind in itertools.product((np.float64, np.float32), KINDS):
            before, after, pairs = random_queries(200, dtype)
            for method, precision in (("exact", "float64"), ("exact", "float32"), ("safe", "float64")):
                if (dtype, method) == (np.float32, "safe"):
                    continue  # a method in floats may leave other queries uncertain
                with self.subTest(dtype=dtype, kind=kind, method=method, precision=precision):
                    make = next(makers)
                    queries = make(np.asfortranarray(pairs) if precision == "float32" else pairs.view(np.int32), gap=32)
                    found = cuda.decide(queries, kind, positions=(make(before), make(after)), method=method,
                                        precision=precision)
                    expected = ccd.decide(pairs, kind, positions=(before, after), method=method)
                    self.assertGreater(expected.may_collide.sum(), 5)
                    np.testing.assert_array_equal(read(found.outcome), expected.outcome)

    def test_first_times_are_the_hosts(self):
        for kind, dtype in zip(KINDS, (np.float64, np.float32)):
            before, after, pairs = random_queries(200, dtype)
            expected = ccd.first_time(pairs, kind, positions=(before, after))
            arguments = WithCapsule(pairs), kind
            positions = WithInterface(before), WithInterface(after)
            found = cuda.first_time(*arguments, positions=positions)
            for name in "query", "low", "high":
                np.testing.assert_array_equal(read(getattr(found, name)), getattr(expected, name))
            self.assertTrue((read(found.outcome) == ccd.Outcome.COLLIDES).all() and len(found) > 5)
            half = cuda.first_time(*arguments, positions=positions, t_max=0.5)
            touching = read(half.outcome) == ccd.Outcome.COLLIDES
            early = ccd.first_time(pairs, kind, positions=(before, after), t_max=0.5)
            np.testing.assert_array_equal(read(half.query)[touching], early.query)
            np.testing.assert_array_equal(read(half.low)[touching], early.low)
            self.assertLess(len(early), len(expected))

    def test_strided_positions(self):
        before, after, pairs = random_queries(60, np.float64)
        expected = ccd.decide(pairs, "vertex_face", positions=(before, after)).outcome
        padded = np.zeros((80, 5))
        padded[::2, 1:4] = before
        for make in PRODUCERS:
            found = cuda.decide(make(pairs), "vertex_face",
                                positions=(make(padded[::2, 1:4]), make(np.asfortranarray(after))))
            np.testing.assert_array_equal(found.outcome.numpy(), expected)

    def test_coordinates_that_are_not_finite(self):
        before, after, pairs = random_queries(60, np.float64)
        after[pairs[3, 0]] = np.nan
        found = cuda.decide(WithCapsule(pairs), "edge_edge", positions=(WithCapsule(before), WithCapsule(after)))
        uncertain = found.outcome.numpy() == ccd.Outcome.UNCERTAIN
        np.testing.assert_array_equal(uncertain, (pairs == pairs[3, 0]).any(1))
        with self.assertRaisesRegex(ValueError, "^a coordinate is not finite$"):
            cuda.step(WithCapsule(before), WithCapsule(after), np.arange(39).reshape(-1, 3))

    def expect_step(self, found, expected):
        for kind in KINDS:
            for name in "pairs", "touching_at_start":
                np.testing.assert_array_equal(read(getattr(getattr(found, name), kind)),
                                              getattr(getattr(expected, name), kind))
            for name in ("low", "high") if expected.times else ():
                np.testing.assert_array_equal(read(found.times[kind][name]), expected.times[kind][name])
            self.assertEqual(found.candidates[kind], expected.candidates[kind])
        self.assertEqual(found.first_contact, expected.first_contact)
        self.assertEqual(found.times is None, expected.times is None)

    def test_steps_are_the_hosts(self):
        before, after, faces = sheets(6)
        kept = cuda.Steps(WithCapsule(faces), vertices=len(before))
        for options in ({}, {"times": True}, {"first_contact": True, "t_max": 0.85}, {"initial_contact": True}):
            with self.subTest(options=options):
                expected = ccd.step(before, after, faces, count_candidates=True, **options)
                self.assertGreater(len(expected.pairs), 5)
                self.expect_step(kept.run(WithCapsule(before), WithInterface(after), **options), expected)
        floats = [x.astype(np.float32) for x in (before, after)]
        expected = ccd.step(*floats, faces, count_candidates=True)
        self.expect_step(cuda.step(*map(WithOldInterface, floats), faces, precision="float32"), expected)
        frames = WithCapsule(before), WithCapsule(after)
        again = cuda.decide(kept.run(*frames).pairs.edge_edge, "edge_edge", positions=frames)  # a result as argument
        self.assertTrue((again.outcome.numpy() == ccd.Outcome.COLLIDES).all())

    def test_empty_arrays(self):
        none, no_pairs = np.zeros((0, 3)), np.zeros((0, 4), np.uint32)
        before, after, _ = random_queries(0, np.float64)
        for make in WithCapsule, WithInterface:
            for frames in (none, none), (before, after):
                frames = [make(frame) for frame in frames]
                found = cuda.decide(make(no_pairs), "edge_edge", positions=frames).outcome
                self.assertEqual(read(found).shape, (0,))
                self.assertEqual(len(cuda.first_time(make(no_pairs), "vertex_face", positions=frames)), 0)
            result = cuda.step(make(none), make(none), make(np.zeros((0, 3), np.int32)), times=True)
            self.assertEqual(read(result.pairs.edge_edge).shape, (0, 4))
            self.assertEqual(read(result.times["edge_edge"]["low"]).shape, (0,))


@on_device
class StreamsAndLifetime(unittest.TestCase):
    def setUp(self):
        self.before, self.after, self.pairs = random_queries(60, np.float64)
        self.expected = ccd.decide(self.pairs, "edge_edge", positions=(self.before, self.after)).outcome

    def decide(self, arrays, **options):
        pairs, before, after = arrays
        return cuda.decide(pairs, "edge_edge", positions=(before, after), **options).outcome

    def arrays(self, make, *stream):
        return [make(x, *stream) for x in (self.pairs, self.before, self.after)]

    def test_work_waits_for_the_arrays_streams(self):
        """The emulator queues copies until their stream is waited for. Without a wait, their memory is not written."""
        producer, own = runtime.new_stream(), runtime.new_stream()
        for make, stream in itertools.product((WithCapsule, WithInterface), (producer, own, None)):
            arrays = self.arrays(make, producer)
            np.testing.assert_array_equal(self.decide(arrays, stream=stream).numpy(), self.expected)
            if make is WithCapsule:
                self.assertEqual([x.last_stream for x in arrays], [stream or 1] * 3)
            del arrays  # before the next copies are queued: cudaFree waits for all streams

    def test_objects_of_streams(self):
        stream = runtime.new_stream()
        for members in {"ptr": stream}, {"cuda_stream": stream}, {"__cuda_stream__": lambda self: (0, stream)}:
            arrays = self.arrays(WithCapsule)
            self.decide(arrays, stream=type("Stream", (), members)())
            self.assertEqual(arrays[0].last_stream, stream)
        for stream, error in ((-1, ValueError), ("0", TypeError), (1.5, TypeError)):
            with self.assertRaisesRegex(error, "^stream is "):
                self.decide(self.arrays(WithCapsule), stream=stream)

    def test_arguments_are_released(self):
        for make in PRODUCERS:
            arrays = self.arrays(make)
            outcome = self.decide(arrays)
            seen = [weakref.ref(x) for x in arrays]
            del arrays
            gc.collect()
            self.assertEqual([x() for x in seen], [None] * 3)
            self.assertFalse(exported)
            np.testing.assert_array_equal(outcome.numpy(), self.expected)

    def test_results_outlive_their_step_and_are_freed(self):
        before, after, faces = sheets(4)
        steps = cuda.Steps(faces, vertices=len(before))
        frames = WithCapsule(before), WithCapsule(after)
        first = steps.run(*frames, times=True)
        expected = first.pairs.vertex_face.numpy()
        steps.run(frames[0], frames[0])
        low = first.times["vertex_face"]["low"]
        address, _ = low.__cuda_array_interface__["data"]
        capsule = low.__dlpack__()
        del steps, frames, low
        gc.collect()
        np.testing.assert_array_equal(first.pairs.vertex_face.numpy(), expected)
        del first
        gc.collect()
        self.assertTrue(runtime.is_allocated(address))  # of the capsule
        del capsule
        gc.collect()
        self.assertFalse(runtime.is_allocated(address))


class Refused(unittest.TestCase):
    @on_device
    def test_arguments(self):
        before, after, pairs = random_queries(10, np.float64)
        good = {"queries": pairs, "before": before, "after": after}

        def decide(kind="vertex_face", options={}, **changed):
            arrays = {name: x if type(x) is list else WithInterface(x) for name, x in good.items()} | changed
            cuda.decide(arrays["queries"], kind, positions=(arrays["before"], arrays["after"]), **options)

        def interface(**changes):
            made = WithInterface(before)
            made.changes = changes
            return {"before": made}

        for error, message, changed in (
                (TypeError, "before is ndarray in the host's memory; expected .*errbound.ccd", {"before": before}),
                (TypeError, "queries is list in the host's memory", {"queries": pairs.tolist()}),
                (TypeError, "after is WithCapsule in the host's memory", {"after": WithCapsule(after, device_type=1)}),
                (TypeError, "DLPack's device type of after is 10", {"after": WithOldCapsule(after, device_type=10)}),
                (TypeError, "before is an array of int64", {"before": WithCapsule(before.astype("i8"))}),
                (TypeError, "before is an array of >f8", interface(typestr=">f8")),
                (TypeError, "after is an array of float32", {"after": WithCapsule(after.astype("f4"))}),
                (TypeError, "queries is an array of int64", {"queries": WithCapsule(pairs.astype("i8"))}),
                (ValueError, r"shape of before is \(40, 2\); expected", {"before": WithCapsule(before[:, :2])}),
                (ValueError, r"shape of queries is \(40,\); expected", {"queries": WithCapsule(pairs.ravel())}),
                (ValueError, r"shape of after is \(\)", {"after": WithInterface(np.array(1.0))}),
                (ValueError, "number of vertices in after is 39; expected 40", {"after": WithCapsule(after[:-1])}),
                (ValueError, r"strides of before are \(-3, 1\) items", {"before": WithCapsule(before[::-1])}),
                (ValueError, r"strides of before are \(25, 8\) bytes", interface(strides=(25, 8))),
                (ValueError, r"queries have strides \(8, 1\)", {"queries": WithCapsule(np.repeat(pairs, 2, 0)[::2])}),
                (ValueError, "queries have strides .* a multiple of 16", {"queries": WithCapsule(pairs, gap=4)}),
                (ValueError, "address of before is 0x0; expected", interface(data=(0, False))),
                (ValueError, "address of before is 0x1003; expected one in", interface(data=(4099, False))),
                (ValueError, "__cuda_array_interface__ of before has version 1,", interface(version=1)),
                (ValueError, "of before has version 3, stream 0,", interface(stream=0)),
                (ValueError, "of before has version 3, stream None, mask True", interface(mask=True)),
                (ValueError, "kind is 'vertex_edge'; expected one of vertex_face, edge_edge", {"kind": "vertex_edge"}),
                (ValueError, "method is 'provot'; expected one of float, safe", {"options": {"method": "provot"}}),
                (ValueError, "precision is 'half'; expected one of", {"options": {"precision": "half"}})):
            with self.subTest(message=message), self.assertRaisesRegex(error, message):
                decide(**changed)
        with self.assertRaisesRegex(TypeError, "positions is int; expected a pair"):
            cuda.decide(WithCapsule(pairs), "edge_edge", positions=3)
        with self.assertRaisesRegex(ValueError, "t_max is nan"):
            cuda.first_time(WithCapsule(pairs), "edge_edge", positions=(WithCapsule(before), WithCapsule(after)),
                            t_max=float("nan"))
        gc.collect()
        exported.clear()  # refused capsules have no consumer

    @on_device
    def test_steps(self):
        before, after, faces = sheets(4)
        frames = WithCapsule(before), WithCapsule(after)
        with self.assertRaisesRegex(IndexError, "vertex index in row 0 of faces is 32"):
            cuda.step(*frames, WithCapsule(faces + 32))
        with self.assertRaisesRegex(ValueError, r"strides of faces are \(1, 36\) items; expected \(3, 1\)"):
            cuda.step(*frames, WithCapsule(np.asfortranarray(faces)))
        with self.assertRaisesRegex(ValueError, "number of vertices in before is 32; expected 33"):
            cuda.Steps(faces, vertices=33).run(*frames)
        with self.assertRaisesRegex(ValueError, "number of vertices on no edge is 3; expected at most 1"):
            cuda.Steps(np.concatenate([faces, [[33, 33, 33]]]), vertices=35)
        with self.assertRaisesRegex(ValueError, "method is tight; expected exact with options for times"):
            cuda.step(*frames, faces, method="tight", times=True)
        with self.assertRaisesRegex(TypeError, "times is 1; expected True or False"):
            cuda.step(*frames, faces, times=1)
        outcome = cuda.step(*frames, faces).pairs.vertex_face
        for options in {"copy": True}, {"dl_device": (1, 0)}:
            with self.assertRaises(BufferError):
                outcome.__dlpack__(**options)

    def test_without_cuda(self):
        calls = (lambda: cuda.decide(1, "edge_edge", positions=(1, 1)), lambda: cuda.step(1, 1, 1),
                 lambda: cuda.first_time(1, "edge_edge", positions=(1, 1)), lambda: cuda.Steps([[0, 1, 2]], vertices=3))
        for extension, message in ((None, "built without CUDA .*python/package.sh --cuda"),
                                   (mock.Mock(fault=lambda: "CUDA: no device"), "^CUDA: no device; expected a CUDA")):
            with mock.patch.object(cuda, "_cuda", extension):
                self.assertFalse(cuda.available())
                for call in calls:
                    self.assertRaisesRegex(RuntimeError, message, call)


if __name__ == "__main__":
    if "ERRBOUND_CUDA_RUNTIME" in os.environ and not cuda.available():
        raise SystemExit("no device, but a runtime is given")
    unittest.main(verbosity=2)
