#include "ccd/contact/turning/body_filter.hpp"

#include <algorithm>
#include <ccd/methods/forms.hpp>
#include <cmath>
#include <errbound/bernstein.hpp>
#include <limits>

#include "ccd/contact/moving_points.hpp"
#include "ccd/contact/separation_filter.hpp"
#include "ccd/contact/turning/rigid_forms.hpp"
#include "ccd/exact/static_filter/subdivision.hpp"

namespace ccd::detail {
namespace {

using errbound::bernstein;
using errbound::filters::error_count;
using errbound::roots::control_values_of;
using separation_filter::operator+;
using separation_filter::operator-;
using separation_filter::operator*;
using vector = point<double>;

double largest_of(const vector& p) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}
double sum_of(const vector& p) {
    return std::abs(p.x) + std::abs(p.y) + std::abs(p.z);
}

vector transformed(const matrix3& m, const vector& x) {
    return {m[0][0] * x.x + m[0][1] * x.y + m[0][2] * x.z,
            m[1][0] * x.x + m[1][1] * x.y + m[1][2] * x.z,
            m[2][0] * x.x + m[2][1] * x.y + m[2][2] * x.z};
}

/// The control points of one feature.
template <std::size_t N>
struct control_points {
    std::size_t count;
    std::array<std::array<vector, N>, 4> at;

    control_points(const control_maps& maps, const vector* from_centre,
                   const std::array<vector, 2>& way)
        : count(maps.count) {
        for (std::size_t j = 0; j < count; ++j) {
            const vector shift = way[0] + maps.along[j] * (way[1] - way[0]);
            for (std::size_t i = 0; i < N; ++i)
                at[j][i] = transformed(maps.linear[j], from_centre[i]) + shift;
        }
    }
    /// Approximates the points at t = 1/2.
    std::array<vector, N> middle() const {
        static constexpr double shares[4][4] = {
            {1}, {1 / 2., 1 / 2.}, {1 / 4., 1 / 2., 1 / 4.}, {1 / 8., 3 / 8., 3 / 8., 1 / 8.}};
        std::array<vector, N> x{};
        for (std::size_t j = 0; j < count; ++j)
            for (std::size_t i = 0; i < N; ++i) x[i] = x[i] + shares[count - 1][j] * at[j][i];
        return x;
    }
    motion_box box() const {
        motion_box b{{at[0][0].x, at[0][0].y, at[0][0].z}, {at[0][0].x, at[0][0].y, at[0][0].z}};
        for (std::size_t j = 0; j < count; ++j)
            for (const vector& x : at[j]) {
                const std::array c{x.x, x.y, x.z};
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    b.low[axis] = std::min(b.low[axis], c[axis]);
                    b.high[axis] = std::max(b.high[axis], c[axis]);
                }
            }
        return b;
    }
    /// The least, or for sign = −1 the negated greatest, projections.
    std::array<double, 4> least_along(const vector& axis, double sign) const {
        std::array<double, 4> least{};
        for (std::size_t j = 0; j < count; ++j) {
            least[j] = sign * separation_filter::dot(axis, at[j][0]);
            for (std::size_t i = 1; i < N; ++i)
                least[j] = std::min(least[j], sign * separation_filter::dot(axis, at[j][i]));
        }
        return least;
    }
};

/// True if for all t the projections of the second feature exceed those of the first by more than
/// `gap`, up to errors: their difference times both weights has positive control values.
bool exceeds(const control_maps& first, const std::array<double, 4>& below,
             const control_maps& second, const std::array<double, 4>& above, double gap) {
    std::array<double, 7> value{};
    for (std::size_t i = 0; i < first.count; ++i)
        for (std::size_t j = 0; j < second.count; ++j)
            value[i + j] += first.weight[i] * second.weight[j] * (above[j] + below[i] - gap);
    double least = value[0];
    for (std::size_t k = 1; k < first.count + second.count - 1; ++k)
        least = std::min(least, value[k]);
    return least > 0;
}

}  // namespace

template <kind K>
bool has_two_bodies(std::span<const body_point> points) {
    constexpr std::size_t first = kind_traits<K>::first_vertices;
    for (std::size_t i = 1; i < points.size(); ++i)
        if (i != first && points[i].motion != points[i - 1].motion) return false;
    return true;
}

