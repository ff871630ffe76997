#!/usr/bin/env bash
# Installs a build tree to a temporary prefix, then builds and runs a separate project against it.
# Arguments: source folder, build folder, C++ compiler, CMake generator.
set -euo pipefail
source=$1 build=$2 compiler=$3 generator=$4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/prefix" >/dev/null
cmake -G "$generator" -S "$source/tests/install/user" -B "$work/build" -DCMAKE_PREFIX_PATH="$work/prefix" \
      -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build "$work/build" >"$work/log" || { cat "$work/log"; exit 1; }
"$work/build/use_headers"
"$work/build/use_ccd"
if [[ -f $work/build/use_adapters ]]; then "$work/build/use_adapters"; fi
scene=$work/prefix/share/errbound/scenes/cloth-over-ball
"$work/build/use_ccd_io" "$scene"/frame{0,1}.ply
! "$work/build/use_ccd_io" "$scene"/frame0.ply missing.ply 2>"$work/said"
grep -q "missing.ply: found no such file" "$work/said"
if [[ -f $work/prefix/lib/liberrbound_ccd_cuda.a ]]; then "$work/build/use_ccd_cuda"; fi
if [[ -f $work/prefix/lib/liberrbound_validation.a ]]; then "$work/build/use_validation" >/dev/null; fi
"$work/prefix/bin/ccd" methods | grep -q exact
test -f "$work/prefix/share/doc/errbound/CITATION.cff"
mkdir "$work/asks"
cat >"$work/asks/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.22)
project(asks CXX)
find_package(errbound REQUIRED COMPONENTS nosuch)
CMAKE
! cmake -S "$work/asks" -B "$work/asks/build" -DCMAKE_PREFIX_PATH="$work/prefix" &>"$work/said"
grep -q "installed without the component nosuch" "$work/said"
echo "installed package found, built against and run"
