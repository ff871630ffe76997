#include "ccd/lab/sections.hpp"

#include <algorithm>
#include <array>
#include <ccd/batch.hpp>
#include <ccd/contact.hpp>
#include <ccd/exact.hpp>
#include <ccd/method.hpp>
#include <ccd/methods/bsc.hpp>
#include <cmath>
#include <errbound/validation/rule_list.hpp>
#include <functional>
#include <limits>

#include "ccd/batch/threads.hpp"
#include "ccd/lab/stress.hpp"
#include "ccd/lab/timing.hpp"

namespace ccd::lab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// ---- Bounds ----

constexpr std::array variable_names{"Y(0)", "Y(1)", "Y'(0)", "Y'(1)", "Y''(0)", "Y''(1)"};

/// Bounds of one variable. `relative` omits queries whose control values of Y are all zero.
struct bound_sample {
    std::vector<double> absolute, relative;
};
using bound_samples = std::array<bound_sample, variable_names.size()>;

/// Adds the bounds of decide_bsc, absolute and relative to the largest control value of Y.
template <class Rule, class Query>
void add_bounds(const Query& query, bound_samples& samples) {
    const auto [scaled, finite] = tracked_query<Rule>(query);
    if (!finite) return;
    const auto y = forms_of(scaled).y();
    const auto slope = derivative(y);
    const auto bend = derivative(slope);
    double largest = 0;
    for (int i = 0; i <= 3; ++i)
        largest = std::max(largest, std::abs(y[i].value()) / errbound::binomial(3, i));
    const std::array bounds{y[0].error(),     y[3].error(),    slope[0].error(),
                            slope[2].error(), bend[0].error(), bend[1].error()};
    for (std::size_t i = 0; i < bounds.size(); ++i) {
        const double known = std::isfinite(bounds[i]) ? bounds[i] : infinity;  // NaN: no bound
        samples[i].absolute.push_back(known);
        if (largest > 0) samples[i].relative.push_back(known / largest);
    }
}

/// Adds quantiles of the numbers, and sorts these.
void add_quantiles(std::vector<double>& numbers, const std::string& prefix, row& into) {
    std::ranges::sort(numbers);
    for (const int percent : {0, 1, 25, 50, 75, 99, 100}) {
        const double q = quantile(numbers, percent / 100.0);
        into[prefix + "q" + std::to_string(percent)] = q < infinity ? row(q) : row("inf");
    }
}

// ---- First contacts ----

/// The first times of all contacts, and a fault of one of them.
struct brackets {
    std::size_t at_start = 0, one_double = 0, neighbours = 0;
    std::vector<double> widths = {};            ///< of neighbours, in t; sorted
    std::vector<std::size_t> of_contacts = {};  ///< the queries with a contact
    std::string broken = {};

    template <class Query>
    brackets(const query_set<Query>& queries, int threads) {
        for (const timed_contact& contact : queries.timed_contacts({.threads = threads}))
            add(contact);
        std::ranges::sort(widths);
        std::vector<outcome> decided(queries.size());
        queries.decide_batch(0, decided, {.threads = threads});
        std::size_t contact = 0;
        for (std::size_t i = 0; i < decided.size(); ++i) {
            const bool listed = contact < of_contacts.size() && of_contacts[contact] == i;
            contact += listed;
            if (listed != (decided[i] == outcome::collides))
                broken = "query " + std::to_string(i) + ": times contradict yes or no";
        }
    }

  private:
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

/// Returns a pass of decisions and a pass of first times, one query at a time.
template <class Query>
std::vector<std::function<void()>> single_passes(const std::vector<Query>& queries) {
    return {[&queries] {
                for (const Query& q : queries) keep(decide_exact(q));
            },
            [&queries] {
                for (const Query& q : queries) keep(time_of_impact(q));
            }};
}

/// Queries with a contact, drawn evenly if there are more than `most`.
template <class Query>
std::vector<Query> with_contact(const query_set<Query>& queries,
                                const std::vector<std::size_t>& which, std::size_t most) {
    std::vector<Query> some;
    const std::size_t count = std::min(which.size(), most);
    for (std::size_t i = 0; i < count; ++i)
        some.push_back(queries[which[i * which.size() / count]]);
    return some;
}

template <class Query>
rows contacts_of(const query_set<Query>& queries, const sample_sizes& size, int threads,
                 const progress& show) {
    if (queries.size() == 0) return {};
    const brackets found(queries, threads);
    const query_set<Query> sample = queries.at_most(size.speed);
    const std::vector<Query> stored = sample.all_stored();
    std::vector<outcome> answers(stored.size());
    auto passes = single_passes(stored);
    passes.push_back([&] { sample.decide_batch(0, answers, {.threads = 1}); });
    passes.push_back([&] { keep(sample.timed_contacts({.threads = 1})); });
    const std::vector<timing> all = race(passes, size.repeats, show);
    const auto ns = [&](std::size_t i) { return all[i].ns(stored.size()); };
    row r = {{"queries", queries.size()},      {"contacts", found.of_contacts.size()},
             {"at_start", found.at_start},     {"one_double", found.one_double},
             {"neighbours", found.neighbours}, {"timed", sample.size()},
             {"ns_decision", ns(0)},           {"ns_time", ns(1)},
             {"ns_batch_decision", ns(2)},     {"ns_batch_time", ns(3)}};
    if (!found.widths.empty()) {
        r["width_median"] = quantile(found.widths, 0.5);
        r["width_largest"] = found.widths.back();
    }
    const auto contacts = with_contact(queries, found.of_contacts, size.times);
    if (!contacts.empty()) {
        const auto of_contacts = race(single_passes(contacts), size.repeats);
        r["timed_contacts"] = contacts.size();
        r["ns_contact_decision"] = of_contacts[0].ns(contacts.size());
        r["ns_contact_time"] = of_contacts[1].ns(contacts.size());
    }
    if (!found.broken.empty()) r["broken"] = found.broken;
    return {r};
}

}  // namespace

