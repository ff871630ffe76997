"""Steps in polyscope, and files for ParaView, which VTK's reader reads."""
import webbrowser
import xml.etree.ElementTree as xml

import numpy as np
import pytest

from errbound import ccd, io, show


@pytest.fixture(scope="module")
def step(scene):
    before, after = scene
    return ccd.step(before.vertices, after.vertices, before.faces, times=True)


def read(path):
    reader = pytest.importorskip("vtkmodules.vtkIOXML", reason="no vtk: pip install vtk").vtkXMLPolyDataReader()
    from vtkmodules.util.numpy_support import vtk_to_numpy

    reader.SetFileName(str(path))
    reader.Update()
    assert reader.GetErrorCode() == 0
    data = reader.GetOutput()
    arrays = {}
    for fields in data.GetPointData(), data.GetCellData(), data.GetFieldData():
        for i in range(fields.GetNumberOfArrays()):
            arrays[fields.GetArrayName(i)] = vtk_to_numpy(fields.GetArray(i))
    polygons = vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    return vtk_to_numpy(data.GetPoints().GetData()), polygons, data.GetNumberOfVerts(), arrays


def test_vtk_reads_what_was_written(scene, step, tmp_path):
    io.write_view(tmp_path / "step.pvd", *scene, step)
    for time, (name, frame) in enumerate(zip(("step-0.vtp", "step-1.vtp"), scene)):
        points, polygons, vertices, arrays = read(tmp_path / name)
        count = len(frame.vertices)
        np.testing.assert_array_equal(points[:count], frame.vertices)
        np.testing.assert_array_equal(polygons, frame.faces)
        np.testing.assert_array_equal(arrays["displacement"][:count], scene[1].vertices - scene[0].vertices)
        assert vertices == len(step.pairs) and arrays["TimeValue"].tolist() == [time]
        np.testing.assert_array_equal(arrays["toi"][:vertices],
                                      np.concatenate([step.times[kind]["low"] for kind in ccd.POINTS]))
        np.testing.assert_array_equal(arrays["pair"], [*range(vertices), *[-1] * len(polygons)])
        contacts = ccd.first_contact(step.pairs.vertex_face, "vertex_face",
                                     positions=tuple(mesh.vertices for mesh in scene))
        np.testing.assert_array_equal(arrays["normal"][count:][:len(contacts)], contacts.normal)
        place = points[count:][:len(contacts)]
        t, v = contacts.low[:, None], step.pairs.vertex_face[:, 0]
        np.testing.assert_allclose(place, (1 - t) * scene[0].vertices[v] + t * scene[1].vertices[v], rtol=1e-14)


def test_series(scene, step, tmp_path):
    (tmp_path / "a&b").mkdir()
    files = [tmp_path / "a&b" / f"{i}.vtp" for i in range(3)]
    for path in files:
        io.write_view(path, *scene, step)
    io.write_pvd(tmp_path / "run.pvd", [0, 0.1, 1e-7], files)
    listed = [(float(e.get("timestep")), e.get("file")) for e in xml.parse(tmp_path / "run.pvd").iter("DataSet")]
    assert listed == [(0, "a&b/0.vtp"), (0.1, "a&b/1.vtp"), (1e-7, "a&b/2.vtp")]
    for _, name in listed:
        assert (tmp_path / name).exists()


def test_a_page_without_a_path(scene, step, monkeypatch, tmp_path):
    opened = []
    monkeypatch.setattr(webbrowser, "open", opened.append)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.setattr("errbound._show.find_spec", lambda name: None)
    page = show(*scene, step)
    assert page.parent == tmp_path and page.read_text().startswith("<!doctype html>") and opened == []
    page = show(*scene, step, browser=True)
    assert opened == [page.as_uri()]


@pytest.mark.parametrize("call, error, message", [
    (lambda b, a, s: show(b, a, s, "step.vtp"), ValueError, "path is 'step.vtp'; expected .* .html"),
    (lambda b, a, s: io.write_view("step.obj", b, a, s), ValueError, "path is 'step.obj'; expected .* .pvd"),
    (lambda b, a, s: show(b, io.Mesh(a.vertices, a.faces[1:]), s, "x.html"), ValueError, "faces of after differ"),
    (lambda b, a, s: show(b, io.Mesh(a.vertices[1:], a.faces), s, "x.html"), ValueError, "number of vertices in after is 2401"),
    (lambda b, a, s: show(b, io.Mesh(a.vertices * np.nan, a.faces), s, "x.html"), ValueError, "row 0 of after is"),
    (lambda b, a, s: show(*[io.Mesh(m.vertices[:9], m.faces[:0]) for m in (b, a)], s, "x.html"), IndexError,
     r"vertex index in row 0 of result.pairs.vertex_face is \d+; expected 0 to 8"),
    (lambda b, a, s: show(b, a, s, "nowhere/x.html"), io.FileError, "nowhere/x.html: cannot be written"),
    (lambda b, a, s: io.write_pvd("x.pvd", [0, 1], ["a"]), ValueError, "number of files is 1; expected 2"),
    (lambda b, a, s: io.write_pvd("x.pvd", [np.inf], ["a"]), ValueError, "row 0 of times is inf"),
])
def test_errors_name_the_argument(scene, step, monkeypatch, tmp_path, call, error, message):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(error, match=message):
        call(*scene, step)
    assert list(tmp_path.iterdir()) == []


def test_polyscope(scene, step, monkeypatch):
    polyscope = pytest.importorskip("polyscope", reason="no polyscope: pip install polyscope")
    polyscope.set_use_prefs_file(False)
    polyscope.init("openGL_mock")
    times, draw = iter([]), polyscope.show
    monkeypatch.setattr("polyscope.imgui.SliderFloat", lambda name, t, low, high: (True, next(times, t)))
    monkeypatch.setattr(polyscope, "show", lambda: draw(3))
    assert show(*scene, step) is None
    mesh, edges, vertices = (polyscope.get_surface_mesh("step"), polyscope.get_curve_network("edges in pairs"),
                             polyscope.get_point_cloud("vertices in pairs"))
    own_edges, own_vertices = np.unique(step.pairs.edge_edge), np.unique(step.pairs.vertex_face[:, 0])
    assert mesh.n_faces() == len(scene[0].faces)
    assert (edges.n_nodes(), vertices.n_points()) == (len(own_edges), len(own_vertices))

    moved, times = [], iter([0.25])
    for structure, update in ((mesh, "update_vertex_positions"), (edges, "update_node_positions"),
                              (vertices, "update_point_positions")):
        original = getattr(type(structure), update)
        monkeypatch.setattr(type(structure), update,
                            lambda self, x, original=original: (moved.append(x), original(self, x)))
    assert show(*scene, step) is None  # replaces structures with the same names
    at_quarter = 0.75 * scene[0].vertices + 0.25 * scene[1].vertices
    for found, expected in zip(moved, (at_quarter, at_quarter[own_edges], at_quarter[own_vertices])):
        np.testing.assert_array_equal(found, expected)
    assert len(moved) >= 3
