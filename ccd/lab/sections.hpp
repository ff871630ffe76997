// The measurements of a report. Each returns rows for the queries of one kind of a data set.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ccd/lab/data_set.hpp"
#include "ccd/lab/families.hpp"
#include "ccd/lab/report.hpp"

namespace ccd::lab {

/// The numbers of queries, which are drawn evenly if there are more.
struct sample_sizes {
    std::size_t speed;           ///< for ns per query
    std::size_t times;           ///< timed one by one
    std::size_t bounds;          ///< whose bounds are taken
    int repeats;                 ///< of each timing
    std::size_t stress_queries;  ///< of each family, kind and value of the knob
    double stress_seconds;       ///< of a method's time on these
    std::size_t expressions;     ///< random ones whose bounds are compared with true errors
    std::size_t tightness;       ///< queries of each data set and kind for the same
};
constexpr sample_sizes sizes(bool quick) {
    return quick ? sample_sizes{20'000, 5'000, 20'000, 5, 40, 0.002, 20'000, 40}
                 : sample_sizes{200'000, 100'000, 200'000, 7, 400, 0.02, 500'000, 200};
}

rows count_errors(const data_set& data, kind which, std::string_view method, int threads,
                  const progress& show);

/// ns per query of the methods, timed alternately on one thread: a row for each.
rows race_methods(const data_set& data, kind which, const std::vector<std::string>& methods,
                  const sample_sizes& size, const progress& show);

/// Quantiles of the times of single queries on one thread: a row for each method.
rows time_queries(const data_set& data, kind which, const std::vector<std::string>& methods,
                  const sample_sizes& size, const progress& show);

/// Bounds of Y, Y' and Y'' at t = 0 and 1, as in BSC: a row for each rule and variable.
rows take_bounds(const data_set& data, kind which, const sample_sizes& size);

/// First contacts by `exact`: widths of brackets, and costs compared with decisions, on one thread,
/// in batches and one by one. The column `broken` reports an invalid bracket, or one that
/// contradicts the decision.
rows find_contacts(const data_set& data, kind which, const sample_sizes& size, int threads,
                   const progress& show);

/// Ratios of bounds to true errors, by MPFR, in random expressions and on queries: rows by rule,
/// number type and quantity, with quantiles of the ratio's log10. The column `broken` reports a
/// broken promise. Only in a build with MPFR.
rows measure_expressions(const sample_sizes& size, int threads, const progress& show);
rows measure_tightness(const std::vector<const data_set*>& data, const sample_sizes& size,
                       int threads, const progress& show);

}  // namespace ccd::lab