template <kind K>
body_filter<K>::body_filter(std::span<const body_point> points, const control_maps& first_maps,
                            const control_maps& second_maps)
    : points_(points), a_(first_maps), b_(second_maps) {
    // Any centre serves a body at rest: x = (x − centre) + centre.
    const auto centre_of = [&](const control_maps& maps, std::size_t i) {
        return maps.motion == control_maps::motion_kind::rests ? points[i].rest : maps.centre;
    };
    const vector a = centre_of(a_, 0), b = centre_of(b_, first);
    for (std::size_t i = 0; i < count; ++i) from_centre_[i] = points[i].rest - (i < first ? a : b);
    const auto way_of = [](const control_maps& maps, const vector& centre) {
        if (maps.motion == control_maps::motion_kind::rests) return std::array{centre, centre};
        return std::array{maps.p0, maps.p1};
    };
    a_way_ = way_of(a_, a);
    b_way_ = way_of(b_, b);
}

/// Let u = 2^-53. The size S has two terms for each feature. One is its body's largest_entry times
/// the largest |x|₁ from the centre. The other is the largest |p|₁ of the centre's way. A
/// coordinate of a control point has an error of at most 30uS. The first terms have 25u from the
/// maps, 1u from the difference `from_centre`, and 3u from products and sums. The second terms have
/// 9u from the shift. The last addition has 1u of both. A projection to an axis of length at
/// most 1.001 multiplies this by at most |axis|₁ <= 1.74, and adds 1.74·3.01uS. Weights with
/// relative errors of 10u each, and the sums of `exceeds`, add at most 1.74(20 + 20)uS. So 2^-45·S,
/// which is 256uS, suffices. Underflow: each of at most 100 operations loses at most 2^-1074
/// divided by weights of at least 2^-84.
template <kind K>
bool body_filter<K>::separated_by_axes(double distance) const {
    if (!a_.usable || !b_.usable) return false;
    const vector origin = b_way_[0];
    const auto shifted = [&](const std::array<vector, 2>& way) {
        return std::array{way[0] - origin, way[1] - origin};
    };
    const auto a_way = shifted(a_way_), b_way = shifted(b_way_);
    const control_points<first> a(a_, from_centre_.data(), a_way);
    const control_points<count - first> b(b_, from_centre_.data() + first, b_way);
    double from_a = 0, from_b = 0;
    for (std::size_t i = 0; i < first; ++i) from_a = std::max(from_a, sum_of(from_centre_[i]));
    for (std::size_t i = first; i < count; ++i) from_b = std::max(from_b, sum_of(from_centre_[i]));
    const double size = a_.largest_entry * from_a + b_.largest_entry * from_b +
                        std::max(sum_of(a_way[0]), sum_of(a_way[1])) + sum_of(b_way[1]);
    if (!(size < 0x1p900)) return false;
    const double gap = distance * (1 + 0x1p-40) + 0x1p-45 * size + 0x1p-500;
    const motion_box of_a = a.box(), of_b = b.box();
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (of_a.low[axis] - of_b.high[axis] > gap || of_b.low[axis] - of_a.high[axis] > gap)
            return true;
    // The direction between the nearest points at t = 1/2, approximately.
    std::array<vector, count> x;
    const auto a_middle = a.middle();
    const auto b_middle = b.middle();
    std::copy(a_middle.begin(), a_middle.end(), x.begin());
    std::copy(b_middle.begin(), b_middle.end(), x.begin() + first);
    const vector between = [&] {
        if constexpr (count == 4)
            return separation_filter::nearest<K>(x);
        else
            return separation_filter::nearest(x);
    }();
    const double length = std::sqrt(separation_filter::dot(between, between));
    if (!(length > 0x1p-400 && length < 0x1p400)) return false;
    const vector axis = (1 / length) * between;
    return exceeds(a_, a.least_along(axis, -1), b_, b.least_along(axis, 1), gap);
}

// ---- Signs of Y and the G_i ----

