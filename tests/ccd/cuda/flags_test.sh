#!/bin/sh
# flags_test.sh NVCC INCLUDE OPTION...: what the library's options are for, read off the PTX.
#
# By default nvcc fuses a product into a sum, which changes plain results (though not those of
# tracked numbers), and under -ftz=true it flushes subnormals; under the options it does neither.
set -eu
nvcc=$1 include=$2
shift 2
source=$(dirname "$0")/flags.cu

# instructions KERNEL PATTERN OPTION...: how many lines of the kernel's PTX have the pattern
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
        echo "$3: found $1, expected $2"
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
