// Options that lack what they do not change.
#include <errbound/predicates.hpp>

struct options {
    using tracked_rule = errbound::tight;
};

constexpr auto difference = errbound::predicate<errbound::points<0, 0>, options>(
    [](const auto& x, const auto& y) { return x - y; });

int main() {
    return difference(1.0, 2.0) == errbound::sign_type::zero;
}
