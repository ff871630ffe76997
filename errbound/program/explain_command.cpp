// `errbound explain`.
#include "errbound/program/explain_command.hpp"

#include <errbound/explain/explanation.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "errbound/program/explanation_file.hpp"
#include "errbound/program/flame_graph.hpp"
#include "errbound/support/command_line.hpp"
#include "errbound/support/output_file.hpp"

namespace errbound::explaining {

/// Printable: a file may contain any name.
static std::string shown_name(const explanation& result) {
    return detail::printable(result.name);
}

explain_command::explain_command(CLI::App& program)
    : line_(*program.add_subcommand(
          "explain",
          "Tell where the errors of results come from, as errbound::write_explanations of a "
          "program\nthat computes with explained numbers wrote it.")) {
    line_.add_option("file", file_, "What the program wrote; - is standard input")
        ->required()
        ->type_name("FILE")
        ->transform(support::input_named);
    line_.add_option("--result", result_, "The result of that name alone");
    line_.add_option("--lines", lines_, "Sources in a table, at most")
        ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 40))
        ->capture_default_str();
    line_.add_option("--picture", picture_, "Draw flame graphs, an SVG file")->type_name("OUT");
}

int explain_command::run() const {
    support::require_good_outputs({picture_}, {file_});
    std::vector<explanation> results = parse_explanations(support::read_whole(file_), file_);
    if (line_.count("--result") > 0)
        results = {support::entry_named("--result", result_, results, shown_name)};
    if (picture_) support::write_whole(*picture_, flame_graphs(results));
    std::ostream& people = support::stream_for_people({picture_});
    for (std::size_t i = 0; i < results.size(); ++i)
        people << (i > 0 ? "\n" : "") << text_of(results[i], lines_);
    return 0;
}

}  // namespace errbound::explaining
