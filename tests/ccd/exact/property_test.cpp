// Random queries of every family: promises of each method compared with the oracle, and symmetries
// of exact verdicts.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <ccd/exact.hpp>
#include <ccd/method.hpp>
#include <ccd/methods/forms.hpp>
#include <ccd/methods/tracked_query.hpp>
#include <ccd/reference.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <errbound/rules/tight.hpp>
#include <functional>
#include <iostream>
#include <iterator>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "ccd/exact/integers.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/query_families.hpp"
#include "tests/support/scaled.hpp"

namespace {

using query_families::csv;
using query_families::families;
using query_families::kind;
using query_families::points;

constexpr std::size_t family_count = std::size(families);

constexpr std::uint64_t seed = 1;  // ./run soak uses other seeds

std::uint64_t queries_per_family() {
    return support::scaled(215000 / family_count);
}

template <class... Values>
std::string format(const char* pattern, Values... values) {
    std::array<char, 256> text;
    std::snprintf(text.data(), text.size(), pattern, values...);
    return text.data();
}

ccd::verdict decide(ccd::method method, kind which, const points& p) {
    return query_families::visit_stored_query(
        which, p, [method](const auto& q) { return ccd::decide(method, q); });
}

// Calls decide(query) with the points as a query of that kind; decide() takes all kinds.
template <class Decide>
ccd::verdict decide_by(const Decide& decide, kind which, const points& p) {
    return query_families::visit_query(which, p, decide);
}

ccd::verdict decide_exact(kind which, const points& p) {
    return decide_by([](const auto& q) { return ccd::decide_exact(q); }, which, p);
}
ccd::verdict decide_reference(kind which, const points& p) {
    return decide_by([](const auto& q) { return ccd::decide_reference(q); }, which, p);
}
ccd::verdict decide_in_integers(kind which, const points& p) {
    return decide_by([](const auto& q) { return ccd::detail::decide_in_integers(q); }, which, p);
}

bool oracle_collides(kind which, const points& p, oracle::shortcuts use = oracle::shortcuts::on) {
    return query_families::visit_query(which, p,
                                       [use](const auto& q) { return oracle::collides(q, use); });
}

// Wrong verdicts of one method; false positives include uncertain ones.
struct errors {
    std::uint64_t false_positives = 0, false_negatives = 0;
};

struct tally {
    std::uint64_t queries = 0;
    std::uint64_t collisions = 0;
    std::uint64_t crossed_once = 0;
    std::vector<errors> by_method = std::vector<errors>(ccd::methods().size());
    // causes of uncertain answers by integers of fixed width
    std::uint64_t out_of_range = 0, undecided = 0;

