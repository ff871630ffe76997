// Packs for processors without xsimd packs: the compiler's vectors of sixteen bytes, with xsimd's
// interface. Internal; included by ccd/exact/simd.hpp only, and under the rules of
// ccd/batch/batch_kernels.hpp.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#if defined(__arm__) && defined(__ARM_NEON) && defined(__clang__)
#error \
    "errbound: NEON of 32-bit ARM takes subnormal numbers for zero; compile with -mfpu=vfpv3-d16 or the like"
#endif

namespace ccd::detail::ERRBOUND_INSTRUCTION_SET {
namespace {

/// All bits of a lane are set, or none.
template <class T>
struct vector_mask {
    using integer = std::conditional_t<sizeof(T) == 8, std::int64_t, std::int32_t>;
    typedef integer vector __attribute__((vector_size(16)));
    static constexpr std::size_t size = 16 / sizeof(T);

    vector data;

    vector_mask() = default;
    explicit vector_mask(const vector& v) : data(v) {}
    vector_mask(bool b) : data(vector{} - integer(b)) {}

    friend vector_mask operator&(const vector_mask& a, const vector_mask& b) {
        return vector_mask(vector(a.data & b.data));
    }
    friend vector_mask operator|(const vector_mask& a, const vector_mask& b) {
        return vector_mask(vector(a.data | b.data));
    }
    vector_mask operator!() const { return vector_mask(vector(~data)); }
    vector_mask operator~() const { return !*this; }

    std::uint32_t bits() const {
        std::uint32_t b = 0;
        for (std::size_t i = 0; i < size; ++i) b |= static_cast<std::uint32_t>(data[i] & 1) << i;
        return b;
    }
    friend bool any(const vector_mask& m) { return m.bits() != 0; }
    friend bool none(const vector_mask& m) { return m.bits() == 0; }
    friend bool all(const vector_mask& m) { return m.bits() == (1U << size) - 1; }
};

template <class T>
struct vector_pack {
    typedef T vector __attribute__((vector_size(16)));
    using mask = vector_mask<T>;
    using bits = typename mask::vector;
    static constexpr std::size_t size = mask::size;

    vector data;

    vector_pack() = default;
    explicit vector_pack(const vector& v) : data(v) {}
    vector_pack(T x) : data(x - vector{}) {}  // x - 0 is x, also for -0

    static vector_pack load_unaligned(const T* from) {
        vector_pack x;
        __builtin_memcpy(&x.data, from, sizeof(x.data));
        return x;
    }
    static vector_pack load_aligned(const T* from) { return load_unaligned(from); }
    void store_unaligned(T* to) const { __builtin_memcpy(to, &data, sizeof(data)); }
    void store_aligned(T* to) const { store_unaligned(to); }

    friend vector_pack operator+(const vector_pack& a, const vector_pack& b) {
        return vector_pack(a.data + b.data);
    }
    friend vector_pack operator-(const vector_pack& a, const vector_pack& b) {
        return vector_pack(a.data - b.data);
    }
    friend vector_pack operator*(const vector_pack& a, const vector_pack& b) {
        return vector_pack(a.data * b.data);
    }
    friend vector_pack operator/(const vector_pack& a, const vector_pack& b) {
        return vector_pack(a.data / b.data);
    }
    vector_pack operator-() const { return vector_pack(-data); }
    vector_pack& operator+=(const vector_pack& b) { return *this = *this + b; }

    friend mask operator<(const vector_pack& a, const vector_pack& b) {
        return mask(bits(a.data < b.data));
    }
    friend mask operator>(const vector_pack& a, const vector_pack& b) { return b < a; }
    friend mask operator<=(const vector_pack& a, const vector_pack& b) {
        return mask(bits(a.data <= b.data));
    }
    friend mask operator>=(const vector_pack& a, const vector_pack& b) { return b <= a; }
    friend mask operator==(const vector_pack& a, const vector_pack& b) {
        return mask(bits(a.data == b.data));
    }

    friend vector_pack select(const mask& m, const vector_pack& a, const vector_pack& b) {
        return of_bits((bits_of(a) & m.data) | (bits_of(b) & ~m.data));
    }
    friend vector_pack min(const vector_pack& a, const vector_pack& b) {
        return select(a < b, a, b);
    }
    friend vector_pack max(const vector_pack& a, const vector_pack& b) {
        return select(b < a, a, b);
    }
    friend vector_pack abs(const vector_pack& x) {
        return of_bits(bits_of(x) & std::numeric_limits<typename mask::integer>::max());
    }
    friend vector_pack sqrt(vector_pack x) {
        for (std::size_t i = 0; i < size; ++i) x.data[i] = std::sqrt(x.data[i]);
        return x;
    }

    friend bits bits_of(const vector_pack& x) { return __builtin_bit_cast(bits, x.data); }
    static vector_pack of_bits(const bits& b) { return vector_pack(__builtin_bit_cast(vector, b)); }
};

}  // namespace
}  // namespace ccd::detail::ERRBOUND_INSTRUCTION_SET
