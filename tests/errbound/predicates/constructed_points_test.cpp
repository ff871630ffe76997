// Constructed points as arguments, compared with the predicates at rational points.
#include <errbound/predicates/constructed_points.hpp>
#include <optional>
#include <vector>

#include "tests/errbound/predicates/predicate_check.hpp"

namespace {

using namespace predicate_check;
using errbound::given;
using errbound::line_line;
using errbound::line_plane;
using errbound::three_planes;
using errbound::weighted_midpoint;

/// A fraction that is not reduced, since reductions of long numbers take most of the time.
class exact_number {
  public:
    exact_number(int n) : n_(n), d_(1) {}
    exact_number(big_integer n, big_integer d) : n_(std::move(n)), d_(std::move(d)) {}

    friend exact_number operator+(const exact_number& x, const exact_number& y) {
        if (!(x.d_ < y.d_) && !(y.d_ < x.d_)) return {x.n_ + y.n_, x.d_};
        return {x.n_ * y.d_ + y.n_ * x.d_, x.d_ * y.d_};
    }
    friend exact_number operator-(const exact_number& x, const exact_number& y) { return x + -y; }
    friend exact_number operator*(const exact_number& x, const exact_number& y) {
        return {x.n_ * y.n_, x.d_ * y.d_};
    }
    friend exact_number operator/(const exact_number& x, const exact_number& y) {
        return {x.n_ * y.d_, x.d_ * y.n_};
    }
    exact_number operator-() const { return {-n_, d_}; }
    friend sign_type sign_of(const exact_number& x) {
        return static_cast<sign_type>(1 + sign(x.n_) * sign(x.d_));
    }
    friend bool operator==(const exact_number& x, const exact_number& y) {
        return sign_of(x - y) == sign_type::zero;
    }

