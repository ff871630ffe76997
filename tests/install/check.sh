#!/usr/bin/env bash
# Installs a build tree to a temporary prefix, then builds and runs a separate project against it.
# Arguments: source folder, build folder, C++ compiler, CMake generator.
set -euo pipefail
source=$1 build=$2 compiler=$3 generator=$4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/prefix" >/dev/null
"$work/prefix/bin/ccd" methods | grep -q exact
"$work/prefix/bin/ccd" step "$work"/prefix/share/errbound/scenes/cloth-over-ball/frame{0,1}.ply >/dev/null
test -f "$work/prefix/share/doc/errbound/CITATION.cff"
export PKG_CONFIG_PATH
PKG_CONFIG_PATH=$(dirname "$(find "$work/prefix" -name errbound.pc)")
read -ra flags < <(pkg-config --cflags --libs errbound-ccd)
"$compiler" -std=c++20 "$source/tests/install/user/use_ccd.cpp" "${flags[@]}" -o "$work/by_pkg_config"
"$work/by_pkg_config"
"$source/tests/install/use.sh" "$source" "$work/prefix" "$work" "$compiler" "$generator"
