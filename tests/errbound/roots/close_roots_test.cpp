// Roots near each other, polynomials of high degree, and limits. For some of these, root isolation
// used up the stack or took minutes.
#include <gtest/gtest.h>
#include <pthread.h>

#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <errbound/polynomial.hpp>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "tests/errbound/roots/polynomial_families.hpp"
#include "tests/errbound/roots/tarski.hpp"
#include "tests/support/scaled.hpp"

namespace {

using namespace errbound;
using namespace errbound::roots;
using boost::multiprecision::cpp_int;
using polynomial_families::generator;
using polynomial_families::integer;
using form = std::vector<integer>;
using point = dyadic<integer>;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Runs `job` in a thread with a stack of 256 KB.
void with_small_stack(std::function<void()> job) {
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    ASSERT_EQ(pthread_attr_setstacksize(&attributes, 256 << 10), 0);
    pthread_t thread;
    const auto run = [](void* f) -> void* {
        (*static_cast<std::function<void()>*>(f))();
        return nullptr;
    };
    ASSERT_EQ(pthread_create(&thread, &attributes, run, &job), 0);
    pthread_join(thread, nullptr);
    pthread_attr_destroy(&attributes);
}

template <class Integer>
void expect_close_pair(std::size_t n, int exponent) {
    auto roots = isolate_roots<Integer>(
        polynomial<double>(polynomial_families::close_pair(n, std::ldexp(1.0, exponent))), 0, 1);
    ASSERT_EQ(roots.size(), 2U) << n;
    const auto first = dyadic<Integer>::power_of_two(-exponent);
    EXPECT_LE(roots[0].low, first);
    EXPECT_LE(first, roots[0].high);
    // 1/a < x < 1/a + 2/a^(n + 1), and no room for another root between the intervals' ends.
    EXPECT_LE(first, roots[1].low);
    const auto beyond =
        first + dyadic<Integer>::power_of_two(1 - exponent * static_cast<int>(n + 1));
    EXPECT_LT(roots[1].low, beyond);
    EXPECT_EQ(roots.sign_at(polynomial<double>{-1, std::ldexp(1.0, exponent)}, 0), sign_type::zero);
}

TEST(CloseRoots, APairAtAnyDistanceInASmallStack) {
    with_small_stack([] {
        for (const std::size_t n : {7, 30, 45}) {
            expect_close_pair<integer>(n, 500);
            expect_close_pair<cpp_int>(n, 510);
        }
    });
}

// (x − 1)(2^k x − 2^k − 1)
TEST(CloseRoots, ThousandsOfHalvingsInASmallStack) {
    with_small_stack([] {
        const integer b = integer(1) << 30000U;
        const auto roots =
            isolate_roots(polynomial<integer>(form{b + 1, -2 * b - 1, b}), -infinity, infinity);
        ASSERT_EQ(roots.size(), 2U);
        EXPECT_EQ(roots[0].high < point::from(1) || roots[1].low < point::from(1), false);
    });
}

TEST(CloseRoots, SparsePolynomialsOfHighDegree) {
    for (const std::size_t n : {5000, 100000}) {
        std::vector<double> c(n + 1);
        c[0] = -2;
        c[n] = 1;
        EXPECT_EQ(count_roots<integer>(polynomial<double>(c), -infinity, infinity), 2U);
        c[n / 2] = 0.5;
        EXPECT_EQ(count_roots<integer>(polynomial<double>(c), -infinity, infinity), 2U);
        c[3] = 1;
        EXPECT_EQ(count_roots<integer>(polynomial<double>(c), 0, infinity), 1U);
    }
}

// On an interval, the time was cubic in the degree.
TEST(CloseRoots, OneSignChangeOnAnInterval) {
    std::vector<double> c(20001);
    c[0] = -2;
    c[20000] = 1;
    const auto expect = [&](double low, double high, std::size_t roots) {
        EXPECT_EQ(count_roots<integer>(polynomial<double>(c), low, high), roots)
            << low << ' ' << high;
    };
    expect(0.5, 1.5, 1);
    expect(-1.5, 1.5, 2);
    expect(1, 1 + 0x1p-10, 1);
    expect(1 + 0x1p-10, 2, 0);
    expect(-2, 1, 1);
    c = {-1, 0, 0, 1};
    expect(0.5, 1, 1);
    expect(1, 3, 1);
}

/// A polynomial with the roots (start + k)/(3·2^bits), near each other and not dyadic.
form cluster(const integer& start, unsigned bits, const std::vector<int>& steps) {
    form p{1};
    for (const int k : steps) p = generator::product(p, form{-(start + k), integer(3) << bits});
    return p;
}

// Clusters within clusters, and pairs of complex roots next to them.
TEST(CloseRoots, Clusters) {
    std::mt19937_64 random(3);
    for (int round = 0; round < support::scaled(60); ++round) {
        form p{1};
        std::size_t roots = 0;
        int place = -40;
        for (int part = 0; part < 3; ++part) {
            place += 1 + static_cast<int>(random() % 20);
            const auto bits = static_cast<unsigned>(random() % 700);
            const integer start = 3 * (integer(place) << bits) + 1;
            const std::vector<int> steps = random() % 2 == 0
                                               ? std::vector<int>{0, 3, 6}
                                               : std::vector<int>{-6, 0, 3, 9, 300000};
            p = generator::product(p, cluster(start, bits, steps));
            roots += steps.size();
            if (random() % 2 == 0) {
                // (x − place − 1/2)² + 4^(−bits), times 4^bits.
                const integer unit = integer(1) << (bits + 1), middle = (2 * integer(place) + 1)
                                                                        << bits;
                p = generator::product(p,
                                       form{middle * middle + 4, -2 * middle * unit, unit * unit});
            }
        }
        const auto found = isolate_roots(polynomial<integer>(p), -infinity, infinity);
        ASSERT_EQ(found.size(), roots);
        for (std::size_t k = 0; k < roots; ++k) {
            ASSERT_NE(sign_at(p, found[k].low), sign_at(p, found[k].high));
            if (k > 0) {
                ASSERT_LE(found[k - 1].high, found[k].low);
            }
        }
    }
}

// x^n − (ax − 1)^k: k roots about 1/a^(n/k) around 1/a, of which one or two are real.
TEST(CloseRoots, AroundAMultipleRoot) {
    for (const std::size_t n : {12, 25}) {
        for (const std::size_t k : {2, 3, 4, 5}) {
            const integer a = 12345 + static_cast<int>(k);
            form power{1};
            for (std::size_t i = 0; i < k; ++i) power = generator::product(power, form{-1, a});
            power.resize(n + 1);
            for (integer& c : power) c = -c;
            power[n] += 1;
            const tarski sturm(power, {1});
            const auto roots = isolate_roots(polynomial<integer>(power), -infinity, infinity);
            EXPECT_EQ(roots.size(), sturm.everywhere()) << n << ' ' << k;
        }
    }
}

// Certain signs of rows that are cut to few bits are right, and no interval with roots is rootless.
TEST(LocalForm, CertainSignsAreRight) {
    generator make(7);
    std::mt19937_64 random(8);
    int certain_signs = 0, uncertain_signs = 0, rootless = 0;
    for (int round = 0; round < support::scaled(600); ++round) {
        const auto family = polynomial_families::all[random() % polynomial_families::all.size()];
        form p = make.make(family, 2 + static_cast<int>(random() % 12)).whole;
        if (p[0] == 0) p[0] = 1;
        const point low(integer(1 + random() % 1000), static_cast<int>(random() % 12) - 10);
        const point width(integer(1 + random() % 1000), static_cast<int>(random() % 40) - 36);
        local_form<integer> local(p, low, width, 1 + static_cast<int>(random() % 100));
        point from = low, to = low + width;
        for (int level = 0; level < 3; ++level) {
            const form exact = control_values_on(p, from, to);
            const auto signs = local.signs(20 + static_cast<int>(random() % 60));
            const auto row = local.coefficients(200);
            const fixed_row<4> fixed(row.values, row.error);
            ASSERT_EQ(signs.size(), exact.size());
            for (std::size_t i = 0; i < signs.size(); ++i) {
                if (signs[i] != 0) {
                    ASSERT_EQ(signs[i], sign(exact[i])) << round << ' ' << i;
                }
                if (fixed.sign(i) != 0) {
                    ASSERT_EQ(fixed.sign(i), sign(exact[i])) << round << ' ' << i;
                }
                ++(signs[i] != 0 ? certain_signs : uncertain_signs);
            }
            ASSERT_FALSE(local.low_end_is_certain() && exact.front() == 0);
            ASSERT_FALSE(local.high_end_is_certain() && exact.back() == 0);
            if (local.surely_rootless()) {
                ASSERT_EQ(tarski(p, {1}).in_closed(from, to), 0) << round;
                ++rootless;
            }
            const int depth = 1 + static_cast<int>(random() % 9);
            const int start = static_cast<int>(random() % (1U << depth));
            const int length =
                1 + static_cast<int>(random() % ((1U << depth) - static_cast<unsigned>(start)));
            local = local.part(integer(start), integer(length), depth);
            const point size = to - from;
            to = from + size * point(integer(start + length), -depth);
            from = from + size * point(integer(start), -depth);
        }
    }
    // Both occur often.
    EXPECT_GT(certain_signs, uncertain_signs / 4);
    EXPECT_GT(uncertain_signs, certain_signs / 100);
    EXPECT_GT(rootless, support::scaled(600) / 20);
}

TEST(RootLimits, StopHardProblemsEarly) {
    const polynomial<double> hard(polynomial_families::close_pair(45, 0x1p510));
    EXPECT_FALSE(count_roots<integer>(hard, 0, 1, {.operations = 100'000}));
    EXPECT_FALSE(isolate_roots<integer>(hard, 0, 1, {.bytes = 10'000}));
    EXPECT_EQ(count_roots<integer>(hard, 0, 1, {.operations = 10'000'000'000}), 2U);
    // x^100000 − 3x^49999 + 1 has two positive roots, which no rule on its coefficients separates.
    std::vector<double> c(100001);
    c[0] = 1;
    c[49999] = -3;
    c[100000] = 1;
    EXPECT_FALSE(
        count_roots<integer>(polynomial<double>(c), 0, infinity, {.operations = 1'000'000'000}));
    // x^1000000 − 2: no value is computed beyond all roots.
    c.assign(1'000'001, 0);
    c[0] = -2;
    c[1'000'000] = 1;
    EXPECT_EQ(count_roots<integer>(polynomial<double>(c), 0, 10, {.operations = 1'000'000'000}),
              1U);
    // The filter decides these without integers.
    EXPECT_EQ(count_roots<integer>(polynomial<double>{-2, 0, 1}, 0, 2, {.operations = 0}), 1U);
    auto roots = isolate_roots<integer>(polynomial<double>{-2, 0, 1}, 0, 2, {.operations = 0});
    ASSERT_TRUE(roots);
    roots->refine(0, 1e-300);  // no longer limited
    EXPECT_EQ(roots->size(), 1U);
}

TEST(RootLimits, NeverChangeTheAnswer) {
    generator make(9);
    for (int k = 0; k < 200; ++k) {
        const auto s = make.make(polynomial_families::family::clustered, 3 + k % 10);
        const polynomial<integer> p(s.whole);
        const std::size_t truth = count_roots(p, -infinity, infinity);
        for (const std::uint64_t operations : {0, 1000, 10'000, 100'000, 10'000'000}) {
            const auto found = count_roots(p, -infinity, infinity, {.operations = operations});
            EXPECT_EQ(found.value_or(truth), truth);
            EXPECT_TRUE(found || operations < 10'000'000);
        }
    }
}

// Refinement did not end in builds without assertions.
TEST(Refine, ToInvalidWidthsThrows) {
    auto roots = isolate_roots<integer>(polynomial<double>{-2, 0, 1}, 0, 2);
    for (const double width : {0.0, -1.0, std::nan(""), infinity})
        EXPECT_THROW(roots.refine(0, width), std::invalid_argument);
    EXPECT_THROW(roots.refine(0, point()), std::invalid_argument);
}

}  // namespace
