// Sorting of what has vertices: into buckets by a vertex of each, which leaves short runs to sort.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <ccd/kind.hpp>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

namespace ccd::detail {

/// Items in buckets, by a vertex of each.
template <class Item>
struct buckets {
    std::vector<Item> items;
    std::vector<std::size_t> end;  ///< of each bucket

    /// for_each(visit) calls visit(vertex, item) for all `count` items, with vertices up to `last`.
    template <class ForEach>
    buckets(std::size_t count, vertex_index last, const ForEach& for_each) : items(count) {
        unsigned shift = 0;
        while (last >> shift > count) ++shift;
        end.resize((last >> shift) + 2);
        for_each([&](vertex_index v, const Item&) { ++end[(v >> shift) + 1]; });
        std::partial_sum(end.begin(), end.end(), end.begin());
        for_each([&](vertex_index v, const Item& item) { items[end[v >> shift]++] = item; });
        end.pop_back();
    }

    /// Calls visit(items) of each bucket, on all threads of the arena.
    template <class Visit>
    void for_each_bucket(const Visit& visit) {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, end.size(), 1024),
                          [&](const tbb::blocked_range<std::size_t>& range) {
                              for (std::size_t b = range.begin(); b < range.end(); ++b) {
                                  const std::size_t begin = b == 0 ? 0 : end[b - 1];
                                  visit(std::span(items).subspan(begin, end[b] - begin));
                              }
                          });
    }
};

}  // namespace ccd::detail
