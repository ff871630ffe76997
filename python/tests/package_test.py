"""The package as a whole: its version, and what it imports."""
import re
import subprocess
import sys

from conftest import ROOT

import errbound


def test_version_is_the_projects():
    expected = re.search(r"project\(errbound VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]
    assert errbound.__version__ == expected


def test_import_takes_no_other_package():
    code = ("import sys, numpy; before = set(sys.modules); import errbound; "
            "print(sorted({m.split('.')[0] for m in set(sys.modules) - before} - sys.stdlib_module_names - {'numpy'}))")
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "['errbound']"
