// Counts sign changes in a row of coefficients, for Descartes' rule.
#pragma once

#include <cstddef>

namespace errbound::roots {

template <class S>
struct sign_changes {
    int count;
    S first, last;  ///< zero if there are none
};

template <class S, class Sign>
constexpr sign_changes<S> sign_changes_of(std::size_t count, S zero, const Sign& sign) {
    sign_changes<S> row{0, zero, zero};
    for (std::size_t i = 0; i < count; ++i) {
        const S s = sign(i);
        if (s == zero) continue;
        if (row.last == zero)
            row.first = s;
        else if (s != row.last)
            ++row.count;
        row.last = s;
    }
    return row;
}

/// Sign changes among sign(0), ..., sign(count − 1), each 1, −1 or 0; skips zeros. Proof:
/// proofs/roots/SignVariations.v, no_variation_no_root, one_variation_one_root.
template <class Sign>
int sign_variations(std::size_t count, const Sign& sign) {
    return sign_changes_of(count, 0, sign).count;
}

/// The largest possible count, where 0 is an uncertain sign. The result 3 stands for more than 2,
/// or for an uncertain end. 0 and 1 are exact, since the end signs fix the parity. (Between
/// opposite signs, every two uncertain signs add two changes; between equal signs, one uncertain
/// sign already adds two.) Proof: proofs/roots/SignVariations.v, max_variations_right.
template <class Sign>
int max_sign_variations(std::size_t count, const Sign& sign) {
    int last = sign(0), most = 0, open = 0;
    if (last == 0) return 3;
    for (std::size_t i = 1; i < count; ++i) {
        const int s = sign(i);
        if (s == 0) {
            ++open;
            continue;
        }
        most += s == last ? (open + 1) / 2 * 2 : open / 2 * 2 + 1;
        if (most > 2) return 3;
        open = 0;
        last = s;
    }
    return open > 0 ? 3 : most;
}

}  // namespace errbound::roots
