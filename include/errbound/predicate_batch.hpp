// Predicates on many inputs. The first filter runs on several inputs at a time by SIMD.
//   std::vector<std::array<double, 2>> a, b, c;
//   std::vector<errbound::sign_type> signs(a.size());
//   errbound::batch_signs(errbound::orient2d, signs, a, b, c);
//
// The signs equal those of single calls. The compiler vectorises the loops (clang from -O2, GCC
// from -O3), on x86-64 also for AVX2 and AVX-512. The processor is tested at run time.
#pragma once

#include <array>
#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <errbound/predicate.hpp>
#include <ranges>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>

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
/// The same point for all inputs.
template <class Point>
struct every {
    Point point;
    constexpr const Point& operator[](std::size_t) const { return point; }
};

namespace detail {

inline constexpr std::size_t block_size = 64;

template <class Range>
constexpr decltype(auto) input_of(const Range& range, std::size_t i) {
    if constexpr (filters::matrix_point<Range>)
        static_assert(Range::RowsAtCompileTime == 1 || Range::ColsAtCompileTime == 1,
                      "errbound: a matrix is not a range of points: write m.colwise()");
    if constexpr (requires { range[i]; })
        return range[i];
    else
        return range.begin()[static_cast<std::ptrdiff_t>(i)];
}
/// True if the range has at least `count` points, or has no size to test.
template <class Range>
constexpr bool has_inputs(const Range& range, std::size_t count) {
    if constexpr (requires { range.size(); })
        return static_cast<std::size_t>(range.size()) >= count;
    else if constexpr (requires { range.end() - range.begin(); })
        return static_cast<std::size_t>(range.end() - range.begin()) >= count;
    else
        return true;
}

template <class Point>
inline constexpr bool has_stored_coordinates =
    std::is_arithmetic_v<Point> || std::is_array_v<Point>;
template <class T, std::size_t N>
inline constexpr bool has_stored_coordinates<std::array<T, N>> = true;

/// A copy of coordinates that are computed, or not stored in one contiguous array. Storing rounds
/// them. Otherwise kernels could fuse a product in a coordinate with a difference.
template <class T, int Dimension, class Range>
class computed_block {
    static constexpr std::size_t rows = Dimension == 0 ? 1 : Dimension;

  public:
    explicit computed_block(const Range& range) : range_(range) {}
    coordinate_arrays<T, rows> at(std::size_t first) {
        coordinate_arrays<T, rows> block{{}, block_size};
        for (std::size_t k = 0; k < rows; ++k) block.coordinates[k] = rows_[k].data();
        for (std::size_t i = 0; i < block_size; ++i)
            for (std::size_t k = 0; k < rows; ++k)
                rows_[k][i] = coordinate_of(input_of(range_, first + i), static_cast<int>(k));
        return block;
    }

