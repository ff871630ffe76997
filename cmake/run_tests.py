#!/usr/bin/env python3
"""Builds the targets that the chosen tests need, and runs these tests.

usage: run_tests.py [--valgrind] BUILD_FOLDER CTEST_OPTION...

--valgrind runs them under memcheck, two at a time. An error or a definite leak fails. Choose tests of GoogleTest then,
for example by -L unit.
"""
import json
import os
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

VALGRIND = ["valgrind", "--quiet", "--error-exitcode=99", "--leak-check=full",
            "--show-leak-kinds=definite", "--errors-for-leak-kinds=definite"]


def chosen(build, options):
    shown = subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1", *options], check=True,
                           stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout
    return json.loads(shown)["tests"]


def targets_of(build, tests):
    """Returns the build targets that these tests need."""
    files = {file for test in tests for p in test["properties"]
             if p["name"] == "REQUIRED_FILES" for file in p["value"]}
    return [os.path.relpath(file, os.path.abspath(build)) for file in sorted(files)]


def passes_under_valgrind(test):
    environment = {**os.environ, "ERRBOUND_TEST_SCALE": os.environ.get("ERRBOUND_TEST_SCALE", "0.01")}
    start = time.monotonic()
    done = subprocess.run([*VALGRIND, *test["command"]], env=environment, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    passed = done.returncode == 0
    print(f"{test['name']:<28}{'0 errors' if passed else 'failed':<10}"
          f"{time.monotonic() - start:5.0f} s", flush=True)
    if not passed:
        print(done.stdout, flush=True)
    return passed


def main():
    arguments = sys.argv[1:]
    valgrind = arguments[:1] == ["--valgrind"]
    build, *options = arguments[valgrind:]
    tests = chosen(build, options)
    if not tests:
        print(f"run: number of tests by {' '.join(options)} in {build} is 0; expected some", file=sys.stderr)
        return 1
    targets = targets_of(build, tests)
    made = subprocess.run(["cmake", "--build", build, "--target", *targets]).returncode if targets else 0
    if made != 0:
        return made
    if not valgrind:
        return subprocess.run(["ctest", "--test-dir", build, "--output-on-failure",
                               f"-j{os.cpu_count()}", *options]).returncode
    with ThreadPoolExecutor(2) as pool:
        passed = sum(pool.map(passes_under_valgrind, tests))
    print(f"{passed} of {len(tests)} tests without an error under valgrind")
    return passed != len(tests)


if __name__ == "__main__":
    sys.exit(main())
