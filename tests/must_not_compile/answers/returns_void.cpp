// An expression without an answer: the return was forgotten.
#include <errbound/predicate.hpp>

constexpr auto predicate = errbound::predicate<errbound::points<0, 0>>(
    [](const auto& x, const auto& y) { (void)sign_of(x - y); });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
