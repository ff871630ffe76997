// ./run soak --predicates: signs of predicates against their oracles, and the bounds of their
// static filters against exact arithmetic, on millions of inputs.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>

#include "errbound/support/table.hpp"
#include "tests/soak/predicates/predicates.hpp"

namespace {

constexpr const char* stage_names[] = {
    "semi-static filter", "static filter", "tracked", "doubles", "short", "word",
    "two words",          "long"};
static_assert(std::size(stage_names) == errbound::predicate_stage_count);

std::string number(double x, int digits) {
    char text[40];
    std::snprintf(text, sizeof text, "%.*f", digits, x);
    return text;
}
std::string percent(std::uint64_t part, std::uint64_t whole) {
    if (part == 0) return "";
    return number(100 * static_cast<double>(part) / static_cast<double>(whole), 2) + " %";
}

/// Progress for those who wait; tables come at the end.
template <class Findings>
void say(const char* part, const Findings& f, std::uint64_t wrong) {
    std::fprintf(stderr, "%s: %s, %s: %s wrong, %.0f s\n", part, std::string(f.predicate).c_str(),
                 std::string(f.number_type).c_str(), std::to_string(wrong).c_str(), f.seconds);
}

/// Whether all signs are right.
bool signs(const soak::predicate_run& run) {
    errbound::support::table rows{{"predicate", "type", "inputs", "zero", "wrong", "uncertain"}};
    for (const char* name : stage_names) rows[0].emplace_back(name);
    rows[0].emplace_back("seconds");
    bool right = true;
    soak::compare_signs(run, [&](const soak::sign_findings& f) {
        say("signs", f, f.wrong);
        right = right && f.wrong == 0 && f.uncertain == 0;
        auto& row = rows.emplace_back(std::vector<std::string>{
            std::string(f.predicate), std::string(f.number_type), std::to_string(f.inputs),
            percent(f.zero, f.inputs), std::to_string(f.wrong), std::to_string(f.uncertain)});
        std::uint64_t asked = f.stages.undecided;
        for (const std::uint64_t n : f.stages.decided) asked += n;
        for (const std::uint64_t n : f.stages.decided) row.push_back(percent(n, asked));
        row.push_back(number(f.seconds, 1));
    });
    std::printf("signs against an oracle in whole numbers, and the stages that decided\n%s\n",
                errbound::support::text_of(rows, 2).c_str());
    return right;
}

/// Whether all bounds hold.
bool bounds(const soak::predicate_run& run) {
    errbound::support::table rows{{"predicate", "type", "constant", "Shewchuk's", "attempts",
                                   "violations", "bound used up", "seconds"}};
    bool hold = true;
    soak::attack_bounds(run, [&](const soak::bound_findings& f) {
        say("bounds", f, f.violations);
        hold = hold && f.violations == 0;
        rows.push_back({std::string(f.predicate), std::string(f.number_type), number(f.constant, 5),
                        f.constant_of_shewchuk == 0 ? "" : std::to_string(f.constant_of_shewchuk),
                        std::to_string(f.attempts), std::to_string(f.violations), number(f.used, 3),
                        number(f.seconds, 1)});
    });
    std::printf(
        "constants of static filters, in units of the roundoff u, and attempts to violate "
        "their bounds\n%s\n",
        errbound::support::text_of(rows, 2).c_str());
    return hold;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Signs of predicates against oracles, and their filters' bounds."};
    app.name("./run soak --predicates");
    soak::predicate_run run;
    app.add_option("--inputs", run.inputs,
                   "Per predicate and number type; as many attempts to violate a bound")
        ->capture_default_str();
    app.add_option("--seed", run.seed, "Same seed, same inputs")->capture_default_str();
    app.add_option("--predicate", run.predicate, "Only those whose name holds this");
    app.add_option("--threads", run.threads, "0: one per core")->capture_default_str();
    app.footer("Exit status: 0 all right, 1 a wrong sign or a violated bound, 2 bad usage.");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    const bool right = signs(run), hold = bounds(run);
    return right && hold ? 0 : 1;
}
