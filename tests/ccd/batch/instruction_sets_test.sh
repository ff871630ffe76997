#!/usr/bin/env bash
# Tests that kernels compiled for a newer instruction set define no function that other code could share. The linker
# keeps one copy of each, and an older machine might get the newer one. usage: instruction_sets_test.sh SET OBJECT...
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
    # The table of kernels must exist, so that an empty listing does not pass.
    nm --demangle --defined-only --extern-only "$object" | grep -q -E " [DR] ccd::detail::$set::(kernels|searching|nearest)$"
done
