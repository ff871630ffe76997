// The oracle's decision of contact. Contact at one instant depends on signs of polynomials in t.
// Tarski queries give those signs at any algebraic instant.
//
// Completeness: "the features share a point at t" depends only on the signs at t of a finite list
// of polynomials. So it is constant between adjacent roots of the list's nonzero members. The
// instants of contact form a closed set, so contact on such an open stretch implies contact at its
// ends. Hence it suffices to test the roots in an interval and those of its ends that belong to it.
// If there are neither, the answer is constant, and the middle suffices. If a nonzero polynomial
// vanishes at every contact, its roots suffice.
#include "tests/support/oracle.hpp"

#include <algorithm>
#include <array>
#include <ccd/methods/transform.hpp>
#include <cstddef>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/support/instants.hpp"
#include "tests/support/whole_points.hpp"

namespace oracle {
namespace {

using namespace detail;

// True if `contact` holds at some instant of the stretch. All of `vanishing` are zero at a contact;
// `all` are the polynomials whose signs determine it.
template <class Contact>
bool contact_somewhere(const stretch& when, std::span<const polynomial> vanishing,
                       std::span<const polynomial> all, const Contact& contact) {
    const auto nonzero = std::ranges::find_if(vanishing, [](const auto& p) { return !p.empty(); });
    if (nonzero != vanishing.end()) return holds_somewhere(when, {&*nonzero, 1}, contact);
    return holds_somewhere(when, all, contact);
}

// ---- Contact at one instant ----

// True if the point at w from one end of the closed segment e is on that segment. A point of its
// line is on it if and only if w and w - e do not point the same way; this includes e = 0.
struct on_segment {
    vector line;
    polynomial between;

    on_segment(const vector& w, const vector& e) : line(cross(w, e)), between(dot(w, w - e)) {}

    bool operator()(const instant& t) const {
        return std::all_of(line.begin(), line.end(),
                           [&](const polynomial& p) { return t.sign(p) == 0; }) &&
               t.sign(between) <= 0;
    }

    void append_to(std::vector<polynomial>& list) const {
        list.insert(list.end(), line.begin(), line.end());
        list.push_back(between);
    }
};

// Decides contact of coplanar features. If `normal` is nonzero at an instant, a coordinate in which
// it is nonzero is dropped. Then each of `weights` divided by `normal` in that coordinate must be
// at least 0 in the plane. If the normal vanishes, one of `segments` must hold.
struct planar_features {
    vector normal;
    std::vector<vector> weights;
    std::vector<on_segment> segments;

    bool touch(const instant& t) const {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const int side = t.sign(normal[axis]);
            if (side == 0) continue;
            return std::all_of(weights.begin(), weights.end(),
                               [&](const vector& w) { return side * t.sign(w[axis]) >= 0; });
        }
        return std::any_of(segments.begin(), segments.end(),
                           [&](const on_segment& touches) { return touches(t); });
    }

    std::vector<polynomial> all() const {
        std::vector<polynomial> list{normal.begin(), normal.end()};
        for (const vector& w : weights) list.insert(list.end(), w.begin(), w.end());
        for (const on_segment& segment : segments) segment.append_to(list);
        return list;
    }
};

// True if there is contact in the stretch of features that are coplanar where `volume` is 0. Calls
// `make_features()` only if they are coplanar at some instant.
template <class MakeFeatures>
bool planar_contact(const stretch& when, const polynomial& volume,
                    const MakeFeatures& make_features) {
    std::optional<planar_features> features;
    const auto made = [&]() -> const planar_features& {
        if (!features) features = make_features();
        return *features;
    };
    const auto contact = [&](const instant& t) { return t.sign(volume) == 0 && made().touch(t); };
    if (!volume.empty()) return holds_somewhere(when, {&volume, 1}, contact);
    return holds_somewhere(when, made().all(), contact);
}

// True if the interval is empty, or if boxes of control points, which contain the swept features,
// are disjoint. Comparisons of doubles are exact.
template <std::size_t count>
bool separate_at_once(const std::array<ccd::curve, count>& points, std::size_t first, shortcuts use,
                      const interval& when) {
    if (is_empty(when)) return true;
    if (use == shortcuts::off) return false;
    const auto range = [&](std::size_t from, std::size_t to, double ccd::point<double>::*axis) {
        double low = points[from].front().*axis, high = low;
        for (std::size_t i = from; i < to; ++i) {
            for (const ccd::point<double>& c : points[i]) {
                low = std::min(low, c.*axis);
                high = std::max(high, c.*axis);
            }
        }
        return std::pair{low, high};
    };
    return std::ranges::any_of(axes, [&](double ccd::point<double>::*axis) {
        const auto [low_a, high_a] = range(0, first, axis);
        const auto [low_b, high_b] = range(first, count, axis);
        return high_a < low_b || high_b < low_a;
    });
}

// The points with a separate unit for each axis. Stretching an axis moves no point into or out of a
// segment or a triangle.
template <std::size_t count>
std::array<vector, count> place(const std::array<ccd::curve, count>& points) {
    return in_units(points, {unit_of(points, 0), unit_of(points, 1), unit_of(points, 2)});
}

}  // namespace

