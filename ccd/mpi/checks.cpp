#include "ccd/mpi/checks.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <unordered_set>

#include "ccd/step/checks.hpp"

namespace ccd::mpi::detail {
namespace {

template <std::size_t N>
void check_same(exchanger& ranks, const std::array<double, N>& options, const std::string& caller) {
    const auto all = ranks.gather(std::vector{options}).items;
    ranks.agree([&] {
        if (all.front() != options)
            throw std::invalid_argument(
                caller + ": options differ from those on rank 0; expected the same on all ranks");
    });
}

void check_lengths(const vertex_lists& lists, std::size_t vertices, const std::string& caller) {
    for (const std::size_t length :
         {lists.groups.size(), lists.pinned.size(), lists.thickness.size(), lists.islands.size()})
        if (length != 0 && length != vertices)
            throw std::invalid_argument(caller + ": length of a list is " + std::to_string(length) +
                                        "; expected " + std::to_string(vertices) +
                                        ", one entry for each number");
}

void check_given_alike(exchanger& ranks, const vertex_lists& lists, std::size_t vertices,
                       const std::string& caller) {
    const std::array given{!lists.groups.empty(), !lists.pinned.empty(), !lists.thickness.empty(),
                           !lists.islands.empty()};
    // Ranks without vertices do not take part.
    const auto all =
        ranks.gather(vertices == 0 ? std::vector<std::array<bool, 4>>() : std::vector{given});
    ranks.agree([&] {
        if (vertices != 0 && all.items.front() != given)
            throw std::invalid_argument(
                caller +
                ": lists of groups, flags, thicknesses or islands are not those of other ranks; "
                "expected the same ones on all ranks with vertices");
    });
}

}  // namespace

void check_mesh(exchanger& ranks, const mesh_part& mesh, const pair_filter& filter,
                const vertex_lists& lists, const std::string& caller) {
    const std::size_t vertices = mesh.numbers.size();
    ranks.agree([&] {
        if (mesh.positions.vertices != vertices)
            throw std::invalid_argument(caller + ": number of positions is " +
                                        std::to_string(mesh.positions.vertices) + "; expected " +
                                        std::to_string(vertices) + ", one for each number");
        std::unordered_set<vertex_number> unique;
        for (const vertex_number number : mesh.numbers)
            if (!unique.insert(number).second)
                throw std::invalid_argument(caller + ": number of a vertex is " +
                                            std::to_string(number) +
                                            " twice; expected unique numbers");
        if (filter.can_collide || filter.region)
            throw std::invalid_argument(caller +
                                        ": filter has can_collide or a region; expected only "
                                        "groups and pinned flags");
        ccd::detail::check_elements(mesh.faces, mesh.edges, vertices, caller);
        ccd::detail::check_positions(mesh.positions, vertices, caller, mesh.numbers);
        check_lengths(lists, vertices, caller);
    });
    check_given_alike(ranks, lists, vertices, caller);
}

void check_options(exchanger& ranks, const step_options& options, placement pairs,
                   std::size_t vertices, const std::string& caller) {
    ranks.agree([&] { ccd::detail::check_options(options, vertices, caller); });
    check_same(ranks,
               std::array{static_cast<double>(options.method), double(options.count_candidates),
                          double(options.explain), double(options.initial_contact),
                          double(options.first_contact), double(options.times),
                          double(options.check_start), double(options.adjacent_rods), options.t_max,
                          options.distances.all, static_cast<double>(options.filter.rule),
                          double(options.filter.skip_unused), static_cast<double>(pairs)},
               caller);
}

void check_options(exchanger& ranks, const advance_options& options, std::size_t vertices,
                   const std::string& caller) {
    ranks.agree([&] {
        ccd::detail::check_shares(options.conservative, options.keep, caller);
        if (options.each_vertex)
            throw std::invalid_argument(caller + ": each_vertex is true; expected false");
        ccd::detail::check_options(
            {.set = options.set, .distances = options.distances, .filter = options.filter},
            vertices, caller);
    });
    check_same(ranks,
               std::array{options.distances.all, static_cast<double>(options.filter.rule),
                          double(options.filter.skip_unused), options.conservative, options.keep,
                          double(options.check_start)},
               caller);
}

bool is_given_anywhere(exchanger& ranks, std::span<const int> list) {
    return ranks.least(list.empty() ? 1 : 0) == 0;
}

}  // namespace ccd::mpi::detail
