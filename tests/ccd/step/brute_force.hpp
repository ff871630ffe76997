// The expected result of a step, by a test of every pair.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/contact.hpp>
#include <ccd/exact.hpp>
#include <ccd/method.hpp>
#include <ccd/step.hpp>
#include <cstddef>
#include <functional>
#include <iterator>
#include <random>
#include <set>
#include <type_traits>
#include <utility>
#include <vector>

namespace brute_force {

using ccd::vertex_index;
using two_frames = std::pair<ccd::mesh, ccd::mesh>;
using vertex = std::array<vertex_index, 1>;

/// A soup of triangles on a small grid, so that touching boxes and degenerate contacts are
/// frequent.
inline two_frames random_soup(std::uint64_t seed, unsigned vertices, unsigned faces) {
    std::mt19937_64 random(seed);
    const auto coordinate = [&random] { return static_cast<double>(random() % 12); };
    ccd::mesh before;
    for (unsigned i = 0; i < vertices; ++i)
        before.vertices.push_back({coordinate(), coordinate(), coordinate()});
    for (unsigned i = 0; i < faces; ++i) {
        const auto v = static_cast<vertex_index>(random() % (vertices - 2));
        before.faces.push_back({v + 2, v, v + 1});
    }
    ccd::mesh after = before;
    for (auto& p : after.vertices) p = {p.x + coordinate() / 4, p.y - coordinate() / 4, p.z};
    return {before, after};
}

/// A soup with rods among the first vertices, and points. Some edges are faces' edges, some are
/// repeated, in either direction, and some repeat a vertex.
inline two_frames random_mixture(std::uint64_t seed) {
    auto [before, after] = random_soup(seed, 24, 6);
    std::mt19937_64 random(seed);
    const auto coordinate = [&random] { return static_cast<double>(random() % 6); };
    for (unsigned i = 0; i < 8; ++i)
        before.edges.push_back({vertex_index(random() % 24), vertex_index(random() % 24)});
    before.edges.push_back({before.edges[0][1], before.edges[0][0]});
    before.edges.push_back({before.faces[0][0], before.faces[0][1]});
    before.edges.push_back({23, 23});
    after.edges = before.edges;
    for (auto* m : {&before, &after})
        for (unsigned i = 0; i < 12; ++i)
            m->vertices.push_back({coordinate(), coordinate(), coordinate()});
    return {before, after};
}

struct elements {
    std::vector<ccd::face> faces;  ///< the first of each set of vertices
    std::vector<ccd::edge> edges, rods;
    std::vector<vertex> vertices, points;