namespace detail {

bool collides_of(const ccd::vertex_face_of<vector>& q, const stretch& when) {
    const vector e1 = q.f1 - q.f0;
    const vector e2 = q.f2 - q.f0;
    const vector e12 = q.f2 - q.f1;
    const vector w0 = q.v - q.f0;
    const vector w1 = q.v - q.f1;
    const vector normal = cross(e1, e2);
    return planar_contact(when, dot(normal, w0), [&] {
        return planar_features{normal,
                               {cross(e1, w0), cross(w0, e2), cross(e12, w1)},
                               {on_segment(w0, e1), on_segment(w0, e2), on_segment(w1, e12)}};
    });
}

bool collides_of(const ccd::edge_edge_of<vector>& q, const stretch& when) {
    const vector a = q.a1 - q.a0;
    const vector b = q.b1 - q.b0;
    const vector w = q.b0 - q.a0;
    const vector w00 = q.a0 - q.b0;
    const vector w01 = q.b1 - q.a0;
    const vector w10 = q.a1 - q.b0;
    const vector normal = cross(a, b);
    return planar_contact(when, dot(normal, w), [&] {
        // a0 + s a = b0 + u b, crossed with b and with a: s normal = w x b and u normal = w x a.
        const vector s = cross(w, b);
        const vector u = cross(w, a);
        return planar_features{
            normal,
            {s, normal - s, u, normal - u},
            {on_segment(w, a), on_segment(w01, a), on_segment(w00, b), on_segment(w10, b)}};
    });
}

bool collides_of(const ccd::vertex_edge_of<vector>& q, const stretch& when) {
    const on_segment touches(q.v - q.e0, q.e1 - q.e0);
    return contact_somewhere(when, touches.line, {&touches.between, 1}, touches);
}

bool collides_of(const ccd::vertex_vertex_of<vector>& q, const stretch& when) {
    const vector gap = q.v - q.w;
    return contact_somewhere(when, gap, {}, [&](const instant& t) {
        return std::ranges::all_of(gap, [&](const polynomial& p) { return t.sign(p) == 0; });
    });
}

}  // namespace detail

template <template <class> class Query>
bool collides(const Query<ccd::curve>& query, shortcuts use, const interval& when) {
    const auto points = ccd::points_of(query);
    constexpr auto first = ccd::kind_traits<ccd::kind_of<Query<ccd::curve>>>::first_vertices;
    if (separate_at_once(points, first, use, when)) return false;
    return std::apply(
        [&](const auto&... p) { return collides_of(Query<vector>{p...}, stretch_of(when)); },
        place(points));
}
template bool collides(const ccd::vertex_face_curves&, shortcuts, const interval&);
template bool collides(const ccd::edge_edge_curves&, shortcuts, const interval&);
template bool collides(const ccd::vertex_edge_curves&, shortcuts, const interval&);
template bool collides(const ccd::vertex_vertex_curves&, shortcuts, const interval&);

}  // namespace oracle
