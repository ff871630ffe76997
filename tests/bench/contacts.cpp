#include <algorithm>
#include <ccd/adapters/kept_gap.hpp>
#include <ccd/contact.hpp>
#include <ccd/exact.hpp>
#include <cmath>

#include "ccd/lab/tables.hpp"
#include "tests/bench/sections.hpp"

namespace bench {
namespace {

row error(double e) {
    return std::isfinite(e) ? row(e) : row("unknown");
}

/// Errors of the data of all contacts.
struct accuracy {
    std::size_t inside = 0;
    std::vector<double> weights, normals;  ///< errors, sorted

    template <class Query>
    accuracy(const std::vector<Query>& queries, const std::vector<ccd::first_time>& times) {
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const ccd::first_contact found = contact_at(queries[i], times[i]);
            inside += found.features.kind == ccd::kind_of<Query>;
            weights.push_back(found.weight_error);
            normals.push_back(found.normal_error);
        }
        std::ranges::sort(weights);
        std::ranges::sort(normals);
    }
};

template <class Query>
void add_contacts_row(const query_set<Query>& set, const options& o, rows& table) {
    std::vector<Query> colliding;
    std::vector<ccd::first_time> times;
    for (std::size_t i = 0; i < set.size(); ++i) {
        const ccd::first_time time = ccd::time_of_impact(set[i]);
        if (time.outcome != ccd::outcome::collides) continue;
        colliding.push_back(set[i]);
        times.push_back(time);
    }
    if (colliding.empty()) return;
    const auto timings = race({[&] {
                                   for (const Query& q : colliding) keep(ccd::decide_exact(q));
                               },
                               [&] {
                                   for (const Query& q : colliding) keep(ccd::time_of_impact(q));
                               },
                               [&] {
                                   for (std::size_t i = 0; i < colliding.size(); ++i)
                                       keep(ccd::contact_at(colliding[i], times[i]));
                               }},
                              o.repeats());
    const auto ns = [&](std::size_t i) { return timings[i].ns(colliding.size()); };
    const accuracy of(colliding, times);
    table.push_back(
        {{"kind", short_name(ccd::kind_of<Query>)},
         {"contacts", colliding.size()},
         {"ns_decision", ns(0)},
         {"ns_first_time", ns(1)},
         {"ns_data_then", ns(2)},
         {"inside_%", 100 * static_cast<double>(of.inside) / static_cast<double>(colliding.size())},
         {"weight_error_median", error(ccd::lab::quantile(of.weights, 0.5))},
         {"weight_error_99_%", error(ccd::lab::quantile(of.weights, 0.99))},
         {"normal_error_median", error(ccd::lab::quantile(of.normals, 0.5))},
         {"normal_error_99_%", error(ccd::lab::quantile(of.normals, 0.99))}});
}

double mean_edge(const ccd::mesh& m) {
    double sum = 0;
    for (const ccd::face& f : m.faces)
        for (std::size_t i = 0; i < 3; ++i) {
            const auto &p = m.vertices[f[i]], &q = m.vertices[f[(i + 1) % 3]];
            sum += std::hypot(p.x - q.x, p.y - q.y, p.z - q.z);
        }
    return sum / (3 * static_cast<double>(m.faces.size()));
}

/// Decides all candidates in batches: only the answers, answers with first times, and answers for a
/// distance.
template <class Query>
void add_batch_rows(const query_set<Query>& set, double distance, const options& o, rows& table) {
    for (const ccd::instruction_set instructions : ccd::instruction_sets()) {
        const ccd::time_options contact{.threads = 1, .set = instructions};
        ccd::time_options within = contact;
        within.distances.all = distance;
        const auto timings =
            race({[&] { keep(ccd::decide_within_batch(set.rows, set.by_index, contact)); },
                  [&] { keep(ccd::timed_contacts(set.rows, set.by_index, contact)); },
                  [&] { keep(ccd::decide_within_batch(set.rows, set.by_index, within)); }},
                 o.repeats());
        const auto near = ccd::decide_within_batch(set.rows, set.by_index, within);
        const auto ns = [&](std::size_t i) { return timings[i].ns(set.size()); };
        table.push_back({{"kind", short_name(ccd::kind_of<Query>)},
                         {"on", name(instructions)},
                         {"candidates", set.size()},
                         {"ns_decision", ns(0)},
                         {"ns_and_first_times", ns(1)},
                         {"times_ratio", ns(1) / ns(0)},
                         {"ns_within_distance", ns(2)},
                         {"within_ratio", ns(2) / ns(0)},
                         {"pairs_within", std::ranges::count(near, ccd::outcome::collides)}});
    }
}

/// The adapters' narrow phase in a loop over all candidates, with the least time found so far as
/// the limit of the next one.
void add_loop_row(const scene& s, double rescaling, const options& o, rows& table) {
    const ccd::adapters::detail::kept_gap kept{rescaling};
    double limit = 1;
    const auto loop = [&] {
        limit = 1;
        s.queries.for_each([&](const auto& known) {
            for (std::size_t i = 0; i < known.queries.size(); ++i)
                limit = std::min(
                    limit, ccd::adapters::detail::answer(known.queries[i], kept, 0, limit).toi);
        });
    };
    const timing t = race({loop}, o.repeats())[0];
    std::size_t candidates = 0;
    s.queries.for_each([&](const auto& known) { candidates += known.queries.size(); });
    table.push_back({{"kept", rescaling < 1 ? "gap" : "no gap"},
                     {"candidates", candidates},
                     {"ns", t.ns(candidates)},
                     {"first_time", limit}});
}

}  // namespace

void contacts(const scene& s, const options& o, report& out) {
    rows one_by_one, batches, loops;
    s.queries.for_each([&](const auto& known) {
        add_contacts_row(o.sampled(known.queries), o, one_by_one);
        if (is_step(s)) add_batch_rows(known.queries, 1e-3 * mean_edge(s.before), o, batches);
    });
    out.table("contacts", {{"scene", s.name}},
              s.name + ": colliding queries one by one, ns of each; errors of the contacts' data",
              one_by_one);
    out.table("contacts in batches", {{"scene", s.name}},
              s.name +
                  ": all candidates in batches, ns of each on one thread; within a thousandth "
                  "of the mean edge",
              batches);
    if (!is_step(s)) return;
    for (const double rescaling : {1.0, 0.8}) add_loop_row(s, rescaling, o, loops);
    out.table(
        "contacts in a loop", {{"scene", s.name}},
        s.name +
            ": all candidates one by one, ns of each, as ipc-toolkit calls a narrow phase: up "
            "to the least time before; the gap is a fifth of the distance at the start",
        loops);
}

}  // namespace bench
