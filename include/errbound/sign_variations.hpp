// Sign changes along a row of coefficients, as Descartes' rule counts them.
#pragma once

#include <cstddef>

namespace errbound {

/// The number of sign changes among sign(0), ..., sign(count − 1), which are 1, −1 or 0, zeros left
/// out.
template <class Sign>
int sign_variations(std::size_t count, const Sign& sign) {
    int changes = 0, last = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const int s = sign(i);
        if (s == 0) continue;
        if (s == -last) ++changes;
        last = s;
    }
    return changes;
}

/// The same where 0 means that a sign is uncertain: 0 or 1 if the number is certain, and both ends'
/// signs are, otherwise 2. One uncertain sign between opposite ones does not matter.
template <class Sign>
int certain_sign_variations(std::size_t count, const Sign& sign) {
    int last = sign(0), changes = 0, open = 0;
    if (last == 0) return 2;
    for (std::size_t i = 1; i < count; ++i) {
        const int s = sign(i);
        if (s == 0) {
            ++open;
            continue;
        }
        if (open > (s == last ? 0 : 1)) return 2;
        if (s != last && ++changes > 1) return 2;
        open = 0;
        last = s;
    }
    return open > 0 ? 2 : changes;
}

}  // namespace errbound
