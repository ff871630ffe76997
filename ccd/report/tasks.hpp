// The parts that a report consists of, as tasks to be done.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "ccd/report/measuring/data_set.hpp"
#include "ccd/report/parts.hpp"
#include "ccd/report/report.hpp"
#include "ccd/report/sections.hpp"

namespace ccd::report {

/// A part to be measured.
struct task {
    part_key key;
    double cost;  ///< roughly, in microseconds
    row about;    ///< columns that its rows begin with
    std::function<rows(const progress&)> measure;
    rows* into;  ///< a table of the list below
};

/// The tasks of a report, in the order in which they are done, and the tables that they fill. Must
/// stay where it is, as must the data.
class task_list {
  public:
    task_list(const options& settings, const machine& here);
    task_list(const task_list&) = delete;
    task_list& operator=(const task_list&) = delete;

    /// What is measured of each data set.
    void add(const data_set& data);
    /// What is measured without data sets, or on all that were added.
    void add_others();

    std::vector<task> tasks;
    rows errors, speeds, times, contacts, bounds, tightness, stress;

  private:
    /// Of a data set, the queries of a kind.
    struct part_of {
        const data_set& data;
        ccd::kind kind;
    };

    template <class Query>
    void add(const data_set& data, const queries_with_truth<Query>& known);
    template <class Query>
    void add_methods(const part_of& part, const queries_with_truth<Query>& known);
    void add_methods(const stress::family& family);
    void add_contacts(const stress::family& family);
    void add_tightness();
    void add_part(const part_of& part, const std::string& what, row depends_on, double cost,
                  std::function<rows(const progress&)> measure, rows& into);
    void add(std::string name, row depends_on, double cost, row about,
             std::function<rows(const progress&)> measure, rows& into);

    std::vector<const data_set*> data_;
    const options settings_;
    const sample_sizes size_;
    const row program_;                ///< what all parts depend on
    std::vector<std::string> singly_;  ///< methods that decide queries one by one
};

}  // namespace ccd::report
