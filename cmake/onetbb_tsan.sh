#!/usr/bin/env bash
# Builds oneTBB with the thread sanitizer, which cannot check its synchronisation otherwise, and installs it in
# out/onetbb-tsan for the preset tsan. Requires dpkg-dev.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
installed=$PWD/out/onetbb-tsan
work=$installed.work
[[ ! -d $installed ]] || exit 0
rm -rf -- "$work"
mkdir -p "$work"
{
    tests/everywhere/fetch_source.sh onetbb "$work" &&
        cmake -G Ninja -S "$work"/source/onetbb-*/ -B "$work/build" -DCMAKE_INSTALL_LIBDIR=lib \
            -DTBB_STRICT=OFF -DTBB_TEST=OFF -DTBBMALLOC_BUILD=OFF -DTBB_DISABLE_HWLOC_AUTOMATIC_SEARCH=ON \
            -DCMAKE_BUILD_TYPE=RelWithDebInfo -DTBB_SANITIZE=thread -DCMAKE_CXX_FLAGS=-w \
            -DCMAKE_INSTALL_PREFIX="$work/installed" &&
        cmake --build "$work/build" &&
        cmake --install "$work/build"
} &>"$work.log" || {
    echo "oneTBB could not be built with the thread sanitizer: $work.log" >&2
    exit 1
}
mv "$work/installed" "$installed"
rm -rf -- "$work"