  private:
    big_integer n_, d_;
};
using exact_point = std::vector<exact_number>;

exact_point exact_of(const double* p, int dimension, int unit, const big_integer& one) {
    exact_point q;
    for (int k = 0; k < (dimension == 0 ? 1 : dimension); ++k)
        q.emplace_back(big_integer(p[k], unit), one);
    return q;
}
exact_point along(const exact_point& a, const exact_point& b, const exact_number& t) {
    exact_point p;
    for (std::size_t k = 0; k < a.size(); ++k) p.push_back(a[k] + t * (b[k] - a[k]));
    return p;
}
exact_number area_of(const exact_point& a, const exact_point& b, const exact_point& c) {
    return (a[0] * b[1] - a[1] * b[0]) + (b[0] * c[1] - b[1] * c[0]) + (c[0] * a[1] - c[1] * a[0]);
}
/// The coefficients of n·x = d, last d.
std::vector<exact_number> plane_of(const exact_point& p, const exact_point& q,
                                   const exact_point& r) {
    const auto minor = [&](std::size_t i, std::size_t j) {
        return area_of({p[i], p[j]}, {q[i], q[j]}, {r[i], r[j]});
    };
    const exact_number x = minor(1, 2), y = minor(2, 0), z = minor(0, 1);
    return {x, y, z, x * p[0] + y * p[1] + z * p[2]};
}
exact_number determinant(const std::vector<std::vector<exact_number>>& m) {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/// The point by division; nothing if it does not exist.
template <class Construction>
std::optional<exact_point> constructed_at(const std::vector<exact_point>& p) {
    if constexpr (std::is_same_v<Construction, given>) {
        return p[0];
    } else if constexpr (std::is_same_v<Construction, line_line>) {
        const exact_number at_a = area_of(p[2], p[3], p[0]), at_b = area_of(p[2], p[3], p[1]);
        if (at_a == at_b) return std::nullopt;
        return along(p[0], p[1], at_a / (at_a - at_b));
    } else if constexpr (std::is_same_v<Construction, line_plane>) {
        const auto n = plane_of(p[2], p[3], p[4]);
        const auto at = [&](const exact_point& x) {
            return exact_number(n[0] * x[0] + n[1] * x[1] + n[2] * x[2] - n[3]);
        };
        const exact_number at_a = at(p[0]), at_b = at(p[1]);
        if (at_a == at_b) return std::nullopt;
        return along(p[0], p[1], at_a / (at_a - at_b));
    } else if constexpr (std::is_same_v<Construction, three_planes>) {
        std::vector<std::vector<exact_number>> planes;
        for (std::size_t i = 0; i < 9; i += 3) planes.push_back(plane_of(p[i], p[i + 1], p[i + 2]));
        const auto with_column = [&](std::size_t replaced) {
            auto m = planes;
            if (replaced < 3)
                for (auto& row : m) row[replaced] = row[3];
            return determinant(m);
        };
        const exact_number w = with_column(3);
        if (w == 0) return std::nullopt;
        return exact_point{with_column(0) / w, with_column(1) / w, with_column(2) / w};
    } else {
        const exact_number w = p[2][0] + p[3][0];
        if (w == 0) return std::nullopt;
        return along(p[0], p[1], p[3][0] / w);
    }
}

/// The sign of the predicate's own expression at exact points. The unit may be any if no terms of
/// different degree are added.
template <class... Arguments, class Shape, class F, class Options, std::size_t... I>
sign_type right_sign(const errbound::predicate_type<Shape, F, Options>&, const double* list,
                     int unit, const big_integer& one, std::index_sequence<I...>) {
    using expression = errbound::filters::constructed_expression<Shape, F, Arguments...>;
    using shape = typename expression::shape;
    const auto argument = [&]<std::size_t Index, class Construction>() {
        std::vector<exact_point> parents;
        for (std::size_t k = 0; k < expression::all::sizes[Index]; ++k) {
            const std::size_t at = expression::first(Index) + k;
            parents.push_back(exact_of(list + shape::offset(at), shape::dimensions[at], unit, one));
        }
        return constructed_at<Construction>(parents);
    };
    const std::array points{argument.template operator()<I, Arguments>()...};
    for (const auto& p : points)
        if (!p) return sign_type::zero;
    const auto result = F()((*points[I])...);
    if constexpr (std::is_same_v<decltype(result), const sign_type>)
        return result;
    else
        return sign_of(result);
}

void expect_all_stages(const char* name, int all, int zeros,
                       const errbound::predicate_report& report) {
    const auto filtered = report[predicate_stage::static_filter];
    const auto exact = report[predicate_stage::long_integers];
    std::printf("%s: %d inputs, %d zero; static filter %llu, long %llu\n", name, all, zeros,
                static_cast<unsigned long long>(filtered), static_cast<unsigned long long>(exact));
    EXPECT_GT(zeros, all / 50);
    EXPECT_GT(filtered, 0U);
    EXPECT_GT(exact, 0U);
}

/// Few different points, at times in one plane.
void set_few_points(auto& points, predicate_inputs::generator& random) {
    const int most = predicate_inputs::between(random, 1, 4);
    for (auto& point : points)
        for (double& x : point) x = predicate_inputs::between(random, 0, most);
}

/// Compares signs as a call, by each stage, and as a predicate of all parents.
template <class... Arguments, class Predicate>
void compare_constructed(const char* name, const Predicate& predicate) {
    const auto over_parents = errbound::with_constructed<Arguments...>(predicate);
    using shape = typename std::remove_const_t<decltype(over_parents)>::shape;
    constexpr std::size_t D = std::size_t{shape::dimensions[0]}, N = shape::count;
    predicate_inputs::generator random(9);
    errbound::predicate_report report;
    int zeros = 0, all = 0;
    // Squares have 4 corners, cubes have 8.
    for (const surface s :
         {surface::concurrent, surface::flat, N > 1U << D ? surface::flat : surface::round})
        for (const auto& family : predicate_inputs::families<double, D, N>)
            for (int i = 0; i < std::max(support::scaled(24), 4); ++i, ++all) {
                auto p = family.make(random, s);
                if (random() % 8 == 0) set_few_points(p, random);
                std::array<double, shape::size> list;
                for (std::size_t k = 0; k < N; ++k)
                    for (std::size_t j = 0; j < (shape::dimensions[k] == 0 ? 1U : D); ++j)
                        list[shape::offset(k) + j] = p[k][j];
                const int last = predicate_oracle::common_unit(p);
                const int unit = predicate.counts.mixed ? std::min(last, 0) : last;
                const sign_type right = right_sign<Arguments...>(
                    predicate, list.data(), unit,
                    predicate.counts.mixed ? big_integer(1.0, unit) : big_integer(1),
                    std::index_sequence_for<Arguments...>());
                zeros += right == sign_type::zero;
                const auto parent = [&]<std::size_t K>() {
                    if constexpr (shape::dimensions[K] == 0)
                        return list[shape::offset(K)];
                    else
                        return std::span<const double, D>(list.data() + shape::offset(K), D);
                };
                [&]<std::size_t... K>(std::index_sequence<K...>) {
                    ASSERT_EQ(over_parents(report, parent.template operator()<K>()...), right)
                        << name << ", " << family.name << predicate_inputs::text_of(p);
                    for (std::size_t k = 0; k < errbound::predicate_stage_count; ++k) {
                        const sign_type found = over_parents.by(static_cast<predicate_stage>(k),
                                                                parent.template operator()<K>()...);
                        ASSERT_TRUE(found == right || found == sign_type::uncertain)
                            << name << ", " << family.name << ", stage " << k
                            << predicate_inputs::text_of(p);
                    }
                }
                (std::make_index_sequence<N>());
                if (testing::Test::HasFatalFailure()) return;
            }
    expect_all_stages(name, all, zeros, report);
}

TEST(ConstructedPoints, InThePlane) {
    compare_constructed<line_line, given, given>("orient2d", errbound::orient2d);
    compare_constructed<given, line_line, line_line>("orient2d of two", errbound::orient2d);
    compare_constructed<weighted_midpoint<2>, given, line_line>("orient2d with midpoint",
                                                                errbound::orient2d);
    compare_constructed<line_line, line_line, given>("distances", errbound::compare_distances2d);
    compare_constructed<given, given, line_line, given>("incircle", errbound::incircle);
    compare_constructed<given, given, given, line_line>("incircle, inside", errbound::incircle);
}
TEST(ConstructedPoints, InPredicatesThatBranch) {
    compare_constructed<line_line, given, given, given>("segments", errbound::segments_intersect2d);
}
TEST(ConstructedPoints, InSpace) {
    compare_constructed<line_plane, given, given, given>("orient3d", errbound::orient3d);
    compare_constructed<given, weighted_midpoint<3>, given, line_plane>("orient3d of two",
                                                                        errbound::orient3d);
    compare_constructed<given, given, given, three_planes>("orient3d, planes", errbound::orient3d);
    compare_constructed<given, given, given, given, line_plane>("insphere", errbound::insphere);
}

// Mixed degrees and constants.
constexpr auto above_parabola =
    errbound::predicate<errbound::points<2, 2>>([](const auto& p, const auto& q) {
        return (3 * p[1] - 1) - 2 * (p[0] * p[0]) + (1 - q[0]) * (p[0] + q[1]) - (-p[0] + 1);
    });
TEST(ConstructedPoints, InCustomPredicates) {
    compare_constructed<line_line, given>("parabola", above_parabola);
    compare_constructed<line_line, weighted_midpoint<2>>("parabola of two", above_parabola);
}

// Parents are constructed, or other arguments are.
constexpr auto determinant_of_two = errbound::predicate<errbound::points<2, 2>>(
    [](const auto& p, const auto& q) { return p[0] * q[1] - p[1] * q[0]; });
TEST(ConstructedPoints, OfConstructedPoints) {
    using errbound::with_constructed;
    compare_constructed<given, given, given, given, line_line>(
        "determinant", with_constructed<line_line, given>(determinant_of_two));
    compare_constructed<given, weighted_midpoint<2>, given, given, line_line>(
        "parabola", with_constructed<line_line, given>(above_parabola));
    const auto with_two = with_constructed<line_line, given, given>(errbound::orient2d);
    compare_constructed<given, given, line_line, given, weighted_midpoint<2>, given>("orient2d",
                                                                                     with_two);
}

TEST(ConstructedPoints, AsArguments) {
    using enum sign_type;
    const point2 a{0, 0}, b{3, 3}, c{0, 2}, d{2, 0};  // the lines meet at (1, 1)
    const auto i = errbound::line_line_point(a, b, c, d);
    EXPECT_EQ(errbound::orient2d(i, point2{5, 1}, point2{9, 1}), zero);
    EXPECT_EQ(errbound::orient2d(point2{5, 1}, i, point2{5, 0}), positive);
    EXPECT_EQ(errbound::incircle(point2{0, 0}, point2{2, 0}, point2{2, 2}, i), positive);
    EXPECT_EQ(errbound::incircle(point2{1, 0}, point2{2, 1}, point2{1, 2}, i), positive);
    EXPECT_EQ(errbound::incircle(point2{0, 0}, point2{1, 0}, point2{0, 1}, i), zero);
    EXPECT_EQ(errbound::orient2d(errbound::line_line_point(a, b, b, a), c, d), zero);
    const auto m = errbound::weighted_midpoint_of<2>(a, point2{4, 4}, 3.0, 1.0);  // (1, 1) too
    EXPECT_EQ(errbound::compare_distances2d(point2{7, -5}, m, i), zero);
    EXPECT_EQ(errbound::compare_distances2d(m, i, a), negative);
    const auto j =
        errbound::line_line_point(i, point2{3, 1}, point2{2, 0}, point2{2, 5});  // (2, 1)
    EXPECT_EQ(errbound::orient2d(j, i, point2{7, 1}), zero);
    EXPECT_EQ(errbound::orient2d(j, i, a), positive);
    errbound::predicate_report report;
    EXPECT_EQ(errbound::orient2d(report, i, i, i), zero);
    const auto of_arrays = [] {
        const double p[] = {0, 0}, q[] = {1, 1}, r[] = {0, 2}, s[] = {2, 0};
        return errbound::line_line_point(p, q, r, s);
    };
    EXPECT_EQ(errbound::orient2d(of_arrays(), point2{5, 1}, point2{9, 2}), positive);
    static_assert(errbound::orient2d(errbound::line_line_point(point2{0, 0}, point2{1, 1},
                                                               point2{0, 2}, point2{2, 0}),
                                     point2{5, 1}, point2{9, 2}) == positive);
    // The existing predicates for parents have the same filters.
    EXPECT_EQ(
        (errbound::with_constructed<line_line, given, given>(errbound::orient2d).counts.roundings),
        errbound::orient2d_line_line.counts.roundings);
    const point3 p{1, 1, -3}, q{1, 1, 9}, r{0, 0, 2}, s{1, 0, 2}, t{0, 1, 2};
    EXPECT_EQ(errbound::orient3d(errbound::line_plane_point(p, q, r, s, t), r, s, t), zero);
    EXPECT_EQ(errbound::orient3d(errbound::three_planes_point(
                                     point3{1, 0, 0}, point3{1, 1, 0}, point3{1, 0, 1},
                                     point3{0, 1, 0}, point3{1, 1, 0}, point3{0, 1, 1}, r, s, t),
                                 p, q, r),
              zero);
}

}  // namespace
