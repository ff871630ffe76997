// `ccd query`: its options and what it does, for the program over ranks, too.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ccd/program/command.hpp"
#include "ccd/program/options.hpp"
#include "ccd/program/query_results.hpp"

namespace ccd::program {

class query : public command {
  public:
    explicit query(CLI::App& program);
    exit_status run() override;

  protected:
    /// What the options ask.
    struct asked_for {
        std::vector<ccd::method> methods;
        device_choice device;
        time_question question;
    };
    /// Throws usage_error, device_error.
    asked_for checked_options() const;
    std::vector<std::optional<std::filesystem::path>> outputs() const {
        return {verdicts_, toi_, json_};
    }
    /// Prints and writes all that was found, a result for each file and method.
    void write(const std::vector<query_result>& results) const;

    std::vector<std::filesystem::path> files_;
    std::string kind_;  ///< empty: from each path
    bool round_ = false;

  private:
    time_question time_asked() const;
    std::vector<ccd::method> methods_on(const device_choice& device) const;
    std::vector<query_result> decide_files(const asked_for& asked) const;
    /// Whether something is asked that only `exact` answers.
    bool asks_exact_alone() const { return toi_ || t_max_.was_given() || separation_.was_given(); }

    std::optional<std::filesystem::path> verdicts_, toi_, json_;
    number_option separation_{line_, "--separation",
                              "Ask for a distance of at most that, in place of contact"};
    number_option t_max_{line_, "--t-max", "Ask about times from 0 to that, in place of 1"};
    methods_option methods_{line_};
    device_options device_{line_};
};

}  // namespace ccd::program
