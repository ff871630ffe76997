// Contact inside a face or inside both edges, in integers of fixed width.
//
// Precondition: the query has no vertex/edge contact in the step. Then there is contact exactly if
// Y = 0 and all G_i > 0 at some t in [0, 1]. (The G_i, or pairs of them, add up to |N|² >= 0, so
// strict signs imply N ≠ 0. A contact with some G_i = 0 or N = 0 is a vertex/edge contact.)
//
// G_i are evaluated at roots of Y only, exactly at rational ones, else by refined brackets. A query
// is `uncertain` if some G_i is too small for the last bracket, or two roots are too close;
// ccd/exact/close_contact.hpp decides it. Proof: proofs/contact/Contact.v, face_inside,
// edges_inside, face_coplanar, edges_coplanar; of the code, proofs/contact/InteriorContact.v,
// interior_contact_right.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/methods/forms.hpp>
#include <ccd/verdict.hpp>
#include <cstddef>
#include <cstdint>
#include <errbound/bernstein.hpp>
#include <errbound/integers/fixed_integer.hpp>
#include <optional>
#include <type_traits>

#include "ccd/exact/axis_units.hpp"
#include "ccd/exact/bounded_integer.hpp"
#include "ccd/exact/common_roots.hpp"
#include "ccd/exact/cubic_roots.hpp"
#include "ccd/exact/features.hpp"

namespace ccd::detail {

/// Device code leaves rare cases to the host, since they would be most of its integer code:
/// brackets whose ends have more than two words, and contact at multiple roots.
enum class effort { whole, limited };
template <effort E>
using effort_constant = std::integral_constant<effort, E>;

/// Forms are over integers of W = Words words. Precondition: coordinate differences are below
/// D = 2^(64W − 3).
template <int Words, template <class, int> class Forms, effort Effort = effort::whole>
class interior_contact {
  public:
    /// y = forms.y(). Differences of coordinates are below 2^units.x.bits, and so on per axis.
    constexpr interior_contact(const Forms<errbound::integers::fixed_integer<Words>, 1>& forms,
                               const cubic_form<3 * Words>& y, const integer_units& units,
                               effort_constant<Effort> = {})
        : forms_(forms), y_(y), units_(units) {}

    /// Tests if Y = 0 and all G_i > 0 at some t in [0, 1]; if Y ≡ 0, at t = 0 or 1, since a later
    /// contact inside begins at a border. Proof: proofs/contact/InteriorContact.v,
    /// interior_contact_right, interior_contact_ends.
    constexpr outcome decide() {
        if (y_[0] == 0 && all_positive(forms_at_end(forms_, 0))) return outcome::collides;
        if (y_[3] == 0 && all_positive(forms_at_end(forms_, 1))) return outcome::collides;
        const inner_sign_changes roots(y_);
        if (roots.count == 0) return outcome::separate;
        if (roots.count > 1) {
            if constexpr (Effort == effort::limited) {
                if (multiple_root()) return outcome::uncertain;
            } else {
                const auto multiple = at_multiple_root();
                if (multiple != outcome::uncertain) return multiple;
            }
        }
        part whole{{}, roots, 0, 0};
        std::copy(y_.h.begin(), y_.h.end(), whole.y.h.begin());
        return by_halving(whole);
    }

  protected:
    /// The numerators of the first bracket have one word, later ones one more each.
    static constexpr int max_end_words = Effort == effort::whole ? 4 : 2;

    template <int W>
    using number = errbound::integers::fixed_integer<W>;
    using sign_type = errbound::sign_type;
    using part = cubic_part<3 * Words>;

    template <class Values>
    static constexpr bool all_positive(const Values& forms_at_a_time) {
        const auto g = forms_at_a_time.inside();
        return std::all_of(g.begin(), g.end(), [](const auto& form) { return form[0] > 0; });
    }

