// What varies is an argument: another one could not be in every stage.
#include <errbound/predicates.hpp>

int main() {
    const int factor = 3;
    const auto scaled = errbound::predicate<errbound::points<0, 0>>(
        [&factor](const auto& x, const auto& y) { return factor * x - y; });
    return scaled(1.0, 2.0) == errbound::sign_type::zero;
}
