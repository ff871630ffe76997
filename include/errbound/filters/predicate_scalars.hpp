// A predicate's expression over the scalars of its stages: arguments, and the sign of the result.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <errbound/detail/rounded.hpp>
#include <errbound/filters/coordinates.hpp>
#include <errbound/filters/expression_check.hpp>
#include <errbound/filters/expression_count.hpp>
#include <errbound/filters/semi_static_filter.hpp>
#include <errbound/filters/static_filter.hpp>
#include <errbound/number_traits.hpp>
#include <errbound/sign.hpp>
#include <tuple>
#include <type_traits>
#include <utility>

namespace errbound::filters {

/// An expression's argument: a point, or a scalar for dimension 0. The type of a point does not
/// depend on its position among the arguments, so a helper function is compiled once per scalar.
template <class Shape, std::size_t Argument, class Scalars>
constexpr decltype(auto) view(const Scalars& scalars) {
    if constexpr (Shape::dimensions[Argument] == 0)
        return scalars.template point<Argument>()[0];
    else
        return scalars.template point<Argument>();
}

/// Coordinate i, for a filter. If the coordinate is computed by a product, that must not be fused
/// into a difference, so that all stages use the same number.
template <class T, bool Stored, class Point>
constexpr T unfused_coordinate(const Point& p, int i) {
    const T x = coordinate_of(p, i);
    if constexpr (Stored)
        return x;
    else
        return detail::rounded(x);
}
template <class T, bool Stored, class Point>
struct filtered_point {
    const Point& point;
    constexpr filtered_coordinate<T> operator[](int i) const {
        return {unfused_coordinate<T, Stored>(point, i)};
    }
};
template <class T, bool Stored, class... Points>
struct filtered_scalars {
    std::tuple<const Points&...> points;
    template <std::size_t Argument>
    constexpr auto point() const {
        using type = std::tuple_element_t<Argument, std::tuple<Points...>>;
        return filtered_point<T, Stored, type>{std::get<Argument>(points)};
    }
};
template <class T, bool Stored, class Point>
struct measured_point {
    const Point& point;
    T* largest;
    constexpr measured_coordinate<T> operator[](int i) const {
        return {unfused_coordinate<T, Stored>(point, i), largest};
    }
};
template <class T, bool Stored, class... Points>
struct measured_scalars {
    std::tuple<const Points&...> points;
    T* largest;
    template <std::size_t Argument>
    constexpr auto point() const {
        using type = std::tuple_element_t<Argument, std::tuple<Points...>>;
        return measured_point<T, Stored, type>{std::get<Argument>(points), largest};
    }
};
/// A point given by its coordinates. `make` turns each coordinate into a scalar, possibly a
/// reference.
template <class Coordinate, class Make>
struct listed_point {
    const Coordinate* first;
    const Make& make;
    constexpr decltype(auto) operator[](int i) const { return make(first[i]); }
};
template <class Shape, class List, class Make>
struct listed_scalars {
    const List& list;
    Make make;
    template <std::size_t Argument>
    constexpr auto point() const {
        return listed_point<typename List::value_type, Make>{list.data() + Shape::offset(Argument),
                                                             make};
    }
};
/// A point for counting; `degrees`, if not null, has one entry per coordinate.
struct counted_point {
    counting_run& run;
    int dimension;
    const int* degrees;
    constexpr expression_count operator[](int i) const {
        const bool is_there = i == 0 || (i > 0 && i < dimension);
        if (!is_there) run.lacks_coordinates = true;
        if (degrees == nullptr || !is_there) return expression_count(run);
        return expression_count(run, degrees[i]);
    }
};
template <class Shape>
struct counted_scalars {
    counting_run& run;
    const int* degrees = nullptr;
    template <std::size_t Argument>
    constexpr counted_point point() const {
        return {run, Shape::dimensions[Argument],
                degrees == nullptr ? nullptr : degrees + Shape::offset(Argument)};
    }
};
template <class Shape>
inline constexpr auto supposed_residues = [] {
    std::array<std::uint64_t, Shape::size> residues{};
    for (std::size_t i = 0; i < Shape::size; ++i) residues[i] = hashed(i) % supposed_signs::prime;
    return residues;
}();
struct supposed_point {
    supposed_signs* signs;
    const std::uint64_t* residues;
    constexpr supposed_number operator[](int i) const { return {signs, residues[i]}; }
};
template <class Shape>
struct supposed_scalars {
    supposed_signs& signs;
    template <std::size_t Argument>
    constexpr supposed_point point() const {
        return {&signs, supposed_residues<Shape>.data() + Shape::offset(Argument)};
    }
};

template <class T>
struct sign_estimate {
    T value, bound;

    friend constexpr sign_type sign_of(const sign_estimate& x) {
        bool decided = number_traits<T>::abs(x.value) > x.bound;
        if constexpr (detail::may_contract)  // see errbound/filters/static_filter.hpp
            decided = decided && number_traits<T>::is_finite(x.value);
        if (decided) [[likely]]
            return x.value > 0 ? sign_type::positive : sign_type::negative;
        return sign_type::uncertain;
    }
};
template <class X>
constexpr sign_type conclude(const X& x) {
    if constexpr (std::is_same_v<X, sign_type>)
        return x;
    else
        return sign_of(x);
}

template <class Shape, class F, class Scalars>
constexpr auto evaluate(const F& f, const Scalars& scalars) {
    return [&]<std::size_t... I>(std::index_sequence<I...>) {
        return f(view<Shape, I>(scalars)...);
    }
    (std::make_index_sequence<Shape::count>());
}
template <class Shape, class F, class List, class Make>
constexpr sign_type sign_over(const F& f, const List& list, const Make& make) {
    return conclude(evaluate<Shape>(f, listed_scalars<Shape, List, Make>{list, make}));
}

template <class Shape, class F>
inline constexpr bool takes_points = []<std::size_t... I>(std::index_sequence<I...>) {
    return requires(const F& f, const counted_scalars<Shape>& scalars) {
        f(view<Shape, I>(scalars)...);
    };
}
(std::make_index_sequence<Shape::count>());
template <class Shape, class F, class Scalars>
using result_over = decltype(evaluate<Shape>(F(), std::declval<const Scalars&>()));
/// True if the expression returns a sign, as those that branch do.
template <class Shape, class F>
inline constexpr bool branches =
    std::is_same_v<result_over<Shape, F, counted_scalars<Shape>>, sign_type>;

template <class Shape, class F>
constexpr expression_findings findings_of(int coordinate_bits, int max_runs,
                                          const int* degrees = nullptr) {
    return count_expression(coordinate_bits, max_runs, [degrees](counting_run& run) {
        const auto x = evaluate<Shape>(F(), counted_scalars<Shape>{run, degrees});
        if (!branches<Shape, F> && run.evaluated > 0) run.number_after_signs = true;
        return conclude(x);
    });
}

/// The fault that one supposition shows. It is a separate constant, since compilers limit the
/// length of each constant's evaluation.
template <class Shape, class F, std::size_t Supposition>
inline constexpr expression_fault fault_by = find_fault(Supposition, [](supposed_signs& signs) {
    return conclude(evaluate<Shape>(F(), supposed_scalars<Shape>{signs}));
});
template <class Shape, class F>
constexpr bool has_fault(expression_fault fault) {
    return [&]<std::size_t... S>(std::index_sequence<S...>) {
        return ((fault_by<Shape, F, S> == fault) || ...);
    }
    (std::make_index_sequence < branches<Shape, F> ? suppositions : 1 > ());
}

}  // namespace errbound::filters
