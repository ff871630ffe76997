#include "ccd/mpi/intersections.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <stdexcept>
#include <tuple>

#include "ccd/mpi/checks.hpp"
#include "ccd/mpi/decomposition.hpp"

namespace ccd::mpi {
namespace detail {
namespace {

void sort(std::vector<numbered_intersection>& pairs) {
    std::ranges::sort(pairs, {}, [](const numbered_intersection& pair) {
        return std::tuple(pair.kind(), pair.a, pair.b);
    });
}

}  // namespace

/// Local indices are in the order of numbers, so elements and pairs keep their order.
std::vector<numbered_intersection> numbered(const std::vector<intersection>& pairs,
                                            const local_mesh& local) {
    const auto with_numbers = [&](const mesh_element& element) {
        numbered_element named{element.size, {}};
        std::ranges::transform(element.vertices(), named.numbers.begin(),
                               [&](vertex_index v) { return local.number(v); });
        return named;
    };
    std::vector<numbered_intersection> all;
    for (const intersection& pair : pairs)
        all.push_back({with_numbers(pair.a), with_numbers(pair.b), pair.relation, pair.segment});
    return all;
}

std::vector<numbered_intersection> placed(exchanger& ranks, const local_mesh& local,
                                          const std::vector<intersection>& pairs, placement where) {
    const std::vector<numbered_intersection> own = numbered(pairs, local);
    std::vector<std::vector<numbered_intersection>> to(ranks.size());
    for (std::size_t i = 0; i < own.size(); ++i)
        to[where == placement::root ? 0 : local.owner(pairs[i].a.indices[0])].push_back(own[i]);
    std::vector<numbered_intersection> here = ranks.all_to_all(to).items;
    sort(here);
    return here;
}

std::vector<numbered_intersection> of_all_ranks(exchanger& ranks, const local_mesh& local,
                                                const std::vector<intersection>& pairs) {
    std::vector<numbered_intersection> all = ranks.gather(numbered(pairs, local)).items;
    sort(all);
    return all;
}

}  // namespace detail

intersection_result intersections(MPI_Comm comm, const mesh_part& mesh,
                                  const intersection_options& options, placement where) {
    using clock = std::chrono::steady_clock;
    const auto start = clock::now();
    detail::exchanger ranks(comm);
    ranks.agree([&] {
        if (options.wanted == intersection_options::amount::first || options.edge_faces ||
            options.merge_equal_positions)
            throw std::invalid_argument(
                "ccd::mpi::intersections: options have first, edge_faces or "
                "merge_equal_positions; expected none of them");
    });
    mesh_part at_rest = mesh;
    at_rest.positions.after = mesh.positions.before;
    const detail::vertex_lists lists(options.filter, {});
    detail::check_mesh(ranks, at_rest, options.filter, lists, "ccd::mpi::intersections");
    detail::check_options(ranks, {.set = options.set, .filter = options.filter}, where,
                          mesh.numbers.size(), "ccd::mpi::intersections");
    const pair_distances contact;
    const detail::given_elements given(at_rest, contact, options.filter.skip_unused);
    const detail::decomposition parts(ranks, given.boxes());
    const detail::local_mesh local(ranks, at_rest, given, parts, lists);

    ccd::intersection_result found;
    intersection_options own = options;
    own.filter = local.filter(parts.part(ranks.rank()), options.filter);
    ranks.agree([&] { found = local.steps().intersections(local.way(), own); });
    intersection_result result;
    result.pairs = detail::placed(ranks, local, found.pairs, where);
    for (const auto& counts : ranks.gather(std::vector{found.counts}).items)
        result.counts += counts;
    result.work = {given.boxes().size(), local.elements(), ranks.bytes(),
                   std::chrono::duration<double>(clock::now() - start).count()};
    return result;
}

}  // namespace ccd::mpi
