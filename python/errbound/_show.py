"""Display of a step in polyscope or on an HTML page."""
from __future__ import annotations

import os
from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._results import Pairs, StepResult
from .io import Mesh, _checked_mesh, _checked_result, write_view

FACE, EDGE, POINT, MESH = (0.79, 0.15, 0.10), (0.04, 0.31, 0.77), (0.79, 0.15, 0.10), (0.75, 0.78, 0.82)


def show(before: Mesh, after: Mesh, result: StepResult, path: str | os.PathLike[str] | None = None,
         *, browser: bool = False) -> Path | None:
    """Shows the mesh at every time of a step, and its pairs. `ccd.step(..., times=True)` adds times.

    If polyscope is installed and neither path nor browser is given, its window opens and the call waits for it.
    Otherwise the step is written as a self-contained HTML page to path (NAME.html; default: a temporary file), and
    opened if browser is True. Returns the page's path, or None.
    Throws: as io.write_view.
    """
    if path is None and not browser and find_spec("polyscope") is not None:
        _window(before, after, result)
        return None
    page = _temporary_file() if path is None else Path(path)
    if page.suffix != ".html":
        raise ValueError(f"path is {os.fspath(page)!r}; expected a name that ends in .html "
                         "(io.write_view writes other formats)")
    write_view(page, before, after, result)
    if browser:
        import webbrowser

        webbrowser.open(page.resolve().as_uri())
    return page


def _temporary_file() -> Path:
    import tempfile

    descriptor, name = tempfile.mkstemp(".html", "errbound-")
    os.close(descriptor)
    return Path(name)


class _Moving:
    """The interpolated positions, and the polyscope structures to update when the time changes."""

    def __init__(self, before: NDArray[Any], after: NDArray[Any]) -> None:
        self.before, self.after = before, after
        self.time = 1.0
        self.updates: list[Callable[[], None]] = []

    def at(self, vertices: NDArray[Any]) -> NDArray[Any]:
        return np.asarray((1 - self.time) * self.before[vertices] + self.time * self.after[vertices])

    def follow(self, vertices: NDArray[Any], update: Callable[[NDArray[Any]], Any]) -> None:
        self.updates.append(lambda: update(self.at(vertices)) and None)

    def set(self, time: float) -> None:
        self.time = time
        for update in self.updates:
            update()


def _window(before: Mesh, after: Mesh, result: StepResult) -> None:
    polyscope, imgui = import_module("polyscope"), import_module("polyscope.imgui")
    at_start, at_end, faces, edges = _checked_mesh(before, after)
    _checked_result(result, len(at_start))
    if not polyscope.is_initialized():
        polyscope.init()
    moving = _Moving(at_start, at_end)
    _add_mesh(polyscope, moving, faces, edges, result.pairs)
    _add_pairs(polyscope, moving, result.pairs)

    def slider() -> None:
        imgui.TextUnformatted(f"{len(result.pairs)} pairs")
        changed, time = imgui.SliderFloat("t", moving.time, 0, 1)
        if changed:
            moving.set(time)

    polyscope.set_user_callback(slider)
    try:
        polyscope.show()
    finally:
        polyscope.clear_user_callback()


def _add_mesh(polyscope: Any, moving: _Moving, faces: NDArray[Any], edges: NDArray[Any], pairs: Pairs) -> None:
    everything = np.arange(len(moving.before))
    for name in "step", "before", "after":
        polyscope.remove_surface_mesh(name, error_if_absent=False)
    if len(faces):
        struck = {tuple(face) for face in pairs.vertex_face[:, 1:].tolist()}
        colours = np.array([FACE if tuple(sorted(face)) in struck else MESH for face in faces.tolist()])
        mesh = polyscope.register_surface_mesh("step", moving.at(everything), faces)
        mesh.add_color_quantity("pairs", colours, defined_on="faces", enabled=True)
        moving.follow(everything, mesh.update_vertex_positions)
        for name, frame in ("before", moving.before), ("after", moving.after):
            polyscope.register_surface_mesh(name, frame, faces, enabled=False, color=MESH)
    _add_edges(polyscope, moving, "edges of the mesh", edges, (0.2, 0.2, 0.2))
    _add_points(polyscope, moving, "points of the mesh",
                np.setdiff1d(everything, np.concatenate([faces.ravel(), edges.ravel()])), (0.2, 0.2, 0.2))


def _add_pairs(polyscope: Any, moving: _Moving, pairs: Pairs) -> None:
    _add_edges(polyscope, moving, "edges in pairs",
               np.concatenate([pairs.edge_edge.reshape(-1, 2), pairs.vertex_edge[:, 1:]]), EDGE)
    _add_points(polyscope, moving, "vertices in pairs",
                np.concatenate([pairs.vertex_face[:, 0], pairs.vertex_edge[:, 0], pairs.vertex_vertex.ravel()]), POINT)


def _add_edges(polyscope: Any, moving: _Moving, name: str, edges: NDArray[Any], color: Any) -> None:
    polyscope.remove_curve_network(name, error_if_absent=False)
    if len(edges):
        used, ends = np.unique(np.unique(edges, axis=0), return_inverse=True)
        network = polyscope.register_curve_network(name, moving.at(used), ends.reshape(-1, 2), color=color)
        moving.follow(used, network.update_node_positions)


def _add_points(polyscope: Any, moving: _Moving, name: str, vertices: NDArray[Any], color: Any) -> None:
    polyscope.remove_point_cloud(name, error_if_absent=False)
    if len(vertices):
        used = np.unique(vertices)
        cloud = polyscope.register_point_cloud(name, moving.at(used), color=color)
        moving.follow(used, cloud.update_point_positions)
