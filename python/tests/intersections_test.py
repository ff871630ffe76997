"""Intersections of meshes at rest, and at the start of steps."""
import json
import math
import subprocess

import numpy as np
import pytest
from conftest import SCENE

from errbound import ccd, io

# The second triangle passes through the first.
PIERCED = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, -1], [1, 1, 1], [1.5, 1, 1]], float)
FACES = [[2, 1, 0], [5, 4, 3]]


def test_pierced_triangles():
    found = ccd.intersections(PIERCED, FACES, edge_faces=True)
    assert len(found) == 1 and found.count(ccd.Relation.CROSSING) == 1
    assert found.face_face.vertices.tolist() == [[0, 1, 2, 3, 4, 5]]
    assert found.face_face.relation.tolist() == [ccd.Relation.CROSSING]
    assert found.face_face.segment.tolist() == [[[1, 1, 0], [1.25, 1, 0]]]
    assert (found.face_face.error < 2**-44).all() and found.face_face.error.shape == (1, 2)
    assert found.edge_faces.tolist() == [[3, 4, 0, 1, 2], [3, 5, 0, 1, 2]]
    assert repr(found) == "<ccd.Intersections, 1 pairs: 1 crossing>"
    assert not ccd.is_free(PIERCED, FACES)
    assert np.isnan(ccd.intersections(PIERCED, FACES, segments=False).face_face.segment).all()


def test_steps_and_advances_report_their_start():
    lifted = PIERCED + [0, 0, 3]
    step = ccd.step(PIERCED, lifted, FACES, check_start=True)
    assert len(step.pairs) == 0
    assert step.intersections_at_start.face_face.vertices.tolist() == [[0, 1, 2, 3, 4, 5]]
    assert ccd.step(PIERCED, lifted, FACES).intersections_at_start is None
    free = ccd.advance(PIERCED, lifted, FACES, check_start=True)
    assert free.fraction == 1 and len(free.intersections_at_start) == 1
    assert ccd.advance(PIERCED, lifted, FACES).intersections_at_start is None


def test_kinds_relations_and_options():
    points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [.25, .25, -1], [.25, .25, 1], [.5, .25, 0], [.25, .25, .5]]
    found = ccd.intersections(points, [[0, 1, 2]], [[3, 4]])
    assert {kind: of.vertices.tolist() for kind, of in found.by_kind.items() if len(of)} == {
        "edge_face": [[3, 4, 0, 1, 2]], "vertex_face": [[5, 0, 1, 2]], "vertex_edge": [[6, 3, 4]]}
    assert len(ccd.intersections(points, [[0, 1, 2]], [[3, 4]], skip_unused=True)) == 1
    assert len(ccd.intersections(points, [[0, 1, 2]], [[3, 4]], pinned=np.ones(7, bool))) == 0
    assert len(ccd.intersections(points, [[0, 1, 2]], [[3, 4]], groups=np.zeros(7, int))) == 0
    assert len(ccd.intersections(points, [[0, 1, 2]], [[3, 4]], can_collide=lambda v, w: 5 in (v, w))) == 1
    seam = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]
    assert len(ccd.intersections(seam, [[0, 1, 2], [3, 5, 4]])) == 1
    assert ccd.is_free(seam, [[0, 1, 2], [3, 5, 4]], merge_equal_positions=True)


def test_in_the_plane():
    steps = ccd.Steps.in_plane([[0, 1], [2, 3]], vertices=4)
    found = steps.intersections([[0, 0], [2, 2], [0, 2], [2, 0]])
    assert found.edge_edge.relation.tolist() == [ccd.Relation.CROSSING]
    assert found.edge_edge.segment.tolist() == [[[1, 1, 0], [1, 1, 0]]]
    assert steps.is_free([[0, 0], [2, 2], [0, 2], [.5, 2]])


def test_scene_is_the_programs(scene, program, tmp_path):
    for frame, edge_faces in zip((0, 1), (57, 399)):
        out, pairs = tmp_path / "out.json", tmp_path / "pairs.csv"
        done = subprocess.run([program, "check", SCENE / f"frame{frame}.ply", "--json", out, "--pairs", pairs],
                              stdout=subprocess.DEVNULL, check=False)
        assert done.returncode == 3
        found = ccd.intersections(scene[frame].vertices, scene[frame].faces, edge_faces=True)
        assert len(found.edge_faces) == json.loads(out.read_text())["edge_face"] == edge_faces
        assert [f"ff,{','.join(map(str, row))},{ccd.Relation(relation).name.lower()}"
                for row, relation in zip(found.face_face.vertices.tolist(), found.face_face.relation)
                ] == pairs.read_text().split()


def test_the_page_has_them(tmp_path):
    before, after = io.Mesh(PIERCED, np.array(FACES)), io.Mesh(PIERCED + [0, 0, 3], np.array(FACES))
    sizes = []
    for check_start in False, True:
        step = ccd.step(before.vertices, after.vertices, before.faces, check_start=check_start)
        io.write_view(tmp_path / "step.html", before, after, step)
        text = (tmp_path / "step.html").read_text()
        sizes.append(len(text.split('id="array-start_face_face">')[1].split("<")[0]))
    assert sizes == [0, 32]


def test_bad_input():
    with pytest.raises(ValueError, match="row 1 of positions is"):
        ccd.intersections([[0, 0, 0], [0, math.nan, 0]], [])
    with pytest.raises(IndexError, match="vertex index in row 0 of faces is 7"):
        ccd.is_free(PIERCED, [[0, 1, 7]])
    with pytest.raises(TypeError, match="option is 'distance'"):
        ccd.intersections(PIERCED, FACES, distance=1)
    with pytest.raises(ValueError, match="shape of positions"):
        ccd.Steps(FACES, vertices=6).intersections(PIERCED[:3])


def test_ipctk_has_intersections():
    ipctk = pytest.importorskip("ipctk", reason="no ipctk: pip install ipctk")
    import errbound.ipctk

    mesh = ipctk.CollisionMesh(PIERCED, ipctk.edges(np.array(FACES)) if hasattr(ipctk, "edges") else
                               np.array([[0, 1], [1, 2], [0, 2], [3, 4], [4, 5], [3, 5]]), np.array(FACES))
    assert errbound.ipctk.has_intersections(mesh, PIERCED)
    assert not errbound.ipctk.has_intersections(mesh, PIERCED + np.arange(6)[:, None].clip(2, 3) * [0, 0, 5])
