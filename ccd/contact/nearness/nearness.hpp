// The data of one query: from the numbers of nearness_filter::values, and weights. Internal.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/kind.hpp>
#include <ccd/nearness.hpp>
#include <cstddef>
#include <cstdint>

namespace ccd::detail {

/// The members of nearness_filter::values, in order.
using nearness_row = std::array<double, 12>;

/// Precondition: the region is not -1.
template <kind K>
nearness nearness_of_row(const nearness_row& row);

/// Sets the weights of features of kind K. Each feature's first point gets the rest of 1, the
/// others weight(i) >= 0, cut to the rest. A cut adds no error, since the true weights add up to 1.
template <kind K, class Weight>
void set_weights(const std::array<std::uint8_t, 4>& points, const Weight& weight, nearness& into) {
    constexpr std::size_t first = kind_traits<K>::first_vertices;
    const auto set = [&](std::size_t begin, std::size_t end) {
        double left = 1;
        for (std::size_t i = end; --i > begin;) {
            const double w = std::min(weight(i), left);
            left -= w;
            into.weights[points[i]] = w;
        }
        into.weights[points[begin]] = left;
    };
    set(0, first);
    set(first, first + kind_traits<K>::second_vertices);
}

}  // namespace ccd::detail
