#include "errbound/program/validate_command.hpp"

#include <ccd/io/query_file.hpp>
#include <cstddef>
#include <cstdint>
#include <errbound/validation/validation.hpp>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "errbound/program/validate_results.hpp"
#include "errbound/support/command_line.hpp"
#include "errbound/support/progress_line.hpp"

namespace errbound::validation {
namespace {

/// One kind of evidence.
struct part {
    std::string name;  ///< "expressions", "tiny", "functions" or the file
    evidence what;
};

std::vector<ccd::io::query_file> read_files(const validate_arguments& arguments) {
    std::vector<ccd::io::query_file> files;
    for (const auto& path : arguments.queries)
        files.push_back(ccd::io::read_queries(path, arguments.kind, arguments.round));
    return files;
}

/// In table order. The parts refer to the queries of `files`.
std::vector<part> parts_of(const validate_arguments& arguments,
                           const std::vector<ccd::io::query_file>& files) {
    std::vector<part> parts;
    if (arguments.tiny)
        parts.push_back({"tiny", evidence_of_tiny(arguments.rules, arguments.every_bound)});
    for (std::size_t i = 0; i < files.size(); ++i)
        std::visit(
            [&](const auto& queries) {
                parts.push_back({arguments.queries[i].string(),
                                 evidence_of_queries(arguments.rules, std::span(queries))});
            },
            files[i].queries);
    if (!arguments.functions.functions.empty())
        parts.push_back({"functions", evidence_of_functions(arguments.functions)});
    if (arguments.expressions)
        parts.push_back(
            {"expressions", evidence_of_expressions(arguments.rules, arguments.options)});
    return parts;
}

}  // namespace

exit_status run_validate(const validate_arguments& arguments) {
    support::require_good_outputs({arguments.json, arguments.csv, arguments.functions_csv},
                                  arguments.queries);
    const std::vector<ccd::io::query_file> files = read_files(arguments);
    std::vector<found_part> found;
    for (const part& p : parts_of(arguments, files)) {
        support::progress_line progress;
        const auto show = [&](std::uint64_t done, std::uint64_t all) {
            progress.show(done, all, "parts: " + p.name);
        };
        found.push_back({p.name, examine(p.what, arguments.options.threads, show)});
    }
    return write_results(found, arguments);
}

}  // namespace errbound::validation
