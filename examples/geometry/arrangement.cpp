// The arrangement of segments by a sweep (Bentley, Ottmann 1979), with crossings as constructed
// points: vertical and overlapping segments, and many segments through one point. Checked by
// rationals.
#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <errbound/predicates/constructed_points.hpp>
#include <random>
#include <set>
#include <vector>

namespace {

using errbound::sign_type;
using point = std::array<double, 2>;

/// Negative if p is left of q, or below it on a vertical line.
constexpr auto compare_xy =
    errbound::predicate<errbound::points<2, 2>>([](const auto& p, const auto& q) {
        const sign_type x = sign_of(p[0] - q[0]);
        return x == sign_type::zero ? sign_of(p[1] - q[1]) : x;
    });

struct segment {
    point from, to;  ///< compare_xy(from, to) is negative
};
/// An end of a segment, or where two segments cross.
struct event {
    point end;
    const segment *first = nullptr, *second = nullptr;  ///< if they cross

    auto crossing() const {
        return errbound::line_line_point(first->from, first->to, second->from, second->to);
    }
};
template <class Visit>
sign_type at(const event& e, const Visit& visit) {
    return e.first == nullptr ? visit(e.end) : visit(e.crossing());
}
struct event_order {
    bool operator()(const event& e, const event& f) const {
        return at(e, [&](const auto& p) {
                   return at(f, [&](const auto& q) { return compare_xy(p, q); });
               }) == sign_type::negative;
    }
};

struct arrangement {
    std::size_t vertices = 0;
    std::vector<std::size_t> vertices_on;  ///< by segment

    std::size_t edges() const {
        std::size_t sum = 0;
        for (const std::size_t n : vertices_on) sum += n - 1;
        return sum;
    }
};

class sweep {
  public:
    explicit sweep(const std::vector<segment>& segments) : segments_(segments) {
        result_.vertices_on.resize(segments.size());
        for (const segment& s : segments) {
            events_.insert({s.from});
            events_.insert({s.to});
        }
        // Segments in the order of their first ends.
        for (std::size_t i = 0; i < segments.size(); ++i) starting_.push_back(i);
        std::ranges::sort(starting_, [&](std::size_t i, std::size_t j) {
            return segments[i].from < segments[j].from;
        });
    }
    arrangement run() {
        while (!events_.empty()) {
            const event e = *events_.begin();
            events_.erase(events_.begin());
            pass(e);
        }
        return result_;
    }

  private:
    /// Positive if e is above the segment's line.
    sign_type side(std::size_t i, const event& e) const {
        const segment& s = segments_[i];
        return at(e, [&](const auto& p) { return errbound::orient2d(s.from, s.to, p); });
    }
    sign_type compare(const event& e, const point& q) const {
        return at(e, [&](const auto& p) { return compare_xy(p, q); });
    }

    void pass(const event& e) {
        ++result_.vertices;
        // From bottom to top, segments through e are consecutive.
        const auto first = std::ranges::partition_point(
            crossed_, [&](std::size_t i) { return side(i, e) == sign_type::positive; });
        auto last = first;
        std::vector<std::size_t> onward;
        for (; last != crossed_.end() && side(*last, e) == sign_type::zero; ++last) {
            ++result_.vertices_on[*last];
            if (compare(e, segments_[*last].to) == sign_type::negative) onward.push_back(*last);
        }
        for (; next_ < starting_.size(); ++next_) {
            const std::size_t i = starting_[next_];
            if (compare(e, segments_[i].from) != sign_type::zero) break;
            ++result_.vertices_on[i];
            onward.push_back(i);
        }
        // After e they are ordered by their slopes; overlapping ones in any order.
        std::ranges::sort(onward, [&](std::size_t i, std::size_t j) {
            return errbound::compare_slopes(segments_[i].from, segments_[i].to, segments_[j].from,
                                            segments_[j].to) == sign_type::negative;
        });
        const auto begin = static_cast<std::size_t>(first - crossed_.begin());
        crossed_.erase(first, last);
        crossed_.insert(crossed_.begin() + static_cast<std::ptrdiff_t>(begin), onward.begin(),
                        onward.end());
        const std::size_t end = begin + onward.size();
        if (begin > 0 && begin < crossed_.size()) meet(crossed_[begin - 1], crossed_[begin], e);
        if (end > begin && end < crossed_.size()) meet(crossed_[end - 1], crossed_[end], e);
    }
    /// Adds the crossing of two neighbours, if it is after e.
    void meet(std::size_t i, std::size_t j, const event& e) {
        const segment &s = segments_[i], &t = segments_[j];
        if (errbound::segments_intersect2d(s.from, s.to, t.from, t.to) == sign_type::negative)
            return;
        if (errbound::compare_slopes(s.from, s.to, t.from, t.to) == sign_type::zero) return;
        const event crossing{{}, &s, &t};
        if (event_order()(e, crossing)) events_.insert(crossing);
    }

