// `errbound explain`.
#include <cstddef>
#include <cstdint>
#include <errbound/explain/explanation.hpp>
#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "errbound/program/commands.hpp"
#include "errbound/program/explanation_file.hpp"
#include "errbound/program/flame_graph.hpp"
#include "errbound/support/output_file.hpp"

namespace errbound::explaining {
namespace {

/// The name made printable, because a file may contain any name.
std::string shown_name(const explanation& result) {
    return detail::printable(result.name);
}

class explain final : public support::command {
  public:
    explicit explain(CLI::App& program);
    support::exit_status run() override;

  private:
    std::string file_, result_;
    std::size_t lines_ = 20;
    std::optional<std::filesystem::path> picture_;
};

explain::explain(CLI::App& program)
    : command(program, "explain",
              "Show where the errors of results come from, as errbound::write_explanations of a "
              "program\nthat computes with explained numbers wrote it") {
    support::add(line_, "FILE", file_, "The explanations; - is standard input")
        .required()
        .type("FILE")
        .input();
    support::add(line_, "--result", result_, "Only the result of that name");
    support::add(line_, "--lines", lines_, "Sources in a table, at most")
        .between(std::uint64_t{1}, std::uint64_t{1} << 40)
        .shows_default();
    support::add_output(line_, "--picture", picture_, "Draw flame graphs, an SVG file");
}

support::exit_status explain::run() {
    support::require_good_outputs({picture_}, {file_});
    std::vector<explanation> results = parse_explanations(support::read_whole(file_), file_);
    if (was_given("--result"))
        results = {support::entry_named("--result", result_, results, shown_name)};
    if (picture_) support::write_whole(*picture_, flame_graphs(results));
    std::ostream& people = support::stream_for_people({picture_});
    for (std::size_t i = 0; i < results.size(); ++i)
        people << (i > 0 ? "\n" : "") << text_of(results[i], lines_);
    return support::done;
}

}  // namespace
}  // namespace errbound::explaining

const errbound::support::command_maker errbound::explain_command =
    errbound::support::make_command<explaining::explain>;
