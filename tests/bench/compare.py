#!/usr/bin/env python3
"""Two builds' benchmarks, the least times of several runs of each, and their ratios:

    compare.py FIRST.json... SECOND.json...

As many files of one as of the other, made by errbound_bench --json in turns. Rows that only one has are
left out, and counted.
"""

import json
import sys

# A figure's unit, and the column that has it.
UNITS = {"ns": "ns_min", "ms": "ms_min"}


def least_times(paths):
    """(what is measured) -> (least time of all files, its unit)."""
    least = {}
    for path in paths:
        for table in json.load(open(path))["tables"]:
            for row in table["rows"]:
                unit = next((unit for unit in UNITS if UNITS[unit] in row), None)
                if unit is None:
                    continue
                words = [str(row[name]) for name in
                         ("scene", "kind", "contestant", "method", "instruction_set", "threads") if name in row]
                key = ", ".join([table["section"], *words])
                time = (row[UNITS[unit]], unit)
                least[key] = min(time, least.get(key, time))
    return least


def main(paths):
    if len(paths) < 2 or len(paths) % 2:
        sys.exit(__doc__)
    first = least_times(paths[: len(paths) // 2])
    second = least_times(paths[len(paths) // 2 :])
    both = [key for key in first if key in second]
    width = max(map(len, both))
    print(f"{'':{width}}{'first':>14}{'second':>14}{'second/first':>14}")
    for key in both:
        (time, unit), (other, _) = first[key], second[key]
        print(f"{key:{width}}{time:>11.1f} {unit}{other:>11.1f} {unit}{other / time:>14.2f}")
    print(f"{len(first) + len(second) - 2 * len(both)} rows are in one only")


main(sys.argv[1:])
