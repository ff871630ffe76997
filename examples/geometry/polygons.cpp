// Intersection, union and difference of two polygons, also if vertices and edges coincide:
// perturbed predicates see proper crossings only. Checked by areas and by points, in rationals.
#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cstddef>
#include <cstdio>
#include <errbound/predicates.hpp>
#include <errbound/predicates/perturbation.hpp>
#include <random>
#include <vector>

namespace {

using errbound::sign_type;
using point = std::array<double, 2>;
using rational = boost::multiprecision::number<boost::multiprecision::cpp_rational_backend,
                                               boost::multiprecision::et_off>;
using exact_point = std::array<rational, 2>;

constexpr auto turn = errbound::perturbed(errbound::orient2d);
constexpr auto compare_y = errbound::perturbed(errbound::predicate<errbound::points<2, 2>>(
    [](const auto& p, const auto& q) { return p[1] - q[1]; }));
/// orient2d(p, q, r) for p, the intersection of lines ab and cd. A factor w replaces its sign,
/// since only expressions that return numbers can be perturbed.
constexpr auto turn_at_crossing =
    errbound::perturbed(errbound::predicate<errbound::points<2, 2, 2, 2, 2, 2>>(
        [](const auto& a, const auto& b, const auto& c, const auto& d, const auto& q,
           const auto& r) {
            const auto p = errbound::forms::line_line(a, b, c, d);
            const auto x = (a[0] - r[0]) * p.w + p.x, y = (a[1] - r[1]) * p.w + p.y;
            return (x * (q[1] - r[1]) - y * (q[0] - r[0])) * p.w;
        }));

enum class operation { intersection, union_, difference };

/// Where edge `a` of the first polygon crosses edge `b` of the second. An edge has the index of its
/// first vertex.
struct crossing {
    std::size_t a, b;
};

/// Both polygons are simple and counterclockwise.
class overlay {
  public:
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
    std::vector<std::vector<exact_point>> border(operation o) const {
        std::vector<std::vector<exact_point>> loops;
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
    std::size_t after(std::size_t v) const {
        return v + 1 == size_ ? 0 : v + 1 == points_.size() ? size_ : v + 1;
    }
    sign_type side(std::size_t e, std::size_t v) const {
        const std::size_t f = after(e);
        return turn({e, f, v}, points_[e], points_[f], points_[v]);
    }
    bool crosses(std::size_t a, std::size_t b) const {
        return side(a, b) != side(a, after(b)) && side(b, a) != side(b, after(a));
    }
    bool above(std::size_t v, std::size_t p) const {
        return compare_y({v, p}, points_[v], points_[p]) == sign_type::positive;
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
        const std::size_t e1 = after(e), f1 = after(f), g1 = after(g);
        return turn_at_crossing({e, e1, f, f1, g, g1}, points_[e], points_[e1], points_[f],
                                points_[f1], points_[g], points_[g1]) == side(g, e);
    }
    std::size_t position(std::size_t k, std::size_t c) const {
        return static_cast<std::size_t>(std::ranges::find(rings_[k], c) - rings_[k].begin());
    }
    /// Appends crossing c and the vertices of polygon k up to the next crossing, which it returns.
    std::size_t follow(std::size_t k, std::size_t c, int step,
                       std::vector<exact_point>& loop) const {
        const auto& ring = rings_[k];
        const std::size_t count = ring.size(), i = position(k, c);
        const std::size_t next = ring[step > 0 ? (i + 1) % count : (i + count - 1) % count];
        loop.push_back(place(crossings_[c]));
        // Forwards from c or backwards from `next`; around the whole ring if it is not behind.
        const std::size_t from = step > 0 ? c : next, to = step > 0 ? next : c;
        std::vector<exact_point> vertices;
        std::size_t e = edge(k, from);
        if (e != edge(k, to) || !before(k, from, to)) do {
                e = after(e);
                vertices.push_back({rational(points_[e][0]), rational(points_[e][1])});
            } while (e != edge(k, to));
        if (step < 0) std::ranges::reverse(vertices);
        loop.insert(loop.end(), vertices.begin(), vertices.end());
        return next;
    }
    /// Before the perturbation. If the edges are on one line, any point of it gives the same area.
    exact_point place(const crossing& c) const {
        const auto exact = [&](std::size_t v) {
            return exact_point{rational(points_[v][0]), rational(points_[v][1])};
        };
        const auto p = errbound::forms::line_line(exact(c.a), exact(after(c.a)), exact(c.b),
                                                  exact(after(c.b)));
        if (p.w == 0) return exact(c.a);
        return {exact(c.a)[0] + p.x / p.w, exact(c.a)[1] + p.y / p.w};
    }
    std::vector<exact_point> whole(std::size_t k) const {
        std::vector<exact_point> loop;
        for (std::size_t v = k == 0 ? 0 : size_; v < (k == 0 ? size_ : points_.size()); ++v)
            loop.push_back({rational(points_[v][0]), rational(points_[v][1])});
        return loop;
    }

    std::vector<point> points_;  ///< of both polygons; the index in this list
    std::size_t size_;           ///< of the first
    std::vector<crossing> crossings_;
    std::array<std::vector<std::size_t>, 2> rings_;  ///< crossings in the order of each polygon
};

/// Twice the area.
rational area(const std::vector<std::vector<exact_point>>& loops) {
    rational sum = 0;
    for (const auto& loop : loops)
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const exact_point &p = loop[i], &q = loop[(i + 1) % loop.size()];
            sum += p[0] * q[1] - p[1] * q[0];
        }
    return sum;
}
/// How many times the borders go around p, which is on none.
int winding(const std::vector<std::vector<exact_point>>& loops, const exact_point& p) {
    int sum = 0;
    for (const auto& loop : loops)
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const exact_point &a = loop[i], &b = loop[(i + 1) % loop.size()];
            if ((a[1] > p[1]) == (b[1] > p[1])) continue;
            const rational s = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
            if ((s > 0) == (b[1] > a[1])) sum += b[1] > a[1] ? 1 : -1;
        }
    return sum;
}

