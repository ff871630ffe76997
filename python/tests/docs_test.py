"""Runs the Python blocks of each page, in order, in a folder with the repository's examples."""
import importlib.resources
import re

import pytest
from conftest import ROOT


@pytest.mark.parametrize("page, printed", [("README.md", "vertex 2"), ("python/README.md", "free for 0.250"), ("docs/python.md", "20 steps, all free"),
                                           ("docs/in-ten-minutes.md", "free for 0.250"),
                                           ("docs/collision-detection.md", "theirs 0.0"),
                                           ("docs/program.md", "rank 0: ")])
def test_blocks_run(page, printed, monkeypatch, tmp_path, capsys):
    if page == "docs/collision-detection.md":
        pytest.importorskip("ipctk", reason="ipctk is not installed (pip install ipctk)")
    if page == "docs/program.md":
        pytest.importorskip("errbound.mpi", reason="no mpi4py, or an errbound without MPI", exc_type=ImportError)
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"^```python\n(.*?)^```", (ROOT / page).read_text(), re.MULTILINE | re.DOTALL)
    assert blocks
    names = {}
    for block in blocks:
        exec(compile(block, page, "exec"), names)
    assert printed in capsys.readouterr().out
    assert {path.name for path in tmp_path.iterdir()} <= {"examples", "out"}, "git does not ignore other files"


@pytest.mark.parametrize("page", ["README.md", "python/README.md"])
def test_blocks_have_types(page, tmp_path):
    """Regression: README's example failed, since times of a step with times=True were Optional."""
    api = pytest.importorskip("mypy.api", reason="mypy is not installed (pip install mypy)")
    blocks = re.findall(r"^```python\n(.*?)^```", (ROOT / page).read_text(), re.MULTILINE | re.DOTALL)
    (tmp_path / "example.py").write_text("\n".join(blocks))
    found, errors, status = api.run(["--strict", "--config-file=", f"--cache-dir={tmp_path}",
                                     str(tmp_path / "example.py")])
    assert status == 0, found + errors


def test_pages_that_docstrings_name_are_in_the_package():
    docs = importlib.resources.files("errbound") / "docs"
    names = {name for file in (ROOT / "python" / "errbound").glob("*.py")
             for name in re.findall(r"docs/([\w-]+\.md)", file.read_text())}
    assert names
    for name in names | {"in-ten-minutes.md", "python.md"}:
        assert (docs / name).read_bytes() == (ROOT / "docs" / name).read_bytes()
