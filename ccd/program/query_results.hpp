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

struct query_result {
    std::string file;
    ccd::kind kind{};
    ccd::method method{};
    std::size_t queries = 0, collisions = 0;
    std::optional<std::size_t> false_positives, false_negatives;
    std::string verdicts;  ///< with verdicts: a character per query; 1: may collide
    std::string times;
    double ns_per_query = 0;
};

struct time_request {
    bool verdicts = false, times = false;
    double t_max = 1;
    std::optional<double> distance = {};

    /// The truth in files is about contact in the whole step.
    bool ignores_truth() const { return t_max < 1 || distance; }
};

/// Decides repeatedly for `seconds`. The time is that of the fastest pass (lab::fastest_of).
query_result decide_queries(const io::query_file& queries, const std::string& file,
                            ccd::method method, const device_choice& device,
                            const time_request& request, double seconds);

std::string text_of_results(const std::vector<query_result>& results);
std::string json_of_results(const std::vector<query_result>& results);

}  // namespace ccd::program
