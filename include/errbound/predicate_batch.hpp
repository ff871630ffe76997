// Predicates on many inputs: the first filter on as many at a time as the processor has lanes.
//
//   std::vector<std::array<double, 2>> a, b, c;
//   std::vector<errbound::sign_type> signs(a.size());
//   errbound::batch_signs(errbound::orient2d, signs, a, b, c);
//
// No intrinsics: the loops are written for compilers to vectorise (-O2 of clang, -O3 of GCC), and
// compiled for the instruction sets of x86 side by side; the processor's is chosen at run time. The
// signs are those of one by one, whatever the instruction set.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <errbound/predicate.hpp>
#include <ranges>
#include <span>
#include <type_traits>

namespace errbound {

/// Points as one array per coordinate: the fastest form.
template <class T, std::size_t Dimension>
struct coordinate_arrays {
    std::array<const T*, Dimension> coordinates;
    std::size_t length;

    constexpr std::size_t size() const { return length; }
    constexpr std::array<T, Dimension> operator[](std::size_t i) const {
        std::array<T, Dimension> p;
        for (std::size_t k = 0; k < Dimension; ++k) p[k] = coordinates[k][i];
        return p;
    }
};
/// One point for every input.
template <class Point>
struct every {
    Point point;
    constexpr const Point& operator[](std::size_t) const { return point; }
};

namespace detail {

inline constexpr std::size_t block_size = 64;

/// A range that must not be copied.
template <class Range>
struct range_view {
    const Range& range;
    constexpr decltype(auto) operator[](std::size_t i) const { return range[i]; }
};
/// Where i of a range is: compilers see through pointers better than through containers.
template <class Range>
constexpr auto indexable(const Range& range) {
    if constexpr (std::ranges::contiguous_range<Range>)
        return std::ranges::data(range);
    else if constexpr (std::is_trivially_copyable_v<Range>)
        return range;
    else
        return range_view<Range>{range};
}

/// Signs of block_size inputs by the first filter; true if all are certain. In floating point to
/// the end, so that it is all of one width.
template <class Predicate, class... Ranges>
[[gnu::always_inline]] inline bool filter_block(sign_type* signs, std::size_t first,
                                                const Ranges&... p) {
    using T = decltype(Predicate::estimate(p[first]...).value);
    std::array<T, block_size> codes;
    for (std::size_t i = 0; i < block_size; ++i) {
        const auto x = Predicate::estimate(p[first + i]...);
        const T size = number_traits<T>::abs(x.value);
        // Instruction sets with fused multiply-add may use it: static_filter.hpp asks for this
        // then.
        const T code = x.value > 0 ? T(2) : T(0);
        const T decided = size > x.bound ? code : T(3);
        codes[i] = size <= number_traits<T>::largest() ? decided : T(3);
    }
    unsigned all = 0;
    for (std::size_t i = 0; i < block_size; ++i) {
        const auto code = static_cast<std::uint8_t>(static_cast<int>(codes[i]));
        signs[i] = static_cast<sign_type>(code);
        all |= code;
    }
    return (all & 1) == 0;
}
static_assert(static_cast<int>(sign_type::negative) == 0 &&
              static_cast<int>(sign_type::positive) == 2 &&
              static_cast<int>(sign_type::uncertain) == 3);

template <class Predicate, class... Ranges>
[[gnu::flatten, gnu::noinline]] bool filter_block_baseline(sign_type* signs, std::size_t first,
                                                           const Ranges&... p) {
    return filter_block<Predicate>(signs, first, p...);
}
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__CUDACC__)
template <class Predicate, class... Ranges>
[[gnu::target("avx2"), gnu::flatten, gnu::noinline]] bool filter_block_avx2(sign_type* signs,
                                                                            std::size_t first,
                                                                            const Ranges&... p) {
    return filter_block<Predicate>(signs, first, p...);
}
template <class Predicate, class... Ranges>
[[gnu::target("avx512f,avx512dq,avx512vl,avx512bw"), gnu::flatten, gnu::noinline]] bool
filter_block_avx512(sign_type* signs, std::size_t first, const Ranges&... p) {
    return filter_block<Predicate>(signs, first, p...);
}
template <class Predicate, class... Ranges>
auto best_filter_block() {
    if (__builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512bw"))
        return filter_block_avx512<Predicate, Ranges...>;
    if (__builtin_cpu_supports("avx2")) return filter_block_avx2<Predicate, Ranges...>;
    return filter_block_baseline<Predicate, Ranges...>;
}
#else
template <class Predicate, class... Ranges>
auto best_filter_block() {
    return filter_block_baseline<Predicate, Ranges...>;
}
#endif

template <class Predicate, class... Ranges>
void batch_over(const Predicate& predicate, std::span<sign_type> signs, const Ranges&... p) {
    std::size_t first = 0;
    if constexpr (!std::is_same_v<decltype(Predicate::estimate(p[first]...)), sign_type>) {
        const auto filter = best_filter_block<Predicate, Ranges...>();
        for (; first + block_size <= signs.size(); first += block_size) {
            if (filter(&signs[first], first, p...)) [[likely]]
                continue;
            for (std::size_t i = first; i < first + block_size; ++i)
                if (!certain(signs[i])) signs[i] = predicate(p[i]...);
        }
    }
    for (; first < signs.size(); ++first) signs[first] = predicate(p[first]...);
}

}  // namespace detail

/// signs[i] becomes the predicate's sign of point i of each range: anything indexed by numbers, of
/// at least signs.size() points; contiguous ranges and coordinate_arrays are vectorised over.
/// Expressions that branch go one by one. No allocation.
template <class Predicate, class... Ranges>
void batch_signs(const Predicate& predicate, std::span<sign_type> signs, const Ranges&... p) {
    detail::batch_over(predicate, signs, detail::indexable(p)...);
}

}  // namespace errbound
