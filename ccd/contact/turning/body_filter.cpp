#include "ccd/contact/turning/body_filter.hpp"

#include <algorithm>
#include <ccd/methods/forms.hpp>
#include <cmath>
#include <errbound/bernstein.hpp>
#include <optional>
#include <tuple>
#include <variant>

#include "ccd/contact/moving_points.hpp"
#include "ccd/contact/separation_filter.hpp"
#include "ccd/contact/turning/rigid_forms.hpp"
#include "ccd/exact/coordinate_axes.hpp"
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

constexpr int halvings = 1;  ///< more cost more than the signs of Y and the G_i

double largest_of(const vector& p) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}
double sum_of(const vector& p) {
    return std::abs(p.x) + std::abs(p.y) + std::abs(p.z);
}

}  // namespace

std::optional<rigid_motion> as_rigid(const body_motion& motion) {
    if (const auto* rigid = std::get_if<rigid_motion>(&motion)) return *rigid;
    const auto* affine = std::get_if<affine_motion>(&motion);
    if (affine == nullptr) return rigid_motion{};
    if (affine->a0 != identity3 || affine->a1 != identity3) return {};
    return rigid_motion{{}, {}, affine->p0, affine->p1, {}};
}

/// Features whose chords stay farther apart than the distance plus both errors are separate: their
/// points are that near to the chords at each time. 1 + 2^-40 covers the rounding of the sum.
template <kind K>
bool body_filter<K>::separated(double distance) const {
    std::array<moving_point<double>, count> chords;
    double sum = 0;
    // Returns the error of a feature's chords.
    const auto add = [&](const motion_chords& motion, std::size_t from, std::size_t to) {
        double length = 0;
        for (std::size_t i = from; i < to; ++i) {
            const vector y = points_[i].rest - motion.centre;
            chords[i] = motion.ends_of(y);
            length = std::max(length, sum_of(y));
            sum += sum_of(y);
        }
        return motion.error_of(length);
    };
    const double errors = add(a_, 0, first) + add(b_, first, count);
    const double gap = distance * (1 + 0x1p-40) + errors;
    // False also if a coordinate is not finite. Otherwise no coordinate of a chord overflows, since
    // errors are at least 2^-46 of them.
    if (!(gap + sum < 0x1p900)) return false;
    static_assert(sizeof(chords) == 6 * count * sizeof(double));
    if (baseline::packs_separated_by_coordinates<K>(reinterpret_cast<const double*>(chords.data()),
                                                    gap))
        return true;
    using query = typename kind_traits<K>::template query<double>;
    const auto linear = std::apply([](const auto&... x) { return query{x...}; }, chords);
    return separation_filter::features(linear, {gap, 0}).stay_apart(halvings);
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
        // Any centre serves a body at rest: x = (x − centre) + centre.
        const auto start = [](const motion_chords& body, const vector& rest) {
            return body.motion == motion_chords::motion_kind::rests
                       ? std::tuple{vector{}, rest, rest}
                       : std::tuple{rest - body.centre,
                                    vector{body.shift[0], body.shift[1], body.shift[2]},
                                    vector{body.shift[3], body.shift[4], body.shift[5]}};
        };
        const auto [of_a, a0, a1] = start(query.a_, points[0].rest);
        const auto [of_b, b0, b1] = start(query.b_, points[first].rest);
        x = of_a;
        y = of_b;
        e = K == kind::vertex_face ? edge(1, 2) : edge(0, 1);
        f = K == kind::vertex_face ? edge(1, 3) : edge(2, 3);
        d = {a0 - b0, a1 - b1};
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
        using motion = motion_chords::motion_kind;
        const elements query(*this);
        if (a_.motion != motion::turns && b_.motion != motion::turns) {
            const auto ends = [](const motion_chords& body) {
                std::array<matrix3, 2> at;
                for (std::size_t i = 0; i < 3; ++i)
                    for (std::size_t j = 0; j < 3; ++j) {
                        at[0][i][j] = body.column[j][i];
                        at[1][i][j] = body.column[j][3 + i];
                    }
                return at;
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
        const auto quaternions = [](const motion_chords& body) {
            if (body.motion == motion::turns) return linear_of(body.q[0], body.q[1]);
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

template class body_filter<kind::vertex_face>;
template class body_filter<kind::edge_edge>;
template class body_filter<kind::vertex_edge>;
template class body_filter<kind::vertex_vertex>;

}  // namespace ccd::detail
