// Compares PTX instructions with the host's operations on special and random operands: arithmetic,
// comparisons, conversions, bits, carries, and operations of warps.
#include <cuda_runtime.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "tests/ccd/cuda/emulator/ptx.hpp"

namespace {

using namespace ptx;
__extension__ typedef __int128 s128;
__extension__ typedef unsigned __int128 u128;

constexpr u32 count = 4096;
bool all_right = true;

template <class T>
bool same(T a, T b) {
    return (a != a && b != b) || std::memcmp(&a, &b, sizeof a) == 0;
}

template <class Case, class R, class T>
__global__ void apply(const T* in, R* out) {
    const u32 i = blockIdx.x * blockDim.x + threadIdx.x;
    out[i] = Case::device(in[i], in[i + count], in[i + 2 * count]);
}

template <class Case, class R, class T>
void compare(const char* name, const std::vector<T>& in) {
    T* x;
    R* r;
    cudaMalloc(&x, sizeof(T) * 3 * count);
    cudaMalloc(&r, sizeof(R) * count);
    cudaMemcpy(x, in.data(), sizeof(T) * 3 * count, cudaMemcpyHostToDevice);
    apply<Case, R, T><<<count / 128, 128>>>(x, r);
    std::vector<R> out(count);
    cudaMemcpy(out.data(), r, sizeof(R) * count, cudaMemcpyDeviceToHost);
    cudaFree(x), cudaFree(r);
    u32 differ = 0;
    for (u32 i = 0; i < count; ++i)
        differ += !same(out[i], R(Case::host(in[i], in[i + count], in[i + 2 * count])));
    if (differ != 0 || cudaGetLastError() != cudaSuccess)
        std::printf("%s differs for %u operands\n", name, differ), all_right = false;
}

template <class T>
std::vector<T> operands() {
    static std::mt19937_64 random(5);
    using limits = std::numeric_limits<T>;
    std::vector<T> special{T(0),  T(1),  T(-1),         T(2),          T(31),
                           T(33), T(64), limits::min(), limits::max(), limits::lowest()};
    if constexpr (!limits::is_integer)
        for (const T x : {limits::infinity(), limits::quiet_NaN(), limits::denorm_min(), T(0.1),
                          T(1.5), T(1e19)})
            special.push_back(x), special.push_back(-x);
    std::vector<T> all(3 * count);
    for (T& x : all) {
        const u64 bits = random() >> random() % 48;
        std::memcpy(&x, &bits, sizeof x);
        if (random() % 2) x = special[random() % special.size()];
    }
    return all;
}

std::vector<void (*)()>& cases() {
    static std::vector<void (*)()> all;
    return all;
}

// CASE(instruction, result, register, operand, register, host): the result of a, b and c is tested.
#define CASE(...) NUMBERED_CASE(__COUNTER__, __VA_ARGS__)
#define NUMBERED_CASE(...) EXPANDED_CASE(__VA_ARGS__)
#define EXPANDED_CASE(n, text, R, r, T, t, ...)                                       \
    struct case##n{static __device__ R device(T a, T b, T c){R d = 0;                 \
    asm volatile("{.reg .pred p, q; .reg .u32 h, l; .reg .u64 w, v;\n" text "}"       \
                 : "=" r(d)                                                           \
                 : t(a), t(b), t(c));                                                 \
    return d;                                                                         \
    }                                                                                 \
    static R host([[maybe_unused]] T a, [[maybe_unused]] T b, [[maybe_unused]] T c) { \
        return static_cast<R>(__VA_ARGS__);                                           \
    }                                                                                 \
    static void test() {                                                              \
        compare<case##n, R, T>(text, operands<T>());                                  \
    }                                                                                 \
    }                                                                                 \
    ;                                                                                 \
    const bool listed##n = (cases().push_back(case##n::test), true)

template <class T>
T wrapped_quotient(T a, T b) {
    return b == 0 ? T(-1) : b == T(-1) ? T(0 - std::make_unsigned_t<T>(a)) : T(a / b);
}
template <class T>
T smaller(T a, T b) {
    return std::isnan(a) || (!std::isnan(b) && (b < a || (b == a && std::signbit(b)))) ? b : a;
}
template <class I, class T>
I saturated(T x) {
    using limits = std::numeric_limits<I>;
    if (x != x) return sizeof(I) == 8 ? limits::min() : I(0);
    return x >= std::ldexp(T(1), limits::digits) ? limits::max()
           : x <= T(limits::min())               ? limits::min()
                                                 : I(x);
}

