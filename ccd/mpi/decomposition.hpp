// Cuts space into a box for each rank, by recursive coordinate bisection of weighted samples.
#pragma once

#include <array>
#include <ccd/step.hpp>
#include <cstddef>
#include <span>
#include <vector>

#include "ccd/mpi/exchange.hpp"
#include "ccd/step/trees/box_tree.hpp"

namespace ccd::mpi::detail {

using swept_box = ccd::detail::box<double>;

/// Boxes that tile space, one for each rank; the same on all ranks. Some may be empty.
class decomposition {
  public:
    /// Samples `boxes`, which elements sweep. Collective. Time: each of a rank's samples is tested
    /// against fewer than 8192 others. The samples are then cut once for each bit of the number of
    /// ranks. Their total number is 256 a rank, but at least 4096 and at most the larger of 2^19
    /// and 64 a rank.
    decomposition(exchanger& ranks, std::span<const swept_box> boxes);

    const space_region& part(std::size_t rank) const { return parts_[rank]; }

    /// Calls visit(rank) for each rank whose region a closed box meets.
    template <class Visit>
    void for_each_met(const swept_box& box, const Visit& visit) const {
        for_each_met(0, box, visit);
    }

  private:
    struct sample {
        swept_box box;
        double elements;  ///< the number of elements that it represents
        double work = 0;
    };
    /// A cut of ranks [first, first + count): the first half is below `at` on the axis.
    struct node {
        std::size_t first, count;
        std::size_t axis = 0;
        double at = 0;
        std::size_t below = 0, above = 0;  ///< nodes, where count > 1
    };

    static std::vector<sample> weighted_samples(exchanger& ranks, std::span<const swept_box> boxes);
    std::size_t cut(std::size_t first, std::size_t count, std::span<sample> samples,
                    const space_region& part);

    template <class Visit>
    void for_each_met(std::size_t i, const swept_box& box, const Visit& visit) const {
        const node& n = nodes_[i];
        if (n.count == 1) {
            visit(n.first);
            return;
        }
        if (box.low[n.axis] < n.at) for_each_met(n.below, box, visit);
        if (box.high[n.axis] >= n.at) for_each_met(n.above, box, visit);
    }

    std::vector<node> nodes_;
    std::vector<space_region> parts_;
};

}  // namespace ccd::mpi::detail
