// Integers, polynomials and predicates over integers from operator new, when memory runs out.
#include <boost/multiprecision/cpp_int.hpp>
#include <errbound/multiprecision.hpp>
#include <errbound/polynomial.hpp>
#include <errbound/predicate_batch.hpp>
#include <errbound/predicates.hpp>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "tests/faults/failing_heap.hpp"

namespace {

using namespace errbound;
using faults::try_every_allocation;

template <class Integer>
struct RootFaults : ::testing::Test {};
using integer_types = ::testing::Types<integer, boost::multiprecision::cpp_int>;
struct integer_names {
    template <class Integer>
    static std::string GetName(int) {
        return std::is_same_v<Integer, integer> ? "integer" : "cpp_int";
    }
};
TYPED_TEST_SUITE(RootFaults, integer_types, integer_names);

/// (x - 1) ... (x - 6), x^2 - 2, a double root, and huge coefficients. The filter decides some of
/// them, integers the others.
const std::vector<polynomial<double>>& polynomials() {
    static const std::vector<polynomial<double>> all{
        {720, -1764, 1624, -735, 175, -21, 1},
        {-2, 0, 1},
        {4, -4, -3, 4, -1},
        {0x1p500, -0x1p501, 0x1.fffffffffp499},
    };
    return all;
}

template <class Integer>
auto ends_of(const real_roots<Integer>& roots) {
    std::vector<std::pair<dyadic<Integer>, dyadic<Integer>>> ends;
    for (std::size_t k = 0; k < roots.size(); ++k) ends.emplace_back(roots[k].low, roots[k].high);
    return ends;
}

/// Positions of the roots, rounded to floats: intervals may be narrower than requested.
template <class Integer>
std::vector<float> places_of(const real_roots<Integer>& roots) {
    std::vector<float> places;
    for (const auto& [low, high] : ends_of(roots)) {
        EXPECT_TRUE(high - low <= dyadic<Integer>::power_of_two(-80));
        places.push_back(static_cast<float>(nearby_double(low.numerator(), low.exponent())));
    }
    return places;
}

TYPED_TEST(RootFaults, Polynomials) {
    using Integer = TypeParam;
    for (std::size_t i = 0; i < polynomials().size(); ++i) {
        const polynomial<double>& p = polynomials()[i];
        const polynomial<double>& other = polynomials()[1];
        const std::string of = ", polynomial " + std::to_string(i);
        try_every_allocation("count_roots" + of, [&] { return count_roots<Integer>(p, -3, 10); });
        try_every_allocation("isolate_roots" + of,
                             [&] { return ends_of(isolate_roots<Integer>(p, -3, 10)); });
        try_every_allocation("sign_on" + of, [&] { return sign_on<Integer>(p, -3, 10); });
        try_every_allocation("common_factor" + of,
                             [&] { return common_factor<Integer>(p, other).coefficients(); });
        try_every_allocation("common_roots" + of,
                             [&] { return common_roots<Integer>(p, other, -3, 10).size(); });
        try_every_allocation("root_where_nonnegative" + of, [&] {
            return root_where_nonnegative<Integer>(p, {other, polynomials()[0]}, -3, 10);
        });
    }
}

TYPED_TEST(RootFaults, RootsThatWereFound) {
    using Integer = TypeParam;
    for (std::size_t i = 0; i < polynomials().size(); ++i) {
        const auto isolated = [&] { return isolate_roots<Integer>(polynomials()[i], -3, 10); };
        const std::string of = ", polynomial " + std::to_string(i);
        try_every_allocation("real_roots::refine" + of, isolated, [](real_roots<Integer>& roots) {
            for (std::size_t k = 0; k < roots.size(); ++k) roots.refine(k, 0x1p-80);
            return places_of(roots);
        });
        try_every_allocation("real_roots::sign_at" + of, isolated, [](real_roots<Integer>& roots) {
            std::vector<sign_type> signs;
            for (std::size_t k = 0; k < roots.size(); ++k)
                for (const auto& q : polynomials()) signs.push_back(roots.sign_at(q, k));
            return signs;
        });
    }
}

/// For each operation: the operand that the result replaces. It must be unchanged or complete after
/// a failure.
TEST(IntegerFaults, OperationsInPlace) {
    const auto of_words = [](int n, int seed) {
        integer x = seed;
        for (int i = 0; i < n; ++i)
            x = (x << 64U) + 0x9e3779b97f4a7c15U * static_cast<unsigned>(i + seed);
        return x;
    };
    const auto try_all = [](const std::string& of, const integer& a, const integer& b) {
        const auto in_place = [&](const std::string& name, const auto& change) {
            try_every_allocation(
                name + of,
                [&a] {
                    return std::pair{a, a};
                },
                [&](std::pair<integer, integer>& of_two) {
                    auto& [x, before] = of_two;
                    integer again = before;  // the new value of x, made without allocating
                    try {
                        change(x);
                    } catch (...) {
                        faults::stop();  // the comparison allocates nothing, a report does
                        EXPECT_TRUE(x == before) << name << " changed the number";
                        throw;
                    }
                    std::swap(x, again);
                    return again;
                });
        };
        in_place("integer +=", [&](integer& x) { x += b; });
        in_place("integer -=", [&](integer& x) { x -= b; });
        in_place("integer *=", [&](integer& x) { x *= b; });
        in_place("integer *= itself", [](integer& x) { x *= x; });
        in_place("integer /=", [&](integer& x) { x /= b; });
        in_place("integer %=", [&](integer& x) { x %= b; });
        in_place("integer <<=", [](integer& x) { x <<= 1000U; });
        in_place("integer >>=", [](integer& x) { x >>= 67U; });
        in_place("integer =", [&](integer& x) { x = b; });
        in_place("integer, divisor", [&](integer& x) { x = gcd(x, b); });
        in_place("integer, text", [&](integer& x) { x = integer::from_string(to_string(b)); });
    };
    try_all(", few words", of_words(4, 3), of_words(6, -5));
    try_all(", by one", -(integer(1) << 256U), integer(-1));
    try_all(", many words", of_words(90, -7), of_words(70, 11));
}

TEST(PredicateFaults, Predicates) {
    using point = std::array<double, 3>;
    const std::vector<point> a{{0, 0, 0}, {0x1p-900, 1, 0}, {0x1p-1074, 0, 0}},
        b{{1, 0, 0}, {1, 0x1p900, 0}, {0, 0x1p1023, 0}}, c{{0, 1, 0}, {0, 1, 0x1p-900}, {1, 1, 1}},
        d{{0.25, 0.25, 0}, {0.25, 0.5, 0x1p-1000}, {0x1p1000, 1, 3}},
        e{{0.5, 0.5, 0}, {0.25, 0x1p500, 0x1p-500}, {0x1p1000, 1, 3}};
    try_every_allocation("orient3d", [&] {
        std::vector<sign_type> signs;
        for (std::size_t i = 0; i < 3; ++i) signs.push_back(orient3d(a[i], b[i], c[i], d[i]));
        return signs;
    });
    try_every_allocation("insphere", [&] {
        std::vector<sign_type> signs;
        for (std::size_t i = 0; i < 3; ++i) signs.push_back(insphere(a[i], b[i], c[i], d[i], e[i]));
        return signs;
    });
    try_every_allocation("batch_signs", [&] {
        std::vector<sign_type> signs(3);
        batch_signs(insphere, signs, a, b, c, d, e);
        return signs;
    });
}

}  // namespace
