// Bernstein forms and real roots, compared with identities; BSC over tracked scalars, compared with
// exact answers.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <errbound/bsc.hpp>
#include <errbound/multiprecision.hpp>
#include <errbound/roots/real_roots.hpp>
#include <random>
#include <vector>

#include "tests/support/special_values.hpp"

namespace {

using namespace errbound;
using namespace errbound::roots;
using integer = whole_number;

int small(std::mt19937_64& random, int bound) {
    return static_cast<int>(random() % static_cast<unsigned>(2 * bound + 1)) - bound;
}

template <int N>
bernstein<rational, N> random_form(std::mt19937_64& random, int bound = 5) {
    bernstein<rational, N> p;
    for (auto& c : p.h) c = rational(small(random, bound));
    return p;
}

TEST(Bernstein, OperationsKeepTheIdentitiesThatDefineThem) {
    std::mt19937_64 random(1);
    for (int k = 0; k < 300; ++k) {
        const auto p = random_form<3>(random);
        const auto q = random_form<2>(random);
        const rational t = rational(small(random, 20)) / 7;
        const rational pt = value_at(p, t), qt = value_at(q, t);
        EXPECT_EQ(value_at(p * q, t), pt * qt);
        EXPECT_EQ(value_at(elevated(p), t), pt);
        EXPECT_EQ(value_at(p + p, t), 2 * pt);
        EXPECT_EQ(value_at(-p, t), -pt);
        EXPECT_EQ(value_at(reversed(p), rational(1 - t)), pt);
        // A cubic's derivative by its exact five-point difference.
        const auto at = [&p](const rational& x) { return value_at(p, x); };
        EXPECT_EQ(12 * value_at(derivative(p), t),
                  at(t - 2) - 8 * at(t - 1) + 8 * at(t + 1) - at(t + 2));
        const rational v = 1 + static_cast<int>(random() % 5),
                       w = 1 + static_cast<int>(random() % 5);
        const rational cut = w / (v + w), factor = (v + w) * (v + w) * (v + w);
        const auto [left, right] = split(p, v, w);
        EXPECT_EQ(value_at(left, t), factor * at(t * cut));
        EXPECT_EQ(value_at(right, t), factor * at(cut + t * (1 - cut)));
        const auto [first, second] = halves(p);
        EXPECT_EQ(value_at(first, t), 8 * at(t / 2));
        EXPECT_EQ(value_at(second, t), 8 * at((1 + t) / 2));
    }
    const auto p = bernstein<rational, 3>::from_control_values({1, 2, 3, 4});
    EXPECT_EQ(value_at(p, rational(1) / 3), 2);  // control values on a line: that line
}

// Four factors d·t − n with known roots, some of them equal.
TEST(RealRoots, CountsAndSignsAgreeWithKnownRoots) {
    std::mt19937_64 random(2);
    for (int k = 0; k < 500; ++k) {
        std::vector<rational> roots;
        std::array<bernstein<integer, 1>, 4> factors;
        for (auto& f : factors) {
            const int d = 1 + static_cast<int>(random() % 6), n = small(random, 8);
            f = {{integer(-n), integer(d - n)}};  // d·t − n
            const rational r = rational(n) / d;
            if (r > 0 && r < 1 && std::find(roots.begin(), roots.end(), r) == roots.end())
                roots.push_back(r);
        }
        std::sort(roots.begin(), roots.end());
        const bernstein<integer, 4> p = factors[0] * factors[1] * factors[2] * factors[3];
        const auto inner = without_end_roots(p);
        real_roots<integer> found(inner);
        ASSERT_EQ(found.size(), roots.size());
        bernstein<integer, 2> g;
        for (auto& c : g.h) c = small(random, 3);
        // A factor of p too, so that common roots occur.
        const bernstein<integer, 3> h = g * factors[0];
        for (std::size_t i = 0; i < roots.size(); ++i) {
            const bernstein<rational, 3> hr{
                {rational(h[0]), rational(h[1]), rational(h[2]), rational(h[3])}};
            EXPECT_EQ(found.sign_at_root(without_end_roots(h), i), sign_of(value_at(hr, roots[i])));
        }
    }
}

/// True if y = 0 and all g > 0 (strict) or g >= 0 for a t in [0, 1].
template <std::size_t M>
bool exists(const bernstein<integer, 3>& y, const std::array<bernstein<integer, 4>, M>& g,
            bool strict) {
    const auto holds = [&](const auto& sign) {
        for (const auto& f : g) {
            const sign_type s = sign(f);
            if (s == sign_type::negative || (strict && s == sign_type::zero)) return false;
        }
        return true;
    };
    if (y[0] == 0 && holds([](const auto& f) { return sign_of(f[0]); })) return true;
    if (y[3] == 0 && holds([](const auto& f) { return sign_of(f[4]); })) return true;
    const auto inner = without_end_roots(y);
    if (inner.size() < 2) return false;
    real_roots<integer> roots(inner);
    for (std::size_t k = 0; k < roots.size(); ++k)
        if (holds([&](const auto& f) { return roots.sign_at_root(without_end_roots(f), k); }))
            return true;
    return false;
}

struct tally {
    int yes = 0, no = 0, maybe = 0;
};

struct query {
    bernstein<integer, 3> y;
    std::array<bernstein<integer, 4>, 2> g;
};

query random_query(std::mt19937_64& random, const std::array<int, 4>& y_bounds, int g_bound) {
    query q;
    for (int i = 0; i <= 3; ++i) q.y[i] = small(random, y_bounds[static_cast<std::size_t>(i)]);
    for (auto& form : q.g)
        for (int i = 0; i <= 4; ++i) form[i] = small(random, g_bound);
    return q;
}

bool is_zero(const bernstein<integer, 3>& y) {
    return y[0] == 0 && y[1] == 0 && y[2] == 0 && y[3] == 0;
}

/// Compares BSC over Scalar with the exact answer on integer forms times `factor`.
template <class Scalar>
void check_bsc(tally& counts, std::uint64_t seed, int queries, const std::array<int, 4>& y_bounds,
               int g_bound, typename Scalar::value_type factor) {
    using T = typename Scalar::value_type;
    const auto tracked_form = [factor]<int N>(const bernstein<integer, N>& p) {
        bernstein<Scalar, N> r;
        for (int i = 0; i <= N; ++i) r[i] = Scalar(T(static_cast<int>(p[i])) * factor);
        return r;
    };
    std::mt19937_64 random(seed);
    for (int k = 0; k < queries; ++k) {
        const auto [y, g] = random_query(random, y_bounds, g_bound);
        if (is_zero(y)) continue;
        const std::array g_tracked{tracked_form(g[0]), tracked_form(g[1])};
        const existence found = root_with_nonnegative(tracked_form(y), [&] { return g_tracked; });
        if (found == existence::no) {
            ++counts.no;
            EXPECT_FALSE(exists(y, g, false)) << "lost: query " << k << " of seed " << seed;
        } else if (found == existence::yes) {
            ++counts.yes;
            EXPECT_TRUE(exists(y, g, true)) << "invented: query " << k << " of seed " << seed;
        } else {
            ++counts.maybe;
        }
    }
}

// Small coefficients have many zeros, double roots and roots at ends; coefficients of different
// size have inflections and extrema near the ends.
constexpr std::array<std::array<int, 4>, 5> bounds_of_y{
    {{2, 4, 4, 2}, {9, 30, 30, 9}, {1, 1000, 1000, 1}, {1000, 3, 1000, 3}, {100, 100, 100, 1}}};

TEST(Bsc, NeverContradictsTheExactAnswer) {
    tally all;
    for (std::size_t i = 0; i < bounds_of_y.size(); ++i)
        for (const int g_bound : {2, 100}) {
            const auto& y = bounds_of_y[i];
            check_bsc<tracked<double, tight>>(all, 10 + i, 3000, y, g_bound, 1);
            check_bsc<tracked<double, tight>>(all, 20 + i, 1000, y, g_bound, 0x1p-900);
            check_bsc<tracked<double, tight>>(all, 30 + i, 1000, y, g_bound, 0x1p+900);
            check_bsc<tracked<double, safe>>(all, 40 + i, 2000, y, g_bound, 1);
            check_bsc<tracked<float, tight>>(all, 50 + i, 2000, y, g_bound, 1.0F);
        }
    // Most answers are certain, and both certain answers occur.
    EXPECT_GT(all.yes, 1000);
    EXPECT_GT(all.no, 10000);
    EXPECT_LT(all.maybe, all.yes + all.no);
}

// With exact numbers only two cases are undecided: Y ≡ 0, and a root at which some G is exactly
// zero and none is negative.
TEST(Bsc, DecidesExactNumbersExceptZeros) {
    int yes = 0, no = 0, open = 0;
    for (const auto& y_bounds : bounds_of_y)
        for (const int g_bound : {2, 100}) {
            std::mt19937_64 random(60);
            for (int k = 0; k < 3000; ++k) {
                const auto [y, g] = random_query(random, y_bounds, g_bound);
                const existence found = root_with_nonnegative(y, [&g = g] { return g; });
                if (is_zero(y)) {
                    EXPECT_TRUE(found == existence::no || found == existence::maybe_root);
                    continue;
                }
                const bool strict = exists(y, g, true), closed = exists(y, g, false);
                EXPECT_EQ(found, strict   ? existence::yes
                                 : closed ? existence::maybe_inside
                                          : existence::no)
                    << "query " << k << " of bounds " << y_bounds[0] << ", " << g_bound;
                ++(strict ? yes : closed ? open : no);
            }
        }
    EXPECT_GT(yes, 1000);
    EXPECT_GT(no, 10000);
    EXPECT_GT(open, 100);
}

// BSC decides well-separated data.
TEST(Bsc, DecidesSimpleQueries) {
    using S = tracked<double>;
    const auto decide = [](const bernstein<S, 3>& y, const bernstein<S, 4>& g) {
        return root_with_nonnegative(y, [&] { return std::array<bernstein<S, 4>, 1>{g}; });
    };
    const bernstein<S, 4> one{{S(1), S(4), S(6), S(4), S(1)}};
    // Y = (9t − 4)(4t − 1)(4t − 3): three roots and an inflection between them.
    const bernstein<S, 1> a{{S(-4), S(5)}}, b{{S(-1), S(3)}}, c{{S(-3), S(1)}};
    const auto three_roots = a * b * c;
    EXPECT_EQ(decide(three_roots, one), existence::yes);
    EXPECT_EQ(decide(three_roots, -one), existence::no);
    // G is positive only on (0.3, 0.7), which has the middle root.
    const bernstein<S, 1> low{{S(-3), S(7)}}, high{{S(7), S(-3)}};
    EXPECT_EQ(decide(three_roots, elevated(elevated(low * high))), existence::yes);
    // G is positive only on (0.26, 0.4), between the roots.
    const bernstein<S, 1> from{{S(-26), S(74)}}, to{{S(40), S(-60)}};
    EXPECT_EQ(decide(three_roots, elevated(elevated(from * to))), existence::no);
    // Two roots around a minimum, and a minimum above zero.
    EXPECT_EQ(decide(elevated(b * c), one), existence::yes);
    EXPECT_EQ(decide(elevated(bernstein<S, 2>{{S(1.1), S(-1.8), S(1.1)}}), one), existence::no);
    // A double root is never excluded.
    EXPECT_NE(decide(elevated(a * a), one), existence::no);
}

}  // namespace
