#pragma once

#include <algorithm>
#include <array>
#include <ccd/step.hpp>
#include <cstddef>
#include <functional>
#include <numeric>
#include <span>

#include "ccd/batch/threads.hpp"
#include "ccd/step/swept_boxes.hpp"

namespace ccd::detail {

inline bool lets_all_through(const pair_filter& filter) {
    return !filter.can_collide && filter.groups.empty() && filter.pinned.empty() && !filter.region;
}

inline bool may_collide(const pair_filter& filter, vertex_index v, vertex_index w) {
    if (!filter.pinned.empty() && filter.pinned[v] != 0 && filter.pinned[w] != 0) return false;
    if (!filter.groups.empty() && (filter.groups[v] == filter.groups[w]) !=
                                      (filter.rule == pair_filter::group_rule::within_groups))
        return false;
    return !filter.can_collide || filter.can_collide(v, w);
}

template <class Pair>
bool may_collide(const pair_filter& filter, const Pair& pair) {
    const auto vertices = vertices_of(pair);
    constexpr std::size_t first = kind_traits<kind_of<Pair>>::first_vertices;
    for (std::size_t i = 0; i < first; ++i)
        for (std::size_t j = first; j < vertices.size(); ++j)
            if (may_collide(filter, vertices[i], vertices[j])) return true;
    return false;
}

/// Applies a filter to pairs, with the boxes that their elements sweep. Keeps references to both.
class pair_test {
  public:
    pair_test(const pair_filter& filter, const swept_boxes& boxes)
        : filter_(filter), boxes_(boxes) {}

    template <class Pair>
    bool operator()(const Pair& pair) const {
        return may_collide(filter_, pair) &&
               (!filter_.region || filter_.region->has(lower_corner(pair)));
    }

  private:
    template <class Pair>
    std::array<double, 3> lower_corner(const Pair& pair) const {
        using traits = kind_traits<kind_of<Pair>>;
        const auto vertices = vertices_of(pair);
        std::array<vertex_index, traits::first_vertices> first;
        std::array<vertex_index, traits::second_vertices> second;
        std::copy_n(vertices.begin(), first.size(), first.begin());
        std::copy_n(vertices.begin() + first.size(), second.size(), second.begin());
        const auto a = boxes_.swept_box<double>(first).low,
                   b = boxes_.swept_box<double>(second).low;
        return {std::max(a[0], b[0]), std::max(a[1], b[1]), std::max(a[2], b[2])};
    }

    const pair_filter& filter_;
    const swept_boxes& boxes_;
};

/// One block of candidates for each thread.
template <class Pair>
class candidate_blocks {
  public:
    using visitor = std::function<void(std::span<const Pair>)>;
    static constexpr std::size_t block_size = 2048;

    class block {
      public:
        block(const visitor& visit, const pair_test* filter, const stop_query& stop)
            : visit_(&visit), filter_(filter), stop_(&stop) {}

        void add(const Pair& c, bool is_one) {
            candidates_[size_] = c;  // unconditionally: a branch would often be mispredicted
            size_ += is_one;
            if (size_ == block_size) flush();
        }
        void flush() {
            stop_if_requested(*stop_);
            std::span<const Pair> found(candidates_.data(), size_);
            if (filter_ != nullptr) {
                const auto end = std::remove_if(candidates_.begin(), candidates_.begin() + size_,
                                                [&](const Pair& c) { return !(*filter_)(c); });
                found = {candidates_.begin(), end};
            }
            if (!found.empty()) (*visit_)(found);
            count_ += found.size();
            size_ = 0;
        }
        std::size_t count() const { return count_; }

      private:
        const visitor* visit_;
        const pair_test* filter_;
        const stop_query* stop_;
        std::size_t size_ = 0, count_ = 0;
        std::array<Pair, block_size> candidates_;
    };

    /// If `filter` is null, all pairs pass.
    candidate_blocks(const visitor& visit, const pair_test* filter, const stop_query& stop)
        : stop_(stop), blocks_([&visit, filter, &stop] { return block(visit, filter, stop); }) {}

    /// Throws ccd::stopped if `stop` requests it, as flush() does.
    block& local() {
        stop_if_requested(stop_);
        return blocks_.local();
    }

    /// Flushes all blocks. Returns the number of candidates.
    std::size_t finish() {
        const std::vector<block*> all = blocks_.all();
        for_each_task(all.size(), [&](std::size_t i) { all[i]->flush(); });
        return std::transform_reduce(all.begin(), all.end(), std::size_t(0), std::plus<>(),
                                     [](const block* b) { return b->count(); });
    }

  private:
    const stop_query& stop_;
    per_thread<block> blocks_;
};

}  // namespace ccd::detail
