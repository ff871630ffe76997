// The double that equals a root, or the two doubles around it, and the nearer one.
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstddef>
#include <errbound/multiprecision.hpp>
#include <errbound/polynomial.hpp>
#include <errbound/roots/double_order.hpp>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "tests/support/scaled.hpp"

namespace {

using integer = boost::multiprecision::cpp_int;
using rational = boost::multiprecision::cpp_rational;
using polynomial = errbound::polynomial<integer>;
using bracket = std::pair<double, double>;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double least = std::numeric_limits<double>::denorm_min();
constexpr double most = std::numeric_limits<double>::max();

std::vector<bracket> brackets(const polynomial& p, double a = -infinity, double b = infinity) {
    auto roots = errbound::isolate_roots(p, a, b);
    std::vector<bracket> all;
    for (std::size_t k = 0; k < roots.size(); ++k) all.push_back(roots.neighbouring_doubles(k));
    return all;
}
integer power_of_two(unsigned n) {
    return integer(1) << n;
}
polynomial product(const polynomial& p, const polynomial& q) {
    std::vector<integer> r(p.coefficients().size() + q.coefficients().size() - 1);
    for (std::size_t i = 0; i < p.coefficients().size(); ++i)
        for (std::size_t j = 0; j < q.coefficients().size(); ++j)
            r[i + j] += p.coefficients()[i] * q.coefficients()[j];
    return polynomial(r);
}

/// The nearer of two finite neighbours to a number between them; for a tie the even one.
double nearer(double low, double high, const rational& x) {
    const rational off = (rational(high) - x) - (x - rational(low));
    if (off != 0) return off > 0 ? low : high;
    return errbound::roots::order_of(low) % 2 == 0 ? low : high;
}

TEST(double_order, neighbours_differ_by_one) {
    using errbound::roots::double_of_order;
    using errbound::roots::order_of;
    for (const double x : {-infinity, -most, -1.0, -least, 0.0, least, 0.1, 0x1p-1022, 1.0, most}) {
        EXPECT_EQ(order_of(std::nextafter(x, infinity)), order_of(x) + 1) << x;
        EXPECT_EQ(double_of_order(order_of(x)), x);
    }
    EXPECT_EQ(order_of(-0.0), 0);
    EXPECT_FALSE(std::signbit(double_of_order(0)));
}

TEST(neighbouring_doubles, of_a_root_that_is_a_double_are_that_one) {
    EXPECT_EQ(brackets({-1, power_of_two(1074)}), std::vector<bracket>({{least, least}}));
    EXPECT_EQ(brackets(product({-1, power_of_two(1074)}, {-1, 0, 1})),
              std::vector<bracket>({{-1, -1}, {least, least}, {1, 1}}));
}
TEST(neighbouring_doubles, of_an_irrational_root) {
    const double root = std::sqrt(2.0);  // rounded up
    const double below = std::nextafter(root, 0);
    EXPECT_EQ(brackets({-2, 0, 1}), std::vector<bracket>({{-root, -below}, {below, root}}));
    EXPECT_EQ(brackets({-2, 0, 1}, 0, 4), std::vector<bracket>({{below, root}}));
}
TEST(neighbouring_doubles, of_a_root_below_the_least_or_beyond_the_largest) {
    EXPECT_EQ(brackets({-1, power_of_two(1075)}), std::vector<bracket>({{0, least}}));
    EXPECT_EQ(brackets({1, power_of_two(5000)}), std::vector<bracket>({{-least, 0}}));
    EXPECT_EQ(brackets({-1, power_of_two(5000)}, 0, 1), std::vector<bracket>({{0, least}}));
    EXPECT_EQ(brackets({-power_of_two(5000), 1}), std::vector<bracket>({{most, infinity}}));
    EXPECT_EQ(brackets({power_of_two(1024), 1}), std::vector<bracket>({{-infinity, -most}}));
    EXPECT_EQ(brackets({-2, 0, power_of_two(3000)}),
              std::vector<bracket>({{-least, 0}, {0, least}}));
}
TEST(neighbouring_doubles, of_two_roots_between_the_same_doubles) {
    // 1 + 1/3 and 1 + 2/3 of an ulp.
    const integer three_ulps = 3 * power_of_two(52);
    const bracket around{1, std::nextafter(1.0, 2)};
    EXPECT_EQ(brackets(product({-three_ulps - 1, three_ulps}, {-three_ulps - 2, three_ulps})),
              std::vector<bracket>({around, around}));
}

/// x^degree + x^(degree/2)/2 − 2
errbound::polynomial<double> three_terms(std::size_t degree) {
    std::vector<double> c(degree + 1);
    c[0] = -2;
    c[degree / 2] = 0.5;
    c[degree] = 1;
    return errbound::polynomial<double>(c);
}
// Exact values at doubles have five million bits; evaluating them took 8.8 s.
TEST(neighbouring_doubles, of_degree_100000) {
    auto roots = errbound::isolate_roots(three_terms(100000), -infinity, infinity);
    ASSERT_EQ(roots.size(), 2U);
    // y² + y/2 − 2 = 0 for y = x^50000: the logarithm of x is log(y)/50000.
    const double root = std::exp(std::log((std::sqrt(33.0) - 1) / 4) / 50000);
    for (std::size_t k = 0; k < 2; ++k) {
        const auto [low, high] = roots.neighbouring_doubles(k);
        EXPECT_EQ(high, std::nextafter(low, infinity));
        EXPECT_NEAR(k == 0 ? -high : low, root, 0x1p-51);
    }
    roots.refine(0, 1e-100);
    EXPECT_LE((roots[0].high - roots[0].low).to_double(), 1e-100);
    EXPECT_EQ(roots.sign_at(errbound::polynomial{0.0, 1.0}, 0), errbound::sign_type::negative);
}
TEST(real_roots, are_stopped_and_used_again) {
    int polls = 0, limit = 0;
    const errbound::root_limits limits{.stop = [&] { return ++polls > limit; }};
    const auto p = three_terms(2000);
    EXPECT_FALSE(errbound::isolate_roots(p, -infinity, infinity, limits).has_value());
    limit = std::numeric_limits<int>::max();
    auto roots = errbound::isolate_roots(p, -infinity, infinity, limits);
    ASSERT_TRUE(roots.has_value());
    limit = polls;
    EXPECT_THROW(roots->refine(0, 1e-300), errbound::roots::gave_up);
    limit = std::numeric_limits<int>::max();
    roots->refine(0, 1e-300);
    EXPECT_LT((roots->operator[](0).high - roots->operator[](0).low).to_double(), 1e-299);
    EXPECT_LT(roots->operator[](0).low, roots->operator[](0).high);
}

/// True if x lies within the error, by exact arithmetic.
bool holds(const errbound::roots::nearby_value<integer>& v, const errbound::dyadic<integer>& x) {
    const int exponent = static_cast<int>(v.exponent);
    const errbound::dyadic<integer> value(v.value, exponent), error(v.error, exponent);
    return !(error < magnitude(x - value));
}
TEST(nearby_value, holds_the_exact_value) {
    std::mt19937_64 random(48);
    errbound::roots::work_meter unlimited;
    const auto draw = [&](int most) {
        return static_cast<int>(random() % static_cast<unsigned>(most));
    };
    const auto whole = [&] {
        integer n = random() >> (random() % 64);
        for (int i = draw(3); i > 0; --i) n = n * power_of_two(64) + random();
        return integer(draw(2) == 0 ? n : -n);
    };
    int certain = 0, uncertain = 0;
    for (int i = 0; i < support::scaled(3000); ++i) {
        std::vector<integer> p(static_cast<std::size_t>(1 + draw(40)));
        for (integer& c : p)
            c = draw(2) == 0
                    ? integer(0)
                    : integer(whole() << static_cast<unsigned>(draw(4) == 0 ? draw(3000) : 0));
        p.back() = whole() * 2 + 1;
        const errbound::dyadic<integer> x(whole() >> static_cast<unsigned>(draw(60)),
                                          draw(200) - 150);
        // Half are near a root: the value there, cut to a whole number, is subtracted.
        const auto exact_at = [&] { return errbound::roots::value_at(p, x); };
        if (draw(2) == 0) p[0] -= errbound::shifted(exact_at().numerator(), exact_at().exponent());
        if (p.back() == 0) continue;
        const auto exact = exact_at();
        for (const int bits : {1, 5, 64, 128, 300}) {
            const auto near = errbound::roots::value_near(p, x, bits, unlimited);
            ASSERT_TRUE(holds(near, exact)) << i << ' ' << bits;
            const auto sign = near.sign();
            (errbound::certain(sign) ? certain : uncertain) += 1;
            if (errbound::certain(sign)) {
                ASSERT_EQ(sign, sign_of(exact)) << i << ' ' << bits;
            }
        }
        ASSERT_EQ(errbound::roots::sign_at(p, x), sign_of(exact));
    }
    EXPECT_GT(certain, 1000);
    EXPECT_GT(uncertain, 100);
}
// Terms of 2^(±10^8): an exact value would take 25 MB.
TEST(nearby_value, of_terms_far_apart) {
    errbound::roots::work_meter unlimited;
    std::vector<integer> p(100001);
    p[0] = -1;
    p[100000] = 3;
    const auto at = [&](int exponent) {
        return errbound::roots::sign_at(p, errbound::dyadic<integer>::power_of_two(exponent),
                                        unlimited);
    };
    EXPECT_EQ(at(1000), errbound::sign_type::positive);
    EXPECT_EQ(at(-1000), errbound::sign_type::negative);
    EXPECT_EQ(at(0), errbound::sign_type::positive);
}

TEST(neighbouring_doubles, of_rational_roots_hold_them) {
    std::mt19937_64 random(27);
    for (int i = 0; i < support::scaled(2000); ++i) {
        // Up to three roots n/m. Some are doubles or near doubles, some are double roots.
        std::vector<rational> roots;
        polynomial p{1};
        for (auto count = 1 + random() % 3; count > 0; --count) {
            const auto shift = static_cast<unsigned>(random() % 130);
            integer n = random() >> random() % 64, m = 1 + (random() >> random() % 64);
            if (random() % 3 == 0) m = power_of_two(shift);
            if (random() % 4 == 0) n = n * power_of_two(shift) + 1;
            if (random() % 2 == 0) n = -n;
            roots.emplace_back(n, m);
            for (auto times = 1 + random() % 2; times > 0; --times) p = product(p, {-n, m});
        }
        std::sort(roots.begin(), roots.end());
        roots.erase(std::unique(roots.begin(), roots.end()), roots.end());
        const auto found = brackets(p);
        const auto rounded = errbound::rounded_roots(p);
        ASSERT_EQ(found.size(), roots.size());
        ASSERT_EQ(rounded.size(), roots.size());
        for (std::size_t k = 0; k < roots.size(); ++k) {
            const auto [low, high] = found[k];
            EXPECT_EQ(rounded[k], nearer(low, high, roots[k]));
            if (low == high) {
                EXPECT_EQ(rational(low), roots[k]);
            } else {
                EXPECT_EQ(std::nextafter(low, infinity), high);
                EXPECT_LT(rational(low), roots[k]);
                EXPECT_LT(roots[k], rational(high));
            }
        }
    }
}

TEST(rounded_roots, of_the_whole_line) {
    using errbound::rounded_roots;
    const double root = std::sqrt(2.0);
    EXPECT_EQ(rounded_roots(polynomial{-2, 0, 1}), std::vector<double>({-root, root}));
    EXPECT_EQ(rounded_roots<integer>(errbound::polynomial{-2.0, 0.0, 1.0}),
              std::vector<double>({-root, root}));
    EXPECT_EQ(rounded_roots(polynomial{1, 0, 1}), std::vector<double>());
    EXPECT_EQ(rounded_roots(polynomial{7}), std::vector<double>());
    EXPECT_EQ(rounded_roots(polynomial{-1, 3}), std::vector<double>({1.0 / 3}));
}
TEST(rounded_roots, of_ties_are_even) {
    const integer ulps = power_of_two(53);
    for (int i = 1; i <= 9; i += 2) {  // halves of ulps above 1: to 0, 2, 2, 4, 4 ulps
        const double wanted = 1 + (i + 1) / 4 * 0x1p-51;
        EXPECT_EQ(rounded_roots(polynomial{-ulps - i, ulps}), std::vector<double>({wanted})) << i;
    }
    EXPECT_EQ(rounded_roots(polynomial{-1, power_of_two(1075)}), std::vector<double>({0}));
    EXPECT_EQ(rounded_roots(polynomial{-3, power_of_two(1075)}), std::vector<double>({2 * least}));
    EXPECT_EQ(rounded_roots(polynomial{-power_of_two(1024) + power_of_two(970), 1}),
              std::vector<double>({infinity}));
    EXPECT_EQ(rounded_roots(polynomial{-power_of_two(1024) + power_of_two(970) + 1, 1}),
              std::vector<double>({most}));
    EXPECT_EQ(rounded_roots(polynomial{power_of_two(5000), 1}), std::vector<double>({-infinity}));
    // Irrational roots next to a tie: √(t² + 2^-200) and √(t² − 2^-200) for t = 1 + 2^-53.
    const integer one = power_of_two(200), t = power_of_two(53) + 1;
    const integer square = t * t * power_of_two(94);
    const double above = std::nextafter(1.0, 2);
    EXPECT_EQ(rounded_roots(polynomial{-square - 1, 0, one}), std::vector<double>({-above, above}));
    EXPECT_EQ(rounded_roots(polynomial{-square + 1, 0, one}), std::vector<double>({-1, 1}));
}

}  // namespace
