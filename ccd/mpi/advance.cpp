// Advances of a mesh on many ranks. Each rank holds the elements near its region of space. All
// ranks have the motion of every group, because they join, shorten and take back by the same list
// of pairs.
//
// Elements stay on the ranks of the whole step, because boxes swept by shorter motions are inside
// those of the whole step.
#include <algorithm>
#include <ccd/mpi.hpp>
#include <chrono>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "ccd/mpi/checks.hpp"
#include "ccd/mpi/decomposition.hpp"
#include "ccd/mpi/exchange.hpp"
#include "ccd/mpi/intersections.hpp"
#include "ccd/mpi/local_mesh.hpp"
#include "ccd/step/advance/advancing.hpp"
#include "ccd/step/vertex_groups.hpp"

namespace ccd::mpi {
namespace {

/// A rank's vertices by index: first those that it holds, then others that it has received.
class known_vertices {
  public:
    known_vertices(const detail::local_mesh& local, bool islands)
        : local_(local), islands_(islands), groups_(local.vertices()) {
        if (!islands) groups_.join_all();
        if (groups_.vertices() == 0) groups_.add();  // represents all vertices
        first_other_ = static_cast<vertex_index>(groups_.vertices());
        for (vertex_index v = 0; islands && v < local.vertices(); ++v)
            groups_.join_named(local.island(v), v);
    }

    vertex_index index(vertex_number number, int island) {
        if (const auto local = local_.find(number)) return *local;
        const auto [at, is_new] = others_.try_emplace(number, 0);
        if (is_new) {
            at->second = groups_.add();
            if (islands_) groups_.join_named(island, at->second);
            numbers_.push_back(number);
            islands_of_others_.push_back(island);
        }
        return at->second;
    }
    vertex_number number(vertex_index v) const {
        return v < first_other_ ? local_.number(v) : numbers_[v - first_other_];
    }
    int island(vertex_index v) const {
        return v < first_other_ ? local_.island(v) : islands_of_others_[v - first_other_];
    }
    ccd::detail::vertex_groups& groups() { return groups_; }

  private:
    const detail::local_mesh& local_;
    bool islands_;
    ccd::detail::vertex_groups groups_;
    vertex_index first_other_ = 0;
    std::unordered_map<vertex_number, vertex_index> others_;
    std::vector<vertex_number> numbers_;
    std::vector<int> islands_of_others_;
};

class other_ranks {
  public:
    other_ranks(detail::exchanger& ranks, known_vertices& vertices)
        : ranks_(ranks), vertices_(vertices) {}

    /// Returns the pairs of all ranks in the order of their vertices' numbers.
    template <class Pair>
    std::vector<ccd::detail::timed_pair<Pair>> found_by_all(
        const std::vector<ccd::detail::timed_pair<Pair>>& own) {
        constexpr std::size_t n = std::tuple_size_v<decltype(vertices_of(Pair{}))>;
        struct sent {
            std::array<vertex_number, n> numbers;
            std::array<int, n> islands;
            first_time time;
        };
        std::vector<sent> list;
        for (const auto& [pair, time] : own) {
            sent& s = list.emplace_back(sent{{}, {}, time});
            const auto of_pair = vertices_of(pair);
            for (std::size_t i = 0; i < n; ++i) {
                s.numbers[i] = vertices_.number(of_pair[i]);
                s.islands[i] = vertices_.island(of_pair[i]);
            }
        }
        auto all = ranks_.gather(list).items;
        std::ranges::sort(all, {}, &sent::numbers);
        std::vector<ccd::detail::timed_pair<Pair>> pairs;
        for (const sent& s : all) {
            std::array<vertex_index, n> v;
            for (std::size_t i = 0; i < n; ++i) v[i] = vertices_.index(s.numbers[i], s.islands[i]);
            pairs.push_back({std::apply([](auto... i) { return Pair{i...}; }, v), s.time});
        }
        return pairs;
    }
    template <class Call>
    void call(const Call& what) {
        ranks_.agree(what);
    }
    first_time earliest(const first_time& time) { return ranks_.earliest(time); }
    bool all(bool holds) { return ranks_.least(holds ? 1 : 0) == 1; }

  private:
    detail::exchanger& ranks_;
    known_vertices& vertices_;
};

template <kind K>
std::vector<numbered_pair<K>> numbered(const std::vector<pair_of_kind<K>>& pairs,
                                       const known_vertices& vertices) {
    std::vector<numbered_pair<K>> numbers;
    for (const auto& pair : pairs)
        std::ranges::transform(vertices_of(pair), numbers.emplace_back().begin(),
                               [&](vertex_index v) { return vertices.number(v); });
    return numbers;
}

}  // namespace

advance_result advance(MPI_Comm comm, const mesh_part& mesh, const advance_options& options) {
    using clock = std::chrono::steady_clock;
    const auto start = clock::now();
    detail::exchanger ranks(comm);
    const detail::vertex_lists lists(options.filter, options.distances, options.groups);
    detail::check_mesh(ranks, mesh, options.filter, lists, "ccd::mpi::advance");
    detail::check_options(ranks, options, mesh.numbers.size(), "ccd::mpi::advance");
    // The search for near pairs has the widest boxes: each rank holds all pairs that it owns there.
    std::vector<double> scaled;
    const detail::given_elements given(mesh, ccd::detail::near_distances(options, scaled),
                                       options.filter.skip_unused);
    const detail::decomposition parts(ranks, given.boxes());
    const detail::local_mesh local(ranks, mesh, given, parts, lists);

    const bool islands = detail::is_given_anywhere(ranks, options.groups);
    known_vertices vertices(local, islands);
    std::vector<vertex_index> own(mesh.numbers.size());
    for (std::size_t i = 0; i < own.size(); ++i)
        own[i] = vertices.index(mesh.numbers[i], islands ? options.groups[i] : 0);
    other_ranks others(ranks, vertices);
    mesh_steps steps = local.steps();
    advance_options adjusted = options;
    adjusted.filter = local.filter(parts.part(ranks.rank()), options.filter);
    adjusted.distances = local.distances(options.distances);
    const vertex_rows way = local.way();
    const ccd::advance_result found =
        ccd::detail::advancing(steps, way, adjusted, islands, vertices.groups(), others).run();

    advance_result result;
    result.first_contact = found.first_contact;
    for_each_kind([&]<kind K>() {
        result.first_pairs.of<K>() = numbered<K>(found.first_pairs.of<K>(), vertices);
        result.touching_at_start.of<K>() = numbered<K>(found.touching_at_start.of<K>(), vertices);
        result.near_at_start.of<K>() = numbered<K>(found.near_at_start.of<K>(), vertices);
    });
    if (options.check_start)
        result.intersections_at_start =
            detail::of_all_ranks(ranks, local, found.intersections_at_start);
    for (vertex_index i = 0; i < own.size(); ++i) {
        const double f = vertices.groups().fraction(own[i]);
        result.fractions.push_back(f);
        result.fraction = std::min(result.fraction, f);
        result.positions.push_back(
            ccd::detail::between(mesh.positions[i], f, vertices.groups().last_places_back(own[i])));
    }
    result.fraction = ranks.least(result.fraction);
    result.work = {given.boxes().size(), local.elements(), ranks.bytes(),
                   std::chrono::duration<double>(clock::now() - start).count()};
    return result;
}

}  // namespace ccd::mpi