/// A star-shaped polygon of points of a small grid.
std::vector<point> random_polygon(std::mt19937_64& random, const point& center, int size) {
    const auto compare = [&](const point& p, const point& q) {
        return errbound::compare_directions(center, p, center, q);
    };
    for (;;) {
        std::vector<point> polygon;
        for (int i = 0; i < size; ++i) {
            const point p{center[0] + double(random() % 9) - 4,
                          center[1] + double(random() % 9) - 4};
            if (p != center) polygon.push_back(p);
        }
        std::ranges::sort(polygon, [&](const point& p, const point& q) {
            return compare(p, q) == sign_type::negative;
        });
        const auto same = std::ranges::unique(polygon, [&](const point& p, const point& q) {
            return compare(p, q) == sign_type::zero;
        });
        polygon.erase(same.begin(), same.end());
        bool around = polygon.size() > 2;
        for (std::size_t i = 0; i < polygon.size(); ++i)
            around = around && errbound::orient2d(polygon[i], polygon[(i + 1) % polygon.size()],
                                                  center) == sign_type::positive;
        if (around) return polygon;
    }
}

}  // namespace

int main() {
    std::mt19937_64 random(1);
    int wrong = 0, count = 0;
    for (; count < 300; ++count) {
        const auto a = random_polygon(random, {0, 0}, 12);
        const auto b = random_polygon(random, {double(random() % 3), double(random() % 2)}, 12);
        const overlay both(a, b);
        const auto common = both.border(operation::intersection),
                   either = both.border(operation::union_),
                   rest = both.border(operation::difference);
        const auto alone = overlay(a, {{90, 0}, {91, 0}, {90, 1}}).border(operation::difference);
        const auto other = overlay(b, {{90, 0}, {91, 0}, {90, 1}}).border(operation::difference);
        bool right = area(common) + area(either) == area(alone) + area(other) &&
                     area(common) + area(rest) == area(alone);
        for (int i = 0; i < 20; ++i) {
            const auto draw = [&] { return rational(std::size_t(random() % 997), 83) - 5; };
            const exact_point p{draw() + rational(1, 1009), draw() + rational(1, 1013)};
            const int in_a = winding(alone, p), in_b = winding(other, p);
            right = right && winding(common, p) == in_a * in_b &&
                    winding(either, p) == std::max(in_a, in_b) &&
                    winding(rest, p) == in_a * (1 - in_b);
        }
        wrong += !right;
    }
    std::printf("%d pairs of polygons, %d wrong\n", count, wrong);
    return wrong == 0 ? 0 : 1;
}
