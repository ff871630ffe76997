// Operations that a predicate must not use. Each case is compiled alone, with its name
// defined.
#include <errbound/predicate.hpp>

#ifdef CASE_argument_types
// The expression takes doubles, but stages use other scalars.

constexpr auto predicate =
    errbound::predicate<errbound::points<0, 0>>([](double x, double y) { return x - y; });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_arguments
// The expression has two arguments, the shape three points.

constexpr auto predicate = errbound::predicate<errbound::points<0, 0, 0>>(
    [](const auto& x, const auto& y) { return x - y; });

int main() {
    return predicate(1.0, 2.0, 3.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_assignment
// A sum is assigned: every result has its own type.

constexpr auto predicate =
    errbound::predicate<errbound::points<0, 0>>([](const auto& x, const auto& y) {
        auto sum = x * x;
        sum += y * y;
        return sum;
    });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_comparison
// Numbers are compared by operator< instead of by the sign of their difference.

constexpr auto predicate = errbound::predicate<errbound::points<0, 0>>(
    [](const auto& x, const auto& y) { return x < y ? sign_of(x) : sign_of(y); });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_condition
// A number is used as a condition.

constexpr auto predicate = errbound::predicate<errbound::points<0, 0>>(
    [](const auto& x, const auto& y) { return x - y ? sign_of(x) : sign_of(y); });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_conversion
// A number is converted to int.

constexpr auto predicate = errbound::predicate<errbound::points<0, 0>>(
    [](const auto& x, const auto& y) { return y - static_cast<int>(x); });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_coordinate
// The expression uses a third coordinate of points with two.

constexpr auto above = errbound::predicate<errbound::points<2, 2>>(
    [](const auto& a, const auto& b) { return b[2] - a[2]; });

int main() {
    const double a[3]{}, b[3]{};
    return above(a, b) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_degree
// x to the 64th power.

constexpr auto predicate = errbound::predicate<errbound::points<0>>([](const auto& x) {
    const auto x4 = x * x * x * x, x16 = x4 * x4 * x4 * x4;
    return x16 * x16 * x16 * x16 - 1;
});

int main() {
    return predicate(1.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_division
// Predicates have no division.

constexpr auto slope = errbound::predicate<errbound::points<2, 2>>(
    [](const auto& a, const auto& b) { return (b[1] - a[1]) / (b[0] - a[0]); });

int main() {
    const double a[2]{}, b[2]{};
    return slope(a, b) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_equality
// Numbers are compared by operator==.

constexpr auto predicate = errbound::predicate<errbound::points<0, 0>>(
    [](const auto& x, const auto& y) { return x == y ? errbound::sign_type::zero : sign_of(x); });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_fraction
// The factor 0.5 is not a whole number; as an int it would be 0.

constexpr auto half = errbound::predicate<errbound::points<0, 0>>(
    [](const auto& x, const auto& y) { return 0.5 * x - y; });

int main() {
    return half(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_size
// The constant has type std::size_t.

constexpr auto predicate = errbound::predicate<errbound::points<0, 0>>(
    [](const auto& x, const auto& y) { return std::size_t(2) * x - y; });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
#endif
