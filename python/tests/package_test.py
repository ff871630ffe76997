"""The whole package: version, imports, and memory that arrays and objects do not share."""
import gc
import re
import subprocess
import sys

import numpy as np
from conftest import ROOT

import errbound
from errbound import ccd, roots, tracked


def test_version_is_the_projects():
    expected = re.search(r"project\(errbound VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]
    assert errbound.__version__ == expected


def test_import_takes_no_other_package():
    code = ("import sys, numpy; before = set(sys.modules); import errbound; "
            "print(sorted({m.split('.')[0] for m in set(sys.modules) - before} - sys.stdlib_module_names - {'numpy'}))")
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "['errbound']"


def made_from(arrays):
    """Returns an object of each type that outlives its arguments. Their arrays are overwritten and freed before use."""
    steps = ccd.Steps(arrays["faces"], arrays["edges"], vertices=6)
    flat = ccd.Steps.in_plane(arrays["edges"], vertices=6)
    numbers = tracked.array(arrays["numbers"])
    found = roots.isolate(arrays["coefficients"], -2, 2)
    queries = ccd.step(arrays["before"], arrays["after"], arrays["faces"], times=True)
    for array in arrays.values():
        array[...] = 0
    arrays.clear()
    gc.collect()
    return steps, flat, numbers, found, queries


def test_objects_keep_no_view_of_the_arrays_they_are_made_from():
    def arrays():
        before = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.2, 0.2, 1], [1, 1, 2], [2, 1, 2]])
        after = before.copy()
        after[3:, 2] -= 2.5
        return {"faces": np.array([[0, 1, 2]], np.uint32), "edges": np.array([[4, 5]], np.uint32),
                "numbers": np.array([1.0, 2.0, 3.0]), "coefficients": np.array([-2.0, 0, 1]),
                "before": before, "after": after}

    before, after = arrays()["before"], arrays()["after"]
    steps, flat, numbers, found, queries = made_from(arrays())
    assert steps.run(before, after).pairs.vertex_face.tolist() == [[3, 0, 1, 2]]
    across = before[:, :2].copy()
    across[4:] -= [0.5, 1.5]
    assert flat.run(before[:, :2], across).pairs.vertex_edge.tolist() == [[1, 4, 5]]
    assert (numbers + numbers).value.tolist() == [2, 4, 6]
    assert len(found) == 2 and queries.pairs.vertex_face.tolist() == [[3, 0, 1, 2]]


def test_results_outlive_the_objects_that_made_them():
    before = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.2, 0.2, 1]])
    steps = ccd.Steps([[0, 1, 2]], vertices=4)
    after = np.vstack([before[:3], before[3] - [0, 0, 2]])
    results = [steps.run(before, after, times=True) for _ in range(100)]
    pairs, lows = ([result.pairs.vertex_face for result in results],
                   [result.times["vertex_face"]["low"] for result in results])
    del steps, results
    gc.collect()
    assert all(p.tolist() == [[3, 0, 1, 2]] for p in pairs) and all(low.tolist() == [0.5] for low in lows)
