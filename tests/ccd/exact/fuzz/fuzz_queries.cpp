// Compares every function of `exact` and the promises of each method with an independent exact
// decision, on queries of all kinds.
#include <array>
#include <ccd/method.hpp>
#include <string>
#include <vector>

#include "tests/soak/parts.hpp"
#include "tests/support/fuzz_numbers.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/query_families.hpp"

namespace {

using query_families::points;

points reversed(points p) {
    for (auto& m : p) std::swap(m.t0, m.t1);
    return p;
}

[[noreturn]] void fail(ccd::kind which, const points& p, const std::string& who, ccd::outcome said,
                       bool truth) {
    fuzz::fail(who + " returns " + std::string(ccd::name(said)) + ", expected " +
               (truth ? "collides" : "separate") + ", " + std::string(short_name(which)) + ":\n" +
               query_families::csv(p));
}

/// True if the method may give this answer. A method that may err on one side reports `uncertain`
/// there.
bool keeps_promise(const ccd::method_info& method, ccd::outcome said, bool truth) {
    if (method.may_lose_collisions)
        return truth || said == ccd::outcome::separate || method.may_report_false_collisions;
    if (said == ccd::outcome::uncertain) return method.may_report_false_collisions;
    return (said == ccd::outcome::collides) == truth;
}

/// `count` queries of the same vertices: the query and its reverse alternately.
template <ccd::kind K>
soak::query_list<K> there_and_back(const points& p, std::size_t count) {
    soak::query_list<K> all;
    constexpr std::size_t vertices = soak::query_list<K>::point_count;
    for (const points& way : {p, reversed(p)})
        for (std::size_t i = 0; i < vertices; ++i) all.add_vertex(way[i]);
    for (std::size_t i = 0; i < count; ++i) {
        std::array<ccd::vertex_index, vertices> at;
        for (std::size_t k = 0; k < vertices; ++k)
            at[k] = static_cast<ccd::vertex_index>(k + i % 2 * vertices);
        all.add_pair(at);
    }
    return all;
}

template <ccd::kind K>
void check(const points& p, std::size_t copies) {
    using query = typename soak::query_list<K>::query;
    const query q = query_families::as_query<query>(p);
    const bool truth = oracle::collides(q);
    const ccd::outcome right = truth ? ccd::outcome::collides : ccd::outcome::separate;
    const auto expect = [&](const soak::decider& d, const soak::query_list<K>& queries) {
        std::vector<ccd::outcome> answers(queries.pairs.size(), static_cast<ccd::outcome>(255));
        d.decide.of<K>()(queries, answers);
        for (const ccd::outcome said : answers)
            if (said != right) fail(K, p, d.name, said, truth);
    };
    static const std::vector<soak::decider> exact = soak::exact_deciders();
    static const std::array slow{soak::reference(), soak::unfiltered_integers()};
    const soak::query_list<K> one = there_and_back<K>(p, 1), many = there_and_back<K>(p, copies);
    for (const soak::decider& d : slow) expect(d, one);
    for (const soak::decider& d : exact) expect(d, many);
    if constexpr (requires { ccd::decide(ccd::method::exact, q); })
        for (const ccd::method_info& method : ccd::methods()) {
            const ccd::outcome said = ccd::decide(method.method, q).outcome;
            if (!keeps_promise(method, said, truth))
                fail(K, p, std::string(method.name), said, truth);
        }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::numbers from(data, size);
    const auto which = static_cast<ccd::kind>(from.below(4));
    const std::size_t copies = 1 + from.below(17);
    const auto p = fuzz::points_from<points>(from);
    ccd::visit_kind(which, [&]<ccd::kind K>() { check<K>(p, copies); });
    return 0;
}
