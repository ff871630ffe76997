#include <errbound/predicate_batch.hpp>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "tests/bench/predicates/predicate_sets.hpp"
#include "tests/bench/sections.hpp"

namespace bench {
namespace {

template <class Set, class Plain>
void plainly(const Set& set, const Plain& plain, signs& out) {
    for (std::size_t i = 0; i < set.size(); ++i) out[i] = plain_sign(set.with(i, plain));
    keep(out);
}
template <class Set, class Predicate>
void one_by_one(const Set& set, const Predicate& predicate, signs& out) {
    for (std::size_t i = 0; i < set.size(); ++i) out[i] = set.with(i, predicate);
    keep(out);
}
template <class Set, class Predicate>
void in_batch(const Set& set, const Predicate& predicate, signs& out) {
    [&]<std::size_t... K>(std::index_sequence<K...>) {
        errbound::batch_signs(predicate, out, set.points[K]...);
    }
    (std::make_index_sequence<std::tuple_size_v<decltype(set.points)>>());
    keep(out);
}
template <class Set, class Predicate>
void of_arrays(const Set& set, const Predicate& predicate, signs& out) {
    [&]<std::size_t... K>(std::index_sequence<K...>) {
        errbound::batch_signs(predicate, out, set.as_arrays(K)...);
    }
    (std::make_index_sequence<std::tuple_size_v<decltype(set.points)>>());
    keep(out);
}

template <class Form>
void add_single_rows(const Form& form, const options& o, std::vector<std::vector<cell>>& rows) {
    const std::size_t inputs = o.quick ? 10'000 : 100'000;
    for (const auto& kind : input_kinds) {
        const auto set = make_set<Form>(kind, inputs);
        signs plain(inputs), exact(inputs);
        const auto timings = race(
            {[&] { plainly(set, form, plain); }, [&] { one_by_one(set, form.predicate, exact); }},
            o.repeats());
        errbound::predicate_report stages;
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < inputs; ++i) {
            set.with(i, [&](const auto&... p) { return form.predicate(stages, p...); });
            wrong += plain[i] != exact[i];
        }
        const auto all = static_cast<double>(inputs);
        const auto ns = [all](const timing& t) { return 1e9 * t.minimum / all; };
        rows.push_back({word(form.name), word(kind.name), number(ns(timings[0]), 2),
                        number(ns(timings[1]), 2),
                        number(timings[1].minimum / timings[0].minimum, 2),
                        percent(static_cast<double>(wrong) / all)});
        for (const std::uint64_t decided : stages.decided)
            rows.back().push_back(percent(static_cast<double>(decided) / all));
    }
}

template <class Form>
void add_batch_rows(const Form& form, const options& o, std::vector<std::vector<cell>>& rows) {
    // 512 inputs fit in the processor's caches; 100,000 are read from memory.
    for (const std::size_t inputs : {std::size_t{512}, std::size_t{100'000}}) {
        const auto set = make_set<Form>(input_kinds[0], inputs);
        signs single(inputs), batch(inputs), arrays(inputs);
        const auto timings = race({[&] { one_by_one(set, form.predicate, single); },
                                   [&] { in_batch(set, form.predicate, batch); },
                                   [&] { of_arrays(set, form.predicate, arrays); }},
                                  o.repeats());
        if (batch != single || arrays != single)
            throw std::runtime_error(std::string(form.name) +
                                     ": batches and single calls disagree");
        const auto ns = [&](const timing& t) {
            return number(1e9 * t.minimum / static_cast<double>(inputs), 2);
        };
        rows.push_back({word(form.name), count(inputs), ns(timings[0]), ns(timings[1]),
                        ns(timings[2]), number(timings[0].minimum / timings[1].minimum, 2),
                        number(timings[0].minimum / timings[2].minimum, 2)});
    }
}

}  // namespace

void predicates(const options& o, report& out) {
    std::vector<std::vector<cell>> rows;
    std::apply([&](const auto&... form) { (add_single_rows(form, o, rows), ...); }, all_forms);
    out.table("predicates", {{"how", "one by one"}},
              "predicates one by one, ns per call, and the stages that decided",
              {{"predicate", "predicate", true},
               {"inputs", "inputs", true},
               {"ns_plain", "plain double"},
               {"ns_exact", "errbound"},
               {"ratio", "ratio"},
               {"plain_wrong", "plain wrong"},
               {"semi_static_filter", "semi-static filter"},
               {"static_filter", "static filter"},
               {"tracked", "tracked"},
               {"exact_doubles", "exact doubles"},
               {"short_integers", "short integers"},
               {"word_integers", "one word"},
               {"two_word_integers", "two words"},
               {"long_integers", "long"}},
              rows);
    rows.clear();
    std::apply([&](const auto&... form) { (add_batch_rows(form, o, rows), ...); }, all_forms);
    out.table("predicates", {{"how", "batches"}},
              "predicates in batches, uniform inputs, ns per call",
              {{"predicate", "predicate", true},
               {"inputs", "inputs"},
               {"ns_single", "one by one"},
               {"ns_points", "batch of points"},
               {"ns_arrays", "batch of arrays"},
               {"speedup_points", "speed-up, points"},
               {"speedup_arrays", "speed-up, arrays"}},
              rows);
}

}  // namespace bench
