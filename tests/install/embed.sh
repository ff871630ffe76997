#!/usr/bin/env bash
# Builds errbound in another project, unoptimised, as a shared library with hidden symbols, and runs programs linked
# with it. Then installs it and builds a program by pkg-config only.
# Arguments: source folder, C++ compiler, CMake generator, cmake (by default the one on the PATH).
set -euo pipefail
source=$1 compiler=$2 generator=$3 cmake=${4:-cmake}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
logged() { "$@" &>"$work/log" || { cat "$work/log"; exit 1; }; }
logged "$cmake" -G "$generator" -S "$source/tests/install/embedding" -B "$work/build" \
    -DERRBOUND_SOURCE="$source" -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_CXX_FLAGS_RELEASE='-O0 -DNDEBUG'
logged "$cmake" --build "$work/build"
if grep -q 'warning: ' "$work/log"; then cat "$work/log"; exit 1; fi
"$work/build/embedding"
"$work/build/embedding_headers"
logged "$cmake" --install "$work/build" --prefix "$work/prefix"

library=$(find "$work/prefix" -name 'liberrbound_ccd.so' -print -quit)
PKG_CONFIG_PATH=${library%/*}/pkgconfig
export PKG_CONFIG_PATH
read -ra flags < <(pkg-config --cflags --libs errbound-ccd)
logged "$compiler" -std=c++20 -O2 "$source/tests/install/user/use_ccd.cpp" "${flags[@]}" -o "$work/use_ccd"
LD_LIBRARY_PATH=${library%/*} "$work/use_ccd"
if [[ $(pkg-config --modversion errbound) != $(pkg-config --modversion errbound-ccd) ]]; then exit 1; fi
echo "embedded, shared, with hidden names, and by pkg-config: built and run"
