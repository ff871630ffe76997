// Positions rounded to floats, for the first stage of `exact` and for boxes. Internal.
#pragma once

#include <algorithm>
#include <ccd/cuda.hpp>
#include <cstddef>
#include <cstdint>
#include <errbound/number_traits.hpp>

#include "ccd/batch/rounded_axes.hpp"
#include "ccd/cuda/queries.hpp"

namespace ccd::cuda::detail {

/// Four floats of a vertex: x y z at the start or the end of the step, and padding.
struct alignas(16) rounded_position {
    float x, y, z, unused;
};

/// The box around all positions. `finite` is true if all coordinates are.
struct scene_extent {
    ccd::detail::rounded_axes::extent box;
    bool finite;

    /// Returns a power of two. Its products with differences of coordinates are at most 4 in size.
    constexpr double power_of_two() const {
        using traits = errbound::number_traits<double>;
        double half_extent = 0;
        for (std::size_t k = 0; k < 3; ++k)
            half_extent = traits::max(half_extent, box.high[k] / 2 - box.low[k] / 2);
        // Neither zero nor infinite. At the bounds, floats decide few candidates.
        const int e =
            half_extent > 0 && traits::is_finite(half_extent) ? traits::exponent(half_extent) : 0;
        return traits::scale(1.0, -std::clamp(e, -1000, 1000));
    }

    static constexpr scene_extent nothing() {
        return {ccd::detail::rounded_axes::extent::nothing(), true};
    }
};

struct extent_of_vertex {
    positions at;

    constexpr scene_extent operator()(std::uint32_t v) const {
        auto e = scene_extent::nothing();
        for (const auto* frame : {&at.before, &at.after})
            for (std::size_t k = 0; k < 3; ++k) {
                const double x = coordinate_at(at, *frame, k, v);
                e.box.widen(k, x);
                e.finite = e.finite && errbound::number_traits<double>::is_finite(x);
            }
        return e;
    }
};
struct hull_of_extents {
    constexpr scene_extent operator()(scene_extent a, const scene_extent& b) const {
        for (std::size_t k = 0; k < 3; ++k) {
            a.box.widen(k, b.box.low[k]);
            a.box.widen(k, b.box.high[k]);
        }
        a.finite = a.finite && b.finite;
        return a;
    }
};

/// Rounds a vertex' positions to rows 2v (before) and 2v + 1 (after).
struct round_vertex {
    positions at;
    const scene_extent* scene;
    rounded_position* rows;

    constexpr void operator()(std::uint32_t v) const {
        const ccd::detail::rounded_axes::frame rounded(scene->box);
        const auto row = [&](const positions::frame& frame) {
            const auto x = [&](std::size_t k) {
                return rounded(k, coordinate_at(at, frame, k, v));
            };
            return rounded_position{x(0), x(1), x(2), 0};
        };
        rows[2 * std::size_t(v)] = row(at.before);
        rows[2 * std::size_t(v) + 1] = row(at.after);
    }
};

template <class Launcher>
void run_rounding(Launcher& launcher, const positions& at, scene_extent* scene,
                  rounded_position* rows) {
    launcher.reduce(at.vertices, extent_of_vertex{at}, hull_of_extents{}, scene_extent::nothing(),
                    scene);
    launcher.for_each(at.vertices, round_vertex{at, scene, rows});
}

}  // namespace ccd::cuda::detail