    void add(const tally& other) {
        queries += other.queries;
        collisions += other.collisions;
        crossed_once += other.crossed_once;
        for (std::size_t i = 0; i < by_method.size(); ++i) {
            by_method[i].false_positives += other.by_method[i].false_positives;
            by_method[i].false_negatives += other.by_method[i].false_negatives;
        }
        out_of_range += other.out_of_range;
        undecided += other.undecided;
    }
};

// Results of one thread, so that threads share nothing.
struct report {
    std::array<tally, family_count> tallies{};
    std::vector<std::string> failures;
};

// Calls check(family, index, report) for every query, on all of the machine's threads.
template <class Check>
report for_all_queries(std::uint64_t per_family, const Check& check) {
    const unsigned workers = std::max(1u, std::thread::hardware_concurrency());
    std::vector<report> reports(workers);
    std::vector<std::thread> threads;
    for (unsigned worker = 0; worker < workers; ++worker) {
        threads.emplace_back([&, worker] {
            for (std::size_t family = 0; family < family_count; ++family) {
                for (std::uint64_t i = worker; i * families[family].thinning < per_family;
                     i += workers) {
                    check(family, i, reports[worker]);
                }
            }
        });
    }
    for (std::thread& t : threads) t.join();
    report total;
    for (report& r : reports) {
        for (std::size_t i = 0; i < family_count; ++i) total.tallies[i].add(r.tallies[i]);
        std::move(r.failures.begin(), r.failures.end(), std::back_inserter(total.failures));
    }
    return total;
}

void expect_no_failures(const report& r) {
    constexpr std::size_t shown = 5;
    for (std::size_t i = 0; i < std::min(shown, r.failures.size()); ++i) {
        ADD_FAILURE() << r.failures[i];
    }
    EXPECT_EQ(r.failures.size(), 0u) << "of them the first " << shown << " are shown";
}

std::string describe(std::size_t family, kind which, std::uint64_t index, const points& p,
                     const std::string& what) {
    return what + "\nfamily " + std::string(families[family].name) + ", " +
           std::string(path_name(which)) + ", index " + std::to_string(index) + "\n" + csv(p);
}

// True if Y certainly has exactly one, simple, root between t = 0 and t = 1: the only possible
// contact.
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
bool crosses_once(kind which, const points& p) {
    return query_families::visit_stored_query(which, p,
                                              [](const auto& q) { return crosses_once(q); });
}

void check_methods(kind which, std::size_t family, std::uint64_t index, report& out) {
    const points p = query_families::make(families[family], which, seed, index);
    const bool truth = oracle_collides(which, p);
    const ccd::outcome right = truth ? ccd::outcome::collides : ccd::outcome::separate;
    tally& count = out.tallies[family];
    ++count.queries;
    count.collisions += truth;
    const auto fail = [&](std::string_view who, ccd::outcome said) {
        const std::string what = std::string(who) + " returns " + std::string(ccd::name(said)) +
                                 ", the oracle returns " + std::string(ccd::name(right));
        out.failures.push_back(describe(family, which, index, p, what));
    };
    const auto require_right = [&](std::string_view who, ccd::verdict said) {
        if (said.outcome != right) fail(who, said.outcome);
    };
    // The last stages are also called directly, since the filter decides most queries.
    require_right("decide_exact", decide_exact(which, p));
    require_right("decide_reference", decide_reference(which, p));
    const ccd::verdict integers = decide_in_integers(which, p);
    if (integers.outcome == ccd::outcome::uncertain)
        ++(integers.cause == ccd::cause::range ? count.out_of_range : count.undecided);
    else
        require_right("decide_in_integers", integers);
    if (crosses_once(which, p)) {
        ++count.crossed_once;
        require_right("root-parity, of one root,", decide(ccd::method::root_parity, which, p));
    }

    for (std::size_t m = 0; m < ccd::methods().size(); ++m) {
        const ccd::method_info& method = ccd::methods()[m];
        const ccd::verdict said = decide(method.method, which, p);
        const bool lost = truth && !ccd::may_collide(said);
        const bool invented = !truth && ccd::may_collide(said);
        count.by_method[m].false_negatives += lost;
        count.by_method[m].false_positives += invented;
        const bool certainly_wrong =
            said.outcome != ccd::outcome::uncertain && said.outcome != right;
        const bool no_errors = !method.may_lose_collisions && !method.may_report_false_collisions;
        if ((lost && !method.may_lose_collisions) ||
            (invented && !method.may_report_false_collisions) ||
            // A method that may err on one side reports `uncertain` there.
            (certainly_wrong && !method.may_lose_collisions) ||
            (no_errors && said.outcome == ccd::outcome::uncertain)) {
            fail(method.name, said.outcome);
        }
    }
}

void print(kind which, const report& r) {
    struct column {
        std::string title;
        std::function<std::uint64_t(const tally&)> value;
    };
    std::vector<column> columns{{"queries", [](const tally& t) { return t.queries; }},
                                {"collisions", [](const tally& t) { return t.collisions; }},
                                {"one root", [](const tally& t) { return t.crossed_once; }}};
    for (std::size_t m = 0; m < ccd::methods().size(); ++m) {
        if (ccd::methods()[m].may_report_false_collisions)
            columns.push_back({std::string(ccd::methods()[m].name) + " FP",
                               [m](const tally& t) { return t.by_method[m].false_positives; }});
    }
    for (std::size_t m = 0; m < ccd::methods().size(); ++m) {
        if (ccd::methods()[m].may_lose_collisions)
            columns.push_back({std::string(ccd::methods()[m].name) + " FN",
                               [m](const tally& t) { return t.by_method[m].false_negatives; }});
    }
    columns.push_back({"out of range", [](const tally& t) { return t.out_of_range; }});
    columns.push_back({"undecided", [](const tally& t) { return t.undecided; }});

    std::cout << format("%-25s", std::string(path_name(which)).c_str());
    for (const column& c : columns) std::cout << "  " << c.title;
    std::cout << '\n';
    const auto row = [&columns](std::string_view title, const tally& t) {
        std::cout << format("%-25s", std::string(title).c_str());
        for (const column& c : columns)
            std::cout << format("%*ju", static_cast<int>(c.title.size()) + 2,
                                std::uintmax_t{c.value(t)});
        std::cout << '\n';
    };
    tally total;
    for (std::size_t i = 0; i < family_count; ++i) {
        row(families[i].name, r.tallies[i]);
        total.add(r.tallies[i]);
    }
    row("all", total);
}

void expect_promises_kept(kind which) {
    const report r = for_all_queries(queries_per_family(),
                                     [which](std::size_t family, std::uint64_t index, report& out) {
                                         check_methods(which, family, index, out);
                                     });
    print(which, r);
    expect_no_failures(r);
}

TEST(promises, vertex_face) {
    expect_promises_kept(kind::vertex_face);
}

TEST(promises, edge_edge) {
    expect_promises_kept(kind::edge_edge);
}

// A face with equal corners is an edge or a vertex, and an edge with equal ends is a vertex. The
// oracle decides those separately.
TEST(promises, features_that_are_smaller_than_they_look) {
    const auto check = [](std::size_t family, std::uint64_t index, report& out) {
        const auto agree = [&](kind which, const points& original, const points& as_face,
                               const points& as_edges) {
            const ccd::outcome right =
                oracle_collides(which, original) ? ccd::outcome::collides : ccd::outcome::separate;
            if (decide(ccd::method::exact, kind::vertex_face, as_face).outcome != right) {
                out.failures.push_back(describe(family, which, index, original, "as vertex-face"));
            }
            if (decide(ccd::method::exact, kind::edge_edge, as_edges).outcome != right) {
                out.failures.push_back(describe(family, which, index, original, "as edge-edge"));
            }
            const ccd::verdict integers = decide_in_integers(which, original);
            if (integers.outcome == ccd::outcome::uncertain ? integers.cause != ccd::cause::range
                                                            : integers.outcome != right) {
                out.failures.push_back(describe(family, which, index, original, "in integers"));
            }
            if (decide_exact(which, original).outcome != right ||
                decide_reference(which, original).outcome != right) {
                out.failures.push_back(describe(family, which, index, original, "as it is"));
            }
        };
        const points e = query_families::make(families[family], kind::vertex_edge, seed, index);
        agree(kind::vertex_edge, e, {e[0], e[1], e[2], e[1]}, {e[0], e[0], e[1], e[2]});
        const points v = query_families::make(families[family], kind::vertex_vertex, seed, index);
        agree(kind::vertex_vertex, v, {v[0], v[1], v[1], v[1]}, {v[0], v[0], v[1], v[1]});
    };
    expect_no_failures(for_all_queries(queries_per_family() / 10 + 1, check));
}

TEST(oracle, shortcuts_change_nothing) {
    const auto check = [](std::size_t family, std::uint64_t index, report& out) {
        for (const kind which :
             {kind::vertex_face, kind::edge_edge, kind::vertex_edge, kind::vertex_vertex}) {
            const points p = query_families::make(families[family], which, seed, index);
            if (oracle_collides(which, p, oracle::shortcuts::on) !=
                oracle_collides(which, p, oracle::shortcuts::off)) {
                out.failures.push_back(describe(family, which, index, p, "shortcut differs"));
            }
        }
    };
    expect_no_failures(for_all_queries(queries_per_family() / 20 + 1, check));
}

// ---- Symmetries of exact verdicts ----

// The default of RapidCheck is 100 cases. It reads its parameters once, at the first property.
const bool enough_cases = setenv("RC_PARAMS", "max_success=3000", 0) == 0;

points any_query(kind which) {
    const auto family = *rc::gen::inRange<std::size_t>(0, family_count).as("family");
    const auto index = *rc::gen::inRange<std::uint64_t>(0, 1000000).as("index");
    const points p = query_families::make(families[family], which, seed, index);
    RC_LOG(csv(p));
    return p;
}

kind any_kind() {
    return *rc::gen::element(kind::vertex_face, kind::edge_edge).as("0 vertex-face, 1 edge-edge");
}

bool same_verdict(kind which, const points& a, const points& b) {
    const ccd::verdict verdict = decide(ccd::method::exact, which, a);
    return verdict.outcome != ccd::outcome::uncertain &&
           verdict == decide(ccd::method::exact, which, b);
}

template <class Change>
points changed(points p, Change change) {
    for (auto& m : p) {
        change(m.t0);
        change(m.t1);
    }
    return p;
}

RC_GTEST_PROP(symmetries, corners_of_a_face, ()) {
    const points p = any_query(kind::vertex_face);
    RC_ASSERT(same_verdict(kind::vertex_face, p, {p[0], p[2], p[3], p[1]}));
    RC_ASSERT(same_verdict(kind::vertex_face, p, {p[0], p[1], p[3], p[2]}));
}

RC_GTEST_PROP(symmetries, edges_and_their_ends, ()) {
    const points p = any_query(kind::edge_edge);
    RC_ASSERT(same_verdict(kind::edge_edge, p, {p[1], p[0], p[2], p[3]}));
    RC_ASSERT(same_verdict(kind::edge_edge, p, {p[0], p[1], p[3], p[2]}));
    RC_ASSERT(same_verdict(kind::edge_edge, p, {p[2], p[3], p[0], p[1]}));
}

RC_GTEST_PROP(symmetries, time_reversed, ()) {
    const kind which = any_kind();
    const points p = any_query(which);
    points reversed = p;
    for (auto& m : reversed) std::swap(m.t0, m.t1);
    RC_ASSERT(same_verdict(which, p, reversed));
}

RC_GTEST_PROP(symmetries, axes_exchanged, ()) {
    const kind which = any_kind();
    const points p = any_query(which);
    RC_ASSERT(same_verdict(which, p, changed(p, [](ccd::point<double>& at) {
                               at = {at.y, at.z, at.x};
                           })));
    RC_ASSERT(
        same_verdict(which, p, changed(p, [](ccd::point<double>& at) { std::swap(at.x, at.y); })));
}

RC_GTEST_PROP(symmetries, mirrored, ()) {
    const kind which = any_kind();
    const points p = any_query(which);
    RC_ASSERT(same_verdict(which, p, changed(p, [](ccd::point<double>& at) { at.z = -at.z; })));
}

RC_GTEST_PROP(symmetries, scaled_by_a_power_of_two, ()) {
    const kind which = any_kind();
    const points p = any_query(which);
    const int exponent = *rc::gen::inRange(-1000, 1001).as("exponent");
    bool exact = true;
    const points scaled = changed(p, [&](ccd::point<double>& at) {
        for (double* x : {&at.x, &at.y, &at.z}) {
            const double original = *x;
            *x = std::ldexp(original, exponent);
            exact = exact && std::isfinite(*x) && std::ldexp(*x, -exponent) == original;
        }
    });
    RC_PRE(exact);
    RC_ASSERT(same_verdict(which, p, scaled));
}

}  // namespace