    /// Returns the multiple root of Y inside (0, 1) as the root of c0·s + c1·t with c0 <= 0 < c1,
    /// and sets the flags for other roots. The Hessian's discriminant is at most 2^20.2·D^12, so it
    /// fits in 12W words. Proof: proofs/contact/CubicRoots.v, one_real_root, double_root_place,
    /// triple_root_place.
    constexpr std::optional<errbound::bernstein<number<6 * Words>, 1>> multiple_root() {
        const auto h = hessian(y_);
        const auto discriminant = sign_of(((h[0] * h[2]) << 2) - h[1] * h[1]);
        distinct_ = discriminant != sign_type::zero;
        three_real_roots_ = discriminant == sign_type::positive;
        if (distinct_) return {};
        triple_ = h[2] == 0;
        if (triple_) {
            // The root of 3·y3·t + y2·s. It is inside, since there are sign changes.
            const auto c1 = thrice(y_[3]);
            if (c1.negative()) return {{{-y_[2], -c1}}};
            return {{{y_[2], c1}}};
        }
        // h is h2·(t − xs)² with h2 > 0 for the double root x, which is inside if x > 0.
        if (h[1] < 0) return {{{h[1], h[2] << 1}}};
        return {};
    }

    /// Returns `uncertain` if Y may have other roots. The G_i are at most 2^47·D^28, so they fit in
    /// 28W words.
    constexpr outcome at_multiple_root() {
        const auto root = multiple_root();
        if (root && all_positive(forms_at(forms_, (*root)[1], -(*root)[0])))
            return outcome::collides;
        return triple_ ? outcome::separate : outcome::uncertain;
    }

    /// True if the part has roots other than a double root. An odd number of sign changes proves
    /// one. If Y has three real roots, any change does, since Descartes' count is then exact.
    /// Otherwise an even number comes from a complex pair or the double root. Proof:
    /// proofs/contact/CubicRoots.v, odd_changes, any_change, one_real_root.
    constexpr bool any_root(const inner_sign_changes& roots) const {
        return roots.opposite || (three_real_roots_ && roots.count > 0);
    }

    /// Halves have no more sign changes together than the whole, so at most three parts with roots
    /// wait, the earliest last. Proof: proofs/contact/InteriorContact.v, by_halving_right,
    /// three_parts_wait.
    constexpr outcome by_halving(const part& whole) const {
        std::array<part, 3> waiting;
        std::size_t count = 0;
        waiting[count++] = whole;
        auto found = outcome::separate;
        while (count > 0) {
            const part last = waiting[--count];
            const auto known = without_halving(last);
            if (known == outcome::collides) return outcome::collides;
            if (known) {
                if (known == outcome::uncertain) found = outcome::uncertain;
                continue;
            }
            const auto wait = [&](const cubic_form<3 * Words + 2>& y, std::int64_t index) {
                const inner_sign_changes roots(y);
                if (any_root(roots)) waiting[count++] = {y, roots, index, last.level + 1};
            };
            wait(reversed(left_half(reversed(last.y))), 2 * last.index + 1);
            wait(left_half(last.y), 2 * last.index);
        }
        return found;
    }

    /// Decides a part; nothing if it has to be halved.
    constexpr std::optional<outcome> without_halving(const part& whole) const {
        if (!any_root(whole.roots)) return outcome::separate;
        if (whole.roots.opposite && (whole.roots.count == 1 || !three_real_roots_)) {
            const auto found = near(whole, estimated_place(whole));
            if (found) return found;
        }
        // There is a root. If every G_i keeps its sign over the part, its position is irrelevant.
        if (whole.level == part::max_halvings) return throughout<1>(whole.index, whole.level, 1);

        const auto middle = sign_of(whole.y[0] + whole.y[1] + whole.y[2] + whole.y[3]);
        if (middle == sign_type::zero) {
            const number<1> end = number<1>::shifted(1, whole.level + 1);
            const number<1> t(2 * whole.index + 1);
            if (all_positive(forms_at(forms_, end - t, t))) return outcome::collides;
        }
        return {};
    }

