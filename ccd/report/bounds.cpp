// How large each rule's bounds are: the six critical variables of BSC, the paper's Figure 8.
#include <errbound/validation/rule_list.hpp>

#include "ccd/report/measuring/statistics.hpp"
#include "ccd/report/sections.hpp"

namespace ccd::report {
namespace {

constexpr std::array variable_names{"Y(0)", "Y(1)", "Y'(0)", "Y'(1)", "Y''(0)", "Y''(1)"};

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Bounds of one variable over the queries; the relative ones where the query has a k that is not
/// zero.
struct bound_sample {
    std::vector<double> absolute, relative;
};
using bound_samples = std::array<bound_sample, variable_names.size()>;

/// Adds the query's bounds, as decide_bsc meets them (ccd/methods/bsc.hpp), and relative to the
/// largest |k|, the control values of Y.
template <class Rule, class Query>
void add_bounds(const Query& query, bound_samples& samples) {
    const auto [scaled, finite] = tracked_query<Rule>(query);
    if (!finite) return;
    const auto y = forms_of(scaled).y();
    const auto slope = derivative(y);
    const auto bend = derivative(slope);
    double largest = 0;
    for (int i = 0; i <= 3; ++i) {
        largest = std::max(largest, std::abs(y[i].value()) / errbound::binomial(3, i));
    }
    const std::array bounds{y[0].error(),     y[3].error(),    slope[0].error(),
                            slope[2].error(), bend[0].error(), bend[1].error()};
    for (std::size_t i = 0; i < bounds.size(); ++i) {
        // NaN, too, says that nothing is known.
        const double known = std::isfinite(bounds[i]) ? bounds[i] : infinity;
        samples[i].absolute.push_back(known);
        if (largest > 0) samples[i].relative.push_back(known / largest);
    }
}

/// q0, q1, q25, ... of the numbers, which are sorted for it.
void add_quantiles(std::vector<double>& numbers, const std::string& prefix, row& into) {
    std::ranges::sort(numbers);
    for (const int percent : {0, 1, 25, 50, 75, 99, 100}) {
        const double q = quantile(numbers, percent / 100.0);
        into[prefix + "q" + std::to_string(percent)] = q < infinity ? row(q) : row("inf");
    }
}

}  // namespace

template <class Query>
rows take_bounds(const queries_with_truth<Query>& data, const sample_sizes& size) {
    const std::vector<Query> queries = data.queries.at_most(size.bounds).all_stored();
    rows result;
    errbound::for_each_rule(errbound::all_rules{}, [&]<class Rule>() {
        if constexpr (!errbound::promises_bound<Rule>) return;
        bound_samples samples;
        for (const Query& q : queries) add_bounds<Rule>(q, samples);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            std::vector<double>& absolute = samples[i].absolute;
            const auto exact = std::ranges::count(absolute, 0.0);
            const auto unknown = std::ranges::count(absolute, infinity);
            row r = {{"rule", Rule::name},
                     {"variable", variable_names[i]},
                     {"count", absolute.size()},
                     {"exact", exact},
                     {"unknown", unknown}};
            add_quantiles(absolute, "", r);
            add_quantiles(samples[i].relative, "relative_", r);
            result.push_back(std::move(r));
        }
    });
    return result;
}

template rows take_bounds(const queries_with_truth<vertex_face<double>>&, const sample_sizes&);
template rows take_bounds(const queries_with_truth<edge_edge<double>>&, const sample_sizes&);

}  // namespace ccd::report
