// Points of a negative number of coordinates.
#include <errbound/predicates.hpp>

constexpr auto difference = errbound::predicate<errbound::points<-2, 0>>(
    [](const auto& x, const auto& y) { return x - y; });

int main() {
    return difference(1.0, 2.0) == errbound::sign_type::zero;
}
