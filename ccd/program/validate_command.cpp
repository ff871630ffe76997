#include <ccd/io/query_file.hpp>
#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "ccd/lab/validation/query_validation.hpp"
#include "ccd/program/command.hpp"
#include "ccd/program/options.hpp"
#include "errbound/program/examined_parts.hpp"

namespace ccd::program {
namespace {

namespace validation = errbound::validation;

class validate final : public command {
  public:
    explicit validate(CLI::App& program)
        : command(program, "validate",
                  "Compare every bound rule with MPFR in the forms and BSC of stored queries, and "
                  "report how\ntight bounds are (errbound validate compares random expressions)") {
        files_.add_options(line_);
        add(line_, "--rules", rules_, "Rules R[,R...]; all by default").type("R[,R...]");
        add_threads_option(line_, threads_);
        to_.add_options(line_);
    }

    exit_status run() override {
        errbound::support::require_one_standard_input("FILE", files_.paths);
        const std::vector<lab::query_rule> rules = chosen_rules();
        errbound::support::require_good_outputs(to_.all(), files_.paths);
        std::vector<io::query_file> queries;
        for (const auto& path : files_.paths)
            queries.push_back(io::read_queries(path, find_kind(files_.kind), files_.round));
        std::vector<validation::part> parts;
        for (std::size_t i = 0; i < queries.size(); ++i)
            std::visit(
                [&](const auto& all) {
                    parts.push_back({files_.paths[i].string(),
                                     lab::evidence_of_queries(rules, std::span(all))});
                },
                queries[i].queries);
        return validation::examine_parts(parts, threads_, to_);
    }

  private:
    std::vector<lab::query_rule> chosen_rules() const {
        const std::vector<lab::query_rule> all = lab::query_rules();
        if (!was_given("--rules")) return all;
        return errbound::support::all_named("--rules", rules_, [&](const std::string& name) {
            return errbound::support::entry_named("--rules", name, all, &lab::query_rule::name);
        });
    }

    query_files files_;
    std::string rules_;
    int threads_ = 0;
    validation::result_files to_;
};

}  // namespace

const command_maker validate_command = make_command<validate>;

}  // namespace ccd::program
