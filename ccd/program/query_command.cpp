// `ccd query`: decides stored queries with some methods, compares with the truth, times them.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "ccd/program/commands.hpp"
#include "errbound/support/output_file.hpp"
#include "errbound/support/progress_line.hpp"
#include "errbound/support/table.hpp"

namespace ccd::program {
namespace {

using std::chrono::steady_clock;

double seconds_since(steady_clock::time_point start) {
    return std::chrono::duration<double>(steady_clock::now() - start).count();
}

/// One row of the table.
struct result {
    std::string file;
    ccd::kind kind{};
    ccd::method method{};
    std::vector<bool> verdicts;  ///< true: may collide
    std::optional<std::size_t> false_positives, false_negatives;
    double ns_per_query = 0;

    std::size_t collisions() const {
        return static_cast<std::size_t>(std::count(verdicts.begin(), verdicts.end(), true));
    }
};

template <class Query>
void decide_all(const std::vector<Query>& queries, const device_choice& device, result& out) {
    // Made into bits afterwards, since that is work which is not the method's.
    std::vector<outcome> outcomes(queries.size());
    double fastest = std::numeric_limits<double>::infinity();
    const steady_clock::time_point start = steady_clock::now();
    do {
        const steady_clock::time_point pass = steady_clock::now();
        if (device.cuda)
            decide_on_device(queries, outcomes, out.method, device.precision);
        else
            for (std::size_t i = 0; i < queries.size(); ++i)
                outcomes[i] = decide(out.method, queries[i]).outcome;
        fastest = std::min(fastest, seconds_since(pass));
    } while (seconds_since(start) < 0.02);
    out.verdicts.clear();
    for (const outcome o : outcomes) out.verdicts.push_back(o != outcome::separate);
    out.ns_per_query = fastest * 1e9 / static_cast<double>(queries.size());
}

result decide_file(const io::query_file& queries, const std::string& file, ccd::method method,
                   const device_choice& device) {
    result out;
    out.file = file;
    out.kind = queries.kind;
    out.method = method;
    if (queries.kind == kind::vertex_face) {
        decide_all(queries.vertex_face_queries, device, out);
    } else {
        decide_all(queries.edge_edge_queries, device, out);
    }
    if (queries.truth) {
        std::size_t positives = 0, negatives = 0;
        for (std::size_t i = 0; i < out.verdicts.size(); ++i) {
            if (out.verdicts[i] && !(*queries.truth)[i]) ++positives;
            if (!out.verdicts[i] && (*queries.truth)[i]) ++negatives;
        }
        out.false_positives = positives;
        out.false_negatives = negatives;
    }
    return out;
}

std::string text_of_results(const std::vector<result>& results) {
    const auto or_dash = [](const std::optional<std::size_t>& count) {
        return count ? std::to_string(*count) : std::string("-");
    };
    table rows = {{"file", "kind", "method", "queries", "collisions", "FP", "FN", "ns/query"}};
    for (const result& r : results) {
        char ns[32];
        std::snprintf(ns, sizeof ns, "%.1f", r.ns_per_query);
        rows.push_back({r.file, std::string(short_name(r.kind)), std::string(info(r.method).name),
                        std::to_string(r.verdicts.size()), std::to_string(r.collisions()),
                        or_dash(r.false_positives), or_dash(r.false_negatives), ns});
    }
    return text_of(rows, 3);
}

std::string json_of(const std::vector<result>& results) {
    const auto or_null = [](const std::optional<std::size_t>& count) {
        return count ? nlohmann::ordered_json(*count) : nlohmann::ordered_json(nullptr);
    };
    auto array = nlohmann::ordered_json::array();
    for (const result& r : results) {
        array.push_back({{"file", r.file},
                         {"kind", std::string(short_name(r.kind))},
                         {"method", info(r.method).name},
                         {"queries", r.verdicts.size()},
                         {"collisions", r.collisions()},
                         {"false_positives", or_null(r.false_positives)},
                         {"false_negatives", or_null(r.false_negatives)},
                         {"ns_per_query", r.ns_per_query}});
    }
    // A path need not be UTF-8; the default would throw on such a one.
    return array.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

}  // namespace

void run_query(const query_arguments& arguments) {
    std::vector<result> results;
    {
        progress_line progress;
        for (std::size_t i = 0; i < arguments.files.size(); ++i) {
            const std::string file = arguments.files[i].string();
            progress.show(i, arguments.files.size(), file);
            const io::query_file queries =
                io::read_queries(arguments.files[i], arguments.kind, arguments.round);
            for (const ccd::method method : arguments.methods) {
                results.push_back(decide_file(queries, file, method, arguments.device));
            }
        }
    }
    if (arguments.verdicts) {
        std::string lines;
        for (const bool verdict : results.front().verdicts) lines += verdict ? "1\n" : "0\n";
        io::write_whole(*arguments.verdicts, lines);
    }
    if (arguments.json) io::write_whole(*arguments.json, json_of(results));
    std::cout << text_of_results(results);
}

}  // namespace ccd::program
