"""Checks that every test has one of the main labels, and the targets that it needs.

Arguments: ctest, the build folder.
"""
import json
import subprocess
import sys

MAIN = {"unit", "property", "program", "install"}
OTHERS = {"sanitize", "memory", "threads", "device", "sources", "bench-smoke", "nightly"}

ctest, build = sys.argv[1:3]
shown = subprocess.run([ctest, "--test-dir", build, "--show-only=json-v1"], check=True,
                       capture_output=True, text=True).stdout
wrong = 0
tests = json.loads(shown)["tests"]
for test in tests:
    properties = {p["name"]: p["value"] for p in test["properties"]}
    labels = set(properties.get("LABELS", []))
    if len(labels & MAIN) != 1 or labels - MAIN - OTHERS:
        print(f"{test['name']}: labels are {sorted(labels)}; expected one of {sorted(MAIN)}, "
              f"and else of {sorted(OTHERS)}")
        wrong += 1
    if "memory" in labels and "sanitize" not in labels:
        print(f"{test['name']}: label memory is given without sanitize; expected both")
        wrong += 1
print(f"{len(tests)} tests, {wrong} with wrong labels")
sys.exit(wrong != 0)
