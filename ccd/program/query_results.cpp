#include "ccd/program/query_results.hpp"

#include <algorithm>
#include <ccd/contact.hpp>
#include <nlohmann/json.hpp>

#include "ccd/lab/timing.hpp"
#include "ccd/program/options.hpp"
#include "errbound/support/table.hpp"

namespace ccd::program {
namespace {

using errbound::support::table;
using errbound::support::text_of;

template <class Query>
outcome decide_one(const Query& query, ccd::method method, const time_request& request) {
    if (request.t_max < 1)
        return request.distance ? time_within(query, {*request.distance, 0}, request.t_max).outcome
                                : time_of_impact(query, request.t_max).outcome;
    return request.distance ? decide_within(query, {*request.distance, 0}).outcome
                            : decide(method, query).outcome;
}

template <class Query>
std::vector<first_time> find_times(const std::vector<Query>& queries, const device_choice& device,
                                   const time_request& request) {
    if (!device.cuda)
        return first_times(queries,
                           {.t_max = request.t_max, .distances = {request.distance.value_or(0)}});
    std::vector<first_time> times(queries.size());
    find_times_on_device<Query>(queries, times, request.t_max);
    return times;
}

template <class Query>
void answer_on_device(const std::vector<Query>& queries, const device_choice& device, method m,
                      const time_request& request, std::vector<outcome>& outcomes) {
    if (request.t_max < 1)
        std::ranges::transform(find_times(queries, device, request), outcomes.begin(),
                               &first_time::outcome);
    else
        decide_on_device<Query>(queries, outcomes, m, device.precision);
}

template <class Query>
std::vector<outcome> decide_all(const std::vector<Query>& queries, const device_choice& device,
                                const time_request& request, double seconds, query_result& out) {
    std::vector<outcome> outcomes(queries.size());
    const double fastest = lab::fastest_of(
        [&] {
            if (device.cuda)
                return answer_on_device(queries, device, out.method, request, outcomes);
            for (std::size_t i = 0; i < queries.size(); ++i)
                outcomes[i] = decide_one(queries[i], out.method, request);
        },
        seconds);
    out.ns_per_query = fastest * 1e9 / static_cast<double>(queries.size());
    if (request.times)
        for (const first_time& time : find_times(queries, device, request))
            out.times += text_of_time(time) + '\n';
    return outcomes;
}

nlohmann::ordered_json or_null(const std::optional<std::size_t>& count) {
    return count ? nlohmann::ordered_json(*count) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json json_of(const query_result& r) {
    return {{"file", r.file},
            {"kind", std::string(short_name(r.kind))},
            {"method", info(r.method).name},
            {"queries", r.queries},
            {"collisions", r.collisions},
            {"false_positives", or_null(r.false_positives)},
            {"false_negatives", or_null(r.false_negatives)},
            {"ns_per_query", r.ns_per_query}};
}

}  // namespace

query_result decide_queries(const io::query_file& queries, const std::string& file,
                            ccd::method method, const device_choice& device,
                            const time_request& request, double seconds) {
    query_result out;
    out.file = file;
    out.kind = queries.kind();
    out.method = method;
    out.queries = queries.size();
    const auto outcomes =
        std::visit([&](const auto& all) { return decide_all(all, device, request, seconds, out); },
                   queries.queries);
    if (queries.truth && !request.ignores_truth()) out.false_positives = out.false_negatives = 0;
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        const bool verdict = outcomes[i] != outcome::separate;
        out.collisions += verdict;
        if (request.verdicts) out.verdicts += verdict ? '1' : '0';
        if (!out.false_positives) continue;
        *out.false_positives += verdict && !(*queries.truth)[i];
        *out.false_negatives += !verdict && (*queries.truth)[i];
    }
    return out;
}

std::string text_of_results(const std::vector<query_result>& results) {
    const auto or_dash = [](const std::optional<std::size_t>& count) {
        return count ? std::to_string(*count) : std::string("-");
    };
    table rows = {{"file", "kind", "method", "queries", "collisions", "FP", "FN", "ns/query"}};
    for (const query_result& r : results) {
        rows.push_back({r.file, std::string(short_name(r.kind)), std::string(info(r.method).name),
                        std::to_string(r.queries), std::to_string(r.collisions),
                        or_dash(r.false_positives), or_dash(r.false_negatives),
                        errbound::support::fixed(r.ns_per_query, "%.1f")});
    }
    return text_of(rows, 3);
}

std::string json_of_results(const std::vector<query_result>& results) {
    auto array = nlohmann::ordered_json::array();
    for (const query_result& r : results) array.push_back(json_of(r));
    // The default error handler throws for a path that is not UTF-8.
    return array.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

}  // namespace ccd::program
