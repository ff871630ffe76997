// Decides queries for which roots of Y are too close together, or a G_i at one is too small, for
// ccd/exact/interior_contact.hpp. Same precondition: no vertex/edge contact.
//
// Y is kept on a subinterval of [0, 1] by its exact coefficients there. Floating point estimates
// its root, or the extremum between two roots. Exact coefficients on a narrow part around it prove
// the estimate: a step gains some 40 bits, or 20 around two roots. Exponents of coefficients show
// roots near an end. If nothing works, the part is halved. The signs of the G_i are tested again
// each time that the number of bits of the position has grown by half.
//
// A query is `uncertain` if a position needs more than `max_bits` bits.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/methods/forms.hpp>
#include <ccd/verdict.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <errbound/bernstein.hpp>
#include <errbound/integers/long_integer.hpp>
#include <limits>
#include <optional>

#include "ccd/exact/bounded_integer.hpp"
#include "ccd/exact/common_roots.hpp"
#include "ccd/exact/cubic_roots.hpp"
#include "ccd/exact/features.hpp"

namespace ccd::detail {

/// Estimates: an extremum of a cubic inside (0, 1), and the distance of two roots from it.
struct root_pair {
    double middle, radius;
};
/// Returns nothing unless the slopes of h0·s³ + h1·s²t + h2·st² + h3·t³ at the ends have opposite
/// signs.
inline std::optional<root_pair> estimated_pair(const std::array<double, 4>& h) {
    // The derivative is d0·s² + d1·st + d2·t². Both terms of q have the same sign, so its positive
    // root t/s is not a difference of close numbers.
    const double d0 = h[1] - 3 * h[0], d1 = 2 * (h[2] - h[1]), d2 = 3 * h[3] - h[2];
    if (!(d0 * d2 < 0)) return {};
    const double q = -(d1 + std::copysign(std::sqrt(d1 * d1 - 4 * d0 * d2), d1)) / 2;
    const double x = q / d2 > 0 ? q / d2 : d0 / q;
    const double t = x / (1 + x), s = 1 - t;
    const double value = ((h[0] * s + h[1] * t) * s + h[2] * t * t) * s + h[3] * t * t * t;
    // Near the extremum the cubic is value + bend·(place − t)². Assume the same at the ends.
    const double bend =
        std::max(std::fabs(h[0] - value) / (t * t), std::fabs(h[3] - value) / (s * s));
    double largest = 0;
    for (const double c : h) largest = std::max(largest, std::fabs(c));
    return root_pair{t, std::sqrt((std::fabs(value) + 0x1p-48 * largest) / bend)};
}

/// Returns e such that no root t/s of a cubic with sign changes is >= 2^e (Kioustelidis 1986;
/// derived in errbound/roots/root_isolation.hpp).
template <class Integer>
int root_exponent(const errbound::bernstein<Integer, 3>& y) {
    using errbound::sign_type;
    int n = 3;
    while (sign_of(y[n]) == sign_type::zero) --n;
    int exponent = std::numeric_limits<int>::min();
    for (int i = 0; i < n; ++i) {
        if (sign_of(y[i]) != -sign_of(y[n])) continue;
        // |y_i/y_n| <= 2^quotient
        const int quotient = y[i].bit_length() - (y[n].bit_length() - 1);
        const int root = quotient > 0 ? (quotient + n - i - 1) / (n - i) : -(-quotient / (n - i));
        exponent = std::max(exponent, root + 1);
    }
    return exponent;
}

/// Decides one query by forms over integers of at most `coordinate_words` words. Precondition:
/// differences are below 2^(64·coordinate_words − 3).
template <template <class, int> class Forms>
class close_contact {
    template <int W>
    using number = errbound::integers::long_integer<W>;
    using sign_type = errbound::sign_type;

  public:
    static constexpr int coordinate_words = 4;

    explicit close_contact(
        const Forms<errbound::integers::long_integer<coordinate_words>, 1>& forms)
        : forms_(forms), y_(forms.y()) {
        const auto h = hessian(y_);
        const auto discriminant = sign_of(((h[0] * h[2]) << 2) - h[1] * h[1]);
        distinct_ = discriminant != sign_type::zero;
        three_real_roots_ = discriminant == sign_type::positive;
    }

    /// Tests if Y = 0 and all G_i > 0 at some t in (0, 1) that is no multiple root of Y. Proof:
    /// proofs/contact/CloseContact.v, close_contact_right, close_contact_ends.
    outcome decide() const { return by_narrowing(whole_step()); }

  protected:
    static constexpr int place_words = 24, max_bits = 64 * place_words - 2;
    static constexpr int y_words = 3 * (coordinate_words + place_words) + 4;
    /// Bits by which an estimate narrows a part around a root, and around an extremum.
    static constexpr int root_bits = 40, pair_bits = 22;
    /// The most bits by which one step narrows, in an std::int64_t.
    static constexpr int most_at_once = 60;
    /// Coefficients of at most this size can be narrowed once more. Proof:
    /// proofs/contact/CloseContact.v, close_widths, narrowed_fits.
    static constexpr int most_y_bits = 64 * y_words - 3 * most_at_once - 8;
    /// The G_i are tested on parts of width 2^-40 or less; interior_contact has tested wider ones.
    static constexpr int first_tested_bits = 40;

