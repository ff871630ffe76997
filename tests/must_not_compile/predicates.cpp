// Definitions and calls of predicates that must be rejected. Each case is compiled separately, with
// its name defined.
#include <errbound/predicates.hpp>

#ifdef CASE_captures
// The lambda captures a value: every stage needs it as an argument.

int main() {
    const int factor = 3;
    const auto scaled = errbound::predicate<errbound::points<0, 0>>(
        [&factor](const auto& x, const auto& y) { return factor * x - y; });
    return scaled(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_degrees
// x² − y is declared to have degree 1 in both. With degree 2 in y it would compile.

struct options : errbound::predicate_options {
    static constexpr std::array<int, 2> degrees{1, 1};
};

constexpr auto difference = errbound::predicate<errbound::points<0, 0>, options>(
    [](const auto& x, const auto& y) { return x * x - y; });

int main() {
    return difference(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_exact_type
// The last stage's type has no sign_of.

struct options : errbound::predicate_options {
    using exact_type = long double;
};

constexpr auto difference = errbound::predicate<errbound::points<0, 0>, options>(
    [](const auto& x, const auto& y) { return x - y; });

int main() {
    return difference(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_fewer_points
// The predicate takes three points, the call has two.

int main() {
    const double p[2]{};
    return errbound::orient2d(p, p) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_homogeneous
// Terms have degrees 1 and 2, but the expression is declared homogeneous.

struct options : errbound::predicate_options {
    static constexpr bool homogeneous = true;
};

constexpr auto difference = errbound::predicate<errbound::points<0, 0>, options>(
    [](const auto& x, const auto& y) { return x * x - y; });

int main() {
    return difference(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_negative_dimension
// A shape has a negative number of coordinates.

constexpr auto difference = errbound::predicate<errbound::points<-2, 0>>(
    [](const auto& x, const auto& y) { return x - y; });

int main() {
    return difference(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_options
// The options are not derived from the defaults.

struct options {
    using tracked_rule = errbound::tight;
};

constexpr auto difference = errbound::predicate<errbound::points<0, 0>, options>(
    [](const auto& x, const auto& y) { return x - y; });

int main() {
    return difference(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_rule_without_promise
// The tracked stage has a rule that only estimates errors.
#include <errbound/rules/stochastic.hpp>

struct options : errbound::predicate_options {
    using tracked_rule = errbound::stochastic;
};

constexpr auto difference = errbound::predicate<errbound::points<0, 0>, options>(
    [](const auto& x, const auto& y) { return x - y; });

int main() {
    return difference(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_shape
// The first template argument is not a shape.

constexpr auto difference =
    errbound::predicate<int>([](const auto& x, const auto& y) { return x - y; });

int main() {
    return difference(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_tracked_rule
// The tracked stage has a type that is not a bound rule.

struct options : errbound::predicate_options {
    using tracked_rule = double;
};

constexpr auto difference = errbound::predicate<errbound::points<0, 0>, options>(
    [](const auto& x, const auto& y) { return x - y; });

int main() {
    return difference(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_whole_coordinates
// Coordinates have type int.

int main() {
    const int p[2]{};
    return errbound::orient2d(p, p, p) == errbound::sign_type::zero;
}
#endif
