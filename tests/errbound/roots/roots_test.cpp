// Roots and signs of polynomials of any degree, compared with Sturm chains in integers.
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdlib>
#include <errbound/polynomial.hpp>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/errbound/roots/polynomial_families.hpp"
#include "tests/errbound/roots/tarski.hpp"
#include "tests/support/scaled.hpp"
#include "tests/support/special_values.hpp"

namespace {

using namespace errbound;
using namespace errbound::roots;
using polynomial_families::degree_of_sample;
using polynomial_families::family;
using polynomial_families::generator;
using polynomial_families::integer;
using polynomial_families::sample;
using form = std::vector<integer>;

constexpr double infinity = std::numeric_limits<double>::infinity();

const int polynomials = support::scaled(120);

std::string text(const sample& s) {
    std::string all;
    for (const integer& c : s.whole) all += c.str() + " ";
    return all;
}

template <class Integer = integer>
real_roots<Integer> isolate(const sample& s, double a, double b) {
    if (!s.doubles.empty()) return isolate_roots<Integer>(polynomial<double>(s.doubles), a, b);
    return isolate_roots(polynomial<Integer>(polynomial_families::in<Integer>(s.whole)), a, b);
}
/// Counts in the library's own integers.
std::size_t count(const sample& s, double a, double b) {
    if (!s.doubles.empty()) return count_roots(polynomial<double>(s.doubles), a, b);
    return count_roots(polynomial(polynomial_families::in<errbound::integer>(s.whole)), a, b);
}

/// Checks everything that `roots` promises; [a, b] is finite.
void expect_isolated(const real_roots<integer>& roots, const sample& s, const tarski& sturm) {
    const form slope = derivative(s.whole);
    for (std::size_t k = 0; k < roots.size(); ++k) {
        const auto& root = roots[k];
        if (k > 0) {
            ASSERT_LE(roots[k - 1].high, root.low);
        }
        form f = s.whole;
        for (int m = 0; m < root.multiplicity; ++m) {
            // A root of multiplicity m is a root of the first m of f, f', ...
            f = m == 0 ? f : common_factor(f, derivative(f));
            if (root.is_point())
                ASSERT_EQ(sign_at(f, root.low), sign_type::zero) << text(s);
            else
                ASSERT_EQ(tarski(f, {1}).between(root.low, root.high), 1) << text(s);
        }
        f = common_factor(f, derivative(f));
        if (root.is_point()) {
            ASSERT_NE(sign_at(f, root.low), sign_type::zero) << text(s);
        } else {
            ASSERT_FALSE(sturm.is_root(root.low) || sturm.is_root(root.high)) << text(s);
            ASSERT_EQ(tarski(f, {1}).between(root.low, root.high), 0) << text(s);
        }
    }
}

// Their images modulo some hundred primes are combined.
TEST(CommonFactors, HaveLongCoefficients) {
    std::mt19937_64 random(1);
    const auto drawn = [&](int words) {
        form f;
        for (int i = 0; i < 4; ++i) {
            integer c = 1;
            for (int k = 0; k < words; ++k) c = (c << 64U) + random();
            f.push_back(random() % 2 == 0 ? c : integer(-c));
        }
        return f;
    };
    const auto product = [](const form& p, const form& q) {
        form r(p.size() + q.size() - 1);
        for (std::size_t i = 0; i < p.size(); ++i)
            for (std::size_t j = 0; j < q.size(); ++j) r[i + j] += p[i] * q[j];
        return r;
    };
    for (const int words : {0, 1, 5, 200}) {
        form expected = drawn(words);
        make_primitive(expected);
        const form found =
            common_factor(product(expected, {2, 3, -7}), product(expected, {5, 1, 1, 1}));
        EXPECT_TRUE(found == expected || found == product(expected, {-1})) << words;
    }
}

class Families : public testing::TestWithParam<family> {};

TEST_P(Families, CountsAndIntervalsAgreeWithSturm) {
    generator make(1 + static_cast<unsigned>(GetParam()));
    int decided = 0;
    for (int k = 0; k < polynomials; ++k) {
        const sample s = make.make(GetParam(), degree_of_sample(GetParam(), k, 30));
        const tarski sturm(s.whole, {1});
        const auto whole = isolate(s, -infinity, infinity);
        ASSERT_EQ(whole.size(), sturm.everywhere()) << text(s);
        ASSERT_EQ(count(s, -infinity, infinity), whole.size()) << text(s);
        ASSERT_EQ(count(s, 0, infinity), sturm.from({})) << text(s);
        decided += whole.decided_by_filter();
        // Small numbers are often roots.
        for (const double unit : {1.0, 0.25}) {
            const double x = make.small(8) * unit, y = x + std::abs(make.small(8)) * unit;
            const auto part = isolate(s, x, y);
            const auto low = dyadic<integer>::from(x), high = dyadic<integer>::from(y);
            ASSERT_EQ(part.size(), sturm.in_closed(low, high)) << x << ' ' << y << ": " << text(s);
            ASSERT_EQ(count(s, x, y), part.size());
            if (k % 8 == 0) expect_isolated(part, s, sturm);
        }
        if (k % 8 == 0) expect_isolated(whole, s, sturm);
    }
    RecordProperty("decided_by_filter", decided);
}

TEST_P(Families, RefinedIntervalsHoldTheirRoots) {
    generator make(100 + static_cast<unsigned>(GetParam()));
    for (int k = 0; k < polynomials / 4; ++k) {
        const sample s = make.make(GetParam(), degree_of_sample(GetParam(), k, 30));
        auto roots = isolate(s, -4, 4);
        const auto width = dyadic<integer>::power_of_two(-20 * (1 + k % 10));
        for (std::size_t i = 0; i < roots.size(); ++i) roots.refine(i, width);
        for (std::size_t i = 0; i < roots.size(); ++i)
            ASSERT_LE(roots[i].high - roots[i].low, width) << text(s);
        if (k % 4 == 0) expect_isolated(roots, s, tarski(s.whole, {1}));
    }
}

TEST_P(Families, SignsAtRootsAgreeWithTarskisQuery) {
    generator make(200 + static_cast<unsigned>(GetParam()));
    for (int k = 0; k < polynomials / 4; ++k) {
        const sample s = make.make(GetParam(), degree_of_sample(GetParam(), k, 16));
        sample g = make.make(polynomial_families::all[static_cast<std::size_t>(k) % 9], 1 + k % 5);
        // Some have a common factor.
        if (k % 3 == 0) g = {generator::product(g.whole, s.whole)};
        if (const form f = derivative(s.whole); k % 3 == 1 && !f.empty()) g = {f};
        auto roots = isolate(s, -infinity, infinity);
        auto own = isolate<errbound::integer>(s, -infinity, infinity);
        const polynomial own_g(polynomial_families::in<errbound::integer>(g.whole));
        for (std::size_t i = 0; i < roots.size(); ++i) {
            const auto root = roots[i];
            const auto truth =
                root.is_point()
                    ? sign_at(g.whole, root.low)
                    : sign_of(integer(tarski(s.whole, g.whole).between(root.low, root.high)));
            ASSERT_EQ(roots.sign_at(polynomial<integer>(g.whole), i), truth) << text(s);
            ASSERT_EQ(own.sign_at(own_g, i), truth) << text(s);
            if (!g.doubles.empty()) {
                ASSERT_EQ(roots.sign_at(polynomial<double>(g.doubles), i), truth) << text(s);
            }
        }
    }
}

/// Signs at the ends, at roots, and at a point between neighbours.
occurring_signs signs_by_samples(const sample& s, const real_roots<integer>& roots, double a,
                                 double b) {
    occurring_signs signs;
    const auto low = dyadic<integer>::from(a), high = dyadic<integer>::from(b);
    std::vector<dyadic<integer>> points{low};
    for (std::size_t k = 0; k < roots.size(); ++k) {
        signs.zero = true;
        points.push_back(roots[k].low);
        points.push_back(roots[k].high);
    }
    points.push_back(high);
    for (std::size_t i = 0; i < points.size(); ++i) {
        signs.add(sign_at(s.whole, points[i]));
        const bool gap = i % 2 == 0 && i + 1 < points.size() && points[i] < points[i + 1];
        if (gap) signs.add(sign_at(s.whole, middle(points[i], points[i + 1])));
    }
    return signs;
}

TEST_P(Families, SignsOnIntervals) {
    generator make(300 + static_cast<unsigned>(GetParam()));
    for (int k = 0; k < polynomials; ++k) {
        const sample s = make.make(GetParam(), degree_of_sample(GetParam(), k, 12));
        const double a = make.small(6), b = a + std::abs(make.small(3));
        const auto found = s.doubles.empty()
                               ? sign_on(polynomial<integer>(s.whole), a, b)
                               : sign_on<integer>(polynomial<double>(s.doubles), a, b);
        ASSERT_EQ(found, signs_by_samples(s, isolate(s, a, b), a, b))
            << a << ' ' << b << ": " << text(s);
    }
}

INSTANTIATE_TEST_SUITE_P(Roots, Families, testing::ValuesIn(polynomial_families::all),
                         [](const auto& info) {
                             return polynomial_families::names[static_cast<int>(info.param)];
                         });

// The roots of f and the g are known; some are common.
TEST(Roots, RootWhereNonnegative) {
    generator make(7);
    int yes = 0, no = 0;
    for (int k = 0; k < 3000; ++k) {
        std::vector<rational> roots;
        form f{1};
        const auto linear = [&](int bound) {
            const int n = make.small(bound), d = 1 + std::abs(make.small(3));
            return std::pair{form{integer(-n), integer(d)}, rational(n) / d};
        };
        for (int degree = 1 + k % 4; degree > 0; --degree) {
            const auto [factor, root] = linear(6);
            f = generator::product(f, factor);
            roots.push_back(root);
        }
        if (k % 7 == 0) f = {};  // every point is a root; test those of the g and between them
        std::vector<polynomial<integer>> g;
        std::vector<rational> critical;
        for (int i = k % 4; i > 0; --i) {
            form p{make.small(1)};
            for (int degree = k % 5; degree > 0; --degree) {
                const auto [factor, root] = linear(6);
                p = generator::product(p, factor);
                critical.push_back(root);
            }
            g.emplace_back(p);
        }
        const int a = make.small(6), b = a + std::abs(make.small(6));
        if (f.empty()) {
            roots = critical;
            roots.push_back(a);
            roots.push_back(b);
        }
        const auto holds = [&](const rational& t) {
            if (t < a || t > b) return false;
            return std::all_of(g.begin(), g.end(), [&](const polynomial<integer>& p) {
                rational sum = 0;
                for (std::size_t i = p.coefficients().size(); i-- > 0;)
                    sum = sum * t + rational(p.coefficients()[i]);
                return sum >= 0;
            });
        };
        const bool truth = std::any_of(roots.begin(), roots.end(), holds);
        ASSERT_EQ(root_where_nonnegative(polynomial<integer>(f), g, a, b), truth) << k;
        ++(truth ? yes : no);
    }
    EXPECT_GT(yes, 500);
    EXPECT_GT(no, 500);
}

TEST(Roots, ZeroConstantAndLinearPolynomials) {
    const polynomial<double> zero, also_zero{0.0, 0.0}, one{1.0}, x{0.0, 1.0};
    EXPECT_EQ(count_roots<integer>(zero, 0, 1), infinitely_many);
    EXPECT_EQ(count_roots<integer>(also_zero, -infinity, infinity), infinitely_many);
    EXPECT_TRUE(isolate_roots<integer>(zero, 0, 1).everywhere());
    EXPECT_EQ(count_roots<integer>(one, -infinity, infinity), 0U);
    EXPECT_EQ(count_roots<integer>(x, 0, 0), 1U);
    EXPECT_EQ(count_roots<integer>(x, 1, infinity), 0U);
    EXPECT_EQ(sign_on<integer>(zero, 0, 1), (occurring_signs{false, true, false}));
    EXPECT_EQ(sign_on<integer>(one, -infinity, infinity), (occurring_signs{false, false, true}));
    EXPECT_EQ(sign_on<integer>(x, -infinity, 0), (occurring_signs{true, true, false}));
    EXPECT_EQ(sign_on<integer>(x, 0, infinity), (occurring_signs{false, true, true}));
    EXPECT_FALSE(root_where_nonnegative<integer>(one, {}, 0, 1));
    EXPECT_TRUE(root_where_nonnegative<integer>(zero, {}, 0, 1));
}

TEST(Roots, BeyondTheRangeOfDouble) {
    // Nearer to 0 than any other double, and larger than all.
    for (const polynomial<double>& p :
         {polynomial{-0x1p-801, -0x1p+329}, polynomial{-0x1p-801, 0x1p+329},
          polynomial{0x1p+1000, -0x1p-1000}}) {
        EXPECT_EQ(count_roots<integer>(p, -infinity, infinity), 1U);
        EXPECT_EQ(isolate_roots<integer>(p, -infinity, infinity).size(), 1U);
    }
    const polynomial<double> tiny{-0x1p-801, 0x1p+329};
    EXPECT_EQ(count_roots<integer>(tiny, 0, number_traits<double>::underflow_unit()), 1U);
    EXPECT_EQ(count_roots<integer>(tiny, number_traits<double>::underflow_unit(), 1), 0U);
    // Signs at such roots, too (refinement in doubles once went on for ever at the negative one).
    auto negative = isolate_roots<integer>(
        polynomial{0x1.02893816ff1dp-793, 0x1.3e4c9556630d8p+474}, -infinity, infinity);
    const polynomial<double> x{0.0, 1.0}, beside{-number_traits<double>::underflow_unit(), 1.0};
    auto roots = isolate_roots<integer>(tiny, -infinity, infinity);
    EXPECT_EQ(negative.sign_at(x, 0), sign_type::negative);
    EXPECT_EQ(roots.sign_at(x, 0), sign_type::positive);
    EXPECT_EQ(roots.sign_at(beside, 0), sign_type::negative);
    EXPECT_EQ(roots.sign_at(tiny, 0), sign_type::zero);
    roots.refine(0, number_traits<double>::underflow_unit());
    EXPECT_LE(roots[0].high - roots[0].low,
              dyadic<integer>::from(number_traits<double>::underflow_unit()));
}

TEST(Roots, Multiplicities) {
    // (x − 1)³ x² (x² − 2)
    const polynomial<integer> p(generator::product(form{0, 0, -1, 3, -3, 1}, form{2, 0, -1}));
    const auto roots = isolate_roots(p, 0, 1.5);
    ASSERT_EQ(roots.size(), 3U);
    EXPECT_EQ(roots[0].multiplicity, 2);
    EXPECT_EQ(roots[1].multiplicity, 3);
    EXPECT_EQ(roots[2].multiplicity, 1);
    EXPECT_EQ(count_roots(p, 0, 1), 2U);
    EXPECT_EQ(count_roots(p, 0.5, 1), 1U);
    EXPECT_EQ(count_roots(p, -infinity, 0), 2U);
    const auto common = common_roots(p, polynomial<integer>{0, -2, 0, 1}, -2, 2);
    ASSERT_EQ(common.size(), 3U);
    EXPECT_EQ(common[1].multiplicity, 1);
}

// Hostile ends and coefficients: points, both zeros, subnormal and huge numbers.
TEST(Roots, PointsAsIntervals) {
    const polynomial<double> p{0.0, -0.75, 1.0};  // 0 and 3/4
    for (const double x : {0.0, -0.0, 0.75}) EXPECT_EQ(count_roots<integer>(p, x, x), 1U) << x;
    EXPECT_EQ(count_roots<integer>(p, -0.0, 0.0), 1U);
    EXPECT_EQ(count_roots<integer>(p, 0.0, -0.0), 1U);
    EXPECT_EQ(count_roots<integer>(p, -0.0, 0.75), 2U);
    EXPECT_EQ(count_roots<integer>(p, -1, -0.0), 1U);
    const double least = number_traits<double>::underflow_unit();
    for (const double x : {0.5, -0.75, std::nextafter(0.75, 1), least, -least})
        EXPECT_EQ(count_roots<integer>(p, x, x), 0U) << x;
    EXPECT_EQ(sign_on<integer>(p, 0.75, 0.75), (occurring_signs{false, true, false}));
    EXPECT_EQ(sign_on<integer>(p, 0.5, 0.5), (occurring_signs{true, false, false}));
    EXPECT_TRUE(root_where_nonnegative<integer>(p, {polynomial{-0.75, 1.0}}, 0.75, 0.75));
    EXPECT_FALSE(root_where_nonnegative<integer>(p, {polynomial{-0.75, 1.0}}, -0.0, 0.0));
    // A point that is a double root of largest·(1 − x/2)².
    const double most = std::numeric_limits<double>::max();
    const polynomial<double> square{most, -2 * (most / 2), most / 4};
    const auto double_root = isolate_roots<integer>(square, 2, 2);
    ASSERT_EQ(double_root.size(), 1U);
    EXPECT_EQ(double_root[0].multiplicity, 2);
}

// Small integers times a power of two have the same roots. (Families test mixed exponents: `wide`.)
TEST(Roots, SubnormalAndHugeCoefficients) {
    generator make(11);
    const double least = number_traits<double>::underflow_unit();
    for (int k = 0; k < 400; ++k) {
        std::vector<double> c(static_cast<std::size_t>(2 + k % 7));
        for (double& x : c) x = make.small(9);
        const sample s = generator::of_doubles(c);
        const std::size_t truth = tarski(s.whole, {1}).everywhere();
        for (const double factor : {least, 2 * least, 0x1p-1000, 0x1p+1000, 0x1p+1020}) {
            std::vector<double> scaled = s.doubles;
            for (double& x : scaled) x *= factor;
            ASSERT_EQ(count_roots<integer>(polynomial<double>(scaled), -infinity, infinity), truth)
                << factor;
        }
    }
}

// Degrees below and above root_filter::max_degree.
TEST_P(Families, DegreesUpTo60) {
    if (GetParam() == family::wide) GTEST_SKIP() << "thousands of bits";
    generator make(400 + static_cast<unsigned>(GetParam()));
    for (int degree = 31; degree <= 60; degree += polynomials < 120 ? 29 : 5) {
        const sample s = make.make(GetParam(), degree);
        const tarski sturm(s.whole, {1});
        ASSERT_EQ(count(s, -infinity, infinity), sturm.everywhere()) << text(s);
        const auto low = dyadic<integer>::from(-1), high = dyadic<integer>::from(0.5);
        const auto part = isolate(s, -1, 0.5);
        ASSERT_EQ(part.size(), sturm.in_closed(low, high)) << text(s);
    }
}

// p < 0 on [1, 2]. Its control values have the signs − − + −, and the first is 2^−1200 of the
// others, which is 0 in doubles.
TEST(Roots, EndWithAValueTooSmallForADouble) {
    const integer size = integer(1) << 1200U;
    const integer a = -30 * size, b = 87 * size, c = -67 * size;  // powers of x − 1
    const form p{-1 - a + b - c, a - 2 * b + 3 * c, b - 3 * c, c};
    std::vector<isolating_interval<integer>> found;
    work_meter unlimited;
    root_isolation<integer>(p, 1, unlimited)
        .isolate(dyadic<integer>::from(1), dyadic<integer>::from(2), found, unlimited);
    EXPECT_TRUE(found.empty());
}

// Polynomials of one library at the roots of another's, and with coefficients of several types.
TEST(Roots, MixedNumberTypes) {
    static_assert(std::is_same_v<decltype(polynomial{1, -2.5, 1}), polynomial<double>>);
    using boost::multiprecision::cpp_int;
    using boost::multiprecision::cpp_rational;
    using boost::multiprecision::mpq_rational;
    using boost::multiprecision::mpz_int;
    const auto expect_signs = [](auto roots) {  // of x² − 2
        ASSERT_EQ(roots.size(), 2U);
        const auto at_both = [&](const auto& g, sign_type left, sign_type right) {
            EXPECT_EQ(roots.sign_at(g, 0), left);
            EXPECT_EQ(roots.sign_at(g, 1), right);
        };
        constexpr auto negative = sign_type::negative, positive = sign_type::positive;
        at_both(polynomial<float>{-1.4142135F, 1}, negative, positive);  // below √2
        at_both(polynomial<double>{-1.4142135623730951, 1}, negative, negative);
        at_both(polynomial<int>{-2, 0, 1}, sign_type::zero, sign_type::zero);
        at_both(polynomial<cpp_int>{-4, 0, 0, 0, 1}, sign_type::zero, sign_type::zero);
        at_both(polynomial<mpz_int>{mpz_int(-3), mpz_int(2)}, negative, negative);
        at_both(polynomial<cpp_rational>{cpp_rational(-7, 5), cpp_rational(1)}, negative, positive);
        at_both(polynomial<mpq_rational>{mpq_rational(17, 12), mpq_rational(-1)}, positive,
                positive);
        at_both(polynomial<double>{}, sign_type::zero, sign_type::zero);
    };
    expect_signs(isolate_roots<cpp_int>(polynomial<float>{-2, 0, 1}, -infinity, infinity));
    expect_signs(isolate_roots<mpz_int>(polynomial<double>{-2, 0, 1}, -10, 10));
    expect_signs(isolate_roots<integer>(polynomial<int>{-2, 0, 1}, -infinity, 3));
    expect_signs(isolate_roots(polynomial<cpp_int>{-6, 0, 3}, -infinity, infinity));
    expect_signs(isolate_roots(polynomial<cpp_rational>{cpp_rational(-2, 3), 0, cpp_rational(1, 3)},
                               -infinity, infinity));
    expect_signs(isolate_roots(polynomial<mpq_rational>{-2, 0, 1}, -infinity, infinity));
    expect_signs(isolate_roots<mpz_int>(polynomial<cpp_int>{-2, 0, 1}, -infinity, infinity));
    // (x − 1/3)(x − 2/7)
    EXPECT_EQ(count_roots(polynomial<cpp_rational>{cpp_rational(2, 21), cpp_rational(-13, 21), 1},
                          0, 0.3),
              1U);
}

TEST(Roots, PreconditionsAreAsserted) {
#ifdef NDEBUG
    GTEST_SKIP() << "assertions are off";
#else
    const polynomial<double> p{-2.0, 0.0, 1.0};
    EXPECT_DEATH(count_roots<integer>(p, 1, 0), "is_interval");
    EXPECT_DEATH(count_roots<integer>(p, std::nan(""), 0), "is_interval");
    EXPECT_DEATH(isolate_roots<integer>(p, 0, std::nan("")), "is_interval");
    EXPECT_DEATH(sign_on<integer>(p, 1, 0), "is_interval");
    EXPECT_DEATH(root_where_nonnegative<integer>(p, {}, 1, 0), "is_interval");
    EXPECT_DEATH((void)count_roots<integer>(p, infinity, infinity), "is_interval");
    auto roots = isolate_roots<integer>(polynomial{-2.0, 0.0, 1.0}, 0, 2);
    EXPECT_DEATH(roots.refine(1, 0.5), "size");
    EXPECT_DEATH((polynomial<double>{1.0, std::nan("")}), "finite");
    EXPECT_DEATH((polynomial<float>{1.0F, HUGE_VALF}), "finite");
#endif
}

// Only integers decide if the degree is above root_filter::max_degree.
TEST(Roots, SignsAtRootsOfHighDegree) {
    form p{1};
    for (int k = 1; k <= 60; ++k) p = generator::product(p, form{-k, 1});
    auto roots = isolate_roots(polynomial<integer>(p), 59, infinity);
    ASSERT_EQ(roots.size(), 2U);
    EXPECT_EQ(roots.sign_at(polynomial<integer>{-60, 1}, 1), sign_type::zero);
    EXPECT_EQ(roots.sign_at(polynomial<integer>{-60, 1}, 0), sign_type::negative);
}

// A count is empty if the coefficients do not determine it, and else right for each polynomial
// within them.
TEST(Roots, TrackedCoefficientsThatAreZero) {
    using number = tracked<double>;
    const polynomial<number> x{number(0), number(1)}, also{number(0), number(0), number(2)};
    EXPECT_EQ(count_roots(x, 0, 1), 1U);
    EXPECT_EQ(count_roots(x, -1, 1), 1U);
    EXPECT_EQ(count_roots(x, 0, 0), 1U);
    EXPECT_EQ(count_roots(x, 2, 2), 0U);
    EXPECT_EQ(count_roots(x, 1, 2), 0U);
    EXPECT_EQ(count_roots(also, 0, infinity), 1U);
    EXPECT_EQ(count_roots(polynomial<number>{number(0)}, 0, 1), infinitely_many);
    const polynomial<number> near{number::within(0, 1), number(1)};
    EXPECT_EQ(count_roots(near, 0.5, 0.5), std::nullopt);
}
TEST(Roots, TrackedCoefficients) {
    using number = tracked<double>;
    generator make(9);
    int decided = 0;
    for (int k = 0; k < 2000; ++k) {
        const int degree = 1 + k % 12;
        const double error = std::ldexp(1.0, -(k % 50) - 3);
        std::vector<number> c;
        std::vector<double> inside;
        for (int i = 0; i <= degree; ++i) {
            const double x = make.uniform();
            c.push_back(number::within(x, error));
            inside.push_back(x + error * 0.99 * make.uniform());
        }
        const auto found = count_roots(polynomial<number>(c), -1, 2);
        if (!found) continue;
        ++decided;
        ASSERT_EQ(*found, count_roots<integer>(polynomial<double>(inside), -1, 2));
    }
    EXPECT_GT(decided, 1000);
}

}  // namespace
