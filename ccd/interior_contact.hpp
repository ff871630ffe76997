// Contact inside a face or inside both edges, in integers of fixed width.
//
// Asked of queries WITHOUT vertex/edge contact at any time of the step. Then contact holds exactly
// if Y = 0 and all G_i > 0, strictly, at some t in [0, 1]: the G_i add up to (pairs of them to)
// |N|² >= 0, so strict signs imply N ≠ 0 and contact; and a contact where some G_i = 0, or N = 0,
// lies on a border, as the head of ccd/reference.cpp shows, which makes it a vertex/edge contact.
// If Y ≡ 0, t = 0 alone is to be asked: let contact hold at some t > 0, and go back in time as long
// as all G_i > 0. Either that leads to t = 0, or to a first time at which it still is contact,
// since contact is closed, but with some G_i = 0: a vertex/edge contact.
//
// Inner roots of Y are isolated by halving, in scaled Bernstein coefficients, which every halving
// multiplies by 2^degree and which therefore stay whole. Strict signs end the search at every root
// but those where some G_i vanishes and none is negative, that is where N = 0, and pairs of roots
// that nearly coincide. True double roots are rational and asked beforehand.
//
// Widths, for coordinates of W words whose differences stay below D = 2^(64W − 3): Y in 3W words
// (|h_i| <= 18D³), G in 4W (216D⁴); the Hessian of Y in 6W (648D⁶), its discriminant in 12W
// (2^20.2·D^12), G at a double root in 28W words (2^49·D^28).
#pragma once

#include <algorithm>
#include <array>
#include <ccd/verdict.hpp>
#include <cstddef>
#include <errbound/bernstein.hpp>
#include <errbound/fixed_integer.hpp>

namespace ccd {

template <int Words>
using cubic_form = errbound::bernstein<errbound::fixed_integer<Words>, 3>;
template <int Words, std::size_t M>
using quartic_forms = std::array<errbound::bernstein<errbound::fixed_integer<Words>, 4>, M>;

/// What the coefficients' signs tell about the roots of a cubic in (0, 1).
struct inner_sign_changes {
    int count = 0;          ///< the number of roots, or an even number more (Descartes)
    bool opposite = false;  ///< the number is odd: just inside the ends, the signs are opposite
    errbound::sign_type first = errbound::sign_type::zero;  ///< just inside t = 0

    template <int Words>
    explicit inner_sign_changes(const cubic_form<Words>& y) {
        auto last = errbound::sign_type::zero;
        for (const auto& h : y.h) {
            const auto sign = sign_of(h);
            if (sign == errbound::sign_type::zero) continue;
            if (last == errbound::sign_type::zero)
                first = sign;
            else if (sign != last)
                ++count;
            last = sign;
        }
        opposite = first != last;
    }
};

/// The search for an inner root of Y at which all G_i are positive.
template <int YWords, int GWords, std::size_t M>
class root_search {
  public:
    /// `close_pairs`: whether Y may have two distinct roots between signs that are not opposite.
    /// Otherwise a root of even multiplicity there is not looked for.
    explicit root_search(bool close_pairs) : close_pairs_(close_pairs) {}

    outcome operator()(const cubic_form<YWords>& y, const quartic_forms<GWords, M>& g) const {
        int y_bits = 0, g_bits = 0;
        for (const auto& h : y.h) y_bits = std::max(y_bits, h.bit_length());
        for (const auto& form : g)
            for (const auto& h : form.h) g_bits = std::max(g_bits, h.bit_length());
        // Coefficients stay below binomial(N, i)·2^(N·depth) times the largest, since the control
        // values do not grow: 2 bits for binomials up to 3, 3 bits for those up to 6.
        const int depth =
            std::min((YWords * 64 - 1 - 2 - y_bits) / 3, (GWords * 64 - 1 - 3 - g_bits) / 4);
        return on_part(y, inner_sign_changes(y), g, M, depth);
    }

  private:
    bool possible(const inner_sign_changes& roots) const {
        return roots.opposite || (close_pairs_ && roots.count > 0);
    }

