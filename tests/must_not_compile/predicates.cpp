// Definitions and calls of predicates that must be refused. Each case is compiled alone, with its
// name defined.
#include <errbound/predicates.hpp>

#ifdef CASE_captures
// A captured value: every stage needs it as an argument.

int main() {
    const int factor = 3;
    const auto scaled = errbound::predicate<errbound::points<0, 0>>(
        [&factor](const auto& x, const auto& y) { return factor * x - y; });
    return scaled(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_degrees
// x² − y, and the claim that both are of degree 1; with y of degree 2 it would be true.

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
// A last stage over a type without sign_of.

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
// Two points for a predicate of three.

int main() {
    const double p[2]{};
    return errbound::orient2d(p, p) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_homogeneous
// Terms of degree 1 and 2, and the claim that there are no such.

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
// Points of a negative number of coordinates.

constexpr auto difference = errbound::predicate<errbound::points<-2, 0>>(
    [](const auto& x, const auto& y) { return x - y; });

int main() {
    return difference(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_options
// Options that lack what they do not change.

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
// A tracked stage under a rule that only estimates errors.
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
// A shape that is none.

constexpr auto difference =
    errbound::predicate<int>([](const auto& x, const auto& y) { return x - y; });

int main() {
    return difference(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_tracked_rule
// A tracked stage under a type that is no bound rule.

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
// Coordinates of type int.

int main() {
    const int p[2]{};
    return errbound::orient2d(p, p, p) == errbound::sign_type::zero;
}
#endif
