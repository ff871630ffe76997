// Groups of joined vertices (union-find by size), and the fraction of its way that each moves.
#pragma once

#include <algorithm>
#include <ccd/kind.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <unordered_map>
#include <utility>
#include <vector>

namespace ccd::detail {

class vertex_groups {
  public:
    /// Each vertex is a separate group, which moves the whole way.
    explicit vertex_groups(std::size_t vertices)
        : parent_(vertices), groups_(vertices), retreats_(vertices) {
        std::iota(parent_.begin(), parent_.end(), vertex_index(0));
    }

    /// Adds a vertex as a group that moves the whole way; to the single group after join_all().
    vertex_index add() {
        const auto v = static_cast<vertex_index>(parent_.size());
        parent_.push_back(v);
        groups_.emplace_back();
        retreats_.push_back(0);
        if (all_are_one_) join(0, v);
        return v;
    }

    std::size_t vertices() const { return parent_.size(); }
    vertex_index root_of(vertex_index v) {
        while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
        return v;
    }
    double fraction(vertex_index v) { return group_of(v).fraction; }
    void limit(vertex_index v, double fraction) {
        group& g = group_of(v);
        g.fraction = std::min(g.fraction, fraction);
    }

    /// Joins both groups. The new group moves by the lesser fraction.
    void join(vertex_index v, vertex_index w) {
        v = root_of(v);
        w = root_of(w);
        if (v == w) return;
        if (groups_[v].size < groups_[w].size) std::swap(v, w);
        parent_[w] = v;
        group &all = groups_[v], &more = groups_[w];
        all.size += more.size;
        if (std::pair(more.fraction, more.shortened) < std::pair(all.fraction, all.shortened)) {
            all.fraction = more.fraction;
            all.shortened = more.shortened;
        }
    }
    void join_named(int name, vertex_index v) {
        join(first_named_.try_emplace(name, v).first->second, v);
    }
    void join_all() {
        all_are_one_ = true;
        for (vertex_index v = 1; v < parent_.size(); ++v) join(0, v);
    }

    int last_places_back(vertex_index v) const {
        return retreats_[v] == 0 ? 0 : 1 << (retreats_[v] - 1);
    }
    static constexpr int max_last_places_back = 1024;

    /// Handles pairs in contact. Joins groups of pairs that move by different fractions. If there
    /// are none, only rounding can have caused the contacts: joins the groups of all pairs and
    /// shortens their ways. If `may_retreat` is true and the group's way was already shortened
    /// `close` times, moves the pairs' vertices back instead.
    template <class Pair>
    void separate(const std::vector<Pair>& pairs, bool may_retreat) {
        if (join_different(pairs)) return;
        std::vector<vertex_index> to_shorten, to_retreat;
        for (const Pair& pair : pairs) {
            const auto vertices = vertices_of(pair);
            const bool can_retreat = std::ranges::any_of(vertices, [&](vertex_index v) {
                return last_places_back(v) < max_last_places_back;
            });
            for (const vertex_index v : vertices) join(vertices[0], v);
            if (may_retreat && can_retreat && group_of(vertices[0]).shortened >= close)
                to_retreat.insert(to_retreat.end(), vertices.begin(), vertices.end());
            else
                to_shorten.push_back(vertices[0]);
        }
        for (const vertex_index v : unique(to_retreat))
            if (last_places_back(v) < max_last_places_back) ++retreats_[v];
        for (vertex_index& v : to_shorten) v = root_of(v);
        for (const vertex_index root : unique(to_shorten)) shorten(groups_[root]);
    }

  private:
    struct group {
        std::size_t size = 1;
        double fraction = 1;
        int shortened = 0;  ///< number of times
    };

    group& group_of(vertex_index v) { return groups_[root_of(v)]; }

    template <class Pair>
    bool join_different(const std::vector<Pair>& pairs) {
        bool any = false;
        for (const Pair& pair : pairs) {
            const auto vertices = vertices_of(pair);
            const double first = fraction(vertices[0]);
            if (std::ranges::all_of(vertices, [&](vertex_index v) { return fraction(v) == first; }))
                continue;
            for (const vertex_index v : vertices) join(vertices[0], v);
            any = true;
        }
        return any;
    }

    /// Takes away 2^-50 of the fraction at first, then more, up to 2^-8; after `close` times more
    /// than 0.99 is left. Then multiplies it by 1/2, 1/4, 1/16 and so on, and at last sets it to 0.
    static void shorten(group& g) {
        const int times = g.shortened++;
        if (times < close)
            g.fraction = std::min(g.fraction - std::ldexp(g.fraction, 6 * times - 50),
                                  std::nextafter(g.fraction, 0.0));
        else
            g.fraction =
                times < max_shortened ? std::ldexp(g.fraction, -(1 << (times - close))) : 0;
    }
    static constexpr int close = 8, max_shortened = close + 11;

    static std::vector<vertex_index>& unique(std::vector<vertex_index>& vertices) {
        std::ranges::sort(vertices);
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
        return vertices;
    }

    std::vector<vertex_index> parent_;
    std::vector<group> groups_;           ///< at the root of each
    std::vector<std::uint8_t> retreats_;  ///< number of retreats of each vertex
    std::unordered_map<int, vertex_index> first_named_;
    bool all_are_one_ = false;
};

}  // namespace ccd::detail
