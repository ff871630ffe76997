// First contacts: their brackets, and what they cost beside yes or no.
#include <ccd/contact.hpp>
#include <ccd/exact.hpp>

#include "ccd/report/measuring/statistics.hpp"
#include "ccd/report/sections.hpp"

namespace ccd::report {
namespace {

/// The first times of all contacts, and what is wrong with them.
struct brackets {
    std::size_t at_start = 0, one_double = 0, neighbours = 0;
    std::vector<double> widths = {};            ///< of neighbours, in t; sorted
    std::vector<std::size_t> of_contacts = {};  ///< which queries have one
    std::string broken = {};

    void add(const timed_contact& contact) {
        const auto& [query, time] = contact;
        of_contacts.push_back(query);
        if (time.at_start()) {
            ++at_start;
        } else if (time.low == time.high) {
            ++one_double;
        } else {
            ++neighbours;
            widths.push_back(time.high - time.low);
            if (std::nextafter(time.low, 2) != time.high)
                broken = "query " + std::to_string(query) + ": its bracket is wider than a place";
        }
    }
};

template <class Query>
brackets brackets_of(const query_set<Query>& queries, int threads) {
    brackets all;
    for (const timed_contact& contact : queries.timed_contacts({.threads = threads}))
        all.add(contact);
    std::ranges::sort(all.widths);
    std::vector<outcome> decided(queries.size());
    queries.decide_batch(0, decided, {.threads = threads});
    std::size_t contact = 0;
    for (std::size_t i = 0; i < decided.size(); ++i) {
        const bool listed = contact < all.of_contacts.size() && all.of_contacts[contact] == i;
        contact += listed;
        if (listed != (decided[i] == outcome::collides))
            all.broken = "query " + std::to_string(i) + ": times contradict yes or no";
    }
    return all;
}

/// ns per query.
struct cost {
    double decision, time;
};

/// Of yes or no, and of the first time with it: one by one, and in batches of `set` if there is
/// one.
template <class Query>
std::vector<cost> costs(const std::vector<Query>& queries, const query_set<Query>* set, int repeats,
                        const progress& show) {
    std::vector<outcome> answers(queries.size());
    std::vector<std::function<void()>> passes{[&] {
                                                  for (const Query& q : queries)
                                                      keep(decide_exact(q));
                                              },
                                              [&] {
                                                  for (const Query& q : queries)
                                                      keep(time_of_impact(q));
                                              }};
    if (set != nullptr) {
        passes.push_back([&] { set->decide_batch(0, answers, {.threads = 1}); });
        passes.push_back([&] { keep(set->timed_contacts({.threads = 1})); });
    }
    const std::vector<timing> timings = race(passes, repeats, show);
    const auto ns = [&](std::size_t i) {
        return 1e9 * timings[i].minimum / static_cast<double>(queries.size());
    };
    std::vector<cost> all;
    for (std::size_t i = 0; i < timings.size(); i += 2) all.push_back({ns(i), ns(i + 1)});
    return all;
}

/// Those of queries with a contact, drawn evenly where there are more than `most`.
template <class Query>
std::vector<Query> with_contact(const query_set<Query>& queries,
                                const std::vector<std::size_t>& which, std::size_t most) {
    std::vector<Query> some;
    const std::size_t count = std::min(which.size(), most);
    for (std::size_t i = 0; i < count; ++i)
        some.push_back(queries[which[i * which.size() / count]]);
    return some;
}

/// Queries of a family: the same number at each value of its knob, fewer where it is thinned.
template <class Query>
query_set<Query> queries_of(const stress::family& family, std::size_t each) {
    query_set<Query> all{.rows = {}, .by_index = {}, .stored = {}};
    for (const double knob : family.knobs) {
        const unsigned thinning = family.thinning(knob);
        for (std::size_t i = 0; i * thinning < each; ++i)
            all.stored.push_back(
                stress::as_query<Query>(stress::make(family, knob, kind_of<Query>, /*seed*/ 1, i)));
    }
    return all;
}

}  // namespace

template <class Query>
rows find_contacts(const query_set<Query>& queries, const sample_sizes& size, int threads,
                   const progress& show) {
    if (queries.size() == 0) return {};
    const brackets found = brackets_of(queries, threads);
    const query_set<Query> sample = queries.at_most(size.speed);
    const auto all = costs(sample.all_stored(), &sample, size.repeats, show);
    row r = {{"queries", queries.size()},
             {"contacts", found.of_contacts.size()},
             {"at_start", found.at_start},
             {"one_double", found.one_double},
             {"neighbours", found.neighbours},
             {"timed", sample.size()},
             {"ns_decision", all[0].decision},
             {"ns_time", all[0].time},
             {"ns_batch_decision", all[1].decision},
             {"ns_batch_time", all[1].time}};
    if (!found.widths.empty()) {
        r["width_median"] = quantile(found.widths, 0.5);
        r["width_largest"] = found.widths.back();
    }
    const auto contacts = with_contact(queries, found.of_contacts, size.times);
    if (!contacts.empty()) {
        const cost of_contacts =
            costs<Query>(contacts, nullptr, size.repeats, [](double) {}).front();
        r["timed_contacts"] = contacts.size();
        r["ns_contact_decision"] = of_contacts.decision;
        r["ns_contact_time"] = of_contacts.time;
    }
    if (!found.broken.empty()) r["broken"] = found.broken;
    return {r};
}

rows find_contacts(const stress::family& family, const sample_sizes& size, int threads,
                   const progress& show) {
    rows all;
    const auto add = [&]<class Query>(double share) {
        const auto show_half = [&](double part) { show(share + part / 2); };
        row r = {{"kind", short_name(kind_of<Query>)}};
        r.update(
            find_contacts(queries_of<Query>(family, size.stress_queries), size, threads, show_half)
                .front());
        all.push_back(std::move(r));
    };
    add.template operator()<vertex_face<double>>(0);
    add.template operator()<edge_edge<double>>(0.5);
    return all;
}

template rows find_contacts(const query_set<vertex_face<double>>&, const sample_sizes&, int,
                            const progress&);
template rows find_contacts(const query_set<edge_edge<double>>&, const sample_sizes&, int,
                            const progress&);

}  // namespace ccd::report
