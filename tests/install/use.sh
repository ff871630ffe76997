#!/usr/bin/env bash
# Builds and runs a separate project against an installed errbound.
# Arguments: source folder, installation prefix, folder to work in, C++ compiler, CMake generator.
set -euo pipefail
source=$1 prefix=$2 work=$3 compiler=$4 generator=$5
cmake -G "$generator" -S "$source/tests/install/user" -B "$work/build" -DCMAKE_PREFIX_PATH="$prefix" \
      -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build "$work/build" >"$work/log" || { cat "$work/log"; exit 1; }
"$work/build/use_headers"
"$work/build/use_ccd"
if [[ -f $work/build/use_adapters ]]; then "$work/build/use_adapters"; fi
scene=$source/examples/scenes/cloth-over-ball
"$work/build/use_ccd_io" "$scene"/frame{0,1}.ply
if "$work/build/use_ccd_io" "$scene"/frame0.ply missing.ply 2>"$work/said"; then exit 1; fi
grep -q "missing.ply: file does not exist" "$work/said"
for optional in ccd_cuda validation; do
    library=$(find "$prefix"/lib* -name "liberrbound_$optional.a" -print -quit)
    if [[ -n $library ]]; then "$work/build/use_$optional" >/dev/null; fi
done
mkdir "$work/asks"
cat >"$work/asks/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.22)
project(asks CXX)
find_package(errbound REQUIRED COMPONENTS nosuch)
CMAKE
if cmake -S "$work/asks" -B "$work/asks/build" -DCMAKE_PREFIX_PATH="$prefix" &>"$work/said"; then exit 1; fi
grep -q "installed without the component nosuch" "$work/said"
echo "installed package found, built against and run"