namespace {

template <class S>
using rows = std::array<triple<S>, 3>;

/// The forms of two bodies whose points move along lines, from their matrices at both ends.
template <kind K, class S>
constexpr linear_forms<K, S> straight_forms(const std::array<rows<S>, 2>& a,
                                            const std::array<rows<S>, 2>& b,
                                            const std::array<triple<S>, 2>& d, const triple<S>& x,
                                            const triple<S>& y, const triple<S>& e,
                                            const triple<S>& f) {
    const auto path = [](const triple<S>& start, const triple<S>& end) -> vector_form<S, 1> {
        return {{{start[0], end[0]}}, {{start[1], end[1]}}, {{start[2], end[2]}}};
    };
    const auto position = [&](std::size_t end) -> triple<S> {
        const triple<S> p = sum(applied(a[end], x), d[end]), q = applied(b[end], y);
        if constexpr (K == kind::vertex_face)
            return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
        else
            return {q[0] - p[0], q[1] - p[1], q[2] - p[2]};
    };
    const auto& of_e = K == kind::vertex_face ? b : a;
    return {path(applied(of_e[0], e), applied(of_e[1], e)),
            path(applied(b[0], f), applied(b[1], f)), path(position(0), position(1))};
}

constexpr error_count difference = error_count::difference();
constexpr triple<error_count> any_difference{difference, difference, difference};

template <kind K>
constexpr auto counted_straight_forms() {
    constexpr error_count exact = error_count::exact();
    constexpr triple<error_count> row{exact, exact, exact};
    constexpr std::array<rows<error_count>, 2> ends{{{row, row, row}, {row, row, row}}};
    return straight_forms<K, error_count>(ends, ends, {any_difference, any_difference},
                                          any_difference, any_difference, any_difference,
                                          any_difference);
}

template <class S>
using rigid_query_of = rigid_query<bernstein<S, 0>, bernstein<S, 1>>;
template <kind K, class S>
using rigid_forms_of = rigid_forms<K, bernstein<S, 0>, bernstein<S, 1>>;

template <class S>
constexpr triple<bernstein<S, 0>> constants_of(const triple<S>& x) {
    return {{{{x[0]}}, {{x[1]}}, {{x[2]}}}};
}
template <class S, std::size_t N>
constexpr auto linear_of(const std::array<S, N>& start, const std::array<S, N>& end) {
    std::array<bernstein<S, 1>, N> r;
    for (std::size_t i = 0; i < N; ++i) r[i] = {{start[i], end[i]}};
    return r;
}

/// Scaled coordinates of quaternions are exact unless they underflow. Their largest is at least
/// 1/2, so this loses far less than the slack in the constants.
template <kind K>
constexpr auto counted_rigid_forms() {
    constexpr error_count one{1, 0, 1};
    constexpr auto q = linear_of<error_count, 4>({one, one, one, one}, {one, one, one, one});
    constexpr auto x = constants_of(any_difference);
    return rigid_forms_of<K, error_count>(
        rigid_query_of<error_count>{{q, q}, linear_of(any_difference, any_difference), x, x, x, x});
}

template <class Forms>
inline constexpr int degree_of_y = std::decay_t<decltype(std::declval<Forms>().y())>::degree;
template <class Forms>
using inside_of = std::decay_t<decltype(std::declval<Forms>().inside())>;
template <class Forms>
inline constexpr int degree_of_g = inside_of<Forms>::value_type::degree;

template <class Forms>
constexpr static_filter::constants<double> y_constants_of(const Forms& counted) {
    using namespace static_filter::detail;
    return static_filter::detail::constants_of<double, degree_of_y<Forms>>(
        worst_of(control_values_of(counted.y())), 3);
}
template <class Forms>
constexpr static_filter::constants<double> g_constants_of(const Forms& counted) {
    using namespace static_filter::detail;
    error_count w;
    for (const auto& g : counted.inside()) w = worst(w, worst_of(control_values_of(g)));
    return static_filter::detail::constants_of<double, degree_of_g<Forms>>(w, 4);
}

struct form_constants {
    static_filter::constants<double> y, g;
};
template <kind K>
constexpr form_constants straight_constants{y_constants_of(counted_straight_forms<K>()),
                                            g_constants_of(counted_straight_forms<K>())};
template <kind K>
constexpr form_constants rigid_constants{y_constants_of(counted_rigid_forms<K>()),
                                         g_constants_of(counted_rigid_forms<K>())};

/// Decides as ccd/exact/stages.hpp. The units are those of the constants' relative errors.
template <class Forms>
outcome decide_forms(const Forms& forms, const form_constants& constants, double y_unit,
                     double g_unit, touching_interval* found) {
    constexpr std::size_t constraints = std::tuple_size_v<inside_of<Forms>>;
    static_filter::part_forms<double, constraints, degree_of_y<Forms>, degree_of_g<Forms>> whole;
    static_filter::form_errors<double> errors;
    const auto error_of = [](double unit, const static_filter::constants<double>& c, double size) {
        return unit * c.relative + c.absolute + size * c.halvings;
    };
    whole.y = control_values_of(forms.y());
    errors.y = error_of(y_unit, constants.y, static_filter::size_of(whole.y));
    if (static_filter::above(whole.y, errors.y) || static_filter::below(whole.y, errors.y))
        return outcome::separate;
    const auto g = forms.inside();
    double largest = 0;
    for (std::size_t i = 0; i < constraints; ++i) {
        whole.g[i] = control_values_of(g[i]);
        largest = std::max(largest, static_filter::size_of(whole.g[i]));
    }
    errors.g = error_of(g_unit, constants.g, largest);
    return static_filter::subdivide_forms(whole, errors, found);
}

triple<double> numbers_of(const vector& p) {
    return {p.x, p.y, p.z};
}

/// Bounds of the components in the forms: of positions, which are at least those of the edges, and
/// of both edges. Each term of Y has one factor of each; each term of a G_i one more of an edge.
struct sizes {
    double position, e, f;

