#include "ccd/lab/stress.hpp"

#include <algorithm>
#include <array>
#include <ccd/batch.hpp>
#include <ccd/reference.hpp>
#include <cmath>
#include <ostream>
#include <utility>

#include "ccd/batch/threads.hpp"
#include "ccd/lab/timing.hpp"
#include "errbound/support/output_file.hpp"
#include "errbound/support/progress_line.hpp"

namespace ccd::lab {
namespace {

using errbound::support::fixed;
using errbound::support::table;
using errbound::support::write_whole;

namespace fs = std::filesystem;

// ---- The run ----

template <class Query>
struct queries_of_cell {
    std::vector<Query> queries;
    std::vector<outcome> truth;  ///< uncertain where coordinates are not finite

    queries_of_cell(const plan& wanted, const family& f, double knob) {
        const std::size_t count = std::max<std::size_t>(1, wanted.queries / f.thinning(knob));
        for (std::uint64_t i = 0; i < count; ++i)
            queries.push_back(as_query<Query>(make(f, knob, kind_of<Query>, wanted.seed, i)));
        truth.resize(count);
        detail::for_each_index(
            count, [this](std::size_t i) { truth[i] = decide_reference(queries[i]).outcome; });
    }
};

template <class Query>
cell measured(const plan& wanted, std::size_t subject, const queries_of_cell<Query>& of) {
    const auto& who = wanted.subjects[subject];
    std::vector<verdict> answers(of.queries.size());
    const auto pass = [&] { who.decide.template of<kind_of<Query>>()(of.queries, answers); };
    cell out{.kind = kind_of<Query>, .subject = subject, .queries = answers.size()};
    out.ns_per_query = fastest_of(pass, wanted.seconds) * 1e9 / static_cast<double>(answers.size());
    for (std::size_t i = 0; i < answers.size(); ++i) {
        const outcome truth = of.truth[i], answer = answers[i].outcome;
        const bool is_certain = answer != outcome::uncertain;
        out.uncertain += !is_certain;
        if (truth == outcome::uncertain) {
            out.from_not_finite += is_certain;
        } else {
            out.finite.add(answer, truth == outcome::collides);
            out.wrong_certain += is_certain && answer != truth;
        }
        if (out.broken) continue;
        if (const auto how = broken_by(who, answers[i], truth))
            out.broken = {std::string(*how), i, truth == outcome::collides};
    }
    return out;
}

void add_cells(const plan& wanted, const family& f, double knob, std::vector<cell>& cells) {
    for (const kind which : stored_kinds)
        visit_stored_kind(which, [&]<kind K>() {
            const queries_of_cell<typename kind_traits<K>::template query<double>> of(wanted, f,
                                                                                      knob);
            for (std::size_t s = 0; s < wanted.subjects.size(); ++s) {
                cells.push_back(measured(wanted, s, of));
                cells.back().family = &f;
                cells.back().knob = knob;
            }
        });
}

// ---- What is printed and written ----

std::string knob_of(const cell& c) {
    return fixed(c.knob, "%g");
}

struct summary {
    cell sum;
    const cell* worst = nullptr;

    void add(const cell& c) {
        if (worst == nullptr || badness(c) > badness(*worst)) worst = &c;
        const auto before = static_cast<double>(sum.queries), here = static_cast<double>(c.queries);
        sum.ns_per_query = (sum.ns_per_query * before + c.ns_per_query * here) / (before + here);
        sum.queries += c.queries;
        sum.finite += c.finite;
        sum.uncertain += c.uncertain;
        sum.wrong_certain += c.wrong_certain;
        sum.from_not_finite += c.from_not_finite;
    }

    /// Shares of false negatives count first, then those of false positives, then time.
    static std::array<double, 4> badness(const cell& c) {
        const auto share = [&c](std::size_t count) {
            return static_cast<double>(count) / static_cast<double>(c.queries);
        };
        return {share(c.from_not_finite), share(c.finite.false_negatives),
                share(c.finite.false_positives), c.ns_per_query};
    }