    /// `undecided`: how many of g, the first ones, are not known to be positive on the part.
    outcome on_part(const cubic_form<YWords>& y, const inner_sign_changes& roots,
                    quartic_forms<GWords, M> g, std::size_t undecided, int depth) const {
        using errbound::sign_type;
        if (!possible(roots)) return outcome::separate;
        for (std::size_t i = 0; i < undecided;) {
            const auto sign = sign_inside(g[i]);
            if (errbound::certainly_nonpositive(sign)) return outcome::separate;
            if (sign == sign_type::positive)
                g[i] = g[--undecided];
            else
                ++i;
        }
        if (roots.opposite && undecided == 0) return outcome::collides;
        if (depth <= 0) return outcome::uncertain;

        const auto middle = sign_of(y[0] + y[1] + y[2] + y[3]);
        if (middle == sign_type::zero) {
            const bool all_positive =
                std::all_of(g.begin(), g.begin() + undecided, [](const auto& f) {
                    return sign_of(f[0] + f[1] + f[2] + f[3] + f[4]) == sign_type::positive;
                });
            if (all_positive) return outcome::collides;
            if (roots.count == 1) return outcome::separate;
        }
        auto found = outcome::separate;
        const auto search = [&](const auto& half_of) {
            const auto half = half_of(y);
            const inner_sign_changes roots_of_half(half);
            if (!possible(roots_of_half)) return;
            quartic_forms<GWords, M> g_of_half;
            for (std::size_t i = 0; i < undecided; ++i) g_of_half[i] = half_of(g[i]);
            const auto in_half = on_part(half, roots_of_half, g_of_half, undecided, depth - 1);
            if (in_half != outcome::separate) found = in_half;
        };
        const bool one = roots.count == 1;  // on the side of the middle that its sign tells
        if (!one || middle != roots.first) search([](const auto& form) { return left_half(form); });
        if (found == outcome::collides) return found;
        if (!one || middle == roots.first)
            search([](const auto& form) { return reversed(left_half(reversed(form))); });
        return found;
    }

    bool close_pairs_;
};

/// Whether all of g are positive at the point t/(s + t).
template <int GWords, std::size_t M, int Words>
bool all_positive_at(const quartic_forms<GWords, M>& g, const errbound::fixed_integer<Words>& s,
                     const errbound::fixed_integer<Words>& t) {
    return std::all_of(g.begin(), g.end(),
                       [&](const auto& form) { return value_at(form, s, t) > 0; });
}

/// The Hessian of a cubic form: a quadratic form that has its double root as a double root, and is
/// zero if the root is triple. 4·h0·h2 − h1² is 3 times the discriminant: positive if there are
/// three distinct real roots t/s, infinity included, negative if there is one and a complex pair.
template <int Words>
errbound::bernstein<errbound::fixed_integer<2 * Words>, 2> hessian(const cubic_form<Words>& y) {
    const auto thrice = [](const auto& x) { return (x << 1) + x; };
    return {{y[1] * y[1] - thrice(y[0] * y[2]), y[1] * y[2] - thrice(thrice(y[0] * y[3])),
             y[2] * y[2] - thrice(y[1] * y[3])}};
}

/// Whether Y = 0 and all G_i > 0 at some t in [0, 1], or at t = 0 if Y ≡ 0.
template <int Words, std::size_t M>
outcome interior_contact(const cubic_form<3 * Words>& y, const quartic_forms<4 * Words, M>& g) {
    using errbound::sign_type;
    for (const auto& form : g)
        if (errbound::certainly_nonpositive(sign_inside(form))) return outcome::separate;
    const auto all_positive = [&g](int end) {
        return std::all_of(g.begin(), g.end(), [end](const auto& form) { return form[end] > 0; });
    };
    if (y[0] == 0 && all_positive(0)) return outcome::collides;
    if (y[3] == 0 && all_positive(4)) return outcome::collides;

    const inner_sign_changes roots(y);
    if (roots.count == 0) return outcome::separate;
    bool close_pairs = false;
    if (roots.count > 1) {
        const auto h = hessian(y);
        const auto discriminant = sign_of(((h[0] * h[2]) << 2) - h[1] * h[1]);
        close_pairs = discriminant == sign_type::positive;
        if (discriminant == sign_type::zero) {
            // h2·(t − xs)² with h2 > 0 for a double root x, which lies inside if x > 0; a triple
            // root, of 3·y3·t + y2·s, is the only root, and inside as there are sign changes.
            if (h[2] == 0) {
                const auto s = (y[3] << 1) + y[3];
                const bool contact =
                    s.negative() ? all_positive_at(g, -s, y[2]) : all_positive_at(g, s, -y[2]);
                return contact ? outcome::collides : outcome::separate;
            }
            if (h[1] < 0 && all_positive_at(g, h[2] << 1, -h[1])) return outcome::collides;
        }
    }
    const root_search<3 * Words + 1, 4 * Words + 1, M> search(close_pairs);
    cubic_form<3 * Words + 1> wide_y;
    std::copy(y.h.begin(), y.h.end(), wide_y.h.begin());
    quartic_forms<4 * Words + 1, M> wide_g;
    for (std::size_t i = 0; i < M; ++i)
        std::copy(g[i].h.begin(), g[i].h.end(), wide_g[i].h.begin());
    return search(wide_y, wide_g);
}

}  // namespace ccd
