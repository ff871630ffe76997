// An answer that does not depend on the sign.
#include <errbound/predicate.hpp>

constexpr auto predicate =
    errbound::predicate<errbound::points<0, 0>>([](const auto& x, const auto& y) {
        using errbound::sign_type;
        const sign_type s = sign_of(x - y);
        if (!certain(s)) return s;
        return s == sign_type::positive ? sign_type::negative : sign_type::negative;
    });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
