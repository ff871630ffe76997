// What a stress run found, as tables and files.
#include "ccd/stress/output.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <errbound/support/error.hpp>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "errbound/support/output_file.hpp"
#include "errbound/support/progress_line.hpp"
#include "errbound/support/system/system.hpp"
#include "errbound/support/table.hpp"

namespace ccd::stress {
namespace {

using errbound::support::file_error;
using errbound::support::progress_line;
using errbound::support::table;
using errbound::support::text_of;
using errbound::support::write_whole;

namespace fs = std::filesystem;
std::string formatted(const char* pattern, double value) {
    char text[64];
    std::snprintf(text, sizeof text, pattern, value);
    return text;
}

std::string knob_of(const cell& c) {
    return formatted("%g", c.knob);
}

/// The cells of one method and family, summed over knob and kind.
struct summary {
    cell sum;
    const cell* worst = nullptr;

    void add(const cell& c) {
        if (worst == nullptr) {
            sum.family = c.family;
            sum.subject = c.subject;
            worst = &c;
        } else if (badness(c) > badness(*worst)) {
            worst = &c;
        }
        const auto before = static_cast<double>(sum.queries), here = static_cast<double>(c.queries);
        sum.ns_per_query = (sum.ns_per_query * before + c.ns_per_query * here) / (before + here);
        sum.queries += c.queries;
        sum.collisions += c.collisions;
        sum.false_positives += c.false_positives;
        sum.false_negatives += c.false_negatives;
        sum.uncertain += c.uncertain;
        sum.wrong_certain += c.wrong_certain;
        sum.from_not_finite += c.from_not_finite;
    }

    /// Shares of false negatives count first, then those of false positives, then time.
    static std::array<double, 4> badness(const cell& c) {
        const auto share = [&c](std::size_t count) {
            return static_cast<double>(count) / static_cast<double>(c.queries);
        };
        return {share(c.from_not_finite), share(c.false_negatives), share(c.false_positives),
                c.ns_per_query};
    }

