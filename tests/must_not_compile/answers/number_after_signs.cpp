// An expression that branches on a sign but returns a number could not pass on `uncertain`.
#include <errbound/predicate.hpp>

constexpr auto folded =
    errbound::predicate<errbound::points<0, 0>>([](const auto& x, const auto& y) {
        const auto d = x - y;
        return sign_of(x) == errbound::sign_type::positive ? d : -d;
    });

int main() {
    return folded(1.0, 2.0) == errbound::sign_type::zero;
}
