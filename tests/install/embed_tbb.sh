#!/usr/bin/env bash
# Configures a project that has its own target TBB::tbb and includes errbound as a subdirectory:
# errbound uses that target and installs nothing.
# Arguments: source folder, C++ compiler, CMake generator, cmake (by default the one on the PATH).
set -euo pipefail
source=$1 compiler=$2 generator=$3 cmake=${4:-cmake}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$cmake" -G "$generator" -S "$source/tests/install/embedding_tbb" -B "$work/own" \
    -DERRBOUND_SOURCE="$source" -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Release
if grep -E 'TBB_DIR:|TBB_VERSION' "$work/own/CMakeCache.txt"; then exit 1; fi
if grep -rn --include=cmake_install.cmake 'file(INSTALL' "$work/own/errbound"; then exit 1; fi