    explicit elements(const ccd::mesh& m) {
        std::set<ccd::face> seen;
        std::set<ccd::edge> of_faces, all, lone;
        const auto add = [](std::set<ccd::edge>& to, vertex_index v, vertex_index w) {
            if (v != w) to.insert({std::min(v, w), std::max(v, w)});
        };
        for (const ccd::face& f : m.faces) {
            ccd::face sorted = f;
            std::ranges::sort(sorted);
            if (seen.insert(sorted).second) faces.push_back(f);
            for (std::size_t k = 0; k < 3; ++k) add(of_faces, f[k], f[(k + 1) % 3]);
        }
        all = of_faces;
        for (const ccd::edge& e : m.edges) add(all, e[0], e[1]);
        std::ranges::set_difference(all, of_faces, std::back_inserter(rods));
        edges.assign(all.begin(), all.end());
        std::set<vertex_index> on_edges;
        for (const ccd::edge& e : edges) on_edges.insert(e.begin(), e.end());
        for (vertex_index v = 0; v < m.vertices.size(); ++v) {
            vertices.push_back({v});
            if (!on_edges.contains(v)) points.push_back({v});
        }
    }
};

template <std::size_t A, std::size_t B>
bool share_vertex(const std::array<vertex_index, A>& a, const std::array<vertex_index, B>& b) {
    return std::ranges::any_of(a,
                               [&](vertex_index v) { return std::ranges::find(b, v) != b.end(); });
}

inline ccd::vertex_face_pair pair_of(const vertex& v, const ccd::face& f) {
    return {v[0], f[0], f[1], f[2]};
}
inline ccd::edge_edge_pair pair_of(const ccd::edge& a, const ccd::edge& b) {
    return {a[0], a[1], b[0], b[1]};
}
inline ccd::vertex_edge_pair pair_of(const vertex& v, const ccd::edge& e) {
    return {v[0], e[0], e[1]};
}
inline ccd::vertex_vertex_pair pair_of(const vertex& v, const vertex& w) {
    return {v[0], w[0]};
}

/// Calls visit(pair) for every two elements without a common vertex, once if both are of one list.
template <class As, class Bs, class Visit>
void for_each_two(const As& as, const Bs& bs, const Visit& visit) {
    constexpr bool within_one = std::is_same_v<As, Bs>;
    for (std::size_t i = 0; i < as.size(); ++i)
        for (std::size_t j = within_one ? i + 1 : 0; j < bs.size(); ++j)
            if (!share_vertex(as[i], bs[j])) visit(pair_of(as[i], bs[j]));
}

/// Calls visit(pair) for every pair of a mesh; vertices of faces are in the mesh's order.
template <class Visit>
void for_each_pair(const ccd::mesh& m, const Visit& visit) {
    const elements of(m);
    for_each_two(of.vertices, of.faces, visit);
    for_each_two(of.edges, of.edges, visit);
    for_each_two(of.points, of.rods, visit);
    for_each_two(of.points, of.points, visit);
}
/// Calls visit(pair) for the pairs of step_options::adjacent_rods.
template <class Visit>
void for_each_adjacent_pair(const ccd::mesh& m, const Visit& visit) {
    const elements of(m);
    std::set<ccd::edge> rods(of.rods.begin(), of.rods.end());
    for (const ccd::face& f : of.faces)
        for (const vertex_index v : f)
            for (const vertex_index w : f)
                if (v < w && (f[0] == f[1] || f[1] == f[2] || f[2] == f[0])) rods.insert({v, w});
    for (const vertex& v : of.vertices)
        for (const ccd::edge& e : rods)
            if (!share_vertex(v, e) && std::ranges::any_of(e, [&](vertex_index w) {
                    return rods.contains({std::min(v[0], w), std::max(v[0], w)});
                }))
                visit(pair_of(v, e));
}
template <class Visit>
void for_each_pair_in_plane(const ccd::mesh& m, const Visit& visit) {
    const elements of(m);
    for_each_two(of.vertices, of.edges, visit);
    for_each_two(of.points, of.points, visit);
}

/// A pair in the form in which steps report it: the vertices of a face ascend.
template <class Pair>
Pair as_reported(Pair pair) {
    if constexpr (std::is_same_v<Pair, ccd::vertex_face_pair>) {
        ccd::face f{pair.f0, pair.f1, pair.f2};
        std::ranges::sort(f);
        return pair_of(vertex{pair.v}, f);
    }
    return pair;
}

template <class Pair>
auto elements_of(const Pair& pair) {
    constexpr std::size_t first = ccd::kind_traits<ccd::kind_of<Pair>>::first_vertices;
    const auto all = vertices_of(pair);
    std::array<vertex_index, first> a;
    std::array<vertex_index, all.size() - first> b;
    std::copy_n(all.begin(), a.size(), a.begin());
    std::copy_n(all.begin() + a.size(), b.size(), b.begin());
    return std::pair(a, b);
}

/// True if the closed swept boxes of a pair's elements touch, or are within a distance.
template <class Pair>
bool boxes_touch(const two_frames& at, const Pair& pair, double distance = 0) {
    const auto [a, b] = elements_of(pair);
    for (const auto axis : {&ccd::point<>::x, &ccd::point<>::y, &ccd::point<>::z}) {
        const auto extent = [&](const auto& element) {
            double low = at.first.vertices[element[0]].*axis, high = low;
            for (const vertex_index v : element)
                for (const auto* m : {&at.first, &at.second}) {
                    low = std::min(low, m->vertices[v].*axis);
                    high = std::max(high, m->vertices[v].*axis);
                }
            return std::pair(low, high);
        };
        const auto [a_low, a_high] = extent(a);
        const auto [b_low, b_high] = extent(b);
        if (a_low - b_high > distance || b_low - a_high > distance) return false;
    }
    return true;
}

using vertices_may_collide = std::function<bool(vertex_index, vertex_index)>;

/// A decision by `exact` whether pairs come within a distance.
struct by_distance {
    double distance = 0;

    ccd::verdict operator()(const auto& query) const { return decide_within(query, {distance, 0}); }
};

/// A method's verdict on queries of all kinds, as in steps.
struct by_method {
    ccd::method method = ccd::method::exact;

    ccd::verdict operator()(const auto& query) const {
        if constexpr (requires { ccd::decide(method, query); })
            return ccd::decide(method, query);
        else
            return ccd::decide_exact(query);
    }
};

/// The step's result from calls of decide(query) for every pair.
template <class Decide = by_method>
ccd::step_result step(const two_frames& at, const Decide& decide = {},
                      const vertices_may_collide& may = {}) {
    double distance = 0;
    if constexpr (requires { decide.distance; }) distance = decide.distance;
    const ccd::vertex_rows rows(at.first, at.second);
    ccd::step_result result;
    result.candidates.emplace();
    for_each_pair(at.first, [&]<class Pair>(const Pair& pair) {
        constexpr ccd::kind K = ccd::kind_of<Pair>;
        if (!boxes_touch(at, pair, distance)) return;
        const auto [a, b] = elements_of(pair);
        if (may && std::ranges::none_of(a, [&, &b = b](vertex_index v) {
                return std::ranges::any_of(b, [&](vertex_index w) { return may(v, w); });
            }))
            return;
        ++result.candidates->of<K>();
        const auto query = query_of(rows, pair);
        if (!may_collide(decide(query))) return;
        result.pairs.of<K>().push_back(as_reported(pair));
        if (may_collide(ccd::touches_at_start(query)))
            result.touching_at_start.of<K>().push_back(as_reported(pair));
    });
    ccd::for_each_kind([&]<ccd::kind K>() {
        std::ranges::sort(result.pairs.of<K>());
        std::ranges::sort(result.touching_at_start.of<K>());
    });
    return result;
}

}  // namespace brute_force