    std::string text_of_worst() const {
        const cell& c = *worst;
        const std::string where = " at " + knob_of(c) + ", " + std::string(short_name(c.kind));
        for (const auto& [label, count] :
             {std::pair("answered", c.from_not_finite), std::pair("FN", c.finite.false_negatives),
              std::pair("FP", c.finite.false_positives)})
            if (count > 0)
                return label + (" " + std::to_string(count)) + "/" + std::to_string(c.queries) +
                       where;
        return fixed(c.ns_per_query, "%.0f ns") + where;
    }
};

table summary_of(const std::vector<cell>& cells, const plan& wanted) {
    table lines{{"family", "method", "queries", "collisions", "FP", "FN", "uncertain", "wrong",
                 "ns/query", "worst at knob"}};
    for (const family* f : wanted.families)
        for (std::size_t s = 0; s < wanted.subjects.size(); ++s) {
            summary all;
            for (const cell& c : cells)
                if (c.family == f && c.subject == s) all.add(c);
            lines.push_back(
                {std::string(f->name), wanted.subjects[s].name, std::to_string(all.sum.queries),
                 std::to_string(all.sum.finite.colliding),
                 std::to_string(all.sum.finite.false_positives),
                 std::to_string(all.sum.finite.false_negatives), std::to_string(all.sum.uncertain),
                 std::to_string(all.sum.wrong_certain + all.sum.from_not_finite),
                 fixed(all.sum.ns_per_query, "%.0f"), all.text_of_worst()});
        }
    return lines;
}

constexpr std::string_view legend =
    "FP, FN: false positives and negatives against the exact answer; uncertain counts as a "
    "collision.\n"
    "wrong: `collides` or `separate` against the truth, or for coordinates that are not finite.\n";

std::string promises_of(const plan& wanted) {
    const auto without = [&wanted](bool subject::*may) {
        std::string list;
        for (const subject& who : wanted.subjects)
            if (!(who.*may)) list += (list.empty() ? "" : ", ") + who.name;
        return list.empty() ? "none" : list;
    };
    return "promised: no false negative by " + without(&subject::may_lose_collisions) +
           "; no false positive by " + without(&subject::may_report_false_collisions) +
           "; no answer from NaN or infinity by all";
}

std::vector<const cell*> broken_of(const std::vector<cell>& cells) {
    std::vector<const cell*> first;
    for (const cell& c : cells) {
        const bool known = std::ranges::any_of(first, [&c](const cell* other) {
            return other->family == c.family && other->subject == c.subject;
        });
        if (c.broken && !known) first.push_back(&c);
    }
    return first;
}

/// Writes the query of each broken promise and returns a line for each.
std::string report_broken(const std::vector<const cell*>& broken, const plan& wanted,
                          const fs::path& folder) {
    std::string lines;
    for (const cell* c : broken) {
        const std::string& method = wanted.subjects[c->subject].name;
        const std::string kind(short_name(c->kind)), family(c->family->name);
        lines += "broken by " + method + ": " + c->broken->clause + "; family " + family +
                 ", knob " + knob_of(*c) + ", " + kind + ", query " +
                 std::to_string(c->broken->index);
        if (c->family->finite) {
            const fs::path path =
                folder / ("stress-" + method + "-" + family + "-" + kind + ".csv");
            const points p = make(*c->family, c->knob, c->kind, wanted.seed, c->broken->index);
            write_whole(path, csv(p, c->broken->collides ? ",1" : ",0"));
            lines += "; replay: ccd query " + path.string() + " --method " + method;
        }
        lines += '\n';
    }
    return lines;
}

/// The cells as JSON, in which a knob of exactly zero is null.
std::string json_of(const rows& cells) {
    row array = cells;
    for (row& r : array)
        if (r["knob"].is_string()) r["knob"] = nullptr;
    return errbound::support::json_of(array, 2) + '\n';
}

}  // namespace

subject subject_named(std::string_view name) {
    if (name == batch_name) {
        subject batch = subject_named(info(method::exact).name);
        batch.name = name;
        const auto decide = [answers = std::vector<outcome>()](
                                auto queries, std::span<verdict> verdicts) mutable {
            answers.resize(queries.size());
            decide_batch(queries, answers, {.threads = 1});
            // Batches are uncertain only of coordinates that are not finite.
            std::ranges::transform(answers, verdicts.begin(), [](outcome answer) {
                return verdict{answer, answer == outcome::uncertain ? cause::range : cause::none};
            });
        };
        batch.decide = {decide, decide};
        return batch;
    }
    const method_info& m = info(*find_method(std::string(name)));
    const auto decide = [method = m.method](auto queries, std::span<verdict> verdicts) {
        for (std::size_t i = 0; i < queries.size(); ++i)
            verdicts[i] = ccd::decide(method, queries[i]);
    };
    return {std::string(m.name),
            m.may_lose_collisions,
            m.may_report_false_collisions,
            {decide, decide}};
}

std::optional<std::string_view> broken_by(const subject& who, verdict answer, outcome truth) {
    using text = std::optional<std::string_view>;
    if (truth == outcome::uncertain) {
        if (answer == verdict{outcome::uncertain, cause::range}) return std::nullopt;
        return answer.outcome == outcome::uncertain
                   ? "it was uncertain of coordinates that are not finite without cause `range`"
                   : "it answered for coordinates that are not finite";
    }
    const bool promises_nothing = who.may_lose_collisions && who.may_report_false_collisions;
    if (truth == outcome::collides && answer.outcome == outcome::separate)
        return who.may_lose_collisions ? std::nullopt : text("it lost a collision");
    if (truth == outcome::separate && answer.outcome == outcome::collides)
        return promises_nothing ? std::nullopt : text("it returned `collides`, which is wrong");
    if (answer.outcome != outcome::uncertain || who.may_report_false_collisions)
        return std::nullopt;
    if (truth == outcome::separate) return "it reported a false collision, as uncertain";
    return who.may_lose_collisions ? std::nullopt : text("it gave no answer");
}

std::vector<cell> run(const plan& wanted, const stress_progress& show) {
    std::size_t all = 0, done = 0;
    for (const family* f : wanted.families) all += f->knobs.size();
    std::vector<cell> cells;
    detail::on_threads(wanted.threads, [&] {
        for (const family* f : wanted.families)
            for (const double knob : f->knobs) {
                show(done++, all, *f);
                add_cells(wanted, *f, knob, cells);
            }
    });
    return cells;
}

const std::vector<std::string> stress_columns{"family",     "knob_name",       "knob",
                                              "kind",       "method",          "queries",
                                              "collisions", "false_positives", "false_negatives",
                                              "uncertain",  "ns_per_query"};

row row_of(const cell& c, const plan& wanted) {
    row r = {{"family", c.family->name},
             {"knob_name", c.family->knob_name},
             {"knob", std::isfinite(c.knob) ? row(static_cast<int>(c.knob)) : row("-inf")},
             {"kind", short_name(c.kind)},
             {"method", wanted.subjects[c.subject].name},
             {"queries", c.queries},
             {"collisions", c.finite.colliding},
             {"false_positives", c.finite.false_positives},
             {"false_negatives", c.finite.false_negatives},
             {"uncertain", c.uncertain},
             {"wrong_certain", c.wrong_certain},
             {"from_not_finite", c.from_not_finite},
             {"ns_per_query", c.ns_per_query}};
    if (c.broken) r.update({{"broken", c.broken->clause}, {"query", c.broken->index}});
    return r;
}

bool run_and_write(const plan& wanted, const stress_outputs& to, std::ostream& text) {
    if (to.folder) make_folder(*to.folder);
    std::vector<cell> cells;
    {
        errbound::support::progress_line line;
        cells = run(wanted, [&](std::size_t done, std::size_t all, const family& next) {
            line.show(done, all, std::string(next.name));
        });
    }
    const table lines = summary_of(cells, wanted);
    const std::vector<const cell*> broken = broken_of(cells);
    const std::string verdict = report_broken(broken, wanted, to.folder.value_or(fs::path())) +
                                promises_of(wanted) +
                                (broken.empty() ? ": kept\n" : ": BROKEN, see above\n");
    rows all;
    for (const cell& c : cells) all.push_back(row_of(c, wanted));
    std::vector<errbound::support::output> files;
    if (to.folder)
        files.push_back(
            {*to.folder / "stress.csv", errbound::support::csv_of(stress_columns, all)});
    if (to.json) files.push_back({*to.json, json_of(all)});
    write_whole(files);
    text << errbound::support::text_of(lines, 2) << '\n' << legend << verdict;
    return broken.empty();
}

}  // namespace ccd::lab
