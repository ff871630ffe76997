"""The build targets that tests need, from what ctest knows: one a line.

Arguments: the build folder, then options of ctest that choose tests.
"""
import json
import os
import subprocess
import sys

build, options = sys.argv[1], sys.argv[2:]
shown = subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1", *options], check=True,
                       stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout
files = {file for test in json.loads(shown)["tests"] for p in test["properties"]
         if p["name"] == "REQUIRED_FILES" for file in p["value"]}
for file in sorted(files):
    print(os.path.relpath(file, os.path.abspath(build)))