  private:
    const Range& range_;
    std::array<std::array<T, block_size>, rows> rows_;
};
template <class Point>
struct stored_block {
    const Point* points;
    const Point* at(std::size_t first) const { return points + first; }
};
template <class T, std::size_t Dimension>
struct stored_arrays_block {
    coordinate_arrays<T, Dimension> arrays;
    coordinate_arrays<T, Dimension> at(std::size_t first) const {
        coordinate_arrays<T, Dimension> block{{}, block_size};
        for (std::size_t k = 0; k < Dimension; ++k)
            block.coordinates[k] = arrays.coordinates[k] + first;
        return block;
    }
};
template <class T, int Dimension, class Range>
auto blocks_of(const Range& range) {
    if constexpr (requires {
                      requires has_stored_coordinates<std::ranges::range_value_t<Range>>;
                  } &&
                  std::ranges::contiguous_range<Range>)
        return stored_block<std::ranges::range_value_t<Range>>{std::ranges::data(range)};
    else
        return computed_block<T, Dimension, Range>(range);
}
template <class T, int Dimension, class U, std::size_t N>
auto blocks_of(const coordinate_arrays<U, N>& arrays) {
    return stored_arrays_block<U, N>{arrays};
}

/// Sets block_size signs by the first filter; returns true if all are certain. The codes have the
/// type T, so that all lanes have one width.
template <class Predicate, class... Ranges>
[[gnu::always_inline]] inline bool filter_block(sign_type* signs, const Ranges&... p) {
    using T = decltype(Predicate::estimate(p[0]...).value);
    std::array<T, block_size> codes;
    for (std::size_t i = 0; i < block_size; ++i) {
        const auto x = Predicate::template estimate<true>(p[i]...);
        const T size = number_traits<T>::abs(x.value);
        const T code = x.value > 0 ? T(2) : T(0);
        const T decided = size > x.bound ? code : T(3);
        // With fused multiply-adds the value can overflow although its size does not.
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
[[gnu::flatten, gnu::noinline]] bool filter_block_baseline(sign_type* signs, const Ranges&... p) {
    return filter_block<Predicate>(signs, p...);
}
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__CUDACC__)
template <class Predicate, class... Ranges>
[[gnu::target("avx2"), gnu::flatten, gnu::noinline]] bool filter_block_avx2(sign_type* signs,
                                                                            const Ranges&... p) {
    return filter_block<Predicate>(signs, p...);
}
template <class Predicate, class... Ranges>
[[gnu::target("avx512f,avx512dq,avx512vl,avx512bw"), gnu::flatten, gnu::noinline]] bool
filter_block_avx512(sign_type* signs, const Ranges&... p) {
    return filter_block<Predicate>(signs, p...);
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

template <class Predicate, class... Ranges, std::size_t... I>
void batch_over(const Predicate& predicate, std::span<sign_type> signs, std::index_sequence<I...>,
                const Ranges&... p) {
    std::size_t first = 0;
    using estimate = decltype(Predicate::estimate(input_of(p, first)...));
    if constexpr (!std::is_same_v<estimate, sign_type>) {
        using T = decltype(estimate::value);
        std::tuple blocks{blocks_of<T, Predicate::shape::dimensions[I]>(p)...};
        const auto filter =
            best_filter_block<Predicate, decltype(std::get<I>(blocks).at(first))...>();
        for (; first + block_size <= signs.size(); first += block_size) {
            if (filter(&signs[first], std::get<I>(blocks).at(first)...)) [[likely]]
                continue;
            for (std::size_t i = first; i < first + block_size; ++i)
                if (!certain(signs[i])) signs[i] = predicate(input_of(p, i)...);
        }
    }
    for (; first < signs.size(); ++first) signs[first] = predicate(input_of(p, first)...);
}

}  // namespace detail

/// Sets signs[i] to the predicate's sign of the points with index i, one of each range. For the
/// columns of a matrix pass m.colwise(). Precondition: each range has at least signs.size() points.
/// coordinate_arrays and contiguous ranges of numbers or arrays are read in place, others copied,
/// 64 points at a time. Expressions that branch are evaluated one by one. No allocation.
template <class Predicate, class... Ranges>
void batch_signs(const Predicate& predicate, std::span<sign_type> signs, const Ranges&... p) {
    static_assert(
        requires { Predicate::counts; },
        "errbound: batch_signs takes a predicate made by predicate(); for a perturbed one "
        "pass the predicate that it perturbs, then call the perturbed one where a sign "
        "is zero");
    constexpr bool constructed =
        (filters::is_constructed<
             std::remove_cvref_t<decltype(detail::input_of(std::declval<const Ranges&>(), 0))>> ||
         ...);
    static_assert(!constructed,
                  "errbound: batch_signs takes explicit points; for constructed ones pass the "
                  "predicate of their parents, by with_constructed, and ranges of parents");
    assert((detail::has_inputs(p, signs.size()) && ...) &&
           "errbound: a range has fewer points than there are signs");
    if constexpr (requires { Predicate::counts; } && !constructed)
        detail::batch_over(predicate, signs, std::index_sequence_for<Ranges...>(), p...);
}

}  // namespace errbound
