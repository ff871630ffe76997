#include "tests/soak/first_times.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <ccd/contact.hpp>
#include <ccd/curves.hpp>
#include <ccd/exact.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/reference.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <utility>

#include "ccd/contact/integer_times.hpp"
#include "tests/support/distance_families.hpp"
#include "tests/support/first_time_faults.hpp"

namespace soak {
namespace {

using ccd::first_time;
using ccd::outcome;
using ccd::separation;
using query_families::kind;
using query_families::source;

constexpr std::uint64_t queries_per_block = 8;  // of a family and kind
constexpr unsigned slow = 16;                   // the stride of slow deciders

bool is_double(const first_time& t) {
    return t.outcome == outcome::collides && t.low == t.high;
}

std::string text_of(const first_time& t) {
    if (t.outcome != outcome::collides) return std::string(ccd::name(t.outcome));
    char text[80];
    std::snprintf(text, sizeof text, "[%a, %a]", t.low, t.high);
    return text;
}
std::string text_of(separation d, double t_max) {
    char text[120];
    std::snprintf(text, sizeof text, "distance %a + %a, t_max %a", d.first, d.second, t_max);
    return text;
}

/// The first time in [0, t_max], computed from the first time in [0, 1].
first_time until(const first_time& right, double t_max) {
    return right.outcome == outcome::collides && right.high <= t_max
               ? right
               : first_time{.outcome = outcome::separate};
}

/// The query's motion from about its first time on, at many times the speed. Its first time is
/// about 0, possibly below the least double, or 0.
query_families::points hastened(const query_families::points& at, double first, int exponent) {
    const auto moved = [&](double t0, double t1, double& from, double& to) {
        constexpr double largest = std::numeric_limits<double>::max();
        from = std::lerp(t0, t1, first);
        to = std::clamp(from + std::ldexp(t1 - t0, exponent), -largest, largest);
    };
    query_families::points out = at;
    for (std::size_t i = 0; i < at.size(); ++i) {
        const auto& [t0, t1] = at[i];
        moved(t0.x, t1.x, out[i].t0.x, out[i].t1.x);
        moved(t0.y, t1.y, out[i].t0.y, out[i].t1.y);
        moved(t0.z, t1.z, out[i].t0.z, out[i].t1.z);
    }
    return out;
}

/// A value of t_max, near the first time or anywhere.
double some_end(source& random, const first_time& right) {
    switch (random.between(0, 7)) {
        case 0:
            return right.low;
        case 1:
            return right.high;
        case 2:
            return std::nextafter(right.low, -1);
        case 3:
            return std::nextafter(right.high, 2);
        case 4:
            return right.high * random.unit();
        case 5:
            return 2 * random.symmetric();
        default:
            return random.unit();
    }
}

struct timed_query {
    std::string name;  ///< of the query: kind, family, index
    query_families::points at;
    separation d = {};
    bool of_distance = false;
};

void count(count_table& table, std::string_view row, const first_time& right) {
    auto& counts = table[row];
    ++counts[0];
    counts[1] += right.outcome == outcome::collides;
    counts[2] += right.at_start();
    counts[3] += is_double(right) && !right.at_start();
    counts[4] += right.high > 0 && right.high < 0x1p-60;
    counts[5] += right.low == 0 && right.high > 0;
}

template <kind K>
auto query_of(const query_families::points& at) {
    return query_families::as_query<typename ccd::kind_traits<K>::template query<double>>(at);
}

/// Compares all deciders with the first, and the first with the oracle; returns its answer.
template <kind K>
first_time check(const std::vector<time_decider>& deciders, const timed_query& of, source& random,
                 findings& out) {
    const auto query = query_of<K>(of.at);
    const auto differ = [&](const time_decider& by, double t_max, const std::string& what) {
        ++out.table("decider")[by.name][1];
        out.differ({of.name + ", " + text_of(of.d, t_max) + ": " + by.name + " returns " + what +
                    "\n" + query_families::csv(of.at)});
    };
    const first_time right = deciders[0].when.of<K>()(query, of.d, 1);
    const std::string fault =
        of.of_distance ? support::fault_of(query, of.d, right) : support::fault_of(query, right);
    if (!fault.empty()) differ(deciders[0], 1, text_of(right) + ", but " + fault);

    const double t_max = some_end(random, right);
    for (const time_decider& by : deciders) {
        if (!random.one_in(static_cast<int>(by.stride))) continue;
        auto& counts = out.table("decider")[by.name];
        for (const auto& [end, found] : by.answers.of<K>()(query, of.d, right, t_max)) {
            ++counts[0];
            if (!found.empty()) differ(by, end, found);
        }
    }
    return right;
}

/// The earliest of the times that are not at the start, as ccd::earliest returns it.
ccd::earliest_time earliest_of(std::span<const first_time> right) {
    ccd::earliest_time all{{.outcome = outcome::separate}, {}, {}};
    const auto order = [](const first_time& t) { return std::pair(t.low, t.high); };
    for (std::size_t i = 0; i < right.size(); ++i) {
        if (right[i].outcome != outcome::collides) continue;
        if (right[i].at_start()) {
            all.at_start.push_back(i);
            continue;
        }
        if (all.queries.empty() || order(right[i]) < order(all.time)) {
            all.time = right[i];
            all.queries.clear();
        }
        if (right[i] == all.time) all.queries.push_back(i);
    }
    return all;
}

/// A block's queries of one kind and their right times.
template <kind K>
struct batch {
    query_list<K> queries = {};
    std::vector<double> thickness = {};  ///< of each vertex, whose distances then are the queries'
    std::vector<timed_query> listed = {};
    std::vector<first_time> right = {};

