// Positions that a mesh keeps from step to step. Vertices that rest at them cost one comparison.
#pragma once

#include <algorithm>
#include <ccd/step.hpp>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "ccd/batch/rounded_positions.hpp"

namespace ccd::detail {

class kept_positions {
  public:
    /// Lists the vertices that do not rest at their kept positions throughout the step, bit for
    /// bit. Returns false if no positions are kept, or more than one vertex in four moves.
    bool find_moving(const vertex_rows& way) {
        moving_.clear();
        is_listed_ = positions_.size() == 3 * way.vertices;
        constexpr std::size_t few = 4, block = 32;
        for (std::size_t v = 0; v < way.vertices && is_listed_; v += block) {
            const std::size_t end = std::min(way.vertices, v + block);
            if (!moves(way, v, end)) continue;
            for (std::size_t i = v; i < end; ++i)
                if (moves(way, i, i + 1)) moving_.push_back(static_cast<vertex_index>(i));
            is_listed_ = moving_.size() <= way.vertices / few;
        }
        return is_listed_;
    }
    /// Ascending. Precondition: find_moving() returned true, also below.
    std::span<const vertex_index> moving() const { return moving_; }

    /// Includes moving(), and changes more seldom.
    std::span<const vertex_index> active() const { return active_; }
    bool is_active(vertex_index v) const { return active_flags_[v] != 0; }
    /// Changes when active() does, or the rounded position of another vertex.
    std::uint64_t version() const { return version_; }

    const rounded_positions& rounded() const { return rounded_; }
    /// Rounds all positions of a step. Precondition: positions are finite, also below.
    void round_all(const vertex_rows& way) {
        is_rounded_ = false;
        rounded_.round(way);
    }
    /// Rounds the positions of the active vertices, after find_moving(way). Rounds all if another
    /// step was rounded before, or if one is outside of the box around all.
    void round_active(const vertex_rows& way) {
        const std::vector<vertex_index> before = choose_active(way.vertices);
        if (is_rounded_ && rounded_.round_again(way, before) && rounded_.round_again(way, active_))
            return;
        // With room, since vertices that have left the box may go on.
        rounded_.round(way, is_rounded_ ? 0.125 : 0);
        is_rounded_ = true;
        ++version_;
    }
    void forget() {
        positions_.clear();
        is_rounded_ = false;
    }
    /// The next round_active() rounds all.
    void forget_rounded() { is_rounded_ = false; }

    /// Keeps the positions at the end of the step, after find_moving(way).
    void keep(const vertex_rows& way) {
        if (is_listed_) {
            for (const vertex_index v : moving_)
                std::copy_n(&way.after[3 * std::size_t(v)], 3, &positions_[3 * std::size_t(v)]);
        } else {
            positions_.assign(way.after, way.after + 3 * way.vertices);
            is_rounded_ = false;
        }
    }

  private:
    /// True if a vertex v, first <= v < end, moves.
    bool moves(const vertex_rows& way, std::size_t first, std::size_t end) const {
        std::uint64_t differences = 0;
        for (std::size_t i = 3 * first; i < 3 * end; ++i) {
            std::uint64_t before, after, kept;
            std::memcpy(&before, &way.before[i], sizeof before);
            std::memcpy(&after, &way.after[i], sizeof after);
            std::memcpy(&kept, &positions_[i], sizeof kept);
            differences |= (before ^ kept) | (after ^ kept);
        }
        return differences != 0;
    }

    /// Returns the vertices that were active before, if they are others.
    std::vector<vertex_index> choose_active(std::size_t vertices) {
        constexpr std::size_t cost = 16;  // of an active vertex, relative to the choice for one
        active_flags_.resize(vertices);
        const bool covered = is_rounded_ && std::ranges::all_of(moving_, [&](vertex_index v) {
                                 return is_active(v);
                             });
        if (covered) excess_ += active_.size() - moving_.size();
        if (covered && cost * excess_ <= vertices) return {};
        for (const vertex_index v : active_) active_flags_[v] = 0;
        for (const vertex_index v : moving_) active_flags_[v] = 1;
        excess_ = 0;
        ++version_;
        return std::exchange(active_, moving_);
    }

    std::vector<double> positions_;  ///< x y z
    bool is_listed_ = false;
    std::vector<vertex_index> moving_, active_;
    std::vector<std::uint8_t> active_flags_;
    std::size_t excess_ = 0;  ///< active vertices that did not move, since active_ was chosen
    std::uint64_t version_ = 0;
    rounded_positions rounded_;
    bool is_rounded_ = false;  ///< all that are not active, at kept positions
};

}  // namespace ccd::detail
