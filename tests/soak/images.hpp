// Images of a query that have the same answer. An invertible linear map, reversed time, a
// translation at each end of the step, and other names for the same points: all exact in doubles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ccd/lab/queries.hpp"

namespace soak {

using ccd::lab::source;

/// A map of the query's space and time; every axis of the image comes from one of the query's.
struct image {
    /// The map of an axis: none; moves one point to 0; moves all by a power of two; adds or
    /// subtracts another axis. The motions of the two ends of the step differ.
    enum class form : std::uint8_t { plain, at_point, moved, sheared };
    struct axis {
        std::uint8_t from = 0;
        form as = form::plain;
        bool negated = false;
        int exponent = 0;  ///< times 2^exponent
    };
    std::array<axis, 3> axes{{{0}, {1}, {2}}};
    bool reversed = false;
};
/// A readable text: "x = -y moved 2^5, ..., time reversed".
std::string text_of(const image& m);

class query_images {
  public:
    /// Uses the first `count` of the points.
    query_images(const ccd::lab::points& query, std::size_t count, source& random);
    /// A random image that is exact.
    image draw(source& random) const;
    ccd::lab::points of(const image& m) const;

  private:
    static constexpr std::size_t form_count = 4;
    /// The coordinates of all points at both ends on one axis. The least and the greatest power of
    /// two by which they can be multiplied exactly.
    struct coordinates {
        std::array<std::array<double, 2>, 4> at{};
        int low = 0, high = 0;
    };
    struct choice {
        std::array<coordinates, form_count> as{};
        std::array<image::form, form_count> exact{};  ///< forms that are exact, plain first
        int exact_count = 1;
    };

    void add_if_exact(std::size_t axis, image::form as, std::size_t count,
                      const std::array<std::array<double, 2>, 4>& added);

    std::array<choice, 3> axes_;
};

/// The index of a query's point for each point of an image. An image's kind may have more points;
/// some of them are then equal.
using slot_map = std::array<std::uint8_t, 4>;
/// All maps from one kind to another; empty if there is none.
std::span<const slot_map> slot_maps(ccd::kind query, ccd::kind image);

}  // namespace soak
