// Definitions and calls of predicates that must be rejected: their operations, answers and options.
// Each case is compiled separately, with its name defined.
#include <errbound/predicates.hpp>
#include <errbound/predicates/constructed_points.hpp>
#include <errbound/predicates/perturbation.hpp>
#include <errbound/rules/stochastic.hpp>

using errbound::points;
using errbound::sign_type;

template <class Shape = points<0, 0>, class Options = errbound::predicate_options, class Function,
          class... Points>
int call(const Function& function, const Points&... at) {
    return errbound::predicate<Shape, Options>(function)(at...) == sign_type::zero;
}

const double p[2]{};

// ---- Operations ----

#ifdef CASE_argument_types  // takes one argument for each point of the shape, of any type
// The expression takes doubles, but stages use other scalars.
const int result = call([](double x, double y) { return x - y; }, 1.0, 2.0);
#endif

#ifdef CASE_arguments  // takes one argument for each point of the shape, of any type
// The expression has two arguments, the shape three points.
const int result =
    call<points<0, 0, 0>>([](const auto& x, const auto& y) { return x - y; }, 1.0, 2.0, 3.0);
#endif

#ifdef CASE_assignment  // write const auto sum = a . b. and never =, .= or
// A sum is assigned: every result has its own type.
const int result = call(
    [](const auto& x, const auto& y) {
        auto sum = x * x;
        sum += y * y;
        return sum;
    },
    1.0, 2.0);
#endif

#ifdef CASE_comparison  // compares by sign_of.a - b.
// Numbers are compared by operator< instead of by the sign of their difference.
const int result =
    call([](const auto& x, const auto& y) { return x < y ? sign_of(x) : sign_of(y); }, 1.0, 2.0);
#endif

#ifdef CASE_condition  // branch on sign_of.x.
// A number is used as a condition.
const int result =
    call([](const auto& x, const auto& y) { return x - y ? sign_of(x) : sign_of(y); }, 1.0, 2.0);
#endif

#ifdef CASE_conversion  // does not convert its numbers: keep them as const auto
// A number is converted to int.
const int result =
    call([](const auto& x, const auto& y) { return y - static_cast<int>(x); }, 1.0, 2.0);
#endif

#ifdef CASE_coordinate  // a coordinate that the predicate's shape does not have
// The expression uses a third coordinate of points with two.
const int result =
    call<points<2, 2>>([](const auto& a, const auto& b) { return b[2] - a[2]; }, p, p);
#endif

#ifdef CASE_degree  // of a higher degree than 63
// x to the 64th power.
const int result = call<points<0>>(
    [](const auto& x) {
        const auto x4 = x * x * x * x, x16 = x4 * x4 * x4 * x4;
        return x16 * x16 * x16 * x16 - 1;
    },
    1.0);
#endif

#ifdef CASE_division  // has only ., - and .: multiply by the divisor
// Predicates have no division.
const int result = call<points<2, 2>>(
    [](const auto& a, const auto& b) { return (b[1] - a[1]) / (b[0] - a[0]); }, p, p);
#endif

#ifdef CASE_equality  // compares by sign_of.a - b.
// Numbers are compared by operator==.
const int result = call(
    [](const auto& x, const auto& y) { return x == y ? sign_type::zero : sign_of(x); }, 1.0, 2.0);
#endif

#ifdef CASE_fraction  // for 0.5 . x multiply all the rest by 2
// The factor 0.5 is not a whole number; as an int it would be 0.
const int result = call([](const auto& x, const auto& y) { return 0.5 * x - y; }, 1.0, 2.0);
#endif

#ifdef CASE_size  // for a size_t static_cast<int>
// The constant has type std::size_t.
const int result =
    call([](const auto& x, const auto& y) { return std::size_t(2) * x - y; }, 1.0, 2.0);
#endif

// ---- Answers ----

#ifdef CASE_asks_nothing  // is the same for all points: it evaluates no sign, or all its terms
// The answer does not use the points.
const int result = call(
    [](const auto& x, const auto& y) {
        (void)(x - y);
        return sign_type::positive;
    },
    1.0, 2.0);
#endif

#ifdef CASE_cancels  // is the same for all points: it evaluates no sign, or all its terms cancel
// Both products are equal: the difference is zero for all points.
const int result = call<points<2, 2>>(
    [](const auto& a, const auto& b) { return a[0] * b[1] - b[1] * a[0]; }, p, p);
#endif

#ifdef CASE_endless  // too_many_signs
// The loop evaluates the sign until it is certain.
const int result = call(
    [](const auto& x, const auto& y) {
        sign_type s = sign_of(x - y);
        while (!certain(s)) s = sign_of(x - y);
        return s;
    },
    1.0, 2.0);