    const std::vector<segment>& segments_;
    std::set<event, event_order> events_;
    std::vector<std::size_t> starting_, crossed_;
    std::size_t next_ = 0;  ///< of `starting_`
    arrangement result_;
};

// ---- The check: all pairs, in rationals ----

using rational = boost::multiprecision::number<boost::multiprecision::cpp_rational_backend,
                                               boost::multiprecision::et_off>;
using exact_point = std::array<rational, 2>;

exact_point exact(const point& p) {
    return {rational(p[0]), rational(p[1])};
}
rational area(const exact_point& a, const exact_point& b, const exact_point& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}
bool is_on(const exact_point& p, const exact_point& a, const exact_point& b) {
    return area(a, b, p) == 0 && !(p < a) && !(b < p);  // a < b, lexicographically
}

bool is_right(const arrangement& found, const std::vector<segment>& segments) {
    std::set<exact_point> vertices;
    bool right = true;
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const exact_point a = exact(segments[i].from), b = exact(segments[i].to);
        std::set<exact_point> on{a, b};
        for (const segment& other : segments) {
            const exact_point c = exact(other.from), d = exact(other.to);
            for (const exact_point& p : {c, d})
                if (is_on(p, a, b)) on.insert(p);
            const rational at_c = area(a, b, c), at_d = area(a, b, d);
            if (at_c == at_d) continue;
            const rational t = at_c / (at_c - at_d);
            const exact_point p{c[0] + t * (d[0] - c[0]), c[1] + t * (d[1] - c[1])};
            if (t >= 0 && t <= 1 && is_on(p, a, b)) on.insert(p);
        }
        right = right && found.vertices_on[i] == on.size();
        vertices.merge(on);
    }
    return right && found.vertices == vertices.size();
}

segment segment_of(const point& a, const point& b) {
    return a < b ? segment{a, b} : segment{b, a};
}
template <class Coordinate>
std::vector<segment> random_segments(std::size_t count, const Coordinate& coordinate) {
    std::vector<segment> segments;
    while (segments.size() < count) {
        const point a{coordinate(), coordinate()}, b{coordinate(), coordinate()};
        if (a != b) segments.push_back(segment_of(a, b));
    }
    return segments;
}

bool test(const char* name, const std::vector<segment>& segments) {
    const auto start = std::chrono::steady_clock::now();
    const arrangement found = sweep(segments).run();
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    const bool right = is_right(found, segments);
    std::printf("%s: %zu segments, %zu vertices, %zu edges, %.3f s, %s\n", name, segments.size(),
                found.vertices, found.edges(), time.count(), right ? "right" : "WRONG");
    return right;
}

}  // namespace

int main() {
    std::mt19937_64 random(1);
    const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    bool right = test("random", random_segments(150, uniform));
    // Many overlaps, vertical segments and common points.
    right &= test("grid", random_segments(120, [&] { return static_cast<double>(random() % 6); }));
    // Nearly through one point, and nearly parallel.
    std::vector<segment> star;
    for (int i = 0; i < 60; ++i) {
        const double x = uniform(), y = uniform();
        star.push_back(segment_of({0.1 - x, 0.3 - y}, {0.1 + x, 0.3 + y}));
        star.push_back(segment_of({-1, 0.3 + i * 0x1p-54}, {1, 0.3 - i * 0x1p-54}));
    }
    right &= test("star", star);
    return right ? 0 : 1;
}
