#include <ccd/contact.hpp>
#include <ccd/exact.hpp>
#include <cmath>

#include "ccd/lab/tables.hpp"
#include "tests/bench/sections.hpp"

namespace bench {
namespace {

cell error(double e) {
    if (!std::isfinite(e)) return {"unknown", nullptr};
    char text[16];
    std::snprintf(text, sizeof text, "%.1e", e);
    return {text, e};
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
void add_contacts_row(const query_set<Query>& set, const options& o,
                      std::vector<std::vector<cell>>& rows) {
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
    const auto all = static_cast<double>(colliding.size());
    const auto ns = [&](std::size_t i) { return number(1e9 * timings[i].minimum / all, 0); };
    const accuracy of(colliding, times);
    rows.push_back(
        {word(short_name(ccd::kind_of<Query>)), count(colliding.size()), ns(0), ns(1), ns(2),
         percent(static_cast<double>(of.inside) / all), error(ccd::lab::quantile(of.weights, 0.5)),
         error(ccd::lab::quantile(of.weights, 0.99)), error(ccd::lab::quantile(of.normals, 0.5)),
         error(ccd::lab::quantile(of.normals, 0.99))});
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
void add_batch_rows(const query_set<Query>& set, double distance, const options& o,
                    std::vector<std::vector<cell>>& rows) {
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
        const auto ns = [&](std::size_t i) {
            return number(1e9 * timings[i].minimum / static_cast<double>(set.size()), 1);
        };
        const auto ratio = [&](std::size_t i) {
            return number(timings[i].minimum / timings[0].minimum, 2);
        };
        rows.push_back(
            {word(short_name(ccd::kind_of<Query>)), word(name(instructions)), count(set.size()),
             ns(0), ns(1), ratio(1), ns(2), ratio(2),
             count(static_cast<std::size_t>(std::ranges::count(near, ccd::outcome::collides)))});
    }
}

void batches(const scene& s, const options& o, report& out) {
    const double distance = 1e-3 * mean_edge(s.before);
    std::vector<std::vector<cell>> rows;
    s.queries.for_each([&](const auto& set) { add_batch_rows(set, distance, o, rows); });
    out.table("contacts in batches", {{"scene", s.name}},
              s.name +
                  ": all candidates in batches, ns of each on one thread; within a thousandth "
                  "of the mean edge",
              {{"kind", "kind", true},
               {"instruction_set", "on", true},
               {"candidates", "candidates"},
               {"ns_decision", "decision"},
               {"ns_times", "and first times"},
               {"times_ratio", "ratio"},
               {"ns_within", "within distance"},
               {"within_ratio", "ratio"},
               {"within", "pairs within"}},
              rows);
}

}  // namespace

void contacts(const scene& s, const options& o, report& out) {
    const std::size_t most =
        o.quick ? o.max_queries() : s.queries.vertex_face.size() + s.queries.edge_edge.size();
    std::vector<std::vector<cell>> rows;
    s.queries.for_each([&](const auto& set) { add_contacts_row(set.at_most(most), o, rows); });
    out.table("contacts", {{"scene", s.name}},
              s.name + ": colliding queries one by one, ns of each; errors of the contacts' data",
              {{"kind", "kind", true},
               {"contacts", "contacts"},
               {"ns_decision", "decision"},
               {"ns_time", "first time"},
               {"ns_data", "data, time known"},
               {"inside_share", "inside"},
               {"weight_error_median", "weights, median"},
               {"weight_error_99", "99 % below"},
               {"normal_error_median", "normal, median"},
               {"normal_error_99", "99 % below"}},
              rows);
    if (s.is_step()) batches(s, o, out);
}

}  // namespace bench
