// The parts of the soak, and the deciders whose answers they compare.
#pragma once

#include <array>
#include <ccd/advance.hpp>
#include <ccd/batch.hpp>
#include <ccd/kind.hpp>
#include <ccd/methods/transform.hpp>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tests/ccd/step/brute_force.hpp"
#include "tests/soak/long_run.hpp"
#include "tests/support/query_families.hpp"

namespace soak {

// ---- Queries of families ----

std::string row_name(const query_families::family& family);

/// The first index of `family` after `blocks` blocks of `per_block` queries. Families that cost the
/// reference tenths of a second have fewer.
std::uint64_t family_end(const query_families::family& family, std::uint64_t blocks,
                         std::uint64_t per_block);
/// The number of queries of all families in the first `blocks` blocks.
std::uint64_t queries_in(std::uint64_t blocks, std::uint64_t per_block);

struct family_query {
    const query_families::family* family;
    std::uint64_t index;
    query_families::points at;
};
/// A block's queries of one kind, `per_block` of every family (slow ones have fewer), in the order
/// in which deciders get them. Neighbours have the same family in even blocks, different families
/// in odd ones.
std::vector<family_query> block_queries(std::uint64_t seed, std::uint64_t block,
                                        std::uint64_t per_block, ccd::kind which);

count_table family_table(std::vector<std::string> columns);

/// The same queries twice: as stored points, and as pairs of a mesh's vertices.
template <ccd::kind K>
struct query_list {
    using query = typename ccd::kind_traits<K>::template query<double>;
    using pair = ccd::pair_of_kind<K>;
    static constexpr std::size_t point_count =
        ccd::kind_traits<K>::first_vertices + ccd::kind_traits<K>::second_vertices;

    std::vector<query> stored = {};
    std::vector<ccd::point<double>> before = {}, after = {};
    std::vector<pair> pairs = {};

    void add_vertex(const ccd::moving_point<double>& p) {
        before.push_back(p.t0);
        after.push_back(p.t1);
    }
    /// Adds the query of vertices added earlier.
    void add_pair(const std::array<ccd::vertex_index, point_count>& at) {
        [&]<std::size_t... I>(std::index_sequence<I...>) {
            pairs.push_back({at[I]...});
            stored.push_back({ccd::moving_point<double>{before[at[I]], after[at[I]]}...});
        }
        (std::make_index_sequence<point_count>());
    }
    ccd::vertex_rows rows() const { return {&before.data()->x, &after.data()->x, before.size()}; }
};

// ---- Decisions ----

/// Writes the answer to query i into answers[i], and returns the report of stages, if there is one.
/// Several threads call it at a time.
template <ccd::kind K>
using batch_decider =
    std::function<ccd::stage_report(const query_list<K>&, std::span<ccd::outcome>)>;

struct decider {
    std::string name;
    ccd::by_kind<batch_decider> decide = {};  ///< empty for kinds that it does not decide
    bool may_be_uncertain = false;
};

/// A decider of `decide(query)`, for the kinds that it takes.
template <class Decide>
decider one_by_one(std::string name, const Decide& decide) {
    decider all{.name = std::move(name)};
    ccd::for_each_kind([&]<ccd::kind K>() {
        if constexpr (requires(typename query_list<K>::query q) { decide(q); })
            all.decide.of<K>() = [decide](const auto& queries, std::span<ccd::outcome> answers) {
                for (std::size_t i = 0; i < answers.size(); ++i)
                    answers[i] = decide(queries.stored[i]).outcome;
                return ccd::stage_report();
            };
    });
    return all;
}

/// ccd::decide_reference.
decider reference();
/// `exact` in single calls, and batches with every instruction set of this machine, of stored
/// queries and by index.
std::vector<decider> exact_deciders();
/// The last stages of `exact` without the filters, which otherwise decide most queries.
decider unfiltered_integers();

/// Compares the deciders with `truth`. Table "family": the queries and their collisions. Table
/// "against the reference": a row for each decider: compared, different.
part comparison_part(decider truth, std::vector<decider> deciders);

/// Queries of every family and all four kinds. The first decider decides the query itself. Each
/// decider, the first too, decides other images of it (tests/soak/images.hpp), and must give the
/// same answer. The printed number of answers omits deciders that can be uncertain; their certain
/// answers are compared, too. Tables: "family", the queries; "decided by", the stages, of deciders
/// that report them; "decider", all answers.
part symmetry_part(std::vector<decider> deciders);
/// exact_deciders() and the methods `tight` and `safe`, whose certain answers must be right.
std::vector<decider> symmetric_deciders();

// ---- Meshes ----

/// A small mesh of three queries of a family, of any kinds, with more elements between them.
brute_force::two_frames mesh_of(const query_families::family& family, std::uint64_t seed,
                                std::uint64_t index);
/// A text with all data of the mesh.
std::string text_of(const brute_force::two_frames& at);

/// Reports the pairs of a mesh by ccd::step with `threads` threads, with candidates counted or not.
using stepper =
    std::function<ccd::step_result(const brute_force::two_frames&, int threads, bool counted)>;
ccd::step_result exact_step(const brute_force::two_frames& at, int threads, bool counted);

/// Small meshes around queries of every family, with faces, rods and points, in some of which a
/// face is repeated. Also mixtures on a grid. Candidates and pairs of `step`, with one thread and
/// with two, are compared with the reference on every pair.
part mesh_part(stepper step = exact_step);

struct advance_scene;
/// Advances a scene by ccd::advance with `threads` threads.
using advancer = std::function<ccd::advance_result(const advance_scene&, int threads)>;
ccd::advance_result library_advance(const advance_scene& scene, int threads);

/// Small meshes of every family of queries, and others whose features are a few units in the last
/// place apart. Some are in the plane, some have distances and groups. They are advanced with
/// one thread, where the oracle checks every pair, and with two, with the same result. Tables:
/// "scenes" by family, and "where", "distances", "groups".
part advance_part(advancer advance = library_advance);

// ---- Others ----

/// Polynomials of every family of tests/errbound/roots, and with roots that nearly coincide.
/// isolate_roots and count_roots with errbound's integers and GMP's, on the line and on its
/// positive half, are compared with FLINT's counts.
part polynomial_part();

/// Every predicate whose name contains `name`, in float and double. An oracle checks its sign, and
/// for one input in eight also batches and every stage. Exact arithmetic checks the bound of its
/// static filter on inputs of all families. From these inputs, a hill climb that changes
/// last places searches for larger errors.
part predicate_part(const std::string& name);

}  // namespace soak
