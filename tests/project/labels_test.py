"""Every test has one of the labels by which tests are chosen, and says which targets it needs.

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
        print(f"{test['name']}: found the labels {sorted(labels)}, expected one of {sorted(MAIN)}, "
              f"and else of {sorted(OTHERS)}")
        wrong += 1
    if "memory" in labels and "sanitize" not in labels:
        print(f"{test['name']}: has the label memory, which is of tests that have sanitize, too")
        wrong += 1
print(f"{len(tests)} tests, {wrong} with wrong labels")
sys.exit(wrong != 0)
