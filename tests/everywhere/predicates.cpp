#include <array>
#include <cmath>
#include <cstddef>
#include <errbound/predicate_batch.hpp>
#include <errbound/predicates.hpp>
#include <errbound/simplices/predicates.hpp>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "tests/everywhere/numbers.hpp"
#include "tests/everywhere/sections.hpp"

namespace everywhere {
namespace {

using ccd::lab::source;

constexpr std::size_t inputs = 640;

/// Points on a lattice, where most predicates are often zero, some moved to an adjacent number; or
/// any numbers.
template <class T, std::size_t Dimension>
std::array<T, Dimension> any_point(source& random, int spread) {
    std::array<T, Dimension> p;
    for (T& x : p) {
        if (spread == 0) {
            x = any_number<T>(random, random.one_in(4));
            continue;
        }
        x = static_cast<T>(random.between(-2, 2)) * T(0.75) + T(spread);
        if (random.one_in(12))
            x = std::nextafter(x, random.one_in(2) ? std::numeric_limits<T>::max()
                                                   : std::numeric_limits<T>::lowest());
    }
    return p;
}

template <class T, std::size_t Dimension, class Predicate, std::size_t... I>
void record_predicate(recorder& to, const char* name, const Predicate& predicate,
                      std::index_sequence<I...>) {
    source random = ccd::lab::source_of(name, {});
    std::array<std::vector<std::array<T, Dimension>>, sizeof...(I)> points;
    for (std::size_t i = 0; i < inputs; ++i) {
        const int spread = random.between(0, 3);
        for (auto& p : points) p.push_back(any_point<T, Dimension>(random, spread * spread));
    }
    for (std::size_t i = 0; i < inputs; ++i) to.add(predicate(points[I][i]...));
    std::vector<errbound::sign_type> signs(inputs);
    errbound::batch_signs(predicate, std::span(signs), points[I]...);
    to.add(signs);
    to.end_item(name);
}

template <std::size_t Dimension, std::size_t Count, class T = double, class Predicate>
void record_all(recorder& to, const char* name, const Predicate& predicate) {
    record_predicate<T, Dimension>(to, name, predicate, std::make_index_sequence<Count>());
}

}  // namespace

void record_predicates(recorder& to) {
    record_all<2, 3>(to, "orient2d", errbound::orient2d);
    record_all<2, 3, float>(to, "orient2d of floats", errbound::orient2d);
    record_all<3, 4>(to, "orient3d", errbound::orient3d);
    record_all<3, 4, float>(to, "orient3d of floats", errbound::orient3d);
    record_all<2, 4>(to, "incircle", errbound::incircle);
    record_all<3, 5>(to, "insphere", errbound::insphere);
    record_all<3, 4>(to, "power_incircle", errbound::power_incircle);
    record_all<4, 5>(to, "power_insphere", errbound::power_insphere);
    record_all<2, 3>(to, "compare_distances2d", errbound::compare_distances2d);
    record_all<3, 3>(to, "compare_distances3d", errbound::compare_distances3d);
    record_all<3, 4>(to, "segments_intersect3d", errbound::segments_intersect3d);
    record_all<2, 4>(to, "segments_intersect2d", errbound::segments_intersect2d);
    record_all<3, 5>(to, "segment_intersects_triangle", errbound::segment_intersects_triangle);
    record_all<3, 6>(to, "triangle_intersects_triangle", errbound::triangle_intersects_triangle);
    record_all<2, 6>(to, "orient2d_line_line", errbound::orient2d_line_line);
    record_all<3, 8>(to, "orient3d_line_plane", errbound::orient3d_line_plane);
    record_all<2, 8>(to, "compare_x_line_line", errbound::compare_x_line_line);
}

}  // namespace everywhere