    double y_unit() const { return position * e * f; }
    double g_unit() const { return y_unit() * std::max(e, f); }
    bool usable() const { return position <= static_filter::largest_difference<double>; }
};

}  // namespace

/// The points x and y and the edges e and f of rigid_query, and the ends of d.
template <kind K>
struct body_filter<K>::elements {
    vector x, y, e, f;
    std::array<vector, 2> d;

    explicit elements(const body_filter& query) {
        const auto& points = query.points_;
        const auto edge = [&](std::size_t from, std::size_t to) {
            return points[to].rest - points[from].rest;
        };
        x = query.from_centre_[0];
        y = query.from_centre_[first];
        e = K == kind::vertex_face ? edge(1, 2) : edge(0, 1);
        f = K == kind::vertex_face ? edge(1, 3) : edge(2, 3);
        d = {query.a_way_[0] - query.b_way_[0], query.a_way_[1] - query.b_way_[1]};
    }
    /// Bounds of all components after multiplication by entries of at most a and b.
    sizes size(double a, double b) const {
        sizes s{0, (K == kind::vertex_face ? b : a) * largest_of(e), b * largest_of(f)};
        s.position = std::max(
            {a * largest_of(x), b * largest_of(y), largest_of(d[0]), largest_of(d[1]), s.e, s.f});
        return s;
    }
};

template <kind K>
outcome body_filter<K>::decide(touching_interval* found) const {
    if constexpr (is_cubic(K)) {
        using motion = control_maps::motion_kind;
        const elements query(*this);
        if (a_.motion != motion::turns && b_.motion != motion::turns) {
            const auto ends = [](const control_maps& maps) {
                const auto at = [&](std::size_t end) {
                    return maps.linear[std::min(end, maps.count - 1)];
                };
                return std::array{at(0), at(1)};
            };
            const sizes size = query.size(a_.largest_entry, b_.largest_entry);
            if (!size.usable()) return outcome::uncertain;
            return decide_forms(
                straight_forms<K, double>(ends(a_), ends(b_),
                                          {numbers_of(query.d[0]), numbers_of(query.d[1])},
                                          numbers_of(query.x), numbers_of(query.y),
                                          numbers_of(query.e), numbers_of(query.f)),
                straight_constants<K>, size.y_unit(), size.g_unit(), found);
        }
        if (a_.is_affine || b_.is_affine) return outcome::uncertain;
        const sizes size = query.size(1, 1);
        if (!size.usable()) return outcome::uncertain;
        const auto quaternions = [](const control_maps& maps) {
            if (maps.motion == motion::turns) return linear_of(maps.q[0], maps.q[1]);
            return linear_of<double, 4>({1, 0, 0, 0}, {1, 0, 0, 0});
        };
        const rigid_query_of<double> rigid{
            {quaternions(a_), quaternions(b_)},
            linear_of(numbers_of(query.d[0]), numbers_of(query.d[1])),
            constants_of(numbers_of(query.x)),
            constants_of(numbers_of(query.y)),
            constants_of(numbers_of(query.e)),
            constants_of(numbers_of(query.f))};
        return decide_forms(rigid_forms_of<K, double>(rigid), rigid_constants<K>, size.y_unit(),
                            size.g_unit(), found);
    }
    return outcome::uncertain;
}

template bool has_two_bodies<kind::vertex_face>(std::span<const body_point>);
template bool has_two_bodies<kind::edge_edge>(std::span<const body_point>);
template bool has_two_bodies<kind::vertex_edge>(std::span<const body_point>);
template bool has_two_bodies<kind::vertex_vertex>(std::span<const body_point>);
template class body_filter<kind::vertex_face>;
template class body_filter<kind::edge_edge>;
template class body_filter<kind::vertex_edge>;
template class body_filter<kind::vertex_vertex>;

}  // namespace ccd::detail
