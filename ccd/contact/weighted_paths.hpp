// The paths of a query's points over a ring, each feature with one weight. Internal.
#pragma once

#include <array>
#include <ccd/kind.hpp>
#include <cstddef>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>

#include "ccd/contact/feature_conditions.hpp"
#include "ccd/contact/moving_points.hpp"

namespace ccd::detail {

/// Not copyable, since `q` refers to the weights.
template <kind K, class Ring>
class weighted_paths {
  public:
    using element = typename Ring::element;

    template <class Motion>
    weighted_paths(std::span<const Motion> points, const Ring& ring) {
        point_evaluator<Ring> evaluate(ring);
        for (std::size_t i = 0; i < count; ++i) own[i] = evaluate(points[i]);
        // Only boxes of bodies need each point with its own weight afterwards.
        std::array<path<element>, count> common;
        for (std::size_t i = 0; i < count; ++i) {
            if constexpr (std::is_same_v<Motion, body_point>)
                common[i] = own[i].h;
            else
                common[i] = std::move(own[i].h);
        }
        weights_ = {with_common_weight(points, common, 0, first),
                    with_common_weight(points, common, first, count)};
        q = paths_of<K, element>([&](std::size_t i) -> weighted_path<element> {
            const auto& weight = weights_[i < first ? 0 : 1];
            return {std::move(common[i]), weight ? &*weight : nullptr};
        });
    }
    weighted_paths(const weighted_paths&) = delete;
    weighted_paths& operator=(const weighted_paths&) = delete;

    /// x times the squares of both weights.
    element times_squared_weights(element x) const {
        for (const auto& w : weights_)
            if (w) x = x * (*w * *w);
        return x;
    }

    /// x divided by both weights as often as possible. Its sign at t in [0, 1] stays the same.
    element without_weights(element x) const {
        for (const auto& w : weights_)
            if (w) x = x.without_factor(*w);
        return x;
    }

    static constexpr std::size_t first = kind_traits<K>::first_vertices;
    static constexpr std::size_t count = first + kind_traits<K>::second_vertices;
    std::array<homogeneous_point<Ring>, count> own;  ///< a body's points with their own weights
    paths<K, element> q;

  private:
    /// Multiplies each point of a feature by the weights of the others, equal ones only once.
    /// Returns the product of all.
    template <class Motion>
    std::optional<element> with_common_weight(std::span<const Motion> points,
                                              std::array<path<element>, count>& common,
                                              std::size_t begin, std::size_t end) const {
        std::optional<element> product;
        for (std::size_t i = begin; i < end; ++i) {
            if (!own[i].weight) continue;
            std::size_t earlier = begin;
            while (!(own[earlier].weight && have_one_weight(points[earlier], points[i]))) ++earlier;
            if (earlier < i) continue;
            const element& w = *own[i].weight;
            for (std::size_t j = begin; j < end; ++j)
                if (!own[j].weight || !have_one_weight(points[i], points[j]))
                    common[j] = times_weight(common[j], &w);
            product = product ? *product * w : w;
        }
        return product;
    }

    std::array<std::optional<element>, 2> weights_;
};

}  // namespace ccd::detail
