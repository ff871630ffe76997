// Polynomials and predicates without memory, over integers that take it from operator new.
#include <boost/multiprecision/cpp_int.hpp>
#include <errbound/multiprecision.hpp>
#include <errbound/polynomial.hpp>
#include <errbound/predicate_batch.hpp>
#include <errbound/predicates.hpp>
#include <utility>
#include <vector>

#include "tests/faults/failing_heap.hpp"

namespace {

using namespace errbound;
using faults::try_every_allocation;
using integer = boost::multiprecision::cpp_int;
using roots_of_doubles = decltype(isolate_roots<integer>(polynomial<double>(), 0, 0));

/// (x - 1) ... (x - 6) near and x^2 - 2; a double root; huge coefficients: filter, then integers.
const std::vector<polynomial<double>>& polynomials() {
    static const std::vector<polynomial<double>> all{
        {720, -1764, 1624, -735, 175, -21, 1},
        {-2, 0, 1},
        {4, -4, -3, 4, -1},
        {0x1p500, -0x1p501, 0x1.fffffffffp499},
    };
    return all;
}

auto ends_of(const roots_of_doubles& roots) {
    std::vector<std::pair<roots_of_doubles::point, roots_of_doubles::point>> ends;
    for (std::size_t k = 0; k < roots.size(); ++k) ends.emplace_back(roots[k].low, roots[k].high);
    return ends;
}

/// Where the roots are, to the nearest float: intervals may be narrower than asked for.
std::vector<float> places_of(const roots_of_doubles& roots) {
    std::vector<float> places;
    for (const auto& [low, high] : ends_of(roots)) {
        EXPECT_TRUE(high - low <= roots_of_doubles::point::power_of_two(-80));
        places.push_back(static_cast<float>(nearby_double(low.numerator(), low.exponent())));
    }
    return places;
}

TEST(RootFaults, Polynomials) {
    for (std::size_t i = 0; i < polynomials().size(); ++i) {
        const polynomial<double>& p = polynomials()[i];
        const polynomial<double>& other = polynomials()[1];
        const std::string of = ", polynomial " + std::to_string(i);
        try_every_allocation("count_roots" + of, [&] { return count_roots<integer>(p, -3, 10); });
        try_every_allocation("isolate_roots" + of,
                             [&] { return ends_of(isolate_roots<integer>(p, -3, 10)); });
        try_every_allocation("sign_on" + of, [&] { return sign_on<integer>(p, -3, 10); });
        try_every_allocation("common_factor" + of,
                             [&] { return common_factor<integer>(p, other).coefficients(); });
        try_every_allocation("common_roots" + of,
                             [&] { return common_roots<integer>(p, other, -3, 10).size(); });
        try_every_allocation("root_where_nonnegative" + of, [&] {
            return root_where_nonnegative<integer>(p, {other, polynomials()[0]}, -3, 10);
        });
    }
}

TEST(RootFaults, RootsThatWereFound) {
    for (std::size_t i = 0; i < polynomials().size(); ++i) {
        const auto isolated = [&] { return isolate_roots<integer>(polynomials()[i], -3, 10); };
        const std::string of = ", polynomial " + std::to_string(i);
        try_every_allocation("real_roots::refine" + of, isolated, [](roots_of_doubles& roots) {
            for (std::size_t k = 0; k < roots.size(); ++k) roots.refine(k, 0x1p-80);
            return places_of(roots);
        });
        try_every_allocation("real_roots::sign_at" + of, isolated, [](roots_of_doubles& roots) {
            std::vector<sign_type> signs;
            for (std::size_t k = 0; k < roots.size(); ++k)
                for (const auto& q : polynomials()) signs.push_back(roots.sign_at(q, k));
            return signs;
        });
    }
}

TEST(RootFaults, Predicates) {
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
