// The predicates of errbound/predicates.hpp and errbound/simplices/predicates.hpp, compared with
// their oracles on inputs of all kinds and sizes, and with simple figures.
#include <array>
#include <cmath>
#include <cstddef>
#include <errbound/predicates.hpp>
#include <errbound/simplices/predicates.hpp>
#include <random>
#include <tuple>

#include "tests/errbound/predicates/predicate_check.hpp"
#include "tests/support/scaled.hpp"

namespace {

using namespace predicate_check;

template <class T>
class Predicates : public testing::Test {};
using number_types = testing::Types<float, double>;
TYPED_TEST_SUITE(Predicates, number_types);

TYPED_TEST(Predicates, AgreeWithTheirOracles) {
    const auto run = [](const auto& entry) {
        if (entry.constant_of_shewchuk != 0) return;  // predicate_test has these
        const auto [first, second] = entry.surfaces;
        compare_entry<TypeParam>(entry, first);
        if (second != first) compare_entry<TypeParam>(entry, second);
    };
    std::apply([&](const auto&... entry) { (run(entry), ...); }, predicate_list::all);
}

TEST(Signs, OfSimpleFigures) {
    using enum sign_type;
    EXPECT_EQ(errbound::orient2d(point2{0, 0}, point2{1, 0}, point2{0.5, 1}), positive);
    const point3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0}, above{0, 0, 1}, below{0, 0, -1};
    EXPECT_EQ(errbound::orient3d(a, b, c, below), positive);
    EXPECT_EQ(errbound::orient3d(a, b, c, above), negative);
    EXPECT_EQ(errbound::incircle(point2{0, 0}, point2{1, 0}, point2{0, 1}, point2{0.9, 0.9}),
              positive);
    EXPECT_EQ(errbound::incircle(point2{0, 0}, point2{1, 0}, point2{0, 1}, point2{1, 1}), zero);
    EXPECT_EQ(errbound::insphere(a, b, c, below, point3{0.25, 0.25, -0.25}), positive);
    EXPECT_EQ(errbound::insphere(a, b, c, below, point3{1, 1, 1}), negative);
    // Unit circles at three corners of a square of side 2, and points with weights at the fourth:
    // the orthogonal circle has its center in the middle and 1 for its squared radius.
    const auto power = [](double weight) {
        return errbound::power_incircle(point3{0, 0, 1}, point3{2, 0, 1}, point3{0, 2, 1},
                                        point3{2, 2, weight});
    };
    EXPECT_EQ(power(1), zero);
    EXPECT_EQ(power(1.5), positive);
    EXPECT_EQ(power(0.5), negative);
    EXPECT_EQ(errbound::compare_distances2d(point2{0, 0}, point2{1, 0}, point2{0, 2}), negative);
    EXPECT_EQ(errbound::compare_distances3d(a, above, b), zero);
}

/// Weighted points. Half have small integers as coordinates; some are equal.
template <std::size_t Size>
std::array<double, Size> weighted(std::size_t dimension, std::mt19937_64& random) {
    std::array<double, Size> x{};
    const bool whole = random() % 2 == 0, alike = random() % 4 == 0;
    for (std::size_t i = 0; i < Size; ++i)
        x[i] = alike && i >= Size - dimension ? x[i - (Size - dimension)]
               : whole                        ? static_cast<double>(random() % 9)
                                              : static_cast<double>(random() >> 11) * 0x1p-52 - 1;
    return x;
}
// Weights have the degree 2: scaling them with the plane changes no sign, and is not slower.
TEST(WeightedPoints, OfAnyScaleAreDecidedByTheSameStages) {
    std::mt19937_64 random(5);
    errbound::predicate_report near, far;
    const int count = support::scaled(4000);
    for (int k = 0; k < count; ++k) {
        const int s = static_cast<int>(random() % 900) - 450;
        const auto check = [&]<std::size_t Size>(std::array<double, Size> x, std::size_t dimension,
                                                 const auto& predicate) {
            const sign_type expected = predicate(near, x);
            for (std::size_t i = 0; i < Size; ++i)
                x[i] = std::ldexp(x[i], i % dimension == dimension - 1 ? 2 * s : s);
            EXPECT_EQ(predicate(far, x), expected) << s;
        };
        check(weighted<12>(3, random), 3, [](auto& report, const auto& x) {
            return errbound::power_incircle(report, &x[0], &x[3], &x[6], &x[9]);
        });
        check(weighted<20>(4, random), 4, [](auto& report, const auto& x) {
            return errbound::power_insphere(report, &x[0], &x[4], &x[8], &x[12], &x[16]);
        });
    }
    using enum errbound::predicate_stage;
    EXPECT_EQ(near.undecided + far.undecided, 0U);
    EXPECT_GE(far[static_filter] + far[short_integers] + far[exact_doubles], near[static_filter]);
    EXPECT_EQ(far[long_integers], 0U);  // near 1 they fit two words
}

