#!/usr/bin/env bash
# Kernels compiled for a newer instruction set must define no function that other code could share:
# the linker keeps one copy of each, and an older machine might be given the newer one.
# usage: instruction_sets_test.sh SET OBJECT...
set -euo pipefail

set=$1
shift
for object in "$@"; do
    shared=$(nm --demangle --defined-only --extern-only "$object" |
        sed -E 's/^[0-9a-f]* +//' | grep -E '^[A-Za-z] ' | grep -v -F "$set" |
        grep -v -E ' DW\.ref\.__gxx_personality_v0$' || true)
    if [[ -n $shared ]]; then
        printf '%s: symbols that do not belong to %s alone:\n%s\n' "$object" "$set" "$shared" >&2
        exit 1
    fi
    # A table of kernels is there, so that an empty listing cannot pass for a good one.
    nm --demangle --defined-only --extern-only "$object" | grep -q -E " [DR] ccd::detail::$set::(kernels|searching)$"
done