#endif

#ifdef CASE_gives_up  // returns `uncertain` although all signs that it evaluated are certain
// The degenerate case is reported as uncertain.
const int result = call(
    [](const auto& x, const auto& y) {
        const sign_type s = sign_of(x - y);
        return s == sign_type::zero ? sign_type::uncertain : s;
    },
    1.0, 2.0);
#endif

#ifdef CASE_number_after_signs  // evaluates signs must return one.*write return sign_of.x.
// The expression returns a number after it has branched on a sign, so it cannot return `uncertain`.
const int result = call(
    [](const auto& x, const auto& y) {
        const auto d = x - y;
        return sign_of(x) == sign_type::positive ? d : -d;
    },
    1.0, 2.0);
#endif

#ifdef CASE_one_answer  // answer is the same for all signs
// The answer is the same for all signs.
const int result = call(
    [](const auto& x, const auto& y) {
        const sign_type s = sign_of(x - y);
        if (!certain(s)) return s;
        return s == sign_type::positive ? sign_type::negative : sign_type::negative;
    },
    1.0, 2.0);
#endif

#ifdef CASE_ordered_signs  // is not a constant expression|acts on a sign that is uncertain.*write
// operator< on signs orders `uncertain` last.
const int result = call(
    [](const auto& x, const auto& y) {
        if (sign_of(x - y) > sign_type::zero) return sign_of(x);
        return sign_type::negative;
    },
    1.0, 2.0);
#endif

#ifdef CASE_possibly  // acts on a sign that is uncertain.*write if ..certain.s.. return s
// The answer is positive although the sign may be uncertain.
const int result = call(
    [](const auto& x, const auto& y) {
        return possibly_positive(sign_of(x - y)) ? sign_type::positive : sign_type::negative;
    },
    1.0, 2.0);
#endif

#ifdef CASE_returns_bool  // instead of bool, int or void return sign_of.x.
// An answer of type bool cannot be `uncertain`.
const int result = call(
    [](const auto& x, const auto& y) { return sign_of(x - y) == sign_type::positive; }, 1.0, 2.0);
#endif

#ifdef CASE_returns_int  // instead of bool, int or void return sign_of.x.
// An answer of type int cannot be `uncertain`.
const int result = call(
    [](const auto& x, const auto& y) { return sign_of(x - y) == sign_type::positive ? 1 : -1; },
    1.0, 2.0);
#endif

#ifdef CASE_returns_void  // instead of bool, int or void return sign_of.x.
// The lambda has no return statement.
const int result = call([](const auto& x, const auto& y) { (void)sign_of(x - y); }, 1.0, 2.0);
#endif

#if defined(CASE_without_certain) || defined(CASE_without_certain_of_a_multiple)
// The code branches on an uncertain sign: the line with certain is missing.
#ifdef CASE_without_certain  // acts on a sign that is uncertain.*write if ..certain.s.. return s
constexpr int factor = 1;
#endif
#ifdef CASE_without_certain_of_a_multiple  // acts on a sign that is uncertain.*write if
constexpr int factor = 2147483647;
#endif
const int result = call<points<0, 0, 0>>(
    [](const auto& x, const auto& y, const auto& z) {
        const sign_type s = sign_of(factor * (x * y - z * z));
        return s == sign_type::positive ? sign_of(x - z) : sign_of(z - y);
    },
    1.0, 2.0, 3.0);
#endif

// ---- Shapes and options ----

constexpr auto difference = [](const auto& x, const auto& y) { return x - y; };
constexpr auto mixed = [](const auto& x, const auto& y) { return x * x - y; };

#ifdef CASE_captures  // must not have captures or members
// The lambda captures a value: every stage needs it as an argument.
int call_with(int factor) {
    return call([&factor](const auto& x, const auto& y) { return factor * x - y; }, 1.0, 2.0);
}
#endif

#ifdef CASE_degrees  // terms of different degree are added
// x² − y is declared to have degree 1 in both. With degree 2 in y it would compile.
struct options : errbound::predicate_options {
    static constexpr std::array<int, 2> degrees{1, 1};
};
const int result = call<points<0, 0>, options>(mixed, 1.0, 2.0);
#endif

#ifdef CASE_exact_type  // exact_type is constructible from double and has a sign_of
// The last stage's type has no sign_of.
struct options : errbound::predicate_options {
    using exact_type = long double;
};
const int result = call<points<0, 0>, options>(difference, 1.0, 2.0);
#endif

#ifdef CASE_fewer_points  // one argument for each point of the predicate's shape
// The predicate takes three points, the call has two.
const auto result = errbound::orient2d(p, p);
#endif

