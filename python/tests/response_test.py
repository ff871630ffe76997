"""examples/simulation/response.py: every step is certified free, with SciPy and without."""
import subprocess
import sys

import numpy as np
import pytest
from conftest import ROOT

from errbound import ccd, io

sys.path.append(str(ROOT / "examples" / "simulation"))
response = pytest.importorskip("response")


@pytest.mark.parametrize("scipy", [True, False])
def test_every_step_is_free(scipy, monkeypatch):
    if not scipy:
        monkeypatch.setattr(response, "factorized", None)
    elif response.factorized is None:
        pytest.skip("SciPy is not installed")
    shares = []
    for scene, fractions in response.simulate(24, cells=10):
        shares.append(fractions.min())
    assert scene.contacts > 0 and min(shares) < 0.9, "contacts limit vertices"
    steps = ccd.Steps(scene.faces, scene.edges, vertices=len(scene.x))
    assert len(scene.saved) == 49
    for before, after in zip(scene.saved, scene.saved[1:]):
        assert steps.certify(before, after).is_free
    assert steps.least_distance(scene.x, pinned=scene.driven).low > 0.1 * response.THICKNESS
    fell = (scene.first - scene.x)[~scene.driven, 2]
    assert fell.mean() > 0.1 and scene.x[:, 2].min() == scene.x[-1, 2], "they fall, and not through the floor"


def test_audit_of_its_files(tmp_path, program):
    assert len((ROOT / "examples" / "simulation" / "response.py").read_text().splitlines()) <= 200
    response.main(4, tmp_path)
    assert np.load(tmp_path / "positions.npy").shape[0] == 9 and (tmp_path / "last.html").exists()
    audit = subprocess.run([program, "audit", "--mesh", tmp_path / "mesh.ply", tmp_path / "positions.npy"],
                           capture_output=True, text=True, check=True)
    assert "8 of 8 steps are free" in audit.stdout
    assert len(io.read_mesh(tmp_path / "mesh.ply").edges) == 20
