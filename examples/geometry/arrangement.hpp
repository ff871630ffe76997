// The arrangement of segments by a sweep (Bentley, Ottmann 1979), with crossings as constructed
// points: also for vertical and overlapping segments, and many through one point.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <errbound/predicates/constructed_points.hpp>
#include <set>
#include <vector>

#include "examples/geometry/signs.hpp"

namespace arrangements {

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
/// An end of a segment, or where two segments cross: in plain double that point, rounded.
struct event {
    point end;
    const segment *first = nullptr, *second = nullptr;  ///< if they cross

    auto crossing() const {
        return errbound::line_line_point(first->from, first->to, second->from, second->to);
    }
};
template <bool Exact>
sign_type at(const event& e, const auto& visit) {
    if constexpr (Exact)
        if (e.first != nullptr) return visit(e.crossing());
    return visit(e.end);
}
template <bool Exact>
struct event_order {
    bool operator()(const event& e, const event& f) const {
        return at<Exact>(e, [&](const auto& p) {
                   return at<Exact>(
                       f, [&](const auto& q) { return sign_by<Exact>(compare_xy)(p, q); });
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

template <bool Exact>
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
        if (&s == e.first || &s == e.second) return sign_type::zero;
        return at<Exact>(
            e, [&](const auto& p) { return sign_by<Exact>(errbound::orient2d)(s.from, s.to, p); });
    }
    sign_type compare(const event& e, const point& q) const {
        return at<Exact>(e, [&](const auto& p) { return sign_by<Exact>(compare_xy)(p, q); });
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
            return sign_by<Exact>(errbound::compare_slopes)(segments_[i].from, segments_[i].to,
                                                            segments_[j].from,
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
        const segment &s = segments_[std::min(i, j)], &t = segments_[std::max(i, j)];
        if (sign_by<Exact>(errbound::segments_intersect2d)(s.from, s.to, t.from, t.to) ==
            sign_type::negative)
            return;
        if (sign_by<Exact>(errbound::compare_slopes)(s.from, s.to, t.from, t.to) == sign_type::zero)
            return;
        event crossing{{}, &s, &t};
        if constexpr (!Exact) {
            const auto p = errbound::forms::line_line(s.from, s.to, t.from, t.to);
            crossing.end = {s.from[0] + p.x / p.w, s.from[1] + p.y / p.w};
        }
        if (event_order<Exact>()(e, crossing)) events_.insert(crossing);
    }

    const std::vector<segment>& segments_;
    std::set<event, event_order<Exact>> events_;
    std::vector<std::size_t> starting_, crossed_;
    std::size_t next_ = 0;  ///< of `starting_`
    arrangement result_;
};

}  // namespace arrangements
