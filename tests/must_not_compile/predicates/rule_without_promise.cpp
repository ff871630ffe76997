// A tracked stage under a rule that only estimates errors.
#include <errbound/predicates.hpp>
#include <errbound/rules/stochastic.hpp>

struct options : errbound::predicate_options {
    using tracked_rule = errbound::stochastic;
};

constexpr auto difference = errbound::predicate<errbound::points<0, 0>, options>(
    [](const auto& x, const auto& y) { return x - y; });

int main() {
    return difference(1.0, 2.0) == errbound::sign_type::zero;
}
