#!/usr/bin/env bash
# Compiles each header of errbound separately, from a copy, and checks what it includes: only the
# standard library, except for the headers that exist for another library. Then compiles all public
# headers in one unit after macros that <windows.h> defines, and units that instantiate templates,
# with the warnings that users turn on.
# Arguments: source folder, C++ compiler, Eigen's folder (empty without Eigen).
set -euo pipefail
source=$1 compiler=$2 eigen=${3:-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/include"
cp -r "$source/include/errbound" "$work/include"
cd "$work/include"
warnings=(-Wall -Wextra -Wconversion -Wsign-conversion -Wshadow -Wold-style-cast -Werror)
count=0
for header in errbound/*.hpp errbound/*/*.hpp; do
    case $header in
        errbound/eigen.hpp | errbound/certified_solve.hpp | errbound/linear/* | \
            errbound/multiprecision.hpp | errbound/validation/*) continue ;;
    esac
    echo "#include <$header>" >"$work/use.cpp"
    "$compiler" -std=c++20 -fsyntax-only "${warnings[@]}" -I. -MD -MF "$work/use.d" "$work/use.cpp"
    if grep -E '/(boost|eigen3|Eigen|xsimd|gmp[^/]*\.h)' "$work/use.d"; then
        echo "$header includes more than the standard library"
        exit 1
    fi
    count=$((count + 1))
done
echo "$count headers compile alone"

# <windows.h> defines min, max, near and far; its parts and relatives define the others. The C++
# library undefines min and max, so the headers of other projects come first.
cd "$source/include"
other_projects=(boost/multiprecision/cpp_bin_float.hpp boost/multiprecision/mpfr.hpp)
if [[ -n $eigen ]]; then other_projects+=(Eigen/Dense ipc/ccd/narrow_phase_ccd.hpp); fi
{
    grep -rhoE '^#include <[a-z_]+>' errbound ccd | sed -E 's/.*<(.*)>/\1/' | sort -u
    printf '%s\n' "${other_projects[@]}"
} | sed 's/.*/#if __has_include(<&>)\n#include <&>\n#endif/' >"$work/all.cpp"
cat >>"$work/all.cpp" <<'MACROS'
#define min(a, b) (((a) < (b)) ? (a) : (b))
#define max(a, b) (((a) > (b)) ? (a) : (b))
#define near
#define far
#define NEAR near
#define FAR far
#define IN
#define OUT
#define OPTIONAL
#define CONST const
#define VOID void
#define ERROR 0
#define DELETE (0x00010000L)
#define small char
#define hyper int
#define interface struct
#define pascal
#define cdecl
MACROS
for header in errbound/*.hpp errbound/*/*.hpp ccd/*.hpp ccd/*/*.hpp; do
    case $header in
        errbound/eigen.hpp | errbound/certified_solve.hpp | errbound/linear/* | ccd/adapters/*)
            needs=Eigen/Core ;;
        errbound/multiprecision.hpp) needs=boost/multiprecision/number.hpp ;;
        errbound/validation/*) needs=mpfr.h ;;
        ccd/mpi.hpp) needs=mpi.h ;;
        *) needs=$header ;;
    esac
    printf '#if __has_include(<%s>)\n#include <%s>\n#endif\n' "$needs" "$header"
done >>"$work/all.cpp"
units=("$work/all.cpp" "$source/examples/authoring.cpp" "$source/examples/wilkinson.cpp")
paths=(-I. -isystem "$source/tests/ccd/adapters/restated")
if [[ -n $eigen ]]; then
    paths+=(-isystem "$eigen")
    units+=("$source/examples/linear/linear_systems.cpp")
fi
for each in "$compiler" clang++; do
    if ! command -v "$each" >/dev/null; then continue; fi
    "$each" -std=c++20 -fsyntax-only "${warnings[@]}" "${paths[@]}" "${units[@]}"
    echo "$each: all headers after the macros of <windows.h>, and ${#units[@]} units, without warnings"
done
