// Random queries of every family: promises of each method compared with the oracle. tests/soak has
// the symmetries of exact verdicts.
#include <gtest/gtest.h>

#include <algorithm>
#include <ccd/exact.hpp>
#include <ccd/method.hpp>
#include <ccd/methods/forms.hpp>
#include <ccd/methods/tracked_query.hpp>
#include <ccd/reference.hpp>
#include <cstdint>
#include <errbound/rules/tight.hpp>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "ccd/exact/integers.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/query_families.hpp"
#include "tests/support/scaled.hpp"

namespace {

using ccd::outcome;
using query_families::families;
using query_families::kind;
using query_families::points;

constexpr std::uint64_t seed = 1;  // ./run soak uses other seeds

std::uint64_t queries_per_family() {
    return support::scaled(215000 / std::size(families));
}

ccd::verdict decide(ccd::method method, kind which, const points& p) {
    return query_families::visit_stored_query(
        which, p, [method](const auto& q) { return ccd::decide(method, q); });
}
ccd::verdict decide_in_integers(kind which, const points& p) {
    return query_families::visit_query(
        which, p, [](const auto& q) { return ccd::detail::decide_in_integers(q); });
}

/// The oracle's answer. Expects it of decide_exact and decide_reference; where() names the query.
template <class Where>
outcome right_outcome(kind which, const points& p, const Where& where) {
    return query_families::visit_query(which, p, [&](const auto& q) {
        const outcome right = oracle::collides(q) ? outcome::collides : outcome::separate;
        EXPECT_EQ(ccd::decide_exact(q).outcome, right) << where();
        EXPECT_EQ(ccd::decide_reference(q).outcome, right) << where();
        return right;
    });
}

/// Calls check(family, index) for every query, on all of the machine's threads.
template <class Check>
void for_all_queries(std::uint64_t per_family, const Check& check) {
    const unsigned workers = std::max(1u, std::thread::hardware_concurrency());
    std::vector<std::thread> threads;
    for (unsigned worker = 0; worker < workers; ++worker)
        threads.emplace_back([&, worker] {
            for (const auto& family : families)
                for (std::uint64_t i = worker; i * family.thinning < per_family; i += workers)
                    check(family, i);
        });
    for (std::thread& t : threads) t.join();
}

std::string describe(const query_families::family& family, kind which, std::uint64_t index,
                     const points& p) {
    return "family " + std::string(family.name) + ", " + std::string(path_name(which)) +
           ", index " + std::to_string(index) + "\n" + query_families::csv(p);
}

/// True if Y certainly has exactly one, simple, root between t = 0 and t = 1: the only possible
/// contact.
template <class Query>
bool crosses_once(const Query& query) {
    const auto [tracked, finite] = ccd::tracked_query<errbound::tight>(query);
    const auto y = ccd::forms_of(tracked).y();
    const auto monotone = errbound::sign_inside(errbound::derivative(y));
    return finite &&
           (monotone == errbound::sign_type::positive ||
            monotone == errbound::sign_type::negative) &&
           sign_of(y[0]) * sign_of(y[3]) == errbound::sign_type::negative;
}

/// The last stages are also called directly, since the filter decides most queries.
void check_methods(kind which, const query_families::family& family, std::uint64_t index) {
    const points p = query_families::make(family, which, seed, index);
    const auto where = [&] { return describe(family, which, index, p); };
    const outcome right = right_outcome(which, p, where);
    const outcome integers = decide_in_integers(which, p).outcome;
    EXPECT_TRUE(integers == outcome::uncertain || integers == right) << where();
    if (query_families::visit_stored_query(which, p,
                                           [](const auto& q) { return crosses_once(q); })) {
        EXPECT_EQ(decide(ccd::method::root_parity, which, p).outcome, right) << where();
    }
    for (const ccd::method_info& method : ccd::methods()) {
        const ccd::verdict said = decide(method.method, which, p);
        const bool truth = right == outcome::collides, may = ccd::may_collide(said);
        EXPECT_TRUE(method.may_lose_collisions || may || !truth) << method.name << ", " << where();
        EXPECT_TRUE(method.may_report_false_collisions || !may || truth)
            << method.name << ", " << where();
        // A method that may err on one side reports `uncertain` there.
        EXPECT_TRUE(method.may_lose_collisions || said.outcome == outcome::uncertain ||
                    said.outcome == right)
            << method.name << ", " << where();
        EXPECT_TRUE(method.may_lose_collisions || method.may_report_false_collisions ||
                    said.outcome != outcome::uncertain)
            << method.name << ", " << where();
    }
}

class Promises : public testing::TestWithParam<kind> {};

TEST_P(Promises, AreKept) {
    for_all_queries(queries_per_family(), [](const auto& family, std::uint64_t index) {
        check_methods(GetParam(), family, index);
    });
}

INSTANTIATE_TEST_SUITE_P(Kinds, Promises, testing::ValuesIn(ccd::stored_kinds),
                         [](const auto& which) { return std::string(short_name(which.param)); });

}  // namespace
