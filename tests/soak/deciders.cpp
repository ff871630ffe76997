#include "tests/soak/deciders.hpp"

#include <algorithm>
#include <ccd/exact.hpp>
#include <ccd/method.hpp>
#include <ccd/reference.hpp>

#include "ccd/exact/integers.hpp"

namespace soak {
namespace {

/// `decide(queries, answers)` of every kind.
template <class Decide>
decider of_all_kinds(std::string name, const Decide& decide) {
    decider all{.name = std::move(name)};
    ccd::for_each_kind([&]<ccd::kind K>() { all.decide.of<K>() = decide; });
    return all;
}

decider exact_one_by_one() {
    return of_all_kinds(
        "one by one", []<ccd::kind K>(const questions<K>& asked, std::span<ccd::outcome> answers) {
            ccd::stage_report report;
            std::ranges::transform(asked.stored, answers.begin(), [&](const auto& q) {
                if constexpr (requires { ccd::decide_exact(q, &report); })
                    return ccd::decide_exact(q, &report).outcome;
                else
                    return ccd::decide_exact(q).outcome;
            });
            return report;
        });
}

}  // namespace

decider reference() {
    return one_by_one("reference", [](const auto& q) { return ccd::decide_reference(q); });
}

std::vector<decider> exact_deciders() {
    std::vector<decider> all{exact_one_by_one()};
    for (const ccd::instruction_set set : ccd::instruction_sets()) {
        const std::string name(ccd::name(set));
        all.push_back(of_all_kinds(
            name + ", stored", [set](const auto& asked, std::span<ccd::outcome> answers) {
                return ccd::decide_batch(asked.stored, answers,
                                         {.threads = 1, .set = set, .explain = true});
            }));
        all.push_back(of_all_kinds(name + ", by index",
                                   [set](const auto& asked, std::span<ccd::outcome> answers) {
                                       // Two threads: the split of a batch is compared too, and
                                       // tells no stages, since the stages that are left out depend
                                       // on it.
                                       return ccd::decide_batch(asked.rows(), asked.pairs, answers,
                                                                {.threads = 2, .set = set});
                                   }));
    }
    return all;
}

decider unfiltered_integers() {
    return one_by_one("integers, unfiltered", [](const auto& q) {
        const ccd::verdict by_integers = ccd::detail::decide_in_integers(q);
        return by_integers.outcome == ccd::outcome::uncertain ? ccd::decide_reference(q)
                                                              : by_integers;
    });
}

std::vector<decider> conservative_deciders() {
    std::vector<decider> all;
    for (const ccd::method method : {ccd::method::tight, ccd::method::safe}) {
        all.push_back(one_by_one(
            std::string(ccd::info(method).name),
            [method](const auto& q) requires requires { ccd::decide(method, q); } {
                return ccd::decide(method, q);
            }));
        all.back().may_be_uncertain = true;
    }
    return all;
}

}  // namespace soak
