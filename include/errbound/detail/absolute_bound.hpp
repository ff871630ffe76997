// The part of a bound rule that rules with one number as their bound share.
#pragma once

#include <errbound/number_traits.hpp>

namespace errbound::detail {

struct absolute_bound {
    template <class T>
    struct bound {
        T error;
    };

    /// Proof: proofs/rules/IeeeRules.v, tight_exact_known.
    template <class T>
    static constexpr bound<T> exact(const T& value) {
        return {value - value};  // 0, or NaN if the value is not finite
    }
    /// Proof: proofs/rules/IeeeRules.v, tight_within_known.
    template <class T>
    static constexpr bound<T> within(const T& value, const T& error) {
        return {error >= 0 ? error + (value - value) : number_traits<T>::infinity()};
    }
    /// Bounds a number whose exact value is 0. Proof: proofs/rules/IeeeRules.v, tight_within_known.
    template <class T>
    static constexpr bound<T> displacement(const T& value) {
        return within<T>(value, number_traits<T>::abs(value));
    }
    /// Proof of the resulting sign: proofs/rules/IeeeRules.v, sign_of_known.
    template <class T>
    static constexpr T error(const T&, const bound<T>& b) {
        return b.error;
    }

  protected:
    template <class Operand>
    static constexpr bool is_zero(const Operand& a) {
        return a.value == 0 && a.bound.error == 0;
    }
};

}  // namespace errbound::detail