    /// Decides by a bracket near `place` of the part's only root (except a double root); nothing if
    /// no bracket holds the root. Proof: proofs/contact/InteriorContact.v, near_right.
    template <int T>
    constexpr std::optional<outcome> near(const part& whole, const dyadic_point<T>& place) const {
        const auto bracket = bracket_near(y_, whole, place);
        if (!bracket) return {};
        if (bracket->is_root()) {
            const auto& t = bracket->low;
            const auto s = number<T>::shifted(1, place.bits) - t;
            if (all_positive(forms_at(forms_, s, t))) return outcome::collides;
            return distinct_ ? outcome::separate : outcome::uncertain;
        }
        const auto found = throughout<T>(bracket->low, place.bits, bracket->width_bits());
        if (found != outcome::uncertain) return found;
        if constexpr (T == 2)
            if (distinct_ && normal_vanishes(*bracket)) return outcome::separate;
        if constexpr (T == max_end_words)
            return outcome::uncertain;
        else
            return near(whole, refined_place(y_, *bracket)).value_or(outcome::uncertain);
    }

    /// True if N = 0 inside the bracket, at a root of Y that is no contact. If Y has no multiple
    /// root, the bracket has no other root. Every G_i is then 0, so that no refined bracket
    /// decides. Proof: proofs/contact/InteriorContact.v, normal_vanishes_right.
    template <int T>
    constexpr bool normal_vanishes(const root_bracket<3 * Words, T>& bracket) const {
        const auto end = number<T>::shifted(1, bracket.bits);
        const auto &low = bracket.low, &high = bracket.high;
        const std::array<quadratic_form<2 * Words>, 3> n{forms_.n.x, forms_.n.y, forms_.n.z};
        const common_roots roots(n);
        using kind = typename decltype(roots)::kind_type;
        if (roots.kind == kind::one) {
            const auto& s = roots.squares[0];  // s² and st are used as s and t
            const auto& t = roots.squares[1];
            return t * (end - low) > s * low && t * (end - high) < s * high;
        }
        if (roots.kind != kind::of_quadratic) return false;
        const auto& f = *roots.quadratic;
        return sign_of(value_at(f, end - low, low)) * sign_of(value_at(f, end - high, high)) ==
               sign_type::negative;
    }

    /// Returns decided_by_weights for all t from low/2^bits to (low + width)/2^bits, width <
    /// 2^width_bits. Differences at low, times 2^bits, are cut to T words with one unit for each
    /// axis. This keeps the signs of G_i at roots of Y. Proof: proofs/contact/InteriorContact.v,
    /// throughout_right.
    template <int T>
    constexpr outcome throughout(const number<T>& low, int bits, int width_bits) const {
        using known = bounded_integer<number<T>>;
        const auto s = number<T>::shifted(1, bits) - low;
        const auto component = [&](const linear_form<Words>& x, const axis_extent& axis) {
            const int cut = std::max(0, bits + axis.bits - (64 * T - 4));
            known r{value_at(x, s, low).template from_bit<T>(cut)};
            // The error covers the change within the bracket and the cut.
            const auto slope = x[1] - x[0];
            if (!(slope == 0)) r.error_bits = slope.bit_length() + width_bits - cut;
            if (cut > 0) r.error_bits = std::max(r.error_bits, 0) + 1;
            return errbound::bernstein<known, 0>{{r}};
        };
        const auto at_low = [&](const vector_form<number<Words>, 1>& v) {
            return vector_form<known, 0>{component(v.x, units_.x), component(v.y, units_.y),
                                         component(v.z, units_.z)};
        };
        return decided_by_weights(
            Forms<known, 0>(at_low(forms_.b), at_low(forms_.c), at_low(forms_.p)));
    }

    const Forms<errbound::integers::fixed_integer<Words>, 1>& forms_;
    const cubic_form<3 * Words>& y_;
    const integer_units& units_;
    bool triple_ = false;            ///< Y has a triple root, and no other
    bool distinct_ = true;           ///< no root of Y is known to be multiple
    bool three_real_roots_ = false;  ///< parts between equal signs may have two roots
};

}  // namespace ccd::detail
