#!/usr/bin/env python3
"""Two builds' benchmarks, the least times of several runs of each, and their ratios:

    compare.py PORTABLE.json... NATIVE.json...

As many files of one as of the other. Takes the figures of the method exact.
"""

import json
import sys


def least_times(paths):
    """(what is measured) -> (least time of all files, its unit)."""
    least = {}
    for path in paths:
        for table in json.load(open(path))["tables"]:
            for row in table["rows"]:
                if table["section"] == "methods" and row["contestant"].startswith("exact"):
                    key = f"{row['scene']}, {row['kind']}, {row['contestant']}"
                    time, unit = row["ns_min"], "ns"
                elif table["section"] == "steps" and row["method"] == "exact":
                    key = f"{row['scene']}, step, threads: {row['threads']}"
                    time, unit = row["ms_min"], "ms"
                else:
                    continue
                least[key] = min((time, unit), least.get(key, (time, unit)))
    return least


def main(paths):
    if len(paths) < 2 or len(paths) % 2:
        sys.exit(__doc__)
    portable = least_times(paths[: len(paths) // 2])
    native = least_times(paths[len(paths) // 2 :])
    width = max(map(len, portable))
    print(f"{'':{width}}{'portable':>14}{'native':>14}{'ratio':>8}")
    for key, (time, unit) in portable.items():
        other = native[key][0]
        print(f"{key:{width}}{time:>11.1f} {unit}{other:>11.1f} {unit}{time / other:>8.2f}")


main(sys.argv[1:])
