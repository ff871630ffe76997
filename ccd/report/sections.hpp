// What a report measures, a function per part: each returns rows for one data set and kind.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/batch.hpp>
#include <ccd/method.hpp>
#include <ccd/methods/bsc.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "ccd/report/measuring/data_set.hpp"
#include "ccd/report/measuring/timing.hpp"
#include "ccd/report/parts.hpp"
#include "ccd/stress/families.hpp"

namespace ccd::report {

/// Queries that are measured, drawn evenly where there are more.
struct sample_sizes {
    std::size_t speed;           ///< for ns per query
    std::size_t times;           ///< timed one by one
    std::size_t bounds;          ///< whose bounds are taken
    int repeats;                 ///< of each timing
    std::size_t stress_queries;  ///< of each family, kind and value of the knob
    double stress_seconds;       ///< that a method is timed on these
    std::size_t expressions;     ///< random ones whose bounds are compared with true errors
    std::size_t tightness;       ///< queries of each data set and kind for the same
};
constexpr sample_sizes sizes(bool quick) {
    return quick ? sample_sizes{20'000, 5'000, 20'000, 5, 40, 0.002, 20'000, 40}
                 : sample_sizes{200'000, 100'000, 200'000, 7, 400, 0.02, 500'000, 200};
}

/// Called now and then with the share of a part that is done.
using progress = std::function<void(double)>;

/// What a method said of all queries, against their truth: one row.
template <class Query>
rows count_errors(const queries_with_truth<Query>& data, std::string_view method, int threads,
                  const progress& show);

/// ns per query of the methods in turn, on one thread: a row for each.
template <class Query>
rows race_methods(const queries_with_truth<Query>& data, const std::vector<std::string>& methods,
                  const sample_sizes& size, const progress& show);

/// How the times of single queries are distributed, on one thread: a row for each method.
template <class Query>
rows time_queries(const queries_with_truth<Query>& data, const std::vector<std::string>& methods,
                  const sample_sizes& size, const progress& show);

/// Bounds of Y, Y' and Y'' at t = 0 and 1 under every rule, as BSC meets them: a row for each rule
/// and variable.
template <class Query>
rows take_bounds(const queries_with_truth<Query>& data, const sample_sizes& size);

/// First contacts by `exact`: how wide their brackets are, and what they cost beside yes or no, on
/// one thread, in batches and one by one: a row, none of no queries. What is no bracket, or
/// contradicts yes or no, is reported in the column `broken`.
template <class Query>
rows find_contacts(const query_set<Query>& queries, const sample_sizes& size, int threads,
                   const progress& show);
/// The same of a family of stiff and extreme queries, over all values of its knob: a row for each
/// kind.
rows find_contacts(const stress::family& family, const sample_sizes& size, int threads,
                   const progress& show);

/// Methods on one family of stiff and extreme queries: a row for each value of the knob, kind and
/// method. A broken promise is reported in the columns `broken` (how) and `query` (which).
rows stress_methods(const stress::family& family, const std::vector<std::string>& methods,
                    const sample_sizes& size, int threads, const progress& show);

/// Bounds against true errors by MPFR, in random expressions and on queries of all data sets: rows
/// by rule, number type and quantity, quantiles of log10 of the ratio. A broken promise is reported
/// in the column `broken`. Only in a build with MPFR.
rows measure_expressions(const sample_sizes& size, int threads, const progress& show);
rows measure_tightness(const std::vector<const data_set*>& data, const sample_sizes& size,
                       int threads, const progress& show);

}  // namespace ccd::report
