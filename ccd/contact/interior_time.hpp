// The first contact inside a face or inside both edges, in integers of fixed width.
//
// Visits the roots of Y in their order, as ccd/exact/interior_contact.hpp does, up to the first
// time at which a vertex/edge contact may exist. So the precondition of interior_contact.hpp holds.
#pragma once

#include <ccd/methods/forms.hpp>
#include <ccd/verdict.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <errbound/integers/fixed_integer.hpp>
#include <optional>
#include <utility>

#include "ccd/contact/time_bracket.hpp"
#include "ccd/contact/vertex_edge_time.hpp"
#include "ccd/exact/interior_contact.hpp"

namespace ccd::detail {

template <int Words, template <class, int> class Forms, effort Effort = effort::whole>
class interior_time : interior_contact<Words, Forms, Effort> {
    using base = interior_contact<Words, Forms, Effort>;
    using typename base::part;
    using typename base::sign_type;

  public:
    /// y = forms.y(). No vertex/edge contact is earlier than `end`.
    constexpr interior_time(const Forms<errbound::integers::fixed_integer<Words>, 1>& forms,
                            const cubic_form<3 * Words>& y, const integer_units& units,
                            const time_bracket& end, effort_constant<Effort> = {})
        : base(forms, y, units), search_(y), first_(end) {}

    /// Returns the first time with Y = 0 and all G_i > 0 if its bracket is earlier than `end`. If Y
    /// ≡ 0, considers t = 0 and 1 only. Proof: proofs/times/InteriorTime.v, interior_time_right.
    constexpr found_time find() {
        if (y_[0] == 0) consider(time_bracket{0, 0}, [this] { return at_end(0); });
        if (y_[3] == 0) consider(time_bracket{1, 1}, [this] { return at_end(1); });
        const inner_sign_changes roots(y_);
        if (roots.count > 1) {
            if (const auto root = this->multiple_root())
                consider(bracket_of_linear_root(*root), [&] {
                    if constexpr (Effort == effort::limited)
                        return outcome::uncertain;
                    else
                        return strict(forms_at(forms_, (*root)[1], -(*root)[0]));
                });
        }
        if (roots.count > 0 && !this->triple_) in_parts(roots);
        if (unplaced_) return outcome::uncertain;
        return found_ == outcome::collides ? found_time(first_) : found_time(found_);
    }

  private:
    using base::forms_, base::y_;

    /// Calls `contact` only if the root of Y is earlier than the first contact so far. Proof:
    /// proofs/times/IntegerTimes.v, considered_right.
    template <class Contact>
    constexpr void consider(const std::optional<time_bracket>& root, const Contact& contact) {
        if (root && !(*root < first_)) return;
        const outcome answer = contact();
        if (answer == outcome::separate) return;
        if (!root) {
            unplaced_ = true;
            return;
        }
        first_ = *root;
        found_ = answer;
    }

    template <class Values>
    static constexpr outcome strict(const Values& forms_at_a_time) {
        return base::all_positive(forms_at_a_time) ? outcome::collides : outcome::separate;
    }
    constexpr outcome at_end(int end) const { return strict(forms_at_end(forms_, end)); }

    /// Halves parts on a stack, like interior_contact::by_halving. Proof:
    /// proofs/times/InteriorTime.v, in_parts_right, in_parts_ends.
    constexpr void in_parts(const inner_sign_changes& roots) {
        std::array<part, 3> waiting;
        std::size_t count = 0;
        waiting[count] = {{}, roots, 0, 0};
        std::copy(y_.h.begin(), y_.h.end(), waiting[count++].y.h.begin());
        while (count > 0) {
            const part last = waiting[--count];
            const double start = place(last.index, last.level);
            if (!(start < first_.low) || root_of(last)) continue;
            if (last.level == part::max_halvings) {
                consider({}, [] { return outcome::uncertain; });
                continue;
            }
            if (last.y[0] + last.y[1] + last.y[2] + last.y[3] == 0) {
                const double middle = place(2 * last.index + 1, last.level + 1);
                consider(time_bracket{middle, middle},
                         [&] { return at(2 * last.index + 1, last.level + 1); });
            }
            const auto wait = [&](const cubic_form<3 * Words + 2>& y, std::int64_t index) {
                const inner_sign_changes changes(y);
                if (this->any_root(changes)) waiting[count++] = {y, changes, index, last.level + 1};
            };
            wait(reversed(left_half(reversed(last.y))), 2 * last.index + 1);
            wait(left_half(last.y), 2 * last.index);
        }
    }
    static constexpr double place(std::int64_t index, int level) {
        return std::ldexp(static_cast<double>(index), -level);
    }
    constexpr outcome at(std::int64_t index, int level) const {
        const auto end = errbound::integers::fixed_integer<1>::shifted(1, level);
        const errbound::integers::fixed_integer<1> t(index);
        return strict(forms_at(forms_, end - t, t));
    }

    /// Considers the part's root if it is certainly the only one, else returns false. If a double
    /// root is near, near() may evaluate the weights there instead. Proof:
    /// proofs/times/InteriorTime.v, tested_root. Proof that the root at which they are evaluated is
    /// inside the part: proofs/contact/InteriorContact.v, near_here.
    constexpr bool root_of(const part& whole) {
        const bool others = this->three_real_roots_ || !this->distinct_;
        if (!whole.roots.opposite || (whole.roots.count > 1 && others)) return false;
        const auto estimate = estimated_place(whole);
        const auto root = search_.between(
            place(whole.index, whole.level), place(whole.index + 1, whole.level), whole.roots.first,
            std::ldexp(static_cast<double>(estimate.numerator.low_word()), -estimate.bits));
        consider(root, [&] {
            auto answer = this->near(whole, estimate);
            if (!answer && root) answer = this->near(whole, place_of(root->low, estimate.bits));
            return answer.value_or(outcome::uncertain);
        });
        return true;
    }
    static constexpr dyadic_point<1> place_of(double t, int bits) {
        return {static_cast<std::int64_t>(std::ldexp(t, bits)), bits};
    }

    const root_search<3 * Words, 3> search_;
    time_bracket first_;                 ///< the first contact so far, or `end`
    outcome found_ = outcome::separate;  ///< at `first_`
    bool unplaced_ = false;              ///< a relevant root has an unknown time or position
};

}  // namespace ccd::detail
