#include <array>
#include <cstddef>
#include <cstdint>
#include <errbound/predicate_batch.hpp>
#include <errbound/predicates.hpp>
#include <errbound/simplices/predicates.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "interruptible.hpp"

namespace errbound::python {
namespace {

using points_array = input<double, -1, -1>;

template <int Dimension>
std::span<const std::array<double, Dimension>> points_of(const points_array& array,
                                                         std::size_t count) {
    if (array.shape(0) != count || array.shape(1) != Dimension)
        throw std::invalid_argument("predicates: arrays of different lengths or dimensions");
    return items_of<std::array<double, Dimension>>(array);
}

/// Binds a function of a list of arrays. Signs are -1, 0, 1; 2 for coordinates that are not finite.
template <class Predicate, std::size_t... I>
void bind(nb::module_& m, const char* name, const Predicate& predicate, std::index_sequence<I...>) {
    m.def(name, [predicate](const nb::list& arrays) {
        if (arrays.size() != sizeof...(I))
            throw std::invalid_argument("number of arrays is " + std::to_string(arrays.size()) +
                                        "; expected " + std::to_string(sizeof...(I)));
        const std::array held{nb::cast<points_array>(arrays[I], false)...};
        const std::size_t count = held[0].shape(0);
        const std::tuple points{points_of<Predicate::shape::dimensions[I]>(held[I], count)...};
        std::vector<std::int8_t> signs(count);
        const std::span found(reinterpret_cast<sign_type*>(signs.data()), count);
        in_parts(count, 65536, [&](std::size_t first, std::size_t size) {
            batch_signs(predicate, found.subspan(first, size),
                        std::get<I>(points).subspan(first, size)...);
            for (std::size_t i = first; i < first + size; ++i)
                signs[i] = static_cast<std::int8_t>(static_cast<int>(found[i]) - 1);
        });
        return numbers_of<std::int8_t>(std::move(signs));
    });
}
template <class Predicate>
void bind(nb::module_& m, const char* name, const Predicate& predicate) {
    bind(m, name, predicate, std::make_index_sequence<Predicate::shape::count>());
}

}  // namespace

void bind_predicates(nb::module_& m) {
    bind(m, "orient2d", orient2d);
    bind(m, "orient3d", orient3d);
    bind(m, "incircle", incircle);
    bind(m, "insphere", insphere);
    bind(m, "power_incircle", power_incircle);
    bind(m, "power_insphere", power_insphere);
    bind(m, "compare_distances2d", compare_distances2d);
    bind(m, "compare_distances3d", compare_distances3d);
    bind(m, "segments_intersect2d", segments_intersect2d);
    bind(m, "segments_intersect3d", segments_intersect3d);
    bind(m, "segment_intersects_triangle", segment_intersects_triangle);
    bind(m, "triangle_intersects_triangle", triangle_intersects_triangle);
    bind(m, "orient2d_line_line", orient2d_line_line);
    bind(m, "orient3d_line_plane", orient3d_line_plane);
    bind(m, "compare_x_line_line", compare_x_line_line);
}

}  // namespace errbound::python
