// The common roots of three quadratics inside (0, 1), exactly, in integers.
//
// Two quadratics that are not proportional have at most one common root, and it is rational. There
// (s², st, t²) is parallel to the cross product m of their coefficient vectors. A vector m has that
// form if and only if m1² = m0·m2.
//
// Widths, for quadratics of 2W words that are products of two differences (|f0|, |f2| <= 2D²,
// |f1| <= 4D², D = 2^(64W − 3)): m in 4W words (16D⁴), m1² in 8W, f·m in 6W (96D⁶).
// Proof: proofs/contact/VertexEdge.v, common_roots_right.
#pragma once

#include <array>
#include <cstddef>
#include <errbound/bernstein.hpp>
#include <errbound/integers/fixed_integer.hpp>

namespace ccd::detail {

template <int Words>
using linear_form = errbound::bernstein<errbound::integers::fixed_integer<Words>, 1>;
template <int Words>
using quadratic_form = errbound::bernstein<errbound::integers::fixed_integer<Words>, 2>;

/// The value of f where (s², st, t²) = m.
template <class A, class B>
constexpr auto value_at_squares(const errbound::bernstein<A, 2>& f,
                                const errbound::bernstein<B, 2>& m) {
    return f[0] * m[0] + f[1] * m[1] + f[2] * m[2];
}

template <class Integer>
struct common_roots {
    using quadratic_type = errbound::bernstein<Integer, 2>;
    using squares_type = errbound::bernstein<decltype(Integer() * Integer()), 2>;

    enum class kind_type {
        none,
        one,  ///< where (s², st, t²) is parallel to `squares`, whose entries are positive
        of_quadratic,  ///< at most the roots of *quadratic, whose coefficients have both signs
        everywhere     ///< all three quadratics are identically zero
    };
    kind_type kind = kind_type::none;
    squares_type squares{};
    const quadratic_type* quadratic = nullptr;

    /// Stores a pointer into f. Cost: some ten products unless an f has one sign.
    explicit constexpr common_roots(const std::array<errbound::bernstein<Integer, 2>, 3>& f) {
        using errbound::sign_of;
        using errbound::sign_type;
        std::array<const quadratic_type*, 3> moving{};  // those not identically zero
        std::size_t count = 0;
        for (const auto& form : f) {
            const auto hull = sign_inside(form);
            if (hull == sign_type::zero) continue;
            if (certain(hull)) return;
            moving[count++] = &form;
        }
        if (count == 0) {
            kind = kind_type::everywhere;
            return;
        }
        const auto& first = *moving[0];
        for (std::size_t i = 1; i < count; ++i) {
            const auto& other = *moving[i];
            const squares_type m{{first[1] * other[2] - first[2] * other[1],
                                  first[2] * other[0] - first[0] * other[2],
                                  first[0] * other[1] - first[1] * other[0]}};
            const auto sign = sign_throughout(m);
            if (sign == sign_type::zero) continue;  // proportional
            if (!certain(sign)) return;
            for (std::size_t k = i + 1; k < count; ++k)
                if (!(value_at_squares(*moving[k], m) == 0)) return;
            if (!(m[1] * m[1] == m[0] * m[2])) return;
            kind = kind_type::one;
            squares = sign == sign_type::negative ? -m : m;
            return;
        }
        kind = kind_type::of_quadratic;
        quadratic = &first;
    }
};

}  // namespace ccd::detail
