"""Steps of the bundled scene, compared with the program ccd; candidates and advances."""
import json
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from conftest import ROOT, SCENE

from errbound import ccd, io


def lines_of(pairs):
    return ([f"vf,{','.join(map(str, p))}" for p in pairs.vertex_face.tolist()] +
            [f"ee,{','.join(map(str, p))}" for p in pairs.edge_edge.tolist()])


@pytest.mark.parametrize("method", ["exact", "tight", "float"])
def test_step_is_the_programs(scene, program, tmp_path, method):
    before, after = scene
    out = tmp_path / "pairs.csv"
    subprocess.run([program, "step", SCENE / "frame0.ply", SCENE / "frame1.ply", "--method", method,
                    "--pairs", out], check=True, stdout=subprocess.DEVNULL)
    found = ccd.step(before.vertices, after.vertices, before.faces, method=method)
    assert sorted(lines_of(found.pairs)) == sorted(out.read_text().split())
    assert len(found.pairs) > 0


def test_first_contact_is_the_programs(scene, program, tmp_path):
    before, after = scene
    out = tmp_path / "step.json"
    subprocess.run([program, "step", SCENE / "frame0.ply", SCENE / "frame1.ply", "--json", out,
                    "--toi", tmp_path / "toi.csv"], check=True, stdout=subprocess.DEVNULL)
    expected = json.loads(out.read_text())["first_contact"]
    found = ccd.step(before.vertices, after.vertices, before.faces, times=True)
    assert list(found.first_contact) == expected
    assert min(t["low"][t["high"] > 0].min(initial=2) for t in found.times.values()) == expected[0]
    single = ccd.first_time(found.pairs.edge_edge, "edge_edge",
                            positions=(before.vertices, after.vertices))
    np.testing.assert_array_equal(single.low, found.times["edge_edge"]["low"])


def test_repeated_steps_and_memory_orders(scene):
    before, after = scene
    steps = ccd.Steps(before.faces.astype(np.int64), vertices=len(before.vertices))
    expected = lines_of(steps.run(before.vertices, after.vertices).pairs)
    assert lines_of(steps.run(np.asfortranarray(before.vertices), after.vertices, threads=1).pairs) == expected
    rounded = [np.float32(mesh.vertices) for mesh in scene]
    assert (lines_of(steps.run(*rounded).pairs) ==
            lines_of(steps.run(*(r.astype(float) for r in rounded)).pairs))
    counted = steps.run(before.vertices, after.vertices, stages=True)
    assert counted.candidates["edge_edge"] == len(steps.candidates(before.vertices, after.vertices).edge_edge)
    assert sum(s.collides for s in counted.stages) == len(counted.pairs)


def test_filters(scene):
    before, after = scene
    steps = ccd.Steps(before.faces, vertices=len(before.vertices))
    everything = steps.run(before.vertices, after.vertices)
    count = len(before.vertices)
    assert len(steps.run(before.vertices, after.vertices, pinned=np.ones(count, bool)).pairs) == 0
    assert len(steps.run(before.vertices, after.vertices, groups=np.zeros(count, int)).pairs) == 0
    within = steps.run(before.vertices, after.vertices, groups=np.zeros(count, int), between_groups=False)
    assert len(within.pairs) == len(everything.pairs)
    called = steps.run(before.vertices, after.vertices, can_collide=lambda v, w: False)
    assert len(called.pairs) == 0
    with pytest.raises(ZeroDivisionError):
        steps.run(before.vertices, after.vertices, can_collide=lambda v, w: 1 / 0)
    assert len(steps.run(before.vertices, after.vertices).pairs) == len(everything.pairs)


def test_advance_is_free(scene):
    before, after = scene
    steps = ccd.Steps(before.faces, vertices=len(before.vertices))
    free = steps.advance(before.vertices, after.vertices)
    assert 0 < free.fraction < 1 and free.first_contact[0] >= free.fraction
    assert len(steps.run(before.vertices, free.positions).pairs) == len(free.touching_at_start)
    islands = steps.advance(before.vertices, after.vertices, islands=np.arange(len(before.vertices)))
    assert islands.fractions.mean() > free.fraction
    assert len(steps.run(before.vertices, islands.positions).pairs) == len(islands.touching_at_start)


def test_plane():
    steps = ccd.Steps.in_plane([[0, 1]], vertices=3)
    found = steps.run([[-1, 0], [1, 0], [0, 1]], [[-1, 0], [1, 0], [0, -1]], times=True)
    assert found.pairs.vertex_edge.tolist() == [[2, 0, 1]] and found.first_contact == (0.5, 0.5)


def test_advance_in_the_plane_returns_rows_of_two():
    """Regression: it returned rows of three, which the next call rejected."""
    steps = ccd.Steps.in_plane([[0, 1]], vertices=3)
    before = np.array([[-1.0, 0], [1, 0], [0, 1]])
    free = steps.advance(before, before - [[0, 0], [0, 0], [0, 2]])
    assert free.positions.shape == (3, 2) and 0 < free.fraction < 0.5
    assert len(steps.run(before, free.positions).pairs) == 0
    assert steps.advance(free.positions, free.positions + [[0, 0], [0, 0], [0, 1]]).fraction == 1


def test_one_call_at_a_time():
    x = np.zeros((9, 3))
    steps = ccd.Steps(np.arange(9).reshape(3, 3), vertices=9)
    with pytest.raises(RuntimeError, match="one at a time"):
        steps.run(x, x, can_collide=lambda v, w: bool(steps.run(x, x)))