rows count_errors(const data_set& data, kind which, std::string_view method, int threads,
                  const progress& show) {
    return data.visit(which, [&](const auto& known) -> rows {
        tally counts;
        const std::size_t n = known.queries.size();
        if (method == batch_name) {
            std::vector<outcome> answers(n);
            known.queries.decide_batch(0, answers, {.threads = threads});
            for (std::size_t i = 0; i < n; ++i) counts.add(answers[i], known.collides[i] != 0);
        } else {
            const ccd::method by = *find_method(std::string(method));
            constexpr std::size_t block = 1 << 14;  // small enough to show progress
            detail::per_thread<tally> tallies;
            detail::on_threads(threads, [&] {
                for (std::size_t first = 0; first < n; first += block) {
                    const auto count = [&](std::size_t begin, std::size_t end) {
                        tally& sum = tallies.local();
                        for (std::size_t i = first + begin; i < first + end; ++i)
                            sum.add(decide(by, known.queries[i]).outcome, known.collides[i] != 0);
                    };
                    detail::for_each_range(std::min(block, n - first), 256, count);
                    show(static_cast<double>(first) / static_cast<double>(n));
                }
            });
            for (const tally* part : tallies.all()) counts += *part;
        }
        return {{{"method", method},
                 {"queries", n},
                 {"colliding", known.colliding},
                 {"collisions", counts.collisions},
                 {"false_positives", counts.false_positives},
                 {"false_negatives", counts.false_negatives},
                 {"uncertain", counts.uncertain}}};
    });
}

rows race_methods(const data_set& data, kind which, const std::vector<std::string>& methods,
                  const sample_sizes& size, const progress& show) {
    return data.visit(which, [&](const auto& known) -> rows {
        const auto sample = known.queries.at_most(size.speed);
        const auto queries = sample.all_stored();
        std::vector<outcome> answers(sample.size());
        std::vector<std::function<void()>> passes;
        for (const std::string& name : methods) {
            if (name == batch_name)
                passes.push_back([&] { sample.decide_batch(0, answers, {.threads = 1}); });
            else
                passes.push_back([&queries, method = *find_method(name)] {
                    for (const auto& q : queries) keep(decide(method, q));
                });
        }
        const std::vector<timing> timings = race(passes, size.repeats, show);
        rows result;
        for (std::size_t i = 0; i < methods.size(); ++i)
            result.push_back({{"method", methods[i]},
                              {"timed", queries.size()},
                              {"ns_min", timings[i].ns(queries.size())},
                              {"ns_median", timings[i].median_ns(queries.size())}});
        return result;
    });
}

rows time_queries(const data_set& data, kind which, const std::vector<std::string>& methods,
                  const sample_sizes& size, const progress& show) {
    return data.visit(which, [&](const auto& known) -> rows {
        const auto queries = known.queries.at_most(size.times).all_stored();
        // The least of several timings of a query: an interrupt is not taken for a slow query.
        std::vector<std::vector<double>> least(methods.size(),
                                               std::vector<double>(queries.size(), infinity));
        const double overhead = clock_overhead();
        for (int repeat = 0; repeat < size.repeats; ++repeat)
            for (std::size_t m = 0; m < methods.size(); ++m) {
                const ccd::method method = *find_method(methods[m]);
                for (std::size_t i = 0; i < queries.size(); ++i) {
                    const clock::time_point start = clock::now();
                    keep(decide(method, queries[i]));
                    least[m][i] = std::min(least[m][i], seconds_since(start));
                }
                show((repeat + static_cast<double>(m) / static_cast<double>(methods.size())) /
                     size.repeats);
            }
        rows result;
        for (std::size_t m = 0; m < methods.size(); ++m) {
            for (double& s : least[m]) s = 1e9 * std::max(s - overhead, 0.0);
            std::ranges::sort(least[m]);
            const auto ns = [&](double p) { return quantile(least[m], p); };
            result.push_back({{"method", methods[m]},
                              {"timed", queries.size()},
                              {"ns_median", ns(0.5)},
                              {"ns_90", ns(0.9)},
                              {"ns_99", ns(0.99)},
                              {"ns_99_9", ns(0.999)},
                              {"ns_worst", ns(1)},
                              {"clock_ns", 1e9 * overhead}});
        }
        return result;
    });
}

rows take_bounds(const data_set& data, kind which, const sample_sizes& size) {
    return data.visit(which, [&](const auto& known) {
        const auto queries = known.queries.at_most(size.bounds).all_stored();
        rows result;
        errbound::for_each_rule(errbound::all_rules{}, [&]<class Rule>() {
            if constexpr (!errbound::promises_bound<Rule>) return;
            bound_samples samples;
            for (const auto& q : queries) add_bounds<Rule>(q, samples);
            for (std::size_t i = 0; i < samples.size(); ++i) {
                std::vector<double>& absolute = samples[i].absolute;
                row r = {{"rule", Rule::name},
                         {"variable", variable_names[i]},
                         {"count", absolute.size()},
                         {"exact", std::ranges::count(absolute, 0.0)},
                         {"unknown", std::ranges::count(absolute, infinity)}};
                add_quantiles(absolute, "", r);
                add_quantiles(samples[i].relative, "relative_", r);
                result.push_back(std::move(r));
            }
        });
        return result;
    });
}

rows find_contacts(const data_set& data, kind which, const sample_sizes& size, int threads,
                   const progress& show) {
    return data.visit(
        which, [&](const auto& known) { return contacts_of(known.queries, size, threads, show); });
}

}  // namespace ccd::lab
