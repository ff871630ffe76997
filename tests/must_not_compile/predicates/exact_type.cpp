// A last stage over a type without sign_of.
#include <errbound/predicates.hpp>

struct options : errbound::predicate_options {
    using exact_type = long double;
};

constexpr auto difference = errbound::predicate<errbound::points<0, 0>, options>(
    [](const auto& x, const auto& y) { return x - y; });

int main() {
    return difference(1.0, 2.0) == errbound::sign_type::zero;
}