    using place_number = number<place_words>;
    using cubic = errbound::bernstein<number<y_words>, 3>;

    /// The interval from low/2^unit_bits, 2^width_bits units wide, and Y there, times a power of
    /// two.
    struct part {
        cubic y;
        inner_sign_changes roots;
        place_number low;
        int unit_bits = 0, width_bits = 0;
        int test_from = first_tested_bits;

        int bits() const { return unit_bits - width_bits; }
        bool can_be_narrowed() const {
            // Products of position and coordinates, and Y's coefficients and their sums, must fit.
            return unit_bits + most_at_once <= max_bits &&
                   std::all_of(y.h.begin(), y.h.end(),
                               [](const auto& h) { return h.bit_length() <= most_y_bits; });
        }

        /// The part between a/2^n and (a + 2^w)/2^n of this one's width, by Horner's rule. Proof:
        /// proofs/contact/CloseContact.v, sub_part_right.
        part sub_part(int n, std::int64_t a, int w) const {
            using big = number<y_words>;
            const big thrice = y[0] + y[0] + y[0];
            // Coefficients of x^k in y(x/2^n)·2^3n, then in y((a + x)/2^n)·2^3n.
            std::array<big, 4> c{y[0] << 3 * n, (y[1] - thrice) << 2 * n,
                                 (y[2] - y[1] - y[1] + thrice) << n, y[3] - y[2] + y[1] - y[0]};
            for (std::size_t first = 0; first < 3; ++first)
                for (std::size_t k = 3; k-- > first;)
                    c[k] = c[k] + big::product(c[k + 1], number<1>(a));
            if (w > 0)
                for (int k = 1; k <= 3; ++k) c[k] = c[k] << k * w;
            const big twice = c[0] + c[0] + c[1];
            part r;
            r.y[0] = c[0];
            r.y[1] = twice + c[0];
            r.y[2] = twice + c[0] + c[1] + c[2];
            r.y[3] = c[0] + c[1] + c[2] + c[3];
            r.roots = inner_sign_changes(r.y);
            r.low = (low << (n - width_bits)) + place_number(a);
            r.unit_bits = unit_bits + n - width_bits;
            r.width_bits = w;
            r.test_from = test_from;
            return r;
        }
        /// The part of two units around `place`, with units of 2^-n of this one's width.
        part around(double place, int n) const {
            const std::int64_t whole = std::int64_t(1) << n;
            const auto middle = static_cast<std::int64_t>(std::ldexp(place, n) + 0.5);
            return sub_part(n, std::clamp<std::int64_t>(middle - 1, 0, whole - 2), 1);
        }
    };

    part whole_step() const {
        part whole;
        for (int i = 0; i <= 3; ++i) whole.y[i] = y_[i];
        whole.roots = inner_sign_changes(y_);
        return whole;
    }

    /// Proof: proofs/contact/CloseContact.v, by_narrowing_right, three_close_parts_wait.
    outcome by_narrowing(const part& whole) const {
        std::array<std::optional<part>, 3> waiting;  // the earliest last
        std::size_t count = 0;
        auto found = outcome::separate;
        const auto wait = [&](const part& next) {
            if (any_root(next.roots)) waiting[count++] = next;
        };
        wait(whole);
        while (count > 0) {
            part last = *waiting[--count];
            if (last.bits() >= last.test_from) {
                const auto known = throughout(last);
                if (known == outcome::collides) return outcome::collides;
                if (known == outcome::separate || normal_vanishes(last)) continue;
                last.test_from = last.bits() + last.bits() / 2;
            }
            if (!last.can_be_narrowed()) {
                found = outcome::uncertain;
                continue;
            }
            if (const auto narrow = narrowed(last)) {
                wait(*narrow);
                continue;
            }
            if (last.y[0] + last.y[1] + last.y[2] + last.y[3] == 0 && contact_in_middle(last))
                return outcome::collides;
            wait(last.sub_part(1, 1, 0));
            wait(last.sub_part(1, 0, 0));
        }
        return found;
    }

    /// See interior_contact::any_root.
    bool any_root(const inner_sign_changes& roots) const {
        return roots.opposite || (three_real_roots_ && roots.count > 0);
    }
    /// True if, except for a possible double root, the part has exactly one root, a simple one.
    /// Precondition: Y has no triple root.
    bool is_single(const inner_sign_changes& roots) const {
        return roots.opposite && (roots.count == 1 || !three_real_roots_);
    }

