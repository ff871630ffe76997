#include "tests/bench/harness.hpp"

#include <cstdio>

#include "ccd/lab/machine.hpp"
#include "errbound/support/command.hpp"
#include "errbound/support/output_file.hpp"
#include "errbound/support/program.hpp"

namespace bench {

void say(const std::string& line) {
    std::printf("%s\n", line.c_str());
    std::fflush(stdout);
}

void report::table(std::string_view section, const row& about, const std::string& title,
                   const rows& all) {
    if (all.empty()) return;
    say("\n" + title + "\n\n" + errbound::support::text_of(all));
    row values = row::array();
    for (const row& r : all) {
        values.push_back(about);
        values.back().update(r);
    }
    tables_.push_back({{"section", section}, {"title", title}, {"rows", std::move(values)}});
}

program::program(const std::string& name, const std::string& description)
    : line(description, name), name_(name) {
    line.add_flag("--quick", quick, "Fewer inputs and repeats: shows that all works");
    line.add_option("--json", json_, "Write the tables as JSON")->type_name("OUT");
    line.add_option("--commit", commit_, "The commit, printed at the head");
}

int program::run(int argc, char** argv, const std::function<void(report&)>& body,
                 const std::function<row()>& more) {
    namespace support = errbound::support;
    const auto measure = [&] {
        row machine = ccd::lab::this_machine();
        if (more) machine.update(more());
        machine["commit"] = commit_;
        for (const auto& [key, value] : machine.items())
            say(key + ": " + (value.is_string() ? value.get<std::string>() : value.dump()));
        report out;
        body(out);
        if (!json_.empty())
            support::write_whole(
                json_,
                support::json_of({{"machine", machine}, {"tables", out.tables()}}, 1) + '\n');
        return status;
    };
    return support::run_program(name_,
                                [&] { return support::parse_and_run(line, argc, argv, measure); });
}

}  // namespace bench
