// The part of a mesh that has to be searched if few vertices move.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "ccd/step/candidate_search.hpp"

namespace ccd::detail {

/// The elements with an active vertex, and the others near them with their trees.
class candidate_search::active_parts {
  public:
    template <std::size_t N>
    struct part {
        std::vector<std::array<vertex_index, N>> active, near;
        extents_tree of_near;  ///< at rest, unless `near` is empty
    };

    active_parts(const kept_positions& kept, const candidate_search& all)
        : version_(kept.version()), rounded_(kept.rounded().data()) {
        are_few_ = list_active(vertices_, all.vertices_, kept) &&
                   list_active(edges_, all.edges_, kept) && list_active(faces_, all.faces_, kept);
        if (!are_few_) return;
        // With room, so that the box holds them for some steps.
        float longest = 0;
        for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, high_[k] - low_[k]);
        for (std::size_t k = 0; k < 3; ++k) {
            low_[k] -= longest / 16;
            high_[k] += longest / 16;
        }
        const std::vector<std::uint8_t> sides = sides_of(kept, all.vertices());
        list_near(vertices_, all.vertices_, sides);
        list_near(edges_, all.edges_, sides);
        list_near(faces_, all.faces_, sides);
    }

    /// False if the search of all elements costs less. Then not all are listed.
    bool are_few() const { return are_few_; }
    /// True if these parts are also those of positions that have changed.
    bool hold(const kept_positions& kept) const {
        return version_ == kept.version() &&
               (!are_few_ || std::ranges::all_of(kept.active(), [&](auto v) { return has(v); }));
    }
    void build_trees(const search_kernels& kernels) {
        const auto build = [&]<std::size_t N>(part<N>& p) {
            if (!p.near.empty())
                p.of_near.template build<N>(kernels, rounded_, 0, p.near, extents_of::start);
        };
        build(vertices_);
        build(edges_);
        build(faces_);
    }

    const float* rounded() const { return rounded_; }
    template <std::size_t N>
    const part<N>& of() const {
        if constexpr (N == 1) return vertices_;
        if constexpr (N == 2) return edges_;
        if constexpr (N == 3) return faces_;
    }
    std::size_t size() const {
        return vertices_.active.size() + edges_.active.size() + faces_.active.size();
    }

  private:
    static constexpr std::uint8_t all_sides = 0x3F, active_bit = 0x40;

    const float* row(vertex_index v) const {
        return rounded_ + rounded_positions::row * std::size_t(v);
    }
    void widen(vertex_index v) {
        for (std::size_t k = 0; k < 3; ++k)
            for (const std::size_t end : {0, 4}) {
                low_[k] = std::min(low_[k], row(v)[end + k]);
                high_[k] = std::max(high_[k], row(v)[end + k]);
            }
    }
    bool has(vertex_index v) const {
        bool inside = true;
        for (std::size_t k = 0; k < 3; ++k)
            for (const std::size_t end : {0, 4})
                inside &= low_[k] <= row(v)[end + k] && row(v)[end + k] <= high_[k];
        return inside;
    }
    template <std::size_t N>
    bool list_active(part<N>& p, const ordered_elements<N>& all, const kept_positions& kept) {
        for (std::size_t i = 0; i < all.size(); ++i)
            if (std::ranges::any_of(all[i], [&](vertex_index v) { return kept.is_active(v); })) {
                p.active.push_back(all[i]);
                for (const vertex_index v : all[i]) widen(v);
            }
        constexpr std::size_t few = 4;  // one in four
        return p.active.size() <= all.size() / few;
    }
    /// Bits for each side of the box that a vertex is beyond, or for active ones.
    std::vector<std::uint8_t> sides_of(const kept_positions& kept, std::size_t vertices) const {
        std::vector<std::uint8_t> all(vertices);
        for (vertex_index v = 0; v < vertices; ++v) {
            unsigned sides = kept.is_active(v) ? active_bit : 0;
            for (std::size_t k = 0; k < 3; ++k)
                sides |= unsigned(row(v)[k] < low_[k]) << (2 * k) | unsigned(row(v)[k] > high_[k])
                                                                        << (2 * k + 1);
            all[v] = static_cast<std::uint8_t>(sides);
        }
        return all;
    }
    /// Elements are near if no coordinate axis separates them from the box. Rounding is monotone.
    template <std::size_t N>
    static void list_near(part<N>& p, const ordered_elements<N>& all,
                          std::span<const std::uint8_t> sides) {
        for (std::size_t i = 0; i < all.size(); ++i) {
            unsigned any = 0, common = all_sides;
            for (const vertex_index v : all[i]) {
                any |= sides[v];
                common &= sides[v];
            }
            if ((any & active_bit) == 0 && common == 0) p.near.push_back(all[i]);
        }
    }

    std::uint64_t version_;
    const float* rounded_;
    part<1> vertices_;
    part<2> edges_;
    part<3> faces_;
    bool are_few_ = false;
    static constexpr float infinity = std::numeric_limits<float>::infinity();
    /// A box in rounded positions that holds the active elements.
    std::array<float, 3> low_{infinity, infinity, infinity}, high_{-infinity, -infinity, -infinity};
};

}  // namespace ccd::detail