    /// Returns a narrower part with the same roots (a double root may be lost), if estimates lead
    /// to one. Proof, for any estimates: proofs/contact/CloseContact.v, opposite_inside,
    /// as_many_changes.
    std::optional<part> narrowed(const part& whole) const {
        const auto h = approximated(whole.y.h);
        if (is_single(whole.roots)) {
            const double place = estimated_root(h);
            for (const int n : {root_bits + 1, root_bits / 2, root_bits / 4}) {
                const part narrow = whole.around(place, n);
                if (narrow.roots.opposite) return narrow;
            }
            return {};
        }
        const auto has_all = [&](const part& narrow) {
            return narrow.roots.count == whole.roots.count;
        };
        if (const int n = std::min(-root_exponent(whole.y), most_at_once); n > 1) {
            const part narrow = whole.sub_part(n, 0, 0);
            if (has_all(narrow)) return narrow;
        }
        if (const int n = std::min(-root_exponent(reversed(whole.y)), most_at_once); n > 1) {
            const part narrow = whole.sub_part(n, (std::int64_t(1) << n) - 1, 0);
            if (has_all(narrow)) return narrow;
        }
        if (whole.roots.count == 2) {
            const auto pair = estimated_pair(h);
            if (!pair || !(pair->radius < 0x1p-5)) return {};
            const int n = std::min(-std::ilogb(pair->radius) - 3, pair_bits);
            const part narrow = whole.around(pair->middle, n);
            if (has_all(narrow)) return narrow;
        }
        return {};
    }

    /// Returns decided_by_weights for all t from low/2^bits to less than (low +
    /// 2^width_bits)/2^bits; without a width, at low/2^bits. Proof: proofs/contact/CloseContact.v,
    /// inside_from_right.
    outcome inside_from(const place_number& low, int bits, std::optional<int> width_bits) const {
        using known = bounded_integer<number<coordinate_words + place_words>>;
        const auto s = place_number(1, bits, false) - low;
        const auto at_low = [&](const vector_form<number<coordinate_words>, 1>& v) {
            const auto component = [&](const auto& x) {
                known r{value_at(x, s, low)};
                const auto slope = x[1] - x[0];
                if (width_bits && !(slope == 0)) r.error_bits = slope.bit_length() + *width_bits;
                return errbound::bernstein<known, 0>{{r}};
            };
            return vector_form<known, 0>{component(v.x), component(v.y), component(v.z)};
        };
        return decided_by_weights(
            Forms<known, 0>(at_low(forms_.b), at_low(forms_.c), at_low(forms_.p)));
    }
    outcome throughout(const part& p) const {
        return inside_from(p.low, p.unit_bits, p.width_bits);
    }
    bool contact_in_middle(const part& p) const {
        const place_number middle = (p.low << 1) + place_number(1, p.width_bits, false);
        return inside_from(middle, p.unit_bits + 1, {}) == outcome::collides;
    }

    /// True if N = 0 at the part's only root, which is then no contact. Proof:
    /// proofs/contact/InteriorContact.v, normal_vanishes_right.
    bool normal_vanishes(const part& p) const {
        if (!is_single(p.roots) || !(distinct_ || p.roots.count == 1)) return false;
        const auto end = place_number(1, p.unit_bits, false);
        const auto &low = p.low, high = low + place_number(1, p.width_bits, false);
        const std::array n{forms_.n.x, forms_.n.y, forms_.n.z};
        const common_roots roots(n);
        using kind = typename decltype(roots)::kind_type;
        if (roots.kind == kind::one) {
            const auto& s = roots.squares[0];  // s² and st are used as s and t
            const auto& t = roots.squares[1];
            return sign_of(t * (end - low) - s * low) == sign_type::positive &&
                   sign_of(s * high - t * (end - high)) == sign_type::positive;
        }
        if (roots.kind != kind::of_quadratic) return false;
        const auto& f = *roots.quadratic;
        return sign_of(value_at(f, end - low, low)) * sign_of(value_at(f, end - high, high)) ==
               sign_type::negative;
    }

  private:
    const Forms<number<coordinate_words>, 1> forms_;
    const errbound::bernstein<number<3 * coordinate_words>, 3> y_;
    bool distinct_;          ///< Y has no multiple root
    bool three_real_roots_;  ///< parts between equal signs may have two roots
};

/// For queries that decide_in_words leaves uncertain. Proof: proofs/contact/CloseContact.v,
/// decided_inside.
template <int Words, template <class, int> class Forms>
outcome decide_close(const Forms<errbound::integers::fixed_integer<Words>, 1>& f) {
    using contact = close_contact<Forms>;
    using number = errbound::integers::long_integer<contact::coordinate_words>;
    const auto lengthened = [](const auto& v) {
        const auto component = [](const auto& x) {
            return errbound::bernstein<number, 1>{{x[0], x[1]}};
        };
        return vector_form<number, 1>{component(v.x), component(v.y), component(v.z)};
    };
    return contact({lengthened(f.b), lengthened(f.c), lengthened(f.p)}).decide();
}

}  // namespace ccd::detail