// The symmetries, and the degenerate cases that the families of inputs rarely have.
TEST(Signs, OfSegments) {
    using enum sign_type;
    const auto at = [](const point3& a, const point3& b, const point3& c, const point3& d) {
        const sign_type s = errbound::segments_intersect3d(a, b, c, d);
        EXPECT_EQ(errbound::segments_intersect3d(d, c, a, b), s);
        return s;
    };
    EXPECT_EQ(at({-1, 0, 1}, {1, 0, 1}, {0, -1, 1}, {0, 1, 1}), positive);
    EXPECT_EQ(at({-1, 0, 1}, {1, 0, 1}, {0, -1, 2}, {0, 1, 2}), negative);
    EXPECT_EQ(at({-1, 0, 1}, {1, 0, 1}, {0, 0, 1}, {0, 1, 1}), zero);      // a T
    EXPECT_EQ(at({-1, 0, 1}, {1, 0, 1}, {2, 0, 1}, {2, 1, 1}), negative);  // end on the line
    EXPECT_EQ(at({0, 0, 0}, {2, 2, 2}, {1, 1, 1}, {3, 3, 3}), zero);       // overlap
    EXPECT_EQ(at({1, 1, 1}, {1, 1, 1}, {0, 0, 0}, {2, 2, 2}), zero);       // a point
    EXPECT_EQ(at({1, 1, 2}, {1, 1, 2}, {0, 0, 0}, {2, 2, 2}), negative);
}

TEST(Signs, OfSegmentsInThePlane) {
    using enum sign_type;
    const auto at = [](const point2& a, const point2& b, const point2& c, const point2& d) {
        const sign_type s = errbound::segments_intersect2d(a, b, c, d);
        EXPECT_EQ(errbound::segments_intersect2d(d, c, a, b), s);
        return s;
    };
    EXPECT_EQ(at({-1, 0}, {1, 0}, {0, -1}, {0, 1}), positive);
    EXPECT_EQ(at({-1, 0}, {1, 0}, {0, 0}, {0, 1}), zero);  // a T
    EXPECT_EQ(at({-1, 0}, {1, 0}, {2, 0}, {2, 1}), negative);
    EXPECT_EQ(at({0, 0}, {2, 2}, {1, 1}, {3, 3}), zero);  // overlap
    EXPECT_EQ(at({0, 0}, {2, 2}, {3, 3}, {4, 4}), negative);
    EXPECT_EQ(at({1, 1}, {1, 1}, {0, 0}, {2, 2}), zero);  // a point
}