    void add(const timed_query& q, const first_time& time) {
        const auto first = static_cast<ccd::vertex_index>(queries.before.size());
        std::array<ccd::vertex_index, query_list<K>::point_count> at;
        for (std::size_t i = 0; i < at.size(); ++i) {
            at[i] = first + static_cast<ccd::vertex_index>(i);
            queries.add_vertex(q.at[i]);
            if (q.of_distance)
                thickness.push_back(i < ccd::kind_traits<K>::first_vertices ? q.d.first
                                                                            : q.d.second);
        }
        queries.add_pair(at);
        listed.push_back(q);
        right.push_back(time);
    }

    void compare(findings& out) const {
        for (const ccd::instruction_set set : ccd::instruction_sets()) {
            const std::string name(ccd::name(set));
            expect(name + ", by index",
                   ccd::first_times(queries.rows(), queries.pairs, options(2, set)), out);
            if (thickness.empty())
                expect(name + ", stored",
                       ccd::first_times(queries.stored, {.threads = 1, .set = set}), out);
        }
        expect_earliest(0, right.size(), out);
        constexpr std::size_t few = 8;
        for (std::size_t i = 0; i + few <= right.size(); i += few) expect_earliest(i, few, out);
    }

    ccd::time_options options(int threads, std::optional<ccd::instruction_set> set = {}) const {
        return {.distances = {.thickness = thickness}, .threads = threads, .set = set};
    }

    void expect_earliest(std::size_t first, std::size_t count, findings& out) const {
        const auto expected = earliest_of(std::span(right).subspan(first, count));
        const auto found = ccd::earliest(
            queries.rows(), std::span(queries.pairs).subspan(first, count), options(2));
        auto& counts = out.table("decider")["earliest"];
        ++counts[0];
        if (found.time == expected.time && found.queries == expected.queries &&
            found.at_start == expected.at_start)
            return;
        ++counts[1];
        out.differ({"the earliest of " + listed[first].name + " to " +
                    listed[first + count - 1].name + ": " + text_of(found.time) + ", not " +
                    text_of(expected.time) + ", or of other queries"});
    }

