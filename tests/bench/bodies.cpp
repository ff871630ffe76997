#include <algorithm>
#include <array>
#include <ccd/bodies/motion.hpp>
#include <ccd/contact.hpp>
#include <ccd/exact.hpp>
#include <ccd/methods/transform.hpp>
#include <cmath>
#include <memory>
#include <random>

#include "tests/bench/sections.hpp"

namespace bench {
namespace {

using position = ccd::point<double>;

/// How a query of two bodies is decided, from cheap to costly.
enum class family { boxes, axes, plane, contact };
constexpr std::string_view family_names[] = {"boxes", "axes", "plane", "contact"};

/// The motions of two bodies. Some queries share them.
using two_motions = std::array<ccd::prepared_motion, 2>;

template <template <class> class Bodies, class Linear>
struct query_pair {
    std::shared_ptr<const two_motions> motions;
    std::array<position, 4> rest;
    Linear linear;  ///< between the same ends, rounded

    const ccd::prepared_motion& motion_of(std::size_t i) const {
        return (*motions)[i < ccd::kind_traits<ccd::kind_of<Linear>>::first_vertices ? 0 : 1];
    }
    Bodies<ccd::body_point> bodies() const {
        const auto at = [&](std::size_t i) {
            return ccd::body_point{&motion_of(i).motion(), rest[i]};
        };
        return {at(0), at(1), at(2), at(3)};
    }
    Bodies<ccd::body_point> prepared() const {
        const auto at = [&](std::size_t i) { return motion_of(i).at(rest[i]); };
        return {at(0), at(1), at(2), at(3)};
    }
};

position operator-(const position& a, const position& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
double determinant(const position& a, const position& b, const position& c) {
    return a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) +
           a.z * (b.x * c.y - b.y * c.x);
}

/// Draws elements with edges of about 1 that move by about 1 and turn by at most `angle`, 16 in a
/// row with the same motions.
class drawn_queries {
  public:
    explicit drawn_queries(double angle) : angle_(angle) {}

    template <class Query>
    Query next() {
        if (drawn_++ % 16 == 0)
            motions_ = std::make_shared<two_motions>(
                two_motions{ccd::prepared_motion(motion()), ccd::prepared_motion(motion())});
        Query q;
        q.motions = motions_;
        for (auto& x : q.rest) x = point(0.6);
        return q;
    }
    static position moved(const ccd::body_motion& motion, const position& x, bool end) {
        const auto& m = std::get<ccd::rigid_motion>(motion);
        const ccd::quaternion& q = end ? m.q1 : m.q0;
        const position& p = end ? m.p1 : m.p0;
        const double n = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
        // x + 2u × (u × x + w x) for the quaternion (w, u).
        const position u{q.x, q.y, q.z};
        const auto cross = [](const position& a, const position& b) -> position {
            return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
        };
        const position c = cross(u, x),
                       d = cross(u, {c.x + q.w * x.x, c.y + q.w * x.y, c.z + q.w * x.z});
        return {x.x + 2 * d.x / n + p.x, x.y + 2 * d.y / n + p.y, x.z + 2 * d.z / n + p.z};
    }

  private:
    position point(double most) {
        return {most * number_(random_), most * number_(random_), most * number_(random_)};
    }
    ccd::body_motion motion() {
        const position axis = point(1), p0 = point(1);
        const double length = std::hypot(axis.x, axis.y, axis.z),
                     half = angle_ / 2 * number_(random_), s = std::sin(half) / length;
        const position way = point(0.4), p1{p0.x + way.x, p0.y + way.y, p0.z + way.z};
        return ccd::rigid_motion{
            {}, {std::cos(half), s * axis.x, s * axis.y, s * axis.z}, p0, p1, {}};
    }