#define FLOAT_CASES(T, r, type, uint)                                                              \
    CASE("add.rn." type " %0, %1, %2;", T, r, T, r, a + b);                                        \
    CASE("sub.rn." type " %0, %1, %2;", T, r, T, r, a - b);                                        \
    CASE("mul.rn." type " %0, %1, %2;", T, r, T, r, a* b);                                         \
    CASE("div.rn." type " %0, %1, %2;", T, r, T, r, a / b);                                        \
    CASE("fma.rn." type " %0, %1, %2, %3;", T, r, T, r, std::fma(a, b, c));                        \
    CASE("rcp.rn." type " %0, %1;", T, r, T, r, 1 / a);                                            \
    CASE("sqrt.rn." type " %0, %1;", T, r, T, r, std::sqrt(a));                                    \
    CASE("abs." type " %0, %1;", T, r, T, r, std::fabs(a));                                        \
    CASE("neg." type " %0, %1;", T, r, T, r, -a);                                                  \
    CASE("copysign." type " %0, %1, %2;", T, r, T, r, std::copysign(b, a));                        \
    CASE("min." type " %0, %1, %2;", T, r, T, r, smaller(a, b));                                   \
    CASE("max." type " %0, %1, %2;", T, r, T, r, -smaller(-a, -b));                                \
    CASE("setp.lt." type " p, %1, %2; selp." type " %0, %2, %3, p;", T, r, T, r, a < b ? b : c);   \
    CASE("setp.leu." type " p, %1, %2; selp." type " %0, %2, %3, p;", T, r, T, r,                  \
         !(a > b) ? b : c);                                                                        \
    CASE("setp.geu." type " p, %1, %2; selp." type " %0, %2, %3, p;", T, r, T, r,                  \
         !(a < b) ? b : c);                                                                        \
    CASE("setp.neu." type " p, %1, %2; selp." type " %0, %2, %3, p;", T, r, T, r, a != b ? b : c); \
    CASE("setp.num." type " p, %1, %2; selp." type " %0, %2, %3, p;", T, r, T, r,                  \
         a == a && b == b ? b : c)

#define SIGNED_CASES(T, r, type, U)                                                                \
    CASE("mul.hi.s" type " %0, %1, %2;", T, r, T, r, (s128(a) * b) >> (8 * sizeof a));             \
    CASE("mul.hi.u" type " %0, %1, %2;", U, r, U, r, (u128(a) * b) >> (8 * sizeof a));             \
    CASE("mul.lo.s" type " %0, %1, %2;", U, r, U, r, a* b);                                        \
    CASE("add.s" type " %0, %1, %2;", U, r, U, r, a + b);                                          \
    CASE("sub.s" type " %0, %1, %2;", U, r, U, r, a - b);                                          \
    CASE("div.s" type " %0, %1, %2;", T, r, T, r, wrapped_quotient(a, b));                         \
    CASE("rem.s" type " %0, %1, %2;", T, r, T, r, U(a) - U(wrapped_quotient(a, b)) * U(b));        \
    CASE("rem.u" type " %0, %1, %2;", U, r, U, r, b == 0 ? a : a % b);                             \
    CASE("abs.s" type " %0, %1;", T, r, T, r, a < 0 ? U(0) - U(a) : U(a));                         \
    CASE("neg.s" type " %0, %1;", U, r, U, r, 0 - a);                                              \
    CASE("min.s" type " %0, %1, %2;", T, r, T, r, a < b ? a : b);                                  \
    CASE("max.u" type " %0, %1, %2;", U, r, U, r, a < b ? b : a);                                  \
    CASE("setp.lt.s" type " p, %1, %2; selp.b" type " %0, %2, %3, p;", T, r, T, r, a < b ? b : c); \
    CASE("setp.ge.u" type " p, %1, %2; selp.b" type " %0, %2, %3, p;", U, r, U, r,                 \
         a >= b ? b : c);                                                                          \
    CASE("and.b" type " %0, %1, %2; not.b" type " %0, %0;", U, r, U, r, ~(a & b));                 \
    CASE("or.b" type " %0, %1, %2; xor.b" type " %0, %0, %3;", U, r, U, r, (a | b) ^ c);           \
    CASE("cvt.u32.u" type " h, %2; shl.b" type " %0, %1, h;", U, r, U, r,                          \
         u32(b) < 8 * sizeof a ? a << u32(b) : 0);                                                 \
    CASE("cvt.u32.u" type " h, %2; shr.u" type " %0, %1, h;", U, r, U, r,                          \
         u32(b) < 8 * sizeof a ? a >> u32(b) : 0);                                                 \
    CASE("cvt.u32.u" type " h, %2; shr.s" type " %0, %1, h;", T, r, T, r,                          \
         a >> (u32(b) < 8 * sizeof a ? u32(b) : 8 * sizeof a - 1))

