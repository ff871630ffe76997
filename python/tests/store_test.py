"""Reads stores of queries, written by `ccd convert`, with h5py and with io.read_queries."""
import os
import subprocess

import numpy as np
import pytest

from errbound import FileError, io

h5py = pytest.importorskip("h5py", reason="no h5py: pip install h5py")


@pytest.fixture(scope="module")
def files(program, tmp_path_factory):
    """CSV files and equal stores, of more than one chunk."""
    folder = tmp_path_factory.mktemp("stores")
    random = np.random.default_rng(5)
    points = random.standard_normal((5000, 2, 3)) * 2.0 ** random.integers(-1000, 1000, (5000, 2, 3))
    queries = points[random.integers(0, 5000, (66000, 4))].swapaxes(1, 2).reshape(-1, 8, 3)
    io.write_queries(folder / "ee.csv", queries, random.integers(0, 2, 66000))
    done = subprocess.run([program, "convert", folder / "ee.csv", folder / "ee.h5"], capture_output=True, text=True)
    if "without HDF5" in done.stderr:
        pytest.skip("the program was built without HDF5")
    assert done.returncode == 0, done.stderr
    return folder / "ee.csv", folder / "ee.h5"


def test_a_store_has_what_the_rows_have(files):
    rows, store = (io.read_queries(file) for file in files)
    assert store.kind == rows.kind == "edge_edge" and len(store.queries) == 66000
    np.testing.assert_array_equal(store.queries.view(np.uint64), rows.queries.view(np.uint64))
    np.testing.assert_array_equal(store.truth, rows.truth)
    assert files[1].stat().st_size * 10 < files[0].stat().st_size


def test_a_store_without_truth(files, program, tmp_path):
    queries = io.read_queries(files[0]).queries[:100]
    io.write_queries(tmp_path / "ee.csv", queries)
    subprocess.run([program, "convert", tmp_path / "ee.csv", tmp_path / "ee.h5"], check=True, capture_output=True)
    store = io.read_queries(tmp_path / "ee.h5")
    assert store.truth is None
    np.testing.assert_array_equal(store.queries, queries)


def test_a_store_is_read_by_h5py_alone(files):
    with h5py.File(files[1]) as file:
        first, last = file["first_point"][1:3]
        points = file["points"][first:last][file["queries"][65536:]]
    expected = io.read_queries(files[0]).queries[65536:]
    np.testing.assert_array_equal(points.reshape(-1, 4, 2, 3).swapaxes(1, 2).reshape(-1, 8, 3), expected)


def test_other_files_are_reported(files, tmp_path):
    with pytest.raises(FileError, match="kind of queries is edge_edge; expected vertex_face"):
        io.read_queries(files[1], "vertex_face")
    torn = tmp_path / "torn.h5"
    torn.write_bytes(files[1].read_bytes()[:5000])
    with pytest.raises(FileError, match="torn.h5 is not a complete store of queries"):
        io.read_queries(torn)


def test_a_link_is_not_followed_and_chunks_are_bounded(files, tmp_path):
    """A link to a pipe without a writer would block. Chunks are read whole, however wide the rows are."""
    def forged(change):
        path = tmp_path / "forged.h5"
        path.write_bytes(files[1].read_bytes())
        with h5py.File(path, "r+") as file:
            change(file)
        return path

    def link(file):
        del file["truth"]
        file["truth"] = h5py.ExternalLink(tmp_path / "pipe", "truth")

    def wide(file):
        del file["points"]
        file.create_dataset("points", (40, 6), "f8", chunks=(2**20, 100), maxshape=(None, None))

    os.mkfifo(tmp_path / "pipe")
    for change, message in (link, "dataset truth is a link"), (wide, "dataset points has .* at most 64 MiB"):
        with pytest.raises(FileError, match=message):
            io.read_queries(forged(change))
