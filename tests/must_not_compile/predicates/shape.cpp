// A shape that is none.
#include <errbound/predicates.hpp>

constexpr auto difference =
    errbound::predicate<int>([](const auto& x, const auto& y) { return x - y; });

int main() {
    return difference(1.0, 2.0) == errbound::sign_type::zero;
}
