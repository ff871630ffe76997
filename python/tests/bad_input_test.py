"""Errors name the argument, also those of arguments that earlier versions accepted or reported without a name."""
import copy
import pickle
import subprocess
import sys
from fractions import Fraction

import numpy as np
import pytest

import errbound
from errbound import ccd, io, predicates, roots, tracked

BEFORE = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, 1.0]])
AFTER = BEFORE - [[0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 2]]
FACES = [[0, 1, 2]]
QUERY = np.concatenate([BEFORE[[3, 0, 1, 2]], AFTER[[3, 0, 1, 2]]])[None]
FRAMES = io.Mesh(BEFORE, np.array(FACES)), io.Mesh(AFTER, np.array(FACES))


@pytest.mark.parametrize("options, error, message", [
    ({"threads": -1}, ValueError, "threads is -1; expected 0 to"),
    ({"threads": 2**40}, ValueError, "threads is 1099511627776; expected 0 to"),
    ({"threads": 1.5}, TypeError, "threads is 1.5; expected an integer"),
    ({"threads": True}, TypeError, "threads is True; expected an integer"),
    ({"method": 3}, TypeError, "method is 3; expected a name"), ({"method": "x"}, ValueError, "method is 'x'"),
    ({"times": 1}, TypeError, "times is 1; expected True or False"),
    ({"distance": "a"}, TypeError, "distance is 'a'; expected a number"),
    ({"distance": Fraction(1, 3)}, ValueError, "expected a number that a double equals"),
    ({"islands": [0] * 4}, TypeError, "option is 'islands'; expected one of"),
    ({"can_collide": 3}, TypeError, "can_collide is 3; expected a function of two vertices"),
    ({"can_collide": lambda v, w: None}, TypeError, "result of can_collide is None; expected True or False"),
    ({"can_collide": lambda v, w: 1 // 0}, ZeroDivisionError, "by zero"),
    ({"distance": -1}, ValueError, "distance is -1.0; expected a finite number >= 0"),
    ({"distance": np.nan}, ValueError, "distance is nan"), ({"t_max": np.inf}, ValueError, "t_max is inf"),
    ({"thickness": [0, 0, np.inf, 0]}, ValueError, "thickness of vertex 2 is inf"),
    ({"thickness": 0.1}, ValueError, "thickness is 0.1; expected a number for each of 4 vertices, or distance= for one"),
    ({"thickness": [0, 0]}, ValueError, r"shape of thickness is \(2,\); expected \(4,\)"),
    ({"method": "tight", "times": True}, ValueError, "^method is tight; expected exact"),
    ({"between_groups": False}, ValueError, "between_groups is False without groups"),
    ({"pinned": [0, 3]}, ValueError, r"shape of pinned is \(2,\); expected \(4,\): a flag for each vertex"),
    ({"pinned": [0, 3, 1, 2]}, ValueError, "pinned is an array of int64 with other values than 0 and 1"),
    ({"pinned": [0, 1, 0, -255]}, ValueError, "pinned is an array of int64 with other values than 0 and 1"),
    ({"pinned": [0, .5, 0, 1]}, ValueError, "pinned is an array of float64 with other values than 0 and 1"),
])
def test_options_of_steps(options, error, message):
    with pytest.raises(error, match=message):
        ccd.step(BEFORE, AFTER, FACES, **options)


@pytest.mark.parametrize("wrong, error, message", [
    ([2**53 + 1, 1], ValueError, "row 0 of thickness is 9007199254740993; expected a number that a double equals"),
    ([.5, 2**53 + 1], ValueError, "row 1 of thickness is 9007199254740993; expected"),
    ([1, Fraction(1, 3)], ValueError, "row 1 of thickness is 1/3; expected a number that a double equals"),
    (np.array([1, np.longdouble(1) / 3]), ValueError, "row 1 of thickness is 0.333"),
    (np.array([1, 2**63 + 1], np.uint64), ValueError, "row 1 of thickness is 9223372036854775809"),
    ([10**400, 1], ValueError, "row 0 of thickness is 1000"),
    ([1, 1j], TypeError, "thickness has items of type complex128; expected real numbers"),
    (["1", "2"], TypeError, "thickness has items of type <U1; expected real numbers"),
    ([True, False], TypeError, "thickness has items of type bool; expected real numbers"),
    ([True, .5], TypeError, "thickness has items of type bool; expected real numbers"),
    ([None, 1], TypeError, "thickness has items of type NoneType; expected real numbers"),
    ([1, -1], ValueError, "thickness of vertex 1 is -1.0; expected a finite number >= 0"),
])
def test_numbers_are_not_rounded(wrong, error, message):
    """thickness was rounded silently. Points 0 and 2^53 + 2: thicknesses 2^53 + 1 and 1 reach, 2^53 and 1 do not."""
    positions = np.array([[0, 0, 0], [2.0**53 + 2, 0, 0]])
    with pytest.raises(error, match=message):
        ccd.decide([[0, 1]], "vertex_vertex", positions=(positions, positions), thickness=wrong)


@pytest.mark.parametrize("exact", [
    [2**53 + 2, 0], [Fraction(2**53 + 2), 0], np.array([2**53 + 2, 0], np.longdouble), [2.0**53 + 2, Fraction(1, 4)],
    np.array([2**53 + 2, 0], np.uint64), np.array([2**53 + 2, 1], object)])
def test_numbers_that_doubles_equal_are_taken(exact):
    positions = np.array([[0, 0, 0], [2.0**53 + 2, 0, 0]])
    assert ccd.decide([[0, 1]], "vertex_vertex", positions=(positions, positions), thickness=exact).collides.all()


@pytest.mark.parametrize("wrong, error, message", [
    ([[0, 0, 2**53 + 1]], ValueError, "row 0 of before is 9007199254740993; expected a number that a double equals"),
    ([[0, 0, .5], [0, 2**53 + 1, 0]], ValueError, "row 1 of before is 9007199254740993; expected"),
    ([[0, 0, True], [0, 0, .5]], TypeError, "before has items of type bool; expected real numbers")])
def test_positions_are_not_rounded(wrong, error, message):
    with pytest.raises(error, match=message):
        ccd.step(wrong, np.zeros((len(wrong), 3)), ())


def test_frames_have_the_same_vertices():
    with pytest.raises(ValueError, match="number of vertices in after is 3; expected 4"):
        ccd.step(BEFORE, AFTER[:3], FACES)


def test_indices_without_positions():
    with pytest.raises(ValueError, match=r"queries is an array of shape \(1, 4\) without positions=; expected "
                                         r"coordinates of shape \(n, 8, 3\), or vertex indices with positions="):
        ccd.decide([[3, 0, 1, 2]], "vertex_face")
    with pytest.raises(ValueError, match="thickness is given without positions=; expected both"):
        ccd.decide(QUERY, "vertex_face", thickness=[1, 1, 1, 1])


class OnlyDlpack:
    def __init__(self, array, device=(1, 0)):
        self._array, self._device = array, device

    def __dlpack__(self, **options):
        return self._array.__dlpack__(**options)

    def __dlpack_device__(self):
        return self._device


def test_objects_that_only_have_dlpack():
    assert ccd.decide(OnlyDlpack(QUERY), "vertex_face").collides.all()
    assert ccd.step(OnlyDlpack(BEFORE), OnlyDlpack(AFTER), OnlyDlpack(np.array(FACES))).pairs.vertex_face.tolist()

    class Unreadable(OnlyDlpack):
        def __dlpack__(self, **options):
            raise BufferError("of a device")

    with pytest.raises(TypeError, match=r"queries is Unreadable, which NumPy cannot read \(of a device\); expected"):
        ccd.decide(Unreadable(QUERY), "vertex_face")


@pytest.mark.parametrize("truth", [[.5], ["yes"], [2]])
def test_truth_is_booleans(truth, tmp_path):
    with pytest.raises(TypeError, match="truth is an array of .*; expected booleans, or 0 and 1"):
        io.write_queries(tmp_path / "vf.csv", QUERY, truth)


@pytest.mark.parametrize("vertices, faces, edges", [
    (BEFORE, [], ()), (BEFORE, np.empty((0, 3)), np.empty((0, 2))), ([], [], []), (np.empty((0, 3)), [], ())])
def test_empty_arrays_are_written(vertices, faces, edges, tmp_path):
    io.write_mesh(tmp_path / "mesh.ply", vertices, faces, edges)
    assert b"element face 0" in (tmp_path / "mesh.ply").read_bytes()


def test_options_have_types_and_descriptions():
    hints = ccd.SearchOptions.__annotations__.keys()
    assert ccd._OF_SEARCH.keys() == hints and ccd._OF_ADVANCE.keys() == ccd.AdvanceOptions.__annotations__.keys()
    assert ccd._OF_RUN.keys() == ccd.RunOptions.__annotations__.keys()
    message = " ".join(c.__doc__ for c in (ccd.SearchOptions, ccd.UntimedOptions, ccd.RunOptions, ccd.AdvanceOptions))
    assert all(name in message for name in [*ccd._OF_RUN, *ccd._OF_ADVANCE])


@pytest.mark.parametrize("call", [ccd.step, ccd.advance, ccd.candidates])
def test_coordinates_that_are_not_finite_are_named(call):
    for name, frames in ("before", (BEFORE * np.nan, AFTER)), ("after", (BEFORE, np.where(AFTER < 0, np.inf, AFTER))):
        row = 3 if name == "after" else 0
        with pytest.raises(ValueError, match=rf"^row {row} of {name} is \[.*\]; expected finite numbers"):
            call(*frames, FACES)
    flat = ccd.Steps.in_plane([[0, 1]], vertices=4)
    with pytest.raises(ValueError, match=r"^row 1 of after is \[inf, 0.0\]"):
        flat.run(BEFORE[:, :2], np.array([[0, 0], [np.inf, 0], [0, 0], [0, 0]]))


def test_exceptions_of_callbacks_are_not_replaced():
    def refuse(v, w):
        raise errbound.FileError("mine")

    with pytest.raises(errbound.FileError, match="^mine$"):
        ccd.step(BEFORE, AFTER, FACES, can_collide=refuse)


@pytest.mark.parametrize("dtype", [np.int64, np.int32])
def test_the_range_of_indices_is_that_of_the_mesh(dtype):
    wrong = np.array([[0, 1, 2, -1]], dtype)
    message = "is -1; expected 0 to 3"
    with pytest.raises(IndexError, match=f"vertex index in row 0 of queries {message}"):
        ccd.decide(wrong, "vertex_face", positions=(BEFORE, AFTER))
    with pytest.raises(IndexError, match=f"vertex index in row 0 of faces {message}"):
        ccd.step(BEFORE, AFTER, wrong[:, 1:])
    for refuse in ccd.Steps, lambda faces, vertices: ccd.Steps.in_plane([[0, 1]], vertices=vertices):
        with pytest.raises(TypeError, match="vertices is 4.0; expected an integer"):
            refuse(FACES, vertices=4.0)
    with pytest.raises(IndexError, match="expected no index, since there are no vertices"):
        ccd.Steps(FACES, vertices=0)


@pytest.mark.parametrize("positions, message", [
    (BEFORE, r"an array of shape \(4, 3\)"), ((BEFORE, AFTER, AFTER), "a sequence of 3 items"), ((BEFORE,), "a sequence of 1 items"), (5, "int")])
def test_positions_are_a_pair(positions, message):
    with pytest.raises(TypeError, match=f"positions is {message}; expected a pair"):
        ccd.decide([[3, 0, 1, 2]], "vertex_face", positions=positions)
    assert ccd.decide([[3, 0, 1, 2]], "vertex_face", positions=np.stack([BEFORE, AFTER])).collides.all()


def test_a_mesh_is_no_array():
    for call in lambda: ccd.step(*FRAMES, FACES), lambda: ccd.step(BEFORE, AFTER, FRAMES[0]):
        with pytest.raises(TypeError, match="is Mesh; expected an array, such as its vertices or its faces"):
            call()


@pytest.mark.parametrize("name", ["mesh.obj", "mesh.stl", "mesh"])
def test_other_files_of_meshes_are_not_written(name, tmp_path):
    with pytest.raises(ValueError, match="path is .*; expected a name that ends in .ply"):
        io.write_mesh(tmp_path / name, BEFORE, FACES)
    assert list(tmp_path.iterdir()) == []


def test_options_of_another_call_are_no_options():
    with pytest.raises(TypeError, match="option is 'times'; expected one of"):
        ccd.advance(BEFORE, AFTER, FACES, times=True)
    with pytest.raises(TypeError, match="option is 'method'; expected one of"):
        ccd.candidates(BEFORE, AFTER, FACES, method="exact")


def test_numpys_scalars_are_options_and_answers():
    assert len(ccd.step(BEFORE, AFTER, FACES, threads=np.int32(1), times=np.bool_(True),
                        distance=np.float32(0.5), can_collide=lambda v, w: np.bool_(True)).pairs) == 1
    assert len(ccd.step(BEFORE, AFTER, FACES, can_collide=lambda v, w: np.bool_(False)).pairs) == 0


@pytest.mark.parametrize("options", [{"threads": "1"}, {"t_max": "1"}, {"t_max": None}])
def test_options_of_queries(options):
    with pytest.raises(TypeError, match=f"{next(iter(options))} is "):
        ccd.first_time(QUERY, "vertex_face", **options)


@pytest.mark.parametrize("call", [
    lambda x: ccd.decide(x, "vertex_face"), lambda x: ccd.step(x[0], x[0], FACES),
    lambda x: predicates.orient3d(*x[0, :4]), lambda x: tracked.array(x),
    lambda x: ccd.step(BEFORE, AFTER, FACES, thickness=x[0, :4, 0]),
    lambda x: ccd.Steps(np.ma.masked_equal(FACES, 1), vertices=4),
])
def test_masks_are_not_dropped(call):
    with pytest.raises(TypeError, match="is a masked array; expected one without a mask"):
        call(np.ma.masked_greater(QUERY, 2))


def test_arrays_of_zero_rows(tmp_path):
    """NumPy cannot reshape an empty array to a shape of unknown or nonzero size."""
    with pytest.raises(ValueError, match="number of queries is 0; expected one or more"):
        io.write_queries(tmp_path / "none.csv", np.empty((0, 8, 3)))
    assert not (tmp_path / "none.csv").exists()
    assert roots.count(np.empty((0, 3))).shape == (0,)
    with pytest.raises(ValueError, match=r"shape of a is \(0,\); expected \(2,\)"):
        predicates.orient2d([], [0, 0], [1, 1])


@pytest.mark.parametrize("name", ["queries.h5", "QUERIES.HDF5"])
def test_queries_are_not_written_as_csv_to_a_file_of_a_store(name, tmp_path):
    with pytest.raises(ValueError, match=f"path is '.*{name}'; expected the name of a CSV file"):
        io.write_queries(tmp_path / name, QUERY)
    assert list(tmp_path.iterdir()) == []


def test_rows_of_different_lengths_name_the_argument():
    with pytest.raises(ValueError, match="queries: "):
        ccd.decide([[1, 2], [3]], "vertex_face")


@pytest.mark.parametrize("p, error, message", [
    ([], ValueError, "p is empty; expected at least one coefficient"), ([np.nan, 1], ValueError, "expected finite numbers"),
    ([1.0, np.nan], ValueError, "row 1 of p is nan"),
    (None, TypeError, "p is None"), ("abc", TypeError, "p is 'abc'"),
    (iter([1, 2]), TypeError, "expected a sequence of coefficients"),
])
def test_coefficients(p, error, message):
    for call in roots.isolate, roots.count:
        with pytest.raises(error, match=message):
            call(p)


@pytest.mark.parametrize("a, b, error", [("a", 1, TypeError), (None, 1, TypeError), (0, 10**400, ValueError), (2, 1, ValueError),
                                         (Fraction(1, 3), 1, ValueError)])
def test_ends_of_intervals_are_doubles(a, b, error):
    with pytest.raises(error, match="is .*; expected"):
        roots.isolate([-1, 0, 4], a, b)


@pytest.mark.parametrize("width", [0, -1, np.nan, np.inf])
def test_widths_are_positive(width):
    with pytest.raises(ValueError, match=f"width is {float(width)}; expected a finite number > 0"):
        roots.isolate([-2, 0, 1]).interval(0, width)


def test_errors_are_not_negative():
    with pytest.raises(ValueError, match="error is -1; expected numbers >= 0"):
        tracked.array([1.0, 2.0], [0, -1])
    assert (tracked.array([1.0, 2.0], [np.nan, np.inf]).error == np.inf).all()


def test_a_tracked_array_is_no_condition():
    x = tracked.array([0.1, 0.2])
    with pytest.raises(TypeError, match="condition is a tracked array; expected its sign or its value"):
        bool(x)
    for compare in lambda: x == x, lambda: x != 0.1, lambda: x < 1, lambda: x <= 1, lambda: 1 < x, lambda: x >= x:
        with pytest.raises(TypeError, match=r"may be uncertain; expected \(x - y\)\.sign .* or x\.value"):
            compare()
    with pytest.raises(TypeError, match="argument is a tracked array; expected a plain one, such as x.value"):
        predicates.orient2d(x, x, x)
    with pytest.raises(TypeError, match="rule is 3; expected a name"):
        tracked.array([1], rule=3)


@pytest.mark.parametrize("path", ["a\0b.ply", "\udc80.ply"])
def test_names_that_no_file_has(path):
    with pytest.raises(errbound.FileError, match="path is .*; expected a name without null characters"):
        io.read_mesh(path)


def test_names_as_bytes(tmp_path):
    name = bytes(tmp_path / "é.ply")
    io.write_mesh(name, BEFORE, FACES)
    assert (io.read_mesh(name).vertices == BEFORE).all()


def test_types_of_show(tmp_path):
    result = ccd.step(BEFORE, AFTER, FACES)
    with pytest.raises(TypeError, match="before is ndarray; expected an io.Mesh"):
        errbound.show(BEFORE, AFTER, result, tmp_path / "page.html")
    with pytest.raises(TypeError, match="result is NoneType; expected a ccd.StepResult"):
        io.write_view(tmp_path / "step.vtp", *FRAMES, None)
    assert list(tmp_path.iterdir()) == []


def test_representations_are_short():
    many = np.random.default_rng(3).random((2000, 3))
    moved = many + 0.1
    faces = np.random.default_rng(4).permutation(2000)[:1800].reshape(-1, 3)
    found = ccd.step(many, moved, faces, times=True)
    for shown in (found, found.pairs, ccd.advance(many, moved, faces), io.Mesh(many, faces), tracked.array(many),
                  ccd.decide(np.tile(QUERY, (2000, 1, 1)), "vertex_face"),
                  ccd.first_contact(np.tile(QUERY, (2000, 1, 1)), "vertex_face"), roots.isolate([0, 0]),
                  io.Queries(QUERY, "vertex_face", None), ccd.Steps(faces, vertices=2000)):
        assert len(repr(shown)) < 800 and "object at" not in repr(shown), repr(shown)
    assert "everywhere" in repr(roots.isolate([0, 0]))


def test_numpys_reductions_of_tracked_arrays_report_nothing():
    """Regression: nanobind reported a leaked instance."""
    code = ("import numpy as np\nfrom errbound import tracked\nx = tracked.array([1.0, 2.0])\n"
            "assert np.sum(x).value == 3\ntry: np.prod(x)\nexcept TypeError: pass\n")
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout + found.stderr == ""


def test_tracked_arrays_are_copied_and_pickled():
    x = tracked.array([0.1, 0.2], 1e-3, rule="residual", dtype=np.float32) * 3
    for again in pickle.loads(pickle.dumps(x)), copy.copy(x), copy.deepcopy(x):
        assert again.rule == "residual" and again.dtype == np.float32
        assert (again.value == x.value).all() and (again.error >= x.error).all()
        assert (again.error <= 1.001 * x.error).all()


def test_results_are_copied_and_pickled():
    result = ccd.step(BEFORE, AFTER, FACES, times=True)
    again = pickle.loads(pickle.dumps(result))
    assert again.first_contact == result.first_contact
    assert (again.pairs.vertex_face == result.pairs.vertex_face).all()
    for kept in ccd.Steps(FACES, vertices=4), roots.isolate([-2, 0, 1]):
        assert "object at" not in repr(kept)
