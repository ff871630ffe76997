// What is possibly positive is taken for positive.
#include <errbound/predicate.hpp>

constexpr auto predicate =
    errbound::predicate<errbound::points<0, 0>>([](const auto& x, const auto& y) {
        return possibly_positive(sign_of(x - y)) ? errbound::sign_type::positive
                                                 : errbound::sign_type::negative;
    });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
