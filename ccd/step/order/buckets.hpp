// Sorts items into parts by one vertex, then into buckets, then each short bucket.
#pragma once

#include <algorithm>
#include <bit>
#include <ccd/kind.hpp>
#include <cstddef>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "ccd/batch/first_touch.hpp"
#include "ccd/batch/threads.hpp"

namespace ccd::detail {

/// The number of shares, at least one, such that each thread of the arena has work.
inline std::size_t shares_of(std::size_t count) {
    constexpr std::size_t least = 4096;
    return std::clamp<std::size_t>(count / least, 1, threads_here());
}
constexpr std::size_t begin_of_share(std::size_t share, std::size_t shares, std::size_t count) {
    return count / shares * share + std::min(share, count % shares);
}

/// Destinations of the items of each share: items with one digit are adjacent, in order of shares.
class share_places {
  public:
    share_places(std::size_t shares, std::size_t digits)
        : digits_(digits), next_(shares * digits) {}

    void clear() { std::ranges::fill(next_, 0); }
    /// The counts, later the destinations, of a share by digit.
    std::size_t* of(std::size_t share) { return &next_[share * digits_]; }
    /// Replaces counts by the destinations of the first items. Returns the total count.
    std::size_t from_counts() {
        std::size_t before = 0;
        for (std::size_t d = 0; d < digits_; ++d)
            for (std::size_t i = d; i < next_.size(); i += digits_)
                before += std::exchange(next_[i], before);
        return before;
    }

  private:
    std::size_t digits_;
    std::vector<std::size_t> next_;
};

/// Sorts a part's items into buckets by their vertices, which are from `first` to `last`.
template <class Item, class VertexOf>
class part_sorter {
  public:
    explicit part_sorter(const VertexOf& vertex_of) : vertex_of_(vertex_of) {}

    void sort(std::span<Item> items, vertex_index first, vertex_index last) {
        unsigned shift = 0;
        while ((last - first) >> shift > items.size()) ++shift;
        const auto bucket = [&](const Item& item) { return (vertex_of_(item) - first) >> shift; };
        end_.assign(((last - first) >> shift) + 2, 0);
        for (const Item& item : items) ++end_[bucket(item) + 1];
        std::partial_sum(end_.begin(), end_.end(), end_.begin());
        in_buckets_.resize(items.size());
        for (const Item& item : items) in_buckets_[end_[bucket(item)]++] = item;
        std::ranges::copy(in_buckets_, items.begin());
        for (std::size_t b = 0; b + 1 < end_.size(); ++b) {
            const std::size_t begin = b == 0 ? 0 : end_[b - 1];
            if (end_[b] - begin > 1) std::ranges::sort(items.subspan(begin, end_[b] - begin));
        }
    }

  private:
    const VertexOf& vertex_of_;
    std::vector<std::size_t> end_;  // of each bucket
    first_touch_vector<Item> in_buckets_;
};

/// Sorts items that come in shares, at least one. for_each(share, visit) calls visit(item) for all
/// items of a share, twice for each share, from several threads at once. Preconditions:
/// vertex_of(item) is at most `last`, and does not decrease in the order by <. Cost: O(count) if
/// few items share a vertex. Shares do not affect the result.
template <class Item, class ForEach, class VertexOf>
std::vector<Item> sorted_by_vertex(std::size_t shares, vertex_index last, const ForEach& for_each,
                                   const VertexOf& vertex_of) {
    // Items and buckets of a part fit in the cache, and parts are few enough to write to all.
    constexpr vertex_index vertices_of_a_part = 4096, most_parts = 512;
    const auto shift =
        static_cast<unsigned>(std::bit_width(std::max(last / most_parts, vertices_of_a_part - 1)));
    const std::size_t parts = (last >> shift) + 1;
    share_places places(shares, parts);
    for_each_task(shares, [&](std::size_t share) {
        std::size_t* const count = places.of(share);
        for_each(share, [&](const Item& item) { ++count[vertex_of(item) >> shift]; });
    });
    std::vector<Item> items(places.from_counts());
    for_each_task(shares, [&](std::size_t share) {
        std::size_t* const next = places.of(share);
        for_each(share, [&](const Item& item) { items[next[vertex_of(item) >> shift]++] = item; });
    });

    const std::size_t* const ends = places.of(shares - 1);  // where its next ones would go
    const auto sorter = [&] { return part_sorter<Item, VertexOf>(vertex_of); };
    per_thread<part_sorter<Item, VertexOf>> sorters(sorter);
    for_each_task(parts, [&](std::size_t part) {
        const std::size_t begin = part == 0 ? 0 : ends[part - 1], end = ends[part];
        const auto first = static_cast<vertex_index>(part << shift);
        sorters.local().sort(std::span(items).subspan(begin, end - begin), first,
                             std::min(last, first + ((vertex_index(1) << shift) - 1)));
    });
    return items;
}

}  // namespace ccd::detail