FLOAT_CASES(float, "f", "f32", u32);
FLOAT_CASES(double, "d", "f64", u64);
CASE("cvt.rn.f32.f64 %0, %1;", float, "f", double, "d", a);
CASE("cvt.f64.f32 %0, %1;", double, "d", float, "f", a);
CASE("cvt.rn.f32.s32 %0, %1;", float, "f", s32, "r", a);
CASE("cvt.rn.f64.s64 %0, %1;", double, "d", s64, "l", a);
CASE("cvt.rn.f64.u64 %0, %1;", double, "d", u64, "l", a);
CASE("cvt.rzi.s64.f64 %0, %1;", s64, "l", double, "d", saturated<s64>(a));
CASE("cvt.rzi.u32.f32 %0, %1;", u32, "r", float, "f", saturated<u32>(a));

SIGNED_CASES(s32, "r", "32", u32);
SIGNED_CASES(s64, "l", "64", u64);
CASE("mul.wide.s32 %0, %1, %2;", s64, "l", s32, "r", s64(a) * b);
CASE("mul.wide.u32 %0, %1, %2;", u64, "l", u32, "r", u64(a) * b);
CASE("mad.lo.s32 %0, %1, %2, %3;", u32, "r", u32, "r", a* b + c);
CASE("add.cc.u32 h, %1, %2; addc.cc.u32 %0, %3, %1;", u32, "r", u32, "r",
     u32(c + a) + (u32(a + b) < a));
CASE("sub.cc.u32 h, %1, %2; subc.cc.u32 %0, %3, %1;", u32, "r", u32, "r", u32(c - a) - (a < b));
CASE("add.cc.s64 w, %1, %2; addc.cc.s64 v, %2, %3; addc.cc.s64 %0, %1, %3;", u64, "l", u64, "l",
     a + c + ((u128(b) + c + (u64(a + b) < a)) >> 64));
CASE("sub.cc.s64 w, %1, %2; subc.cc.s64 v, %2, %3; subc.cc.s64 %0, %1, %3;", u64, "l", u64, "l",
     a - c - (u128(b) < u128(c) + (a < b)));
CASE("popc.b32 %0, %1;", u32, "r", u32, "r", __builtin_popcount(a));
CASE("clz.b32 %0, %1;", u32, "r", u32, "r", a == 0 ? 32 : __builtin_clz(a));
CASE("clz.b64 %0, %1;", u32, "r", u64, "l", a == 0 ? 64 : __builtin_clzll(a));
CASE("brev.b32 %0, %1; brev.b32 %0, %0;", u32, "r", u32, "r", a);
CASE("brev.b32 %0, %1; clz.b32 %0, %0;", u32, "r", u32, "r", a == 0 ? 32 : __builtin_ctz(a));
CASE("bfind.shiftamt.u32 %0, %1;", u32, "r", u32, "r", a == 0 ? ~0u : __builtin_clz(a));
CASE("bmsk.clamp.b32 %0, %1, %2;", u32, "r", u32, "r",
     a > 31 ? 0 : u64(b > 31 ? ~0u : (1u << b) - 1) << a);
CASE("bfi.b64 %0, %1, %2, 12, 20;", u64, "l", u64, "l", (b & ~0xfffff000ull) | (a & 0xfffff) << 12);
CASE("prmt.b32 %0, %1, %2, 0x7604;", u32, "r", u32, "r",
     (b & 255) | (a & 255) << 8 | b >> 16 << 16);
