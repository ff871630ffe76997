// Separation of a query's features by fixed axes.
#pragma once

#include <algorithm>
#include <ccd/methods/forms.hpp>
#include <errbound/number_traits.hpp>
#include <type_traits>
#include <utility>

#include "ccd/exact/static_filter/difference_extents.hpp"

namespace ccd::static_filter {

namespace detail {

/// project(difference, end) projects b, c or p at an end of the step, with an error of at most
/// margin/4.
template <class S, class Project>
constexpr mask<S> separated_along(const vertex_face_forms<S>& f, const S& margin,
                                  const Project& project) {
    using std::max, std::min;
    const auto at = [&](int end) {
        const S b = project(f.b, end), c = project(f.c, end), v = project(f.p, end);
        const S zero(0.0);
        return std::pair<mask<S>, mask<S>>(v > max(max(b, c), zero) + margin,
                                           v < min(min(b, c), zero) - margin);
    };
    const auto start = at(0), end = at(1);
    return (start.first & end.first) | (start.second & end.second);
}
template <class S, class Project>
constexpr mask<S> separated_along(const edge_edge_forms<S>& f, const S& margin,
                                  const Project& project) {
    using std::max, std::min;
    const auto at = [&](int end) {
        const S a1 = project(f.b, end), b0 = project(f.p, end), b1 = b0 + project(f.c, end);
        const S zero(0.0);
        return std::pair<mask<S>, mask<S>>(min(b0, b1) > max(a1, zero) + margin,
                                           max(b0, b1) < min(a1, zero) - margin);
    };
    const auto start = at(0), end = at(1);
    return (start.first & end.first) | (start.second & end.second);
}

/// See separated_by_axes. Not for floats, whose differences may underflow.
inline constexpr double margin = 9.2 * errbound::number_traits<double>::epsilon();

}  // namespace detail

template <class S, class Forms>
constexpr mask<S> certainly_separated_by_coordinates(const Forms& f,
                                                     const difference_extents<S>& m) {
    static_assert(std::is_same_v<typename difference_extents<S>::real, double>);
    const auto along = [&](const S& size, const auto& project) {
        return detail::separated_along<S>(f, size * S(detail::margin), project);
    };
    const mask<S> x = along(m.x, [](const auto& d, int end) { return d.x[end]; });
    const mask<S> y = along(m.y, [](const auto& d, int end) { return d.y[end]; });
    const mask<S> z = along(m.z, [](const auto& d, int end) { return d.z[end]; });
    return x | y | z;
}

template <class S, class Forms>
constexpr mask<S> separated_by_diagonals(const Forms& f, const difference_extents<S>& m) {
    static_assert(std::is_same_v<typename difference_extents<S>::real, double>);
    const auto along = [&](const S& size, const auto& u, const auto& v) {
        const S e = size * S(detail::margin);
        const mask<S> sum = detail::separated_along<S>(
            f, e, [&](const auto& d, int end) { return S(u(d)[end] + v(d)[end]); });
        const mask<S> difference = detail::separated_along<S>(
            f, e, [&](const auto& d, int end) { return S(u(d)[end] - v(d)[end]); });
        return mask<S>(sum | difference);
    };
    const auto x = [](const auto& d) -> const auto& {
        return d.x;
    };
    const auto y = [](const auto& d) -> const auto& {
        return d.y;
    };
    const auto z = [](const auto& d) -> const auto& {
        return d.z;
    };
    const mask<S> xy = along(m.x + m.y, x, y);
    const mask<S> yz = along(m.y + m.z, y, z);
    const mask<S> zx = along(m.z + m.x, z, x);
    return xy | yz | zx;
}

/// True if x, y, z, x ± y, y ± z or z ± x separates the features in the same order at both ends of
/// the step: so it does throughout. Proof: proofs/bsc/Decisions.v, face_separated, edges_separated.
/// Proof of the margin: proofs/filters/SeparatingAxis.v, separated_face_separate,
/// separated_edges_separate.
///
/// Margins: the error of a difference is at most ε·m, of a sum of two axes 2ε(1 + ε)(m_x + m_y), of
/// two compared projections twice that. An edge's far end is a rounded sum of two projections,
/// which doubles it again: 8ε(1 + ε)(m_x + m_y). The bound's own addition adds ε(m_x + m_y). So
/// 9.2ε suffices for all. Sums lose nothing to underflow.
template <class S, class Forms>
constexpr mask<S> separated_by_axes(const Forms& f, const difference_extents<S>& m) {
    return certainly_separated_by_coordinates<S>(f, m) | separated_by_diagonals<S>(f, m);
}

}  // namespace ccd::static_filter
