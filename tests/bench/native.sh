#!/usr/bin/env bash
# ./run bench --native: runs the benchmarks of a portable build and of a build for this processor alternately, so that
# disturbances affect both. Arguments: options of errbound_bench.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.."
cmake --preset native >/dev/null
cmake --build build --target errbound_bench
cmake --build build-native --target errbound_bench
out=out/bench
mkdir -p "$out"
for round in 1 2 3; do
    printf 'round %d of 3\n' "$round"
    for build in build build-native; do
        "$build/tests/bench/errbound_bench" --sections methods,steps "$@" --json "$out/$build-$round.json" >/dev/null
    done
done
/usr/bin/python3 tests/bench/compare.py "$out"/build-[123].json "$out"/build-native-[123].json
