// Kernels that nvcc 13 miscompiles without a warning, and sound ones. tests/ccd/cuda/null_calls.py
// must report every kernel named broken_ and none named sound_.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <errbound/bsc.hpp>
#include <errbound/detail/bits.hpp>
#include <errbound/predicates.hpp>
#include <errbound/tracked.hpp>

namespace {

struct limits {
    static constexpr std::int64_t farthest = std::int64_t{1} << 60;
    static constexpr double root = 0x1p-40;
};
constexpr std::int64_t next_step(std::int64_t step) {
    return std::min(4 * step, limits::farthest);
}
constexpr double at_least_root(double x) {
    return errbound::number_traits<double>::max(limits::root, x);
}

using number = errbound::tracked<double, errbound::tight>;
using part = errbound::bsc::part<number, 3>;
constexpr part constructed(const errbound::bernstein<number, 3>& y) {
    return part{y, {}};
}
constexpr part assigned(const errbound::bernstein<number, 3>& y) {
    part p;
    p.y = y;
    return p;
}

}  // namespace

// nvcc replaces the value by a constant (64), or removes the code after the call.
__global__ void broken_countr_zero(const std::uint64_t* x, int* y) {
    *y = std::countr_zero(*x);
}
__global__ void broken_countl_zero(const std::uint64_t* x, int* y) {
    *y = std::countl_zero(*x);
}
__global__ void broken_bit_width(const std::uint64_t* x, int* y) {
    *y = static_cast<int>(std::bit_width(*x));
}
__global__ void broken_popcount(const std::uint64_t* x, int* y) {
    *y = std::popcount(*x);
}
// BSC returned "no contact" for every query whose Y may have a root.
__global__ void broken_nested_array(const double* x, double* y) {
    *y = constructed({{x[0], x[1], x[2], x[3]}}).g[0][0].value();
}
// First contact times and safeccd-tight trapped.
__global__ void broken_reference_to_member(std::int64_t* step) {
    *step = next_step(*step);
}
__global__ void broken_reference_to_own_max(double* x) {
    *x = at_least_root(*x);
}

__global__ void sound_bits(const std::uint64_t* x, int* y) {
    using namespace errbound::detail;
    *y = countr_zero(*x) + countl_zero(*x) + bit_width(*x);
}
__global__ void sound_nested_array(const double* x, double* y) {
    *y = assigned({{x[0], x[1], x[2], x[3]}}).g[0][0].value();
}
__global__ void sound_minimum(std::int64_t* step) {
    *step = std::min(4 * *step, +limits::farthest);
}
__global__ void sound_predicate(const double* x, errbound::sign_type* sign) {
    constexpr std::remove_const_t<decltype(errbound::orient2d)> orient2d{};
    *sign = orient2d(x, x + 2, x + 4);
}
