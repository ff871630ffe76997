// Packs of numbers of twice double's precision: unevaluated sums of two doubles. Internal.
//
// Let operands have sizes of at most A and B, and u = 2^-53. Without overflow, a sum has an error
// of at most 5u²(A + B), a product 13u²AB. These are Dekker's short forms (1971), whose errors are
// relative to the operands. Proof, with underflow: proofs/times/Twofold.v, sum_near, product_near,
// product_rounded, product_rounded_fma.
#pragma once

#include <errbound/error_free.hpp>

#include "ccd/exact/simd.hpp"

namespace ccd::detail::ERRBOUND_INSTRUCTION_SET {
namespace {

struct twofold {
    pack value, error;

    static twofold normal(const pack& value, const pack& error) {
        const auto sum = errbound::fast_two_sum(value, error);
        return {sum.value, sum.error};
    }
    static twofold product(const pack& a, const pack& b) {
        const pack value = a * b;
#if defined __AVX512F__
        return {value, _mm512_fmsub_pd(a, b, value)};
#elif defined __FMA__
        return {value, _mm256_fmsub_pd(a, b, value)};
#else
        const auto halves = [](const pack& x) {
            const pack c = x * pack(0x1p27 + 1);  // Veltkamp's splitting
            const pack high = c - (c - x);
            return twofold{high, x - high};
        };
        const twofold x = halves(a), y = halves(b);
        return {value, ((x.value * y.value - value) + x.value * y.error + x.error * y.value) +
                           x.error * y.error};
#endif
    }

    twofold operator-() const {
        return {-value, -error};
    }
    friend twofold operator+(const twofold& a, const twofold& b) {
        const auto sum = errbound::two_sum(a.value, b.value);
        return normal(sum.value, sum.error + (a.error + b.error));
    }
    friend twofold operator-(const twofold& a, const twofold& b) {
        return a + -b;
    }
    friend twofold operator*(const twofold& a, const twofold& b) {
        const twofold p = product(a.value, b.value);
        return normal(p.value, p.error + (a.value * b.error + a.error * b.value));
    }
};

}  // namespace
}  // namespace ccd::detail::ERRBOUND_INSTRUCTION_SET
