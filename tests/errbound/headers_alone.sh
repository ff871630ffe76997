#!/usr/bin/env bash
# Compiles each header by itself, from a copy of include/errbound, and looks at what it includes:
# nothing but the standard library, but for the headers that are there to meet another one.
# Arguments: source folder, C++ compiler.
set -euo pipefail
source=$1 compiler=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/include"
cp -r "$source/include/errbound" "$work/include"
cd "$work/include"
count=0
for header in errbound/*.hpp errbound/*/*.hpp; do
    case $header in
        errbound/eigen.hpp | errbound/certified_solve.hpp | errbound/linear/* | \
            errbound/multiprecision.hpp | errbound/validation/*) continue ;;
    esac
    echo "#include <$header>" >"$work/use.cpp"
    "$compiler" -std=c++20 -fsyntax-only -Wall -Wextra -Werror -I. \
        -MD -MF "$work/use.d" "$work/use.cpp"
    if grep -E '/(boost|eigen3|Eigen|xsimd|gmp[^/]*\.h)' "$work/use.d"; then
        echo "$header includes more than the standard library"
        exit 1
    fi
    count=$((count + 1))
done
echo "$count headers compile alone"
