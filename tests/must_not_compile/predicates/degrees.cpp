// x² − y, and the claim that both are of degree 1; with y of degree 2 it would be true.
#include <errbound/predicates.hpp>

struct options : errbound::predicate_options {
    static constexpr std::array<int, 2> degrees{1, 1};
};

constexpr auto difference = errbound::predicate<errbound::points<0, 0>, options>(
    [](const auto& x, const auto& y) { return x * x - y; });

int main() {
    return difference(1.0, 2.0) == errbound::sign_type::zero;
}
