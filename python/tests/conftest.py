"""Fixtures: the bundled scene, the program ccd and stored data."""
import os
from pathlib import Path

import pytest

from errbound import io

ROOT = Path(__file__).resolve().parents[2]
SCENE = ROOT / "examples" / "scenes" / "cloth-over-ball"


@pytest.fixture(scope="session")
def scene():
    return io.read_mesh(SCENE / "frame0.ply"), io.read_mesh(SCENE / "frame1.ply")


@pytest.fixture(scope="session")
def program():
    """The program ccd: ERRBOUND_CCD, or the release build's."""
    path = Path(os.environ.get("ERRBOUND_CCD", ROOT / "build" / "ccd"))
    if not path.exists():
        pytest.skip(f"no program at {path}: ./run build makes it, ERRBOUND_CCD names another")
    return path


@pytest.fixture(scope="session")
def shared_data():
    """The folder of stored scenes and queries: ERRBOUND_SHARED_DATA, or the default of the C++ tests."""
    path = Path(os.environ.get("ERRBOUND_SHARED_DATA", ROOT / ".." / "shared" / "data"))
    if not path.exists():
        pytest.skip(f"no stored data at {path}: ERRBOUND_SHARED_DATA names another place")
    return path
