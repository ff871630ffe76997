// What `ccd query` finds of stored queries: a row of its table for each file and method.
#pragma once

#include <ccd/io/query_file.hpp>
#include <ccd/kind.hpp>
#include <ccd/method.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "ccd/program/device_run.hpp"

namespace ccd::program {

/// One row of the table.
struct query_result {
    std::string file;
    ccd::kind kind{};
    ccd::method method{};
    std::size_t queries = 0, collisions = 0;
    std::optional<std::size_t> false_positives, false_negatives;
    std::string verdicts;  ///< if asked for: a character a query; 1: may collide
    std::string times;     ///< if asked for: a line a query
    double ns_per_query = 0;
};

/// What `exact` is asked beyond contact in the whole step, and what is wanted beside counts.
struct time_question {
    bool verdicts = false, times = false;
    double t_max = 1;
    std::optional<double> distance = {};

    /// Whether the files' truth, of contact in the whole step, is another question's.
    bool is_another() const { return t_max < 1 || distance; }
};

/// Decides all queries once, and again as long as less than `seconds` have passed: the time noted
/// is the fastest pass's.
query_result decide_queries(const io::query_file& queries, const std::string& file,
                            ccd::method method, const device_choice& device,
                            const time_question& asked, double seconds);

std::string text_of_results(const std::vector<query_result>& results);
std::string json_of_results(const std::vector<query_result>& results);

}  // namespace ccd::program
