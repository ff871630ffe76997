#!/bin/sh
# flags_test.sh NVCC INCLUDE OPTION...: tests the effect of the library's options on the PTX.
#
# nvcc fuses products into sums by default, which changes plain results (but not those of tracked
# numbers), and -ftz=true flushes subnormals. The library's options prevent both.
set -eu
nvcc=$1 include=$2
shift 2
source=$(dirname "$0")/flags.cu

# instructions KERNEL PATTERN OPTION...: prints the number of matching lines in the kernel's PTX
instructions() {
    kernel=$1 pattern=$2
    shift 2
    "$nvcc" -std=c++20 --expt-relaxed-constexpr -arch=sm_80 -I "$include" "$@" -ptx -o - "$source" |
        awk -v kernel="$kernel" '/\.entry/ { inside = index($0, kernel) } inside' |
        grep -c -- "$pattern" || true
}
# expect FOUND EXPECTED WHAT
expect() {
    if [ "$1" -ne "$2" ]; then
        echo "$3 is $1; expected $2"
        exit 1
    fi
}

expect "$(instructions plain_sum 'fma.rn.f64')" 1 'fused operations of plain numbers by default'
expect "$(instructions plain_sum 'fma.rn.f64' "$@")" 0 'fused operations of plain numbers'
expect "$(instructions tracked_sum 'fma.rn.f64')" 0 \
    'fused operations of a tracked number by default'
expect "$(instructions tracked_sum 'mul.rn.f64')" 1 \
    'products of a tracked number that ptxas may not fuse either, by default'
expect "$(instructions plain_product 'ftz' -ftz=true)" 1 'flushing operations under -ftz=true'
expect "$(instructions plain_product 'ftz' "$@")" 0 'flushing operations'
echo 'no fused and no flushing operations under the options'
