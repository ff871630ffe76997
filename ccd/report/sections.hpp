// What a report measures, a function per part: each returns rows for one data set and kind.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/batch.hpp>
#include <ccd/bsc.hpp>
#include <ccd/method.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "ccd/report/data_set.hpp"
#include "ccd/report/parts.hpp"
#include "ccd/report/timing.hpp"

namespace ccd::report {

/// `exact` in batches, as a method of its own.
inline constexpr std::string_view batch_name = "exact, batch";

/// Queries that are measured, drawn evenly where there are more.
struct sample_sizes {
    std::size_t speed;   ///< for ns per query
    std::size_t times;   ///< timed one by one
    std::size_t bounds;  ///< whose bounds are taken
    int repeats;         ///< of each timing
};
constexpr sample_sizes sizes(bool quick) {
    return quick ? sample_sizes{20'000, 5'000, 20'000, 5}
                 : sample_sizes{200'000, 100'000, 200'000, 7};
}

/// Called now and then with the share of a part that is done.
using progress = std::function<void(double)>;

/// What a method said of all queries, against their truth: one row.
template <class Query>
rows count_errors(const judged_queries<Query>& data, std::string_view method, int threads,
                  const progress& show);

/// ns per query of the methods in turn, on one thread: a row for each.
template <class Query>
rows race_methods(const judged_queries<Query>& data, const std::vector<std::string>& methods,
                  const sample_sizes& size);

/// How the times of single queries are distributed, on one thread: a row for each method.
template <class Query>
rows time_queries(const judged_queries<Query>& data, const std::vector<std::string>& methods,
                  const sample_sizes& size, const progress& show);

/// Bounds of Y, Y' and Y'' at t = 0 and 1 under every rule, as BSC meets them: a row for each rule
/// and variable.
template <class Query>
rows take_bounds(const judged_queries<Query>& data, const sample_sizes& size);

}  // namespace ccd::report
