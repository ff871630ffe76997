// Groups of vertices that are joined (union and find, by size), and the fraction of its way that
// each moves.
#pragma once

#include <algorithm>
#include <ccd/kind.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace ccd::detail {

class vertex_groups {
  public:
    /// Each vertex by itself, all the way.
    explicit vertex_groups(std::size_t vertices)
        : parent_(vertices), groups_(vertices), retreats_(vertices) {
        std::iota(parent_.begin(), parent_.end(), vertex_index(0));
    }

    std::size_t vertices() const { return parent_.size(); }
    /// A vertex of its group, the same for all of one group.
    vertex_index root_of(vertex_index v) {
        while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
        return v;
    }
    double fraction(vertex_index v) { return group_of(v).fraction; }
    void limit(vertex_index v, double fraction) {
        group& g = group_of(v);
        g.fraction = std::min(g.fraction, fraction);
    }

    /// Makes one group of theirs, which moves as the shorter one did.
    void join(vertex_index v, vertex_index w) {
        v = root_of(v);
        w = root_of(w);
        if (v == w) return;
        if (groups_[v].size < groups_[w].size) std::swap(v, w);
        parent_[w] = v;
        group &all = groups_[v], &more = groups_[w];
        all.size += more.size;
        all.fraction = std::min(all.fraction, more.fraction);
        all.shortened = std::max(all.shortened, more.shortened);
    }
    void join_all() {
        for (vertex_index v = 1; v < parent_.size(); ++v) join(0, v);
    }

    /// Last places by which a vertex is taken back from where its fraction leads.
    int last_places_back(vertex_index v) const {
        return retreats_[v] == 0 ? 0 : 1 << (retreats_[v] - 1);
    }
    static constexpr int max_last_places_back = 1024;

    /// Handles pairs in contact: joins each one's groups; and where these already moved by one
    /// fraction, so that only rounding can have brought the pair together, shortens their way or,
    /// if `may_retreat`, takes the pair's vertices back a little once it was shortened a little.
    template <class Pair>
    void separate(const std::vector<Pair>& pairs, bool may_retreat) {
        std::vector<vertex_index> to_shorten, to_retreat;
        for (const Pair& pair : pairs) {
            const auto vertices = vertices_of(pair);
            const vertex_index first = vertices[0];
            const bool by_rounding = std::ranges::all_of(
                vertices, [&](vertex_index v) { return fraction(v) == fraction(first); });
            for (const vertex_index v : vertices) join(first, v);
            if (!by_rounding) continue;
            if (may_retreat && group_of(first).shortened >= close &&
                std::ranges::any_of(vertices, [&](vertex_index v) {
                    return last_places_back(v) < max_last_places_back;
                }))
                to_retreat.insert(to_retreat.end(), vertices.begin(), vertices.end());
            else
                to_shorten.push_back(first);
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
        int shortened = 0;  ///< how often
    };

    group& group_of(vertex_index v) { return groups_[root_of(v)]; }

    /// By 2^-50 at first, then by ever more up to 2^-8, which leaves more than 0.99 after `close`
    /// times; then to a half, a quarter, ..., and at last to nothing.
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
    std::vector<std::uint8_t> retreats_;  ///< of each vertex, how often
};

}  // namespace ccd::detail
