"""Runs tests under valgrind's memcheck, two at a time; an error or a leak fails.

Arguments: the build folder, then options of ctest that choose tests, all of GoogleTest's. (What is only
possibly lost is not counted: TBB's threads are still there at the end.)
"""
import json
import os
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

VALGRIND = ["valgrind", "--quiet", "--error-exitcode=99", "--leak-check=full",
            "--show-leak-kinds=definite", "--errors-for-leak-kinds=definite"]

build, options = sys.argv[1], sys.argv[2:]
shown = subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1", *options], check=True,
                       stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout
tests = json.loads(shown)["tests"]
environment = {**os.environ, "ERRBOUND_TEST_SCALE": os.environ.get("ERRBOUND_TEST_SCALE", "0.01")}


def run(test):
    start = time.monotonic()
    done = subprocess.run([*VALGRIND, *test["command"]], env=environment, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    passed = done.returncode == 0
    print(f"{test['name']:<28}{'0 errors' if passed else 'failed':<10}"
          f"{time.monotonic() - start:5.0f} s", flush=True)
    if not passed:
        print(done.stdout, flush=True)
    return passed


with ThreadPoolExecutor(2) as pool:
    passed = sum(pool.map(run, tests))
print(f"{passed} of {len(tests)} tests without an error under valgrind")
sys.exit(passed != len(tests) or not tests)
