"""Reads the meshes of the examples, for pictures of them."""
import pathlib
import re

import numpy


def read_ply(path):
    """Returns points (n, 3), triangles (m, 3) and edges (k, 2) of a file as errbound or make_scene.py writes it."""
    data = pathlib.Path(path).read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    head = data[:end].decode()
    count = {name: int(n) for name, n in re.findall(r"element (\w+) (\d+)", head)}
    order = "<" if "binary_little_endian" in head else ">"
    points = numpy.frombuffer(data, order + "f8", 3 * count["vertex"], end).reshape(-1, 3)
    at = end + points.nbytes
    face = numpy.dtype([("n", "u1"), ("v", order + "u4", 3)])
    faces = numpy.frombuffer(data, face, count.get("face", 0), at)["v"]
    edges = numpy.frombuffer(data, order + "u4", 2 * count.get("edge", 0), at + face.itemsize * len(faces))
    return points, faces, edges.reshape(-1, 2)


def bodies_of(faces, vertices):
    """Returns the index of each vertex's connected part."""
    part = numpy.arange(vertices)
    while True:
        least = part[faces].min(axis=1)
        new = part.copy()
        for corner in range(3):
            numpy.minimum.at(new, faces[:, corner], least)
        new = new[new]
        if (new == part).all():
            return numpy.unique(part, return_inverse=True)[1]
        part = new
