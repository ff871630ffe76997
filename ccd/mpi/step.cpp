#include <algorithm>
#include <ccd/mpi.hpp>
#include <chrono>
#include <numeric>
#include <utility>

#include "ccd/mpi/checks.hpp"
#include "ccd/mpi/decomposition.hpp"
#include "ccd/mpi/exchange.hpp"
#include "ccd/mpi/intersections.hpp"
#include "ccd/mpi/local_mesh.hpp"

namespace ccd::mpi {
namespace {

/// A pair in a message to the rank that reports it.
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
void return_pairs(detail::exchanger& ranks, const detail::local_mesh& local,
                  const ccd::step_result& found, placement where, step_result& result) {
    const auto& pairs = found.pairs.of<K>();
    const auto& times = found.times.of<K>();
    const auto& at_start = found.touching_at_start.of<K>();
    std::vector<std::vector<sent_pair<K>>> to(ranks.size());
    const std::vector<std::size_t> owners =
        where == placement::root ? std::vector<std::size_t>(pairs.size(), 0) : local.owners(pairs);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        sent_pair<K> pair{};
        std::ranges::transform(vertices_of(pairs[i]), pair.vertices.begin(),
                               [&](vertex_index v) { return local.number(v); });
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
    detail::exchanger ranks(comm);
    const detail::vertex_lists lists(options.filter, options.distances);
    detail::check_mesh(ranks, mesh, options.filter, lists, "ccd::mpi::step");
    detail::check_options(ranks, options, where, mesh.numbers.size(), "ccd::mpi::step");
    const detail::given_elements given(mesh, options.distances, options.filter.skip_unused);
    const detail::decomposition parts(ranks, given.boxes());
    const detail::local_mesh local(ranks, mesh, given, parts, lists);

    ccd::step_result found;
    step_options own = options;
    own.filter = local.filter(parts.part(ranks.rank()), options.filter);
    own.distances = local.distances(options.distances);
    ranks.agree([&] { found = local.steps().run(local.way(), own); });
    step_result result;
    for_each_kind([&]<kind K>() { return_pairs<K>(ranks, local, found, where, result); });
    if (options.check_start)
        result.intersections_at_start =
            detail::placed(ranks, local, found.intersections_at_start, where);
    if (options.times || options.first_contact || options.t_max < 1)
        result.first_contact = ranks.earliest(found.first_contact);
    result.decided = found.candidates;
    if (found.candidates) result.candidates = sum_of(ranks, *found.candidates);
    result.work = {given.boxes().size(), local.elements(), ranks.bytes(),
                   std::chrono::duration<double>(clock::now() - start).count()};
    return result;
}

}  // namespace ccd::mpi
