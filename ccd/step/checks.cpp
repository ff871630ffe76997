#include "ccd/step/checks.hpp"

#include <algorithm>
#include <ccd/method.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "ccd/batch/checks.hpp"
#include "ccd/exact/finite.hpp"

namespace ccd::detail {
namespace {

template <std::size_t N>
void check_indices(std::span<const std::array<vertex_index, N>> elements, const std::string& of,
                   std::size_t vertices) {
    for (std::size_t i = 0; i < elements.size(); ++i)
        for (const vertex_index v : elements[i])
            if (v >= vertices)
                throw std::invalid_argument(of + std::to_string(i) + " is " + std::to_string(v) +
                                            "; expected less than " + std::to_string(vertices));
}

/// `time` is empty if there is one frame.
void check_finite(const std::string& caller, const double* frame, std::size_t vertices,
                  const char* time, std::span<const std::uint64_t> numbers = {}) {
    if (all_finite(frame, 3 * vertices)) return;
    const double* bad =
        std::find_if_not(frame, frame + 3 * vertices, [](double x) { return std::isfinite(x); });
    const auto at = static_cast<std::size_t>(bad - frame);
    throw std::invalid_argument(caller + ": " + "xyz"[at % 3] + " of vertex " +
                                std::to_string(numbers.empty() ? at / 3 : numbers[at / 3]) + time +
                                " is " + text_of(*bad) + "; expected a finite number");
}

void check_length(const std::string& of, std::size_t found, std::size_t vertices) {
    if (found != vertices)
        throw std::invalid_argument(of + " is " + std::to_string(found) + "; expected " +
                                    std::to_string(vertices) + ", one for each vertex");
}

void check_filter(const std::string& caller, const pair_filter& filter, std::size_t vertices) {
    if (filter.rule != pair_filter::group_rule::between_groups &&
        filter.rule != pair_filter::group_rule::within_groups)
        throw std::invalid_argument(caller + ": group rule is " +
                                    std::to_string(static_cast<int>(filter.rule)) +
                                    "; expected between_groups or within_groups");
    if (!filter.groups.empty())
        check_length(caller + ": number of groups", filter.groups.size(), vertices);
    if (!filter.pinned.empty())
        check_length(caller + ": number of pinned flags", filter.pinned.size(), vertices);
}

std::string text(std::span<const vertex_index> indices) {
    std::string s;
    for (const vertex_index i : indices) s += (s.empty() ? "(" : ", ") + std::to_string(i);
    return s + ")";
}

template <class Elements>
void check_same(const std::string& of, const Elements& before, const Elements& after,
                const std::string& caller) {
    if (before.size() != after.size())
        throw std::invalid_argument(caller + ": number of " + of + "s after is " +
                                    std::to_string(after.size()) + "; expected " +
                                    std::to_string(before.size()) + " as before");
    const auto [b, a] = std::ranges::mismatch(before, after);
    if (b != before.end())
        throw std::invalid_argument(caller + ": " + of + " " + std::to_string(b - before.begin()) +
                                    " after is " + text(*a) + "; expected " + text(*b) +
                                    " as before");
}

}  // namespace

void check_frames(const mesh& before, const mesh& after, const std::string& caller) {
    if (before.vertices.size() != after.vertices.size())
        throw std::invalid_argument(caller + ": number of vertices after is " +
                                    std::to_string(after.vertices.size()) + "; expected " +
                                    std::to_string(before.vertices.size()) + " as before");
    check_same("face", before.faces, after.faces, caller);
    check_same("edge", before.edges, after.edges, caller);
}

void check_elements(std::span<const face> faces, std::span<const edge> edges, std::size_t vertices,
                    const std::string& caller) {
    if (std::max({vertices, faces.size(), edges.size()}) > std::numeric_limits<vertex_index>::max())
        throw std::invalid_argument(caller +
                                    ": number of vertices, faces or edges is too large; expected "
                                    "fewer than 2^32");
    check_indices(faces, caller + ": vertex index of face ", vertices);
    check_indices(edges, caller + ": vertex index of edge ", vertices);
}

void check_positions(const vertex_rows& positions, std::size_t vertices, const std::string& caller,
                     std::span<const std::uint64_t> numbers) {
    check_length(caller + ": number of positions", positions.vertices, vertices);
    if (vertices == 0) return;
    if (positions.before == nullptr || positions.after == nullptr)
        throw std::invalid_argument(caller + ": pointer to positions is null; expected positions");
    check_finite(caller, positions.before, vertices, " at t = 0", numbers);
    check_finite(caller, positions.after, vertices, " at t = 1", numbers);
}

void check_at_rest(const vertex_rows& positions, std::size_t vertices, const pair_filter& filter,
                   bool in_plane) {
    check_length("ccd::intersections: number of positions", positions.vertices, vertices);
    check_filter("ccd::intersections", filter, vertices);
    if (vertices == 0) return;
    if (positions.before == nullptr)
        throw std::invalid_argument(
            "ccd::intersections: pointer to positions is null; expected positions");
    check_finite("ccd::intersections", positions.before, vertices, "");
    for (std::size_t v = 0; in_plane && v < vertices; ++v)
        if (positions.before[3 * v + 2] != 0)
            throw std::invalid_argument("ccd::intersections: z of vertex " + std::to_string(v) +
                                        " is not 0; expected positions in the plane z = 0");
}

bool needs_times_or_distances(const step_options& options) {
    return options.times || options.first_contact || options.t_max < 1 ||
           !options.distances.is_contact();
}

void check_shares(double conservative, double keep, const std::string& caller) {
    if (!(0 < conservative && conservative <= 1))
        throw std::invalid_argument(caller + ": conservative is " + text_of(conservative) +
                                    "; expected a number in (0, 1]");
    if (!(0 <= keep && keep < 1))
        throw std::invalid_argument(caller + ": keep is " + text_of(keep) +
                                    "; expected a number in [0, 1)");
}

void check_plane(const vertex_rows& positions, const std::string& caller) {
    for (vertex_index v = 0; v < positions.vertices; ++v) {
        const auto [before, after] = positions[v];
        if (before.z != 0 || after.z != 0)
            throw std::invalid_argument(caller + ": z of vertex " + std::to_string(v) +
                                        " is not 0; expected positions in the plane z = 0");
    }
}

void check_options(const step_options& options, std::size_t vertices, const std::string& caller) {
    if (std::ranges::find(methods(), options.method, &method_info::method) == methods().end())
        throw std::invalid_argument(caller + ": method is " +
                                    std::to_string(static_cast<int>(options.method)) +
                                    "; expected one of ccd::methods()");
    check_t_max(caller.c_str(), options.t_max);
    check_distances(caller.c_str(), options.distances, vertices);
    if (needs_times_or_distances(options) && options.method != method::exact)
        throw std::invalid_argument(caller + ": method is " +
                                    std::string(info(options.method).name) +
                                    "; expected exact, the only one with times and distances");
    if (options.adjacent_rods && !options.distances.is_contact())
        throw std::invalid_argument(
            caller + ": adjacent_rods is given with distances; expected only one of them");
    check_filter(caller, options.filter, vertices);
}

bool has_faces_only(const mesh& mesh) {
    std::vector<bool> on_an_edge(mesh.vertices.size());
    for (const edge& e : unique_edges(mesh.faces)) on_an_edge[e[0]] = on_an_edge[e[1]] = true;
    return mesh.edges.empty() && std::ranges::count(on_an_edge, false) < 2;
}

}  // namespace ccd::detail
