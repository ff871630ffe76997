// Whoever answers queries in a soak: the reference, `exact` in every way, conservative methods.
#pragma once

#include <array>
#include <ccd/batch.hpp>
#include <ccd/kind.hpp>
#include <ccd/methods/transform.hpp>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace soak {

/// The same queries twice: as they are, and as pairs of a mesh's vertices.
template <ccd::kind K>
struct questions {
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
    /// The query of vertices that were added.
    void add_pair(const std::array<ccd::vertex_index, point_count>& at) {
        [&]<std::size_t... I>(std::index_sequence<I...>) {
            pairs.push_back({at[I]...});
            stored.push_back({ccd::moving_point<double>{before[at[I]], after[at[I]]}...});
        }
        (std::make_index_sequence<point_count>());
    }
    ccd::vertex_rows rows() const { return {&before.data()->x, &after.data()->x, before.size()}; }
};

/// Decides query i into answers[i], by whatever means, and returns what the stages did, if it
/// tells. Called from several threads at once.
template <ccd::kind K>
using batch_decider =
    std::function<ccd::stage_report(const questions<K>&, std::span<ccd::outcome>)>;

struct decider {
    std::string name;
    ccd::by_kind<batch_decider> decide = {};  ///< empty for kinds that it does not decide
    bool may_be_uncertain = false;
};

/// A decider of `decide(query)`, for kinds for which there is one.
template <class Decide>
decider one_by_one(std::string name, const Decide& decide) {
    decider all{.name = std::move(name)};
    ccd::for_each_kind([&]<ccd::kind K>() {
        if constexpr (requires(typename questions<K>::query q) { decide(q); })
            all.decide.of<K>() = [decide](const auto& asked, std::span<ccd::outcome> answers) {
                for (std::size_t i = 0; i < answers.size(); ++i)
                    answers[i] = decide(asked.stored[i]).outcome;
                return ccd::stage_report();
            };
    });
    return all;
}

/// ccd::decide_reference.
decider reference();
/// `exact` one by one, and batches on every instruction set of this machine, of stored queries and
/// by index.
std::vector<decider> exact_deciders();
/// The last stages of `exact` without the filters: they see what filters decide before them.
decider unfiltered_integers();
/// `tight` and `safe`: what they are certain of must be right.
std::vector<decider> conservative_deciders();

}  // namespace soak
