// `errbound validate`.
#include <algorithm>
#include <cstdint>
#include <errbound/validation/validation.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "errbound/program/commands.hpp"
#include "errbound/program/examined_parts.hpp"
#include "errbound/program/named_rules.hpp"

namespace errbound::validation {
namespace {

struct validate_arguments {
    std::vector<rule> rules;
    bool expressions = false, tiny = false;  ///< parts to run
    function_options functions;              ///< with the numbers and seed of expressions
    bool every_bound = false;                ///< for tiny
    expression_options options;              ///< threads: for all parts
    result_files to;
};

class validate final : public support::command {
  public:
    explicit validate(CLI::App& program);
    support::exit_status run() override;

  private:
    void add_expressions();
    void add_functions();
    /// These throw errbound::support::usage_error; the second if an option has no effect.
    validate_arguments checked() const;
    void require_use_of_options(const validate_arguments& all) const;

    validate_arguments arguments_;
    std::string rules_ = "all", numbers_, functions_;
};

/// The largest error that function_error allows.
constexpr double most_units = 1024;

number_type number_named(const std::string& name) {
    return support::entry_named("--numbers", name, number_types, &named_number_type::name).type;
}
std::string names_of_numbers() {
    std::string names;
    for (const named_number_type& one : number_types)
        names += (names.empty() ? "" : ", ") + std::string(one.name);
    return names;
}
void require_rules_of_numbers(const validate_arguments& all) {
    for (const number_type number : all.options.numbers)
        if (std::ranges::none_of(all.rules, [&](const rule& r) { return r.supports(number); }))
            throw support::usage_error("--numbers is '" + std::string(name_of(number)) +
                                       "'; expected a type that a rule of --rules supports");
}
elementary_function function_named(const std::string& name) {
    return support::entry_named("--functions", name, named_functions, &named_function::name)
        .function;
}
std::vector<elementary_function> functions_named(const std::string& names) {
    if (names != "all") return support::all_named("--functions", names, function_named);
    std::vector<elementary_function> all;
    for (const named_function& f : named_functions) all.push_back(f.function);
    return all;
}

void require_use_of_every_float(const function_options& options) {
    if (std::ranges::all_of(options.functions, has_two_arguments) ||
        std::ranges::find(options.numbers, number_type::float_type) == options.numbers.end())
        throw support::usage_error(
            "--every-float is given; expected a function of one argument, and float");
}

validate::validate(CLI::App& program)
    : command(program, "validate",
              "Compare every bound rule's bounds and certain signs with MPFR, and report how tight "
              "they are.\nRandom expressions, unless --tiny or --functions is given. ccd validate "
              "compares stored queries") {
    add_expressions();
    support::add(line_, "--numbers", numbers_,
                 "Number types N[,N...] of expressions: " + names_of_numbers() +
                     "; the first two by default")
        .type("N[,N...]");
    support::add_flag(line_, "--tiny", arguments_.tiny,
                      "Every case of number formats of 6 to 8 bits");
    support::add_flag(line_, "--every-bound", arguments_.every_bound,
                      "With --tiny: in float8_e5m2 and float8_e4m3 every pair of bounds too");
    add_functions();
    support::add(line_, "--rules", rules_, "Rules R[,R...]; all by default").type("R[,R...]");
    support::add(line_, "--threads", arguments_.options.threads, "Threads; 0: one per core")
        .between(0, 4096);
    arguments_.to.add_options(line_);
}

void validate::add_expressions() {
    support::add(line_, "--expressions", arguments_.options.expressions,
                 "Random expressions, at least N per rule and number type")
        .between(std::uint64_t{1}, std::uint64_t{1} << 40)
        .shows_default();
    support::add(line_, "--seed", arguments_.options.seed, "Same seed, same expressions")
        .check(support::checked_seed)
        .shows_default();
    support::add(line_, "--first", arguments_.options.first,
                 "Skip the first N expressions of the seed's sequence. Runs with --first 0, M, "
                 "2M, ... and\nM expressions each partition one long run")
        .between(std::uint64_t{0}, std::uint64_t{1} << 40)
        .shows_default();
    support::add(line_, "--operations", arguments_.options.operations,
                 "Operations in an expression, at most")
        .between(1, max_operations)
        .shows_default();
}

void validate::add_functions() {
    support::add(line_, "--functions", functions_,
                 "The errors of the system's elementary functions F[,F...], or of all, in float "
                 "and\ndouble, compared with function_error")
        .type("F[,F...]");
    support::add(line_, "--samples", arguments_.functions.samples,
                 "With --functions: arguments of each function and number type")
        .between(std::uint64_t{1}, std::uint64_t{1} << 40)
        .shows_default();
    support::add_flag(line_, "--every-float", arguments_.functions.every_float,
                      "With --functions: all floats, of functions of one argument: long");
    support::add(line_, "--units", arguments_.functions.units,
                 "With --functions: compare with that many units in the last place instead of "
                 "function_error");
    support::add_output(line_, "--functions-csv", arguments_.to.functions_csv,
                        "Write the table of functions as CSV");
}

validate_arguments validate::checked() const {
    validate_arguments all = arguments_;
    all.rules = rules_named(rules_);
    if (was_given("--numbers"))
        all.options.numbers = support::all_named("--numbers", numbers_, number_named);
    if (was_given("--functions")) all.functions.functions = functions_named(functions_);
    if (const auto units = all.functions.units; units && !(*units > 0 && *units <= most_units))
        throw support::usage_error("--units is out of range; expected a number > 0 and <= 1024");
    all.functions.numbers = all.options.numbers;
    const auto has_functions = [](number_type number) {
        return number == number_type::float_type || number == number_type::double_type ||
               number == number_type::long_double_type;
    };
    if (!all.functions.functions.empty() &&
        std::ranges::none_of(all.functions.numbers, has_functions))
        throw support::usage_error(
            "--numbers has no float, double or long double; expected one of them with --functions");
    all.functions.seed = all.options.seed;
    all.expressions = was_given("--expressions") || (!all.tiny && all.functions.functions.empty());
    if (all.expressions) require_rules_of_numbers(all);
    require_use_of_options(all);
    if (all.functions.every_float) require_use_of_every_float(all.functions);
    return all;
}

void validate::require_use_of_options(const validate_arguments& all) const {
    const bool functions = !all.functions.functions.empty();
    const bool random = all.expressions || functions;
    const bool rules = all.expressions || all.tiny;
    const std::tuple<const char*, bool, const char*> needs[] = {
        {"--rules", rules, "--expressions or --tiny"},
        {"--first", all.expressions, "--expressions"},
        {"--operations", all.expressions, "--expressions"},
        {"--numbers", random, "--expressions or --functions"},
        {"--seed", random, "--expressions or --functions"},
        {"--every-bound", all.tiny, "--tiny"},
        {"--samples", functions, "--functions"},
        {"--every-float", functions, "--functions"},
        {"--units", functions, "--functions"},
        {"--functions-csv", functions, "--functions"},
        {"--csv", all.expressions, "--expressions"}};
    for (const auto& [option, is_used, by] : needs)
        if (was_given(option) && !is_used)
            throw support::usage_error(std::string(option) + " is given without " + by +
                                       "; expected both");
}

support::exit_status validate::run() {
    const validate_arguments all = checked();
    support::require_good_outputs(all.to.all(), {});
    std::vector<part> parts;  // in the order of tables
    if (all.tiny) parts.push_back({"tiny", evidence_of_tiny(all.rules, all.every_bound)});
    if (!all.functions.functions.empty())
        parts.push_back({"functions", evidence_of_functions(all.functions)});
    if (all.expressions)
        parts.push_back({"expressions", evidence_of_expressions(all.rules, all.options)});
    return examine_parts(parts, all.options.threads, all.to);
}

}  // namespace
}  // namespace errbound::validation

const errbound::support::command_maker errbound::validate_command =
    errbound::support::make_command<validation::validate>;