INTERRUPTED = """
import numpy as np, signal, sys
from errbound import ccd, predicates, roots, tracked
signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored where the tests run in the background
n = 3000000
x = np.zeros(({points}, 3))
print("ready", flush=True)
try:
    while True: {call}
except KeyboardInterrupt:
    print("interrupted")
"""


@pytest.mark.parametrize("points, call", [
    (20000, "ccd.step(x, x + 1, (), np.arange(20000).reshape(-1, 2))"),
    (4, "ccd.decide(np.tile(np.arange(4), (n, 1)), 'edge_edge', positions=(x, x), method='exact')"),
    (4, "ccd.decide(np.tile(np.arange(4), (n, 1)), 'edge_edge', positions=(x, x), method='bsc-exact')"),
    (1, "predicates.insphere(*[np.zeros((n, 3))] * 5)"),
    (1, "roots.isolate(np.cos(np.arange(3000.0) ** 2))"),
    (1, "roots.isolate([-2] + [0] * 9999 + [1]).sign_at(np.cos(np.arange(3000.0) ** 2))"),
    (1, "tracked.sin(tracked.array(np.ones(n), rule='affine'))"),
])
def test_ctrl_c(points, call):
    code = INTERRUPTED.format(points=points, call=call)
    running = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    assert running.stdout.readline() == "ready\n"
    time.sleep(0.7)
    sent = time.monotonic()
    running.send_signal(signal.SIGINT)
    try:
        out, _ = running.communicate(timeout=60)
    finally:
        running.kill()
    assert out == "interrupted\n" and time.monotonic() - sent < 5


def test_files(scene, shared_data, program, tmp_path):
    before, _ = scene
    io.write_mesh(tmp_path / "mesh.ply", np.asfortranarray(before.vertices), before.faces)
    again = io.read_mesh(tmp_path / "mesh.ply")
    np.testing.assert_array_equal(again.vertices, before.vertices)
    np.testing.assert_array_equal(again.faces, before.faces)
    assert len(again.unused_vertices) == 0
    stored = sorted((shared_data / "queries").rglob("*.csv"))
    read = next(q for q in map(io.read_queries, stored) if q.truth is not None)
    np.testing.assert_array_equal(ccd.decide(read.queries, read.kind).collides, read.truth)


def test_unused_vertices_and_polygons(tmp_path):
    """A vertex falls through a quad, and is skipped if it is unused."""
    square = [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]]
    path = tmp_path / "quad.obj"
    path.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in [*square, [.5, 1.5, 1]]) + "f 1 2 3 4\n")
    with pytest.raises(io.FileError, match="number of vertices of a face is 4"):
        io.read_mesh(path)
    mesh = io.read_mesh(path, triangulate=True)
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3]] and mesh.unused_vertices.tolist() == [4]
    assert "5 vertices (1 unused), 2 faces" in repr(mesh)
    after = np.array([*square, [.5, 1.5, -1]], float)
    for edges, skip_unused, hits in ([], False, 1), ([], True, 0), ([[4, 4]], True, 1):
        found = ccd.step(mesh.vertices, after, mesh.faces, edges, skip_unused=skip_unused)
        assert len(found.pairs) == hits
        free = ccd.advance(mesh.vertices, after, mesh.faces, edges, skip_unused=skip_unused)
        assert (free.fraction == 1) == (hits == 0)
    io.write_mesh(tmp_path / "again.ply", mesh.vertices, [], [[4, 4]])
    again = io.read_mesh(tmp_path / "again.ply")
    assert again.edges.tolist() == [[4, 4]] and again.unused_vertices.tolist() == [0, 1, 2, 3]


def test_queries_are_written_exactly(tmp_path):
    queries = np.random.default_rng(2).standard_normal((50, 8, 3)) * 1e-300
    truth = np.arange(50) % 2 == 0
    io.write_queries(tmp_path / "vf.csv", queries, truth)
    read = io.read_queries(tmp_path / "vf.csv")
    np.testing.assert_array_equal(read.queries, queries)
    np.testing.assert_array_equal(read.truth, truth)
    assert read.kind == "vertex_face"
    with pytest.raises(io.FileError, match="file does not exist"):
        io.read_mesh(tmp_path / "missing.ply")


def test_line_searches_as_numpy_rounds_them():
    """Smaller than python/bench/barriers.py --steps 0."""
    sys.path.append(str(ROOT / "python" / "bench"))
    found = [pytest.importorskip("barriers").line_search(seed) for seed in range(150)]
    assert sum(unfree for _, unfree in found) == 0
    assert sum(alpha < 1 for alpha, _ in found) > 75


def test_keep():
    """A vertex is pressed onto a plate and slides along it."""
    for keep, fraction in ({}, 1), ({"keep": 0}, 0):
        x = np.array([[-9, -9, 0], [9, -9, 0], [0, 9, 0], [0, 0, 0.5]])
        for _ in range(4):
            first = x[3, 2]
            found = ccd.advance(x, x + np.array([[0, 0, 0]] * 3 + [[1, 0, -0.05]]), [[0, 1, 2]], distance=0.475, **keep)
            x = found.positions
            assert x[3, 2] >= (0.475 if keep else 0.1 * first)
        assert found.fraction == pytest.approx(fraction, abs=1e-12)
    with pytest.raises(ValueError, match=r"distance is -1(\.0*)?;"):
        ccd.advance(x, x, [[0, 1, 2]], distance=-1)