CASE("prmt.b32 %0, %1, %2, 0x30F8;", u32, "r", u32, "r",
     (a & 0x80 ? 255u : 0) | (b >> 31 ? 0xff00u : 0) | (a & 255) << 16 | a >> 24 << 24);
CASE("mov.b64 {l, h}, %1; mov.b64 %0, {h, l};", u64, "l", u64, "l", a >> 32 | a << 32);
CASE("cvt.s64.s32 %0, %1;", s64, "l", s32, "r", a);
CASE("cvt.u32.u64 %0, %1;", u32, "r", u64, "l", a);
CASE("cvt.s16.s8 %0, %1;", s16, "h", s16, "h", s8(a));
CASE("add.s16 %0, %1, %2; shr.u16 %0, %0, 3;", u16, "h", u16, "h", u16(a + b) >> 3);
CASE("setp.lt.s16 p, %1, %2; not.pred q, p; selp.u16 %0, 1, 2, q;", s16, "h", s16, "h",
     a < b ? 2 : 1);

struct row {
    u32 x[16];
};
/// Indexes its parameter, whose address is one of local memory.
__device__ __noinline__ u32 at(const row r, u32 i) {
    const u32* volatile p = r.x;
    return p[i];
}
__global__ void meet(u32* out, u32* sum, u64* least) {
    const u32 t = threadIdx.x, all = ~0u;
    u32* const mine = out + 8 * t;
    mine[0] = __shfl_up_sync(all, t, 3);
    mine[1] = __shfl_down_sync(all, t, 5, 16);
    mine[2] = __shfl_sync(all, t, 9, 8);
    mine[3] = __ballot_sync(all, t % 3 == 0);
    mine[4] = u32(__all_sync(all, t < 32)) + 2 * u32(__any_sync(all, t == 40)) +
              4 * u32(__any_sync(all, t == 7));
    mine[5] = t % 2 == 0 ? __activemask() : 0;
    mine[6] = u32(__syncthreads_or(t == 50));
    row r;
    for (u32 i = 0; i < 16; ++i) r.x[i] = i * t;
    atomicAdd(sum, at(r, 1 + t % 2) / (1 + t % 2));
    atomicMin(reinterpret_cast<unsigned long long*>(least), 1000ull - t);
    mine[7] = t < 32 ? 0 : __shfl_sync(all, mine[0], 31);
}

void warps() {
    u32 *out, *sum, host[8 * 64], total = 0;
    u64 *least, minimum = 5000;
    cudaMalloc(&out, sizeof host), cudaMalloc(&sum, 4), cudaMalloc(&least, 8);
    cudaMemcpy(sum, &total, 4, cudaMemcpyHostToDevice),
        cudaMemcpy(least, &minimum, 8, cudaMemcpyHostToDevice);
    meet<<<1, 64>>>(out, sum, least);
    cudaMemcpy(host, out, sizeof host, cudaMemcpyDeviceToHost);
    cudaMemcpy(&total, sum, 4, cudaMemcpyDeviceToHost),
        cudaMemcpy(&minimum, least, 8, cudaMemcpyDeviceToHost);
    bool right = total == 63 * 32 && minimum == 1000 - 63;
    for (u32 t = 0; t < 64; ++t) {
        const u32 w = t / 32 * 32, lane = t % 32;
        u32 thirds = 0;
        for (u32 i = 0; i < 32; ++i) thirds |= u32((w + i) % 3 == 0) << i;
        const u32 expected[8] = {lane < 3 ? t : t - 3,
                                 t % 16 + 5 < 16 ? t + 5 : t,
                                 t / 8 * 8 + 1,
                                 thirds,
                                 t < 32 ? 5u : 2u,
                                 t % 2 == 0 ? 0x55555555u : 0,
                                 1,
                                 t < 32 ? 0u : 60u};
        right = right && std::memcmp(host + 8 * t, expected, sizeof expected) == 0;
    }
    if (!right) std::printf("operations of warps differ\n"), all_right = false;
}

}  // namespace

int main() {
    for (const auto test : cases()) test();
    warps();
    std::printf("%s\n", all_right ? "all instructions agree with the host" : "FAILED");
    return all_right ? 0 : 1;
}
