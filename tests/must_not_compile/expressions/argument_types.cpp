// An expression of doubles: the stages have scalars of their own.
#include <errbound/predicate.hpp>

constexpr auto predicate =
    errbound::predicate<errbound::points<0, 0>>([](double x, double y) { return x - y; });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