    void expect(const std::string& name, const std::vector<first_time>& times,
                findings& out) const {
        auto& counts = out.table("decider")[name];
        for (std::size_t i = 0; i < right.size(); ++i) {
            ++counts[0];
            if (times[i] == right[i]) continue;
            ++counts[1];
            out.differ({listed[i].name + ", " + text_of(listed[i].d, 1) + ": " + name +
                        " returns " + text_of(times[i]) + ", not " + text_of(right[i]) + "\n" +
                        query_families::csv(listed[i].at)});
        }
    }
};

template <kind K>
void compare(std::uint64_t seed, std::uint64_t block, const std::vector<time_decider>& deciders,
             bool of_distance, findings& out) {
    batch<K> all;
    for (const family_query& q : block_queries(seed, block, queries_per_block, K)) {
        source random = query_families::source_of(
            q.family->name, {static_cast<std::uint64_t>(K), seed, q.index, /*of times*/ 8});
        timed_query query{.name = std::string(short_name(K)) + " " + std::string(q.family->name) +
                                  " " + std::to_string(q.index),
                          .at = q.at,
                          .of_distance = of_distance};
        const auto& distance = distance_families::draw(random);
        if (of_distance) query.d = distance.make(random, K, q.at);
        if (random.one_in(64)) {
            const first_time t = deciders[0].when.of<K>()(query_of<K>(q.at), query.d, 1);
            const bool little = of_distance || !random.one_in(8);  // distances take long there
            query.at =
                hastened(q.at, t.low, little ? random.between(0, 100) : random.between(960, 1023));
            query.name += ", hastened";
        }
        const first_time right = check<K>(deciders, query, random, out);
        all.add(query, right);
        count(out.table("family"), row_name(*q.family), right);
        count(out.table("kind"), short_name(K), right);
        if (of_distance) count(out.table("distance"), distance.name, right);
        out.stir(static_cast<std::uint64_t>(right.outcome));
        out.stir(std::bit_cast<std::uint64_t>(right.low));
        out.stir(std::bit_cast<std::uint64_t>(right.high));
    }
    all.compare(out);
}

/// Tables with all rows, including those that a block leaves empty.
findings empty_findings(const std::vector<time_decider>& deciders, bool of_distance) {
    const std::vector<std::string> columns{"queries",           "with a time", "at the start",
                                           "at another double", "below 2^-60", "below 2^-1074"};
    findings out{.blocks = 1, .tables = {family_table(columns), {"kind", columns}}};
    ccd::for_each_kind([&]<kind K>() { out.table("kind")[short_name(K)]; });
    if (of_distance) {
        out.tables.push_back({"distance", columns});
        for (const auto& f : distance_families::families) out.table("distance")[f.name];
    }
    out.tables.push_back({"decider", {"answers", "differences"}});
    for (const time_decider& d : deciders) out.table("decider")[d.name];
    for (const ccd::instruction_set set : ccd::instruction_sets()) {
        out.table("decider")[std::string(ccd::name(set)) + ", by index"];
        if (!of_distance) out.table("decider")[std::string(ccd::name(set)) + ", stored"];
    }
    out.table("decider")["earliest"];
    return out;
}

part part_of(std::string name, std::vector<time_decider> deciders, bool of_distance) {
    part all{.name = std::move(name), .unit = "queries"};
    all.count = [](std::uint64_t blocks) { return 4 * queries_in(blocks, queries_per_block); };
    all.compare_block = [deciders = std::move(deciders), of_distance](std::uint64_t seed,
                                                                      std::uint64_t block) {
        findings out = empty_findings(deciders, of_distance);
        ccd::for_each_kind([&]<kind K>() { compare<K>(seed, block, deciders, of_distance, out); });
        return out;
    };
    return all;
}

/// Calls the stage after the filters directly, since filters decide most queries.
template <class Query>
first_time in_integers_unfiltered(const Query& query, double t_max) {
    const ccd::detail::found_time found = ccd::detail::first_contact_in_integers(query);
    if (found.outcome == outcome::uncertain) return ccd::time_of_impact_reference(query, t_max);
    return until({found.outcome, found.time.low, found.time.high}, t_max);
}

}  // namespace

std::string fault_of(const first_time& found, const first_time& right, double t_max) {
    const first_time expected = until(right, t_max);
    return found == expected ? "" : text_of(found) + ", not " + text_of(expected);
}

std::vector<time_decider> contact_deciders() {
    std::vector<time_decider> all;
    const auto when = [&](std::string name, unsigned stride, const auto& time) {
        all.push_back(by_time(std::move(name), [time](const auto& q, separation, double t_max) {
            return time(q, t_max);
        }));
        all.back().stride = stride;
    };
    when("time_of_impact", 1,
         [](const auto& q, double t_max) { return ccd::time_of_impact(q, t_max); });
    when("integers, unfiltered", 1,
         [](const auto& q, double t_max) { return in_integers_unfiltered(q, t_max); });
    when("its reference", slow,
         [](const auto& q, double t_max) { return ccd::time_of_impact_reference(q, t_max); });
    when("along curves", slow, [](const auto& q, double t_max) {
        return oracle::along_lines(q, [&](const auto& c) { return ccd::time_of_impact(c, t_max); });
    });
    all.push_back(by_outcome(
        "decide_exact", [](const auto& q, separation) { return ccd::decide_exact(q).outcome; }));
    all.push_back(by_data("contact_at", [](const auto& q, const first_time& time) {
        return ccd::contact_at(q, time);
    }));
    all.back().stride = 4;
    return all;
}

std::vector<time_decider> distance_deciders() {
    std::vector<time_decider> all{
        by_time("time_within", [](const auto& q, separation d,
                                  double t_max) { return ccd::time_within(q, d, t_max); }),
        by_outcome("decide_within",
                   [](const auto& q, separation d) {  // the order of a sum is irrelevant
                       return ccd::decide_within(q, {d.second, d.first}).outcome;
                   }),
        by_time("its reference",
                [](const auto& q, separation d, double t_max) {
                    return ccd::time_within_reference(q, d, t_max);
                }),
        by_outcome(
            "its reference's",
            [](const auto& q, separation d) { return ccd::decide_within_reference(q, d).outcome; }),
        by_time("along curves", [](const auto& q, separation d, double t_max) {
            return oracle::along_lines(
                q, [&](const auto& c) { return ccd::time_within(c, d, t_max); });
        })};
    for (std::size_t i = 2; i < all.size(); ++i) all[i].stride = slow;
    return all;
}

part contact_time_part(std::vector<time_decider> deciders) {
    return part_of("times", std::move(deciders), false);
}

part distance_time_part(std::vector<time_decider> deciders) {
    return part_of("separation", std::move(deciders), true);
}

}  // namespace soak
