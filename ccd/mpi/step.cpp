// One step of a mesh that is spread over ranks.
#include <algorithm>
#include <ccd/mpi.hpp>
#include <chrono>
#include <numeric>
#include <stdexcept>
#include <string>
#include <tuple>
#include <unordered_set>
#include <utility>

#include "ccd/mpi/decomposition.hpp"
#include "ccd/mpi/exchange.hpp"
#include "ccd/mpi/held_mesh.hpp"
#include "ccd/step/checks.hpp"

namespace ccd::mpi {
namespace {

void check(const mesh_part& mesh, const step_options& options) {
    if (mesh.positions.vertices != mesh.numbers.size())
        throw std::invalid_argument(
            "ccd::mpi::step: found " + std::to_string(mesh.positions.vertices) +
            " positions, expected " + std::to_string(mesh.numbers.size()) + ", one a number");
    const std::unordered_set<vertex_number> unique(mesh.numbers.begin(), mesh.numbers.end());
    if (unique.size() != mesh.numbers.size())
        throw std::invalid_argument("ccd::mpi::step: found a vertex's number given twice");
    if (options.filter.can_collide || options.filter.part)
        throw std::invalid_argument(
            "ccd::mpi::step: found can_collide or a part of space, expected groups and pinned "
            "flags alone");
    ccd::detail::check_elements(mesh.faces, mesh.edges, mesh.numbers.size(), "ccd::mpi::step");
    ccd::detail::check_positions(mesh.positions, mesh.numbers.size());
    ccd::detail::check_options(options, mesh.numbers.size());
}

/// A pair on its way to who asked for it.
template <kind K>
struct sent_pair {
    numbered_pair<K> vertices;
    first_time time;
    bool touches_at_start;
    friend bool operator<(const sent_pair& a, const sent_pair& b) {
        return a.vertices < b.vertices;
    }
};

template <kind K>
void return_pairs(detail::exchanger& ranks, const detail::held_mesh& held,
                  const ccd::step_result& found, placement where, step_result& result) {
    const auto& pairs = found.pairs.of<K>();
    const auto& times = found.times.of<K>();
    const auto& at_start = found.touching_at_start.of<K>();
    std::vector<std::vector<sent_pair<K>>> to(ranks.size());
    const std::vector<std::size_t> owners =
        where == placement::root ? std::vector<std::size_t>(pairs.size(), 0) : held.owners(pairs);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        sent_pair<K> pair{};
        std::ranges::transform(vertices_of(pairs[i]), pair.vertices.begin(),
                               [&](vertex_index v) { return held.number(v); });
        if (!times.empty()) pair.time = times[i];
        pair.touches_at_start = std::ranges::binary_search(at_start, pairs[i]);
        to[owners[i]].push_back(pair);
    }
    auto here = ranks.all_to_all(to).items;
    std::ranges::sort(here, std::less<>());
    for (const sent_pair<K>& pair : here) {
        result.pairs.of<K>().push_back(pair.vertices);
        if (pair.touches_at_start) result.touching_at_start.of<K>().push_back(pair.vertices);
        if (pair.time.outcome == outcome::collides) result.times.of<K>().push_back(pair.time);
    }
}

/// The earliest of all ranks' first contacts.
first_time earliest_of(detail::exchanger& ranks, const first_time& own) {
    first_time earliest = own;
    for (const first_time& time : ranks.gather(std::vector<first_time>{own}).items) {
        if (time.outcome != outcome::collides) continue;
        if (earliest.outcome != outcome::collides ||
            std::pair(time.low, time.high) < std::pair(earliest.low, earliest.high))
            earliest = time;
    }
    return earliest;
}

pair_counts sum_of(detail::exchanger& ranks, const pair_counts& own) {
    pair_counts sum;
    for (const pair_counts& counts : ranks.gather(std::vector<pair_counts>{own}).items)
        for_each_kind([&]<kind K>() { sum.of<K>() += counts.of<K>(); });
    return sum;
}

}  // namespace

step_result step(MPI_Comm comm, const mesh_part& mesh, const step_options& options,
                 placement where) {
    using clock = std::chrono::steady_clock;
    const auto start = clock::now();
    detail::agree(comm, [&] { check(mesh, options); });
    detail::exchanger ranks(comm);
    const detail::given_elements given(mesh, options.distances);
    const detail::decomposition parts(ranks, given.boxes());
    const detail::held_mesh held(ranks, mesh, given, parts, options);

    ccd::step_result found;
    detail::agree(comm, [&] { found = held.step(parts.part(ranks.rank()), options); });
    step_result result;
    for_each_kind([&]<kind K>() { return_pairs<K>(ranks, held, found, where, result); });
    if (options.times || options.first_contact || options.t_max < 1)
        result.first_contact = earliest_of(ranks, found.first_contact);
    result.decided = found.candidates;
    if (found.candidates) result.candidates = sum_of(ranks, *found.candidates);
    result.work = {given.boxes().size(), held.elements(), ranks.bytes(),
                   std::chrono::duration<double>(clock::now() - start).count()};
    return result;
}

}  // namespace ccd::mpi