TEST(Signs, OfSegmentAndTriangle) {
    using enum sign_type;
    const auto at = [](const point3& p, const point3& q, const point3& c = {0, 4, 0}) {
        const point3 a{0, 0, 0}, b{4, 0, 0};
        const sign_type s = errbound::segment_intersects_triangle(p, q, a, b, c);
        EXPECT_EQ(errbound::segment_intersects_triangle(q, p, b, c, a), s);
        return s;
    };
    EXPECT_EQ(at({1, 1, -1}, {1, 1, 1}), positive);
    EXPECT_EQ(at({3, 3, -1}, {3, 3, 1}), negative);
    EXPECT_EQ(at({2, 2, -1}, {2, 2, 1}), zero);   // an edge
    EXPECT_EQ(at({1, 1, 0}, {1.5, 1, 0}), zero);  // in the plane, inside
    EXPECT_EQ(at({5, 5, 0}, {9, 1, 0}), negative);
    EXPECT_EQ(at({1, -1, 0}, {1, 1, 0}, {8, 0, 0}), zero);  // the triangle is a segment
    EXPECT_EQ(at({1, -1, 1}, {1, 1, 1}, {8, 0, 0}), negative);
    EXPECT_EQ(at({1, 1, 0}, {1, 1, 0}), zero);  // the segment is a point
}

TEST(Signs, OfTriangles) {
    using enum sign_type;
    const auto at = [](const point3& p, const point3& q, const point3& r) {
        const point3 a{0, 0, 0}, b{4, 0, 0}, c{0, 4, 0};
        const sign_type s = errbound::triangle_intersects_triangle(a, b, c, p, q, r);
        EXPECT_EQ(errbound::triangle_intersects_triangle(r, p, q, b, a, c), s);
        return s;
    };
    EXPECT_EQ(at({1, 1, -1}, {1, 1, 1}, {9, 9, 1}), positive);
    EXPECT_EQ(at({1, 1, 1}, {1, 1, 2}, {9, 9, 1}), negative);
    EXPECT_EQ(at({1, 1, 0}, {1, 1, 2}, {9, 9, 1}), zero);  // a vertex
    EXPECT_EQ(at({1, 0, 0}, {1, 1, 0}, {9, 9, 1}), zero);  // an edge
    EXPECT_EQ(at({-1, 4, 1}, {5, -2, 1}, {2, 1, -2}), positive);
    EXPECT_EQ(at({1, 1, 0}, {2, 1, 0}, {1, 2, 0}), zero);  // in the plane, inside
    EXPECT_EQ(at({5, 5, 0}, {9, 1, 0}, {9, 9, 0}), negative);
    EXPECT_EQ(at({1, 1, 1}, {1, 1, 2}, {1, 1, -1}), positive);  // a segment
    // Edges meet at both ends of the common segment, but the interiors cross.
    EXPECT_EQ(at({0, 2, 0}, {2, 0, 2}, {2, 0, -2}), positive);
}

TEST(Signs, OfImplicitPoints) {
    using enum sign_type;
    const point2 a{0, 0}, b{3, 3}, c{0, 2}, d{2, 0};  // the lines meet at (1, 1)
    for (const double y : {2, 1, 0}) {
        const point2 q{5, 1}, r{y == 1 ? 9.0 : 5.0, y};
        EXPECT_EQ(errbound::orient2d_line_line(a, b, c, d, q, r),
                  errbound::orient2d(point2{1, 1}, q, r));
    }
    EXPECT_EQ(errbound::orient2d_line_line(a, b, point2{1, 0}, point2{2, 1}, c, d), zero);
    EXPECT_EQ(errbound::compare_x_line_line(a, b, c, d, a, b, c, point2{4, 0}), negative);
    EXPECT_EQ(errbound::compare_x_line_line(a, b, c, d, point2{1, 5}, point2{1, 7}, c, b), zero);
    const point3 p{1, 1, -3}, q{1, 1, 9}, r{0, 0, 2}, s{1, 0, 2}, t{0, 1, 2};  // at (1, 1, 2)
    for (const point3& u : {point3{0, 0, 0}, point3{0, 0, 3}, point3{0, 0, 2}})
        EXPECT_EQ(errbound::orient3d_line_plane(p, q, r, s, t, s, t, u),
                  errbound::orient3d(point3{1, 1, 2}, s, t, u));
}

}  // namespace
