#include <algorithm>
#include <ccd/advance.hpp>
#include <stdexcept>
#include <string>

#include "ccd/step/advancing.hpp"
#include "ccd/step/checks.hpp"
#include "ccd/step/vertex_groups.hpp"

namespace ccd {
namespace {

detail::vertex_groups groups_of(std::size_t vertices, std::span<const int> groups) {
    if (!groups.empty() && groups.size() != vertices)
        throw std::invalid_argument("ccd::advance: number of groups is " +
                                    std::to_string(groups.size()) + "; expected " +
                                    std::to_string(vertices) + ", one for each vertex");
    detail::vertex_groups made(vertices);
    if (groups.empty()) made.join_all();
    for (vertex_index v = 0; v < groups.size(); ++v) made.join_named(groups[v], v);
    return made;
}

}  // namespace

advance_result advance(mesh_steps& steps, const vertex_rows& positions,
                       const advance_options& options) {
    detail::vertex_groups groups = groups_of(positions.vertices, options.groups);
    detail::no_others nobody;
    advance_result result =
        detail::advancing(steps, positions, options, !options.groups.empty(), groups, nobody).run();
    for (const double f : result.fractions) result.fraction = std::min(result.fraction, f);
    return result;
}

advance_result advance(const mesh& before, const mesh& after, const advance_options& options) {
    detail::check_frames(before, after);
    mesh_steps steps(before);
    return advance(steps, vertex_rows(before, after), options);
}

}  // namespace ccd
