// Intersection, union and difference of two polygons, also if vertices and edges coincide:
// perturbed predicates see proper crossings only.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <errbound/predicates/constructed_points.hpp>
#include <errbound/predicates/perturbation.hpp>
#include <vector>

#include "examples/geometry/signs.hpp"

namespace polygons {

using errbound::sign_type;
using point = std::array<double, 2>;

constexpr auto compare_y = errbound::predicate<errbound::points<2, 2>>(
    [](const auto& p, const auto& q) { return p[1] - q[1]; });
/// orient2d(p, q, r) for p, the intersection of the lines ab and cd.
constexpr auto turn_at_crossing =
    errbound::with_constructed<errbound::line_line, errbound::given, errbound::given>(
        errbound::orient2d);

enum class operation { intersection, union_, difference };

/// Where edge `a` of the first polygon crosses edge `b` of the second. An edge has the index of its
/// first vertex.
struct crossing {
    std::size_t a, b;
};

/// Both polygons are simple and counterclockwise. Results have coordinates of this number type.
template <bool Exact, class Number>
class overlay {
  public:
    using result_point = std::array<Number, 2>;

    overlay(const std::vector<point>& first, const std::vector<point>& second)
        : points_(first), size_(first.size()), rings_{} {
        points_.insert(points_.end(), second.begin(), second.end());
        for (std::size_t a = 0; a < size_; ++a)
            for (std::size_t b = size_; b < points_.size(); ++b)
                if (crosses(a, b)) crossings_.push_back({a, b});
        for (std::size_t k = 0; k < 2; ++k) {
            auto& ring = rings_[k];
            for (std::size_t c = 0; c < crossings_.size(); ++c) ring.push_back(c);
            std::ranges::sort(ring, [&](std::size_t c, std::size_t d) { return before(k, c, d); });
        }
    }

    /// The borders of the result: counterclockwise; those of holes are clockwise.
    std::vector<std::vector<result_point>> border(operation o) const {
        std::vector<std::vector<result_point>> loops;
        const bool first_inside = contains(1, 0), second_inside = contains(0, size_);
        const bool wanted_inside = o == operation::intersection;
        if (crossings_.empty()) {
            if (first_inside == wanted_inside) loops.push_back(whole(0));
            if (second_inside == (o != operation::union_)) loops.push_back(whole(1));
            if (o == operation::difference && second_inside) std::ranges::reverse(loops.back());
            return loops;
        }
        // Each loop follows the first polygon from where it enters (leaves) the second to the next
        // crossing. Then it follows the second polygon, backwards for differences.
        std::vector<bool> done(crossings_.size());
        for (std::size_t i = 0; i < crossings_.size(); ++i) {
            if (done[i] || (first_inside == (i % 2 == 1)) != wanted_inside) continue;
            loops.emplace_back();
            std::size_t at = i;
            do {
                done[at] = true;
                const std::size_t c = rings_[0][at];
                const std::size_t d = follow(0, c, 1, loops.back());
                const std::size_t next =
                    follow(1, d, o == operation::difference ? -1 : 1, loops.back());
                at = position(0, next);
            } while (at != i);
        }
        return loops;
    }

  private:
    /// The sign for the perturbed vertices with these indices.
    sign_type sign(const auto& predicate, std::same_as<std::size_t> auto... v) const {
        if constexpr (Exact)
            return errbound::perturbed(predicate)(std::array{v...}, points_[v]...);
        else
            return sign_by<false>(predicate)(points_[v]...);
    }
    std::size_t after(std::size_t v) const {
        return v + 1 == size_ ? 0 : v + 1 == points_.size() ? size_ : v + 1;
    }
    sign_type side(std::size_t e, std::size_t v) const {
        return sign(errbound::orient2d, e, after(e), v);
    }
    bool crosses(std::size_t a, std::size_t b) const {
        return side(a, b) != side(a, after(b)) && side(b, a) != side(b, after(a));
    }
    bool above(std::size_t v, std::size_t p) const {
        return sign(compare_y, v, p) == sign_type::positive;
    }
    /// Counts the edges to the right of vertex p.
    bool contains(std::size_t polygon, std::size_t p) const {
        bool inside = false;
        const std::size_t end = polygon == 0 ? size_ : points_.size();
        for (std::size_t e = polygon == 0 ? 0 : size_; e < end; ++e) {
            const bool up = above(after(e), p);
            if (up != above(e, p) && (side(e, p) == sign_type::positive) == up) inside = !inside;
        }
        return inside;
    }
    std::size_t edge(std::size_t k, std::size_t c) const {
        return k == 0 ? crossings_[c].a : crossings_[c].b;
    }
    /// True if crossing c comes before d on polygon k: on one edge, if the edge of d has c and the
    /// beginning on the same side.
    bool before(std::size_t k, std::size_t c, std::size_t d) const {
        const std::size_t e = edge(k, c), f = edge(1 - k, c), g = edge(1 - k, d);
        if (e != edge(k, d)) return e < edge(k, d);
        if (f == g) return false;
        return sign(turn_at_crossing, e, after(e), f, after(f), g, after(g)) == side(g, e);
    }
    std::size_t position(std::size_t k, std::size_t c) const {
        return static_cast<std::size_t>(std::ranges::find(rings_[k], c) - rings_[k].begin());
    }
    /// Appends crossing c and the vertices of polygon k up to the next crossing, which it returns.
    std::size_t follow(std::size_t k, std::size_t c, int step,
                       std::vector<result_point>& loop) const {
        const auto& ring = rings_[k];
        const std::size_t count = ring.size(), i = position(k, c);
        const std::size_t next = ring[step > 0 ? (i + 1) % count : (i + count - 1) % count];
        loop.push_back(place(crossings_[c]));
        // Forwards from c or backwards from `next`; around the whole ring if it is not behind.
        const std::size_t from = step > 0 ? c : next, to = step > 0 ? next : c;
        std::vector<result_point> vertices;
        std::size_t e = edge(k, from);
        if (e != edge(k, to) || !before(k, from, to)) do {
                e = after(e);
                vertices.push_back(vertex(e));
            } while (e != edge(k, to));
        if (step < 0) std::ranges::reverse(vertices);
        loop.insert(loop.end(), vertices.begin(), vertices.end());
        return next;
    }
    result_point vertex(std::size_t v) const {
        return {Number(points_[v][0]), Number(points_[v][1])};
    }
    /// Before the perturbation. If the edges are on one line, any point of it gives the same area.
    result_point place(const crossing& c) const {
        const auto p = errbound::forms::line_line(vertex(c.a), vertex(after(c.a)), vertex(c.b),
                                                  vertex(after(c.b)));
        if (p.w == 0) return vertex(c.a);
        return {vertex(c.a)[0] + p.x / p.w, vertex(c.a)[1] + p.y / p.w};
    }
    std::vector<result_point> whole(std::size_t k) const {
        std::vector<result_point> loop;
        for (std::size_t v = k == 0 ? 0 : size_; v < (k == 0 ? size_ : points_.size()); ++v)
            loop.push_back(vertex(v));
        return loop;
    }

    std::vector<point> points_;  ///< of both polygons; the index in this list
    std::size_t size_;           ///< of the first
    std::vector<crossing> crossings_;
    std::array<std::vector<std::size_t>, 2> rings_;  ///< crossings in the order of each polygon
};

}  // namespace polygons
