// Running error bounds of dot products, for the rules `tight` and `sharp`. Internal.
#pragma once

#include <errbound/detail/rounded.hpp>
#include <errbound/number_traits.hpp>

namespace errbound::detail {

/// The largest m <= 8 with (m + 6)² <= 2^bits, or 0: one factor covers m + 6 roundings.
constexpr int terms_at_once(int bits) {
    int m = 8;
    while (bits < 8 && m > 0 && (m + 6) * (m + 6) > (1 << bits)) --m;
    return m;
}

/// Sums each term's own rounding errors and those of its arguments, Σ |â|σb + σa(|b̂| + σb). Every
/// terms_at_once(Bits) terms, multiplies the sum by a factor f and adds the underflows. Derived is
/// the rule's dot_bound. It defines two functions, with a proof:
/// - factor_units(terms) = (f − 1)/ε, where f covers the roundings of these sums;
/// - underflows(terms, uncertain): the number of η lost; `uncertain` terms have inexact arguments.
template <class T, class Derived, int Bits>
class running_bound {
    static constexpr int most = terms_at_once(Bits);

  protected:
    static constexpr bool pays = most > 0;

    template <class Operand>
    constexpr void add_term(const T& own, const Operand& a, const Operand& b) {
        own_ = own_ + own;
        if (!(a.bound.error == 0 && b.bound.error == 0)) {
            inherited_ =
                inherited_ + T(rounded_product(number_traits<T>::abs(a.value), b.bound.error) +
                               rounded_product(a.bound.error,
                                               T(number_traits<T>::abs(b.value) + b.bound.error)));
            ++uncertain_;
        }
        if (++terms_ == most) close();
    }
    constexpr T closed() {
        if (terms_ > 0) close();
        return closed_;
    }

  private:
    constexpr void close() {
        const T lost = static_cast<T>(Derived::underflows(terms_, uncertain_)) *
                       number_traits<T>::underflow_unit();
        const T factor =
            1 + static_cast<T>(Derived::factor_units(terms_)) * number_traits<T>::epsilon();
        closed_ = rounded_product(T((own_ + (inherited_ + closed_)) + lost), factor);
        own_ = inherited_ = T(0);
        terms_ = uncertain_ = 0;
    }

    T closed_ = T(0), own_ = T(0), inherited_ = T(0);
    int terms_ = 0, uncertain_ = 0;
};

}  // namespace errbound::detail