    std::string text_of_worst() const {
        const cell& c = *worst;
        const auto [what, count] = c.from_not_finite > 0 ? std::pair("answered", c.from_not_finite)
                                   : c.false_negatives > 0 ? std::pair("FN", c.false_negatives)
                                   : c.false_positives > 0 ? std::pair("FP", c.false_positives)
                                                           : std::pair("", std::size_t{0});
        const std::string where = " at " + knob_of(c) + ", " + std::string(short_name(c.kind));
        if (count == 0) return formatted("%.0f ns", c.ns_per_query) + where;
        return what + std::string(" ") + std::to_string(count) + "/" + std::to_string(c.queries) +
               where;
    }
};

/// By family, then method.
std::vector<summary> summaries_of(const std::vector<cell>& cells, std::size_t subjects) {
    std::vector<summary> all;
    for (const cell& c : cells) {
        if (all.empty() || all[all.size() - subjects].sum.family != c.family)
            all.resize(all.size() + subjects);
        all[all.size() - subjects + c.subject].add(c);
    }
    return all;
}

table rows_of(const std::vector<summary>& summaries, const plan& what) {
    table rows = {{"family", "method", "queries", "collisions", "FP", "FN", "uncertain", "wrong",
                   "ns/query", "worst at knob"}};
    for (const summary& s : summaries) {
        rows.push_back({std::string(s.sum.family->name), what.subjects[s.sum.subject].name,
                        std::to_string(s.sum.queries), std::to_string(s.sum.collisions),
                        std::to_string(s.sum.false_positives),
                        std::to_string(s.sum.false_negatives), std::to_string(s.sum.uncertain),
                        std::to_string(s.sum.wrong_certain + s.sum.from_not_finite),
                        formatted("%.0f", s.sum.ns_per_query), s.text_of_worst()});
    }
    return rows;
}

constexpr std::string_view legend =
    "FP, FN: false positives and negatives against the exact answer; uncertain counts as a "
    "collision.\n"
    "wrong: `collides` or `separate` said where the contrary is true, or of coordinates that are "
    "not finite.\n";

/// What was promised, by which methods.
std::string promises_of(const plan& what) {
    std::string without_lost, without_false;
    for (const subject& who : what.subjects) {
        const auto add = [&who](std::string& list) {
            list += (list.empty() ? "" : ", ") + who.name;
        };
        if (!who.may_lose_collisions) add(without_lost);
        if (!who.may_report_false_collisions) add(without_false);
    }
    const auto or_none = [](const std::string& list) { return list.empty() ? "none" : list; };
    return "promised: no false negative by " + or_none(without_lost) + "; no false positive by " +
           or_none(without_false) + "; no answer from NaN or infinity by all";
}

/// The first broken promise of each method and family.
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

/// Writes the query of each broken promise and reports it, a line each.
std::string report_broken(const std::vector<const cell*>& broken, const plan& what,
                          const fs::path& folder) {
    std::string lines;
    for (const cell* c : broken) {
        const std::string& method = what.subjects[c->subject].name;
        lines += "broken by " + method + ": " + c->broken->what + "; family " +
                 std::string(c->family->name) + ", knob " + knob_of(*c) + ", " +
                 std::string(short_name(c->kind)) + ", query " + std::to_string(c->broken->index);
        if (c->family->finite) {
            const fs::path path =
                folder / ("stress-" + method + "-" + std::string(c->family->name) + "-" +
                          std::string(short_name(c->kind)) + ".csv");
            const points p = make(*c->family, c->knob, c->kind, what.seed, c->broken->index);
            write_whole(path, csv(p, c->broken->collides ? ",1" : ",0"));
            lines += "; replay: ccd query " + path.string() + " --method " + method;
        }
        lines += '\n';
    }
    return lines;
}

std::string csv_of(const std::vector<cell>& cells, const plan& what) {
    std::string text =
        "family,knob_name,knob,kind,method,queries,collisions,false_positives,false_negatives,"
        "uncertain,ns_per_query\n";
    for (const cell& c : cells) {
        text += std::string(c.family->name) + ',' + std::string(c.family->knob_name) + ',' +
                knob_of(c) + ',' + std::string(short_name(c.kind)) + ',' +
                what.subjects[c.subject].name;
        for (const std::size_t count :
             {c.queries, c.collisions, c.false_positives, c.false_negatives, c.uncertain})
            text += ',' + std::to_string(count);
        text += ',' + formatted("%.1f", c.ns_per_query) + '\n';
    }
    return text;
}

std::string json_of(const std::vector<cell>& cells, const plan& what) {
    auto array = nlohmann::ordered_json::array();
    for (const cell& c : cells) {
        array.push_back({{"family", c.family->name},
                         {"knob_name", c.family->knob_name},
                         {"knob", c.knob},  // JSON has no infinity: null
                         {"kind", std::string(short_name(c.kind))},
                         {"method", what.subjects[c.subject].name},
                         {"queries", c.queries},
                         {"collisions", c.collisions},
                         {"false_positives", c.false_positives},
                         {"false_negatives", c.false_negatives},
                         {"uncertain", c.uncertain},
                         {"wrong_certain", c.wrong_certain},
                         {"from_not_finite", c.from_not_finite},
                         {"ns_per_query", c.ns_per_query}});
    }
    return array.dump(2) + '\n';
}

std::string markdown_table(const table& rows) {
    std::string text;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (const std::string& entry : rows[i]) text += "| " + entry + ' ';
        text += "|\n";
        if (i > 0) continue;
        for (std::size_t k = 0; k < rows[i].size(); ++k) text += "|---";
        text += "|\n";
    }
    return text;
}

std::string markdown_of(const table& rows, const plan& what, const std::string& verdict) {
    table families = {{"family", "what it is", "knob"}};
    for (const family* f : what.families)
        families.push_back(
            {std::string(f->name), std::string(f->description), std::string(f->knob_name)});
    return "# Stiff and extreme queries\n\nSeed " + std::to_string(what.seed) + ", " +
           std::to_string(what.queries) +
           " queries of each family, kind and value of the knob (fewer where the exact answer "
           "takes "
           "tenths of a second).\n\n" +
           markdown_table(rows) + '\n' + std::string(legend) + '\n' + verdict + '\n' +
           markdown_table(families);
}

/// Makes the folder. Throws if it cannot be written to: before the run, not after it.
void prepare(const outputs& to) {
    if (!to.folder) return;
    const fs::path& folder = *to.folder;
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw file_error(folder.string() + ": cannot be made (" + error.message() + ")");
    if (!errbound::support::system::may_write_in(errbound::support::system::native_name(folder)))
        throw file_error(folder.string() + ": cannot be written to");
}

bool write(const std::vector<cell>& cells, const plan& what, const outputs& to,
           std::ostream& text) {
    const table rows = rows_of(summaries_of(cells, what.subjects.size()), what);
    const std::vector<const cell*> broken = broken_of(cells);
    const std::string verdict = report_broken(broken, what, to.folder.value_or(fs::path())) +
                                promises_of(what) +
                                (broken.empty() ? ": kept\n" : ": BROKEN, as said above\n");
    std::vector<errbound::support::output> files;
    if (to.folder) {
        files.push_back({*to.folder / "stress.csv", csv_of(cells, what)});
        files.push_back({*to.folder / "stress.md", markdown_of(rows, what, verdict)});
    }
    if (to.json) files.push_back({*to.json, json_of(cells, what)});
    write_whole(files);
    text << text_of(rows, 2) << '\n' << legend << verdict;
    return broken.empty();
}

}  // namespace

bool run_and_write(const plan& what, const outputs& to, std::ostream& text) {
    prepare(to);
    std::vector<cell> cells;
    {
        progress_line line;
        cells = run(what, [&](std::size_t done, std::size_t all, const family& next) {
            line.show(done, all, std::string(next.name));
        });
    }
    return write(cells, what, to, text);
}

}  // namespace ccd::stress