#ifdef CASE_homogeneous  // the expression is not homogeneous as declared
// Terms have degrees 1 and 2, but the expression is declared homogeneous.
struct options : errbound::predicate_options {
    static constexpr bool homogeneous = true;
};
const int result = call<points<0, 0>, options>(mixed, 1.0, 2.0);
#endif

#ifdef CASE_negative_dimension  // at least one, and none negative
// A shape has a negative number of coordinates.
const int result = call<points<-2, 0>>(difference, 1.0, 2.0);
#endif

#ifdef CASE_options  // options derive from errbound::predicate_options
// The options are not derived from the defaults.
struct options {
    using tracked_rule = errbound::tight;
};
const int result = call<points<0, 0>, options>(difference, 1.0, 2.0);
#endif

#ifdef CASE_rule_without_promise  // tracked_rule promises bounds, which .none. and .stochastic. do
// The tracked stage has a rule that only estimates errors.
struct options : errbound::predicate_options {
    using tracked_rule = errbound::stochastic;
};
const int result = call<points<0, 0>, options>(difference, 1.0, 2.0);
#endif

#ifdef CASE_shape  // predicate's first argument must be a shape: points<2, 2, 2>
// The first template argument is not a shape.
const int result = call<int>(difference, 1.0, 2.0);
#endif

#ifdef CASE_tracked_rule  // a bound rule needs a template bound<T>
// The tracked stage has a type that is not a bound rule.
struct options : errbound::predicate_options {
    using tracked_rule = double;
};
const int result = call<points<0, 0>, options>(difference, 1.0, 2.0);
#endif

#ifdef CASE_whole_coordinates  // coordinates must be float or double
// Coordinates have type int.
const int whole[2]{};
const auto result = errbound::orient2d(whole, whole, whole);
#endif

// ---- Perturbation, constructed points ----

#ifdef CASE_perturbed_coordinate  // perturbed has the index of a coordinate that no point has
// Coordinate 3 is perturbed, which no point has: the sign could be zero.
const int result =
    errbound::perturbed<3>(errbound::orient2d)({0, 1, 2}, p, p, p) == sign_type::zero;
#endif

#ifdef CASE_perturbed_branches  // perturbed needs an expression that returns a number
// The expression returns a sign_type.
const int result = errbound::perturbed(errbound::segments_intersect2d)({0, 1, 2, 3}, p, p, p, p) ==
                   sign_type::zero;
#endif

#ifdef CASE_perturbed_indices  // one index for each point of the predicate's shape
// A call with two indices for three points.
const int result = errbound::perturbed(errbound::orient2d)({0, 1}, p, p, p) == sign_type::zero;
#endif

#ifdef CASE_perturbed_indices_of_array  // one index for each point of the predicate's shape
const int result = errbound::perturbed(errbound::orient2d)(std::array<std::size_t, 4>(), p, p, p) ==
                   sign_type::zero;
#endif

#ifdef CASE_perturbed_constructed  // takes explicit points. for constructed ones perturb the
// A constructed point is the argument of a perturbed predicate.
const int result = errbound::perturbed(errbound::orient2d)(
                       {0, 1, 2}, errbound::line_line_point(p, p, p, p), p, p) == sign_type::zero;
#endif

#ifdef CASE_perturbed_constructed_branches  // perturbed needs an expression that returns a number
// The predicate of the parents branches.
const int result =
    errbound::perturbed(
        errbound::with_constructed<errbound::line_line, errbound::given, errbound::given,
                                   errbound::given>(errbound::segments_intersect2d))(
        {0, 1, 2, 3, 4, 5, 6}, p, p, p, p, p, p, p) == sign_type::zero;
#endif

#if defined(CASE_perturbed_batch) || defined(CASE_constructed_batch)
#include <errbound/predicate_batch.hpp>

using point = std::array<double, 2>;
void batch(std::array<sign_type, 2>& signs, const std::array<point, 2>& a) {
#ifdef CASE_perturbed_batch  // for a perturbed one pass the predicate that it perturbs
    errbound::batch_signs(errbound::perturbed(errbound::orient2d), signs, a, a, a);
#endif
#ifdef CASE_constructed_batch  // batch_signs takes explicit points
    using crossing = decltype(errbound::line_line_point(a[0], a[0], a[0], a[0]));
    errbound::batch_signs(errbound::orient2d, signs, std::array<crossing, 2>(), a, a);
#endif
}
#endif

#ifdef CASE_constructed_dimension  // constructed point.s dimension differs from the predicate.s
// The point is in the plane, the predicate in space.
const int result =
    errbound::orient3d(errbound::line_line_point(p, p, p, p), p, p, p) == sign_type::zero;
#endif
