// Terms of degree 1 and 2, and the claim that there are no such.
#include <errbound/predicates.hpp>

struct options : errbound::predicate_options {
    static constexpr bool homogeneous = true;
};

constexpr auto difference = errbound::predicate<errbound::points<0, 0>, options>(
    [](const auto& x, const auto& y) { return x * x - y; });

int main() {
    return difference(1.0, 2.0) == errbound::sign_type::zero;
}