    double angle_;
    std::size_t drawn_ = 0;
    std::shared_ptr<const two_motions> motions_;
    std::mt19937 random_{1};
    std::uniform_real_distribution<double> number_{-1, 1};
};

/// The family of a query by its linear motion, or `contact` if the bodies touch.
template <class Query>
family family_of(const Query& q) {
    if (ccd::decide_exact(q.bodies()).outcome == ccd::outcome::collides) return family::contact;
    const auto points = points_of(q.linear);
    constexpr std::size_t first =
        ccd::kind_traits<ccd::kind_of<decltype(q.linear)>>::first_vertices;
    for (const auto axis : {&position::x, &position::y, &position::z}) {
        std::array<double, 2> low{9, 9}, high{-9, -9};
        for (std::size_t i = 0; i < points.size(); ++i)
            for (const position& x : {points[i].t0, points[i].t1}) {
                low[i < first ? 0 : 1] = std::min(low[i < first ? 0 : 1], x.*axis);
                high[i < first ? 0 : 1] = std::max(high[i < first ? 0 : 1], x.*axis);
            }
        if (low[0] > high[1] + 0.05 || low[1] > high[0] + 0.05) return family::boxes;
    }
    const auto side = [&](auto end) {
        const auto x = [&](std::size_t i) { return points[i].*end; };
        return determinant(x(1) - x(0), x(2) - x(0), x(3) - x(0)) > 0;
    };
    using moving = ccd::moving_point<double>;
    return side(&moving::t0) != side(&moving::t1) ? family::plane : family::axes;
}

template <template <class> class Bodies, template <class> class Linear>
void add_rows(std::string_view kind, double angle, const options& o, rows& all) {
    using drawn = query_pair<Bodies, Linear<double>>;
    const std::size_t count = o.quick ? 100 : 1'000;
    std::array<std::vector<drawn>, std::size(family_names)> families;
    drawn_queries draw(angle);
    const auto is_full = [&](const auto& f) { return f.size() == count; };
    while (!std::ranges::all_of(families, is_full)) {
        auto q = draw.template next<drawn>();
        const auto at = [&](std::size_t i) -> ccd::moving_point<double> {
            const auto& motion = q.motion_of(i).motion();
            return {draw.moved(motion, q.rest[i], false), draw.moved(motion, q.rest[i], true)};
        };
        q.linear = {at(0), at(1), at(2), at(3)};
        auto& family = families[static_cast<std::size_t>(family_of(q))];
        if (!is_full(family)) family.push_back(q);
    }
    for (std::size_t f = 0; f < families.size(); ++f) {
        const auto& queries = families[f];
        const auto each = [&](const auto& decide) {
            return [&queries, decide] {
                for (const drawn& q : queries) keep(decide(q));
            };
        };
        const auto timings =
            race({each([](const drawn& q) { return ccd::decide_exact(q.linear); }),
                  each([](const drawn& q) { return ccd::decide_exact(q.bodies()); }),
                  each([](const drawn& q) { return ccd::decide_exact(q.prepared()); }),
                  each([](const drawn& q) { return ccd::time_of_impact(q.linear); }),
                  each([](const drawn& q) { return ccd::time_of_impact(q.bodies()); })},
                 o.repeats());
        const auto columns = [&](const std::string& name, const timing& t) {
            all.back()[name + "_ns"] = t.ns(count);
            all.back()[name + "_median"] = t.median_ns(count);
        };
        all.push_back({{"kind", kind}, {"rad", angle}, {"decided_by", family_names[f]}});
        columns("linear", timings[0]);
        columns("bodies", timings[1]);
        all.back()["ratio"] = timings[1].minimum / timings[0].minimum;
        columns("prepared", timings[2]);
        all.back()["prepared_ratio"] = timings[2].minimum / timings[0].minimum;
        columns("toi_linear", timings[3]);
        columns("toi_bodies", timings[4]);
    }
}

}  // namespace

void bodies(const options& o, report& out) {
    rows all;
    for (const double angle : {0.0, 0.1}) {
        add_rows<ccd::vertex_face_of, ccd::vertex_face>("vf", angle, o, all);
        add_rows<ccd::edge_edge_of, ccd::edge_edge>("ee", angle, o, all);
    }
    out.table("bodies", {},
              "Queries of two bodies that turn by at most `rad`, next to linear motion", all);
}

}  // namespace bench
