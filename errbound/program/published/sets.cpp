// Predicates, intervals, functions and programs.
#include <algorithm>
#include <array>
#include <cmath>
#include <errbound/predicates.hpp>
#include <errbound/validation/validation.hpp>
#include <optional>
#include <span>
#include <string_view>

#include "errbound/program/published/compared_rules.hpp"
#include "errbound/program/published/fpcore.hpp"
#include "errbound/program/published/text.hpp"
#include "errbound/validation/worst_case/range.hpp"

namespace errbound::validation {
namespace {

std::vector<recorded> inputs_of(std::size_t count) {
    std::vector<recorded> all;
    for (std::size_t k = 0; k < count; ++k)
        all.emplace_back(recording::node{.kind = recording::leaf::input, .left = k});
    return all;
}

template <std::size_t Dimension, std::size_t Points>
struct fixture {
    using point = std::array<double, Dimension>;
    static constexpr std::size_t coordinates = Dimension * Points;

    template <class T, class Function>
    static auto with_points(const Function& f, const std::vector<T>& x) {
        return [&]<std::size_t... I>(std::index_sequence<I...>) {
            return f(point_of(x, I)...);
        }
        (std::make_index_sequence<Points>());
    }
    template <class T>
    static std::array<T, Dimension> point_of(const std::vector<T>& x, std::size_t i) {
        std::array<T, Dimension> p;
        for (std::size_t k = 0; k < Dimension; ++k) p[k] = x[i * Dimension + k];
        return p;
    }

    template <class Form, class Predicate>
    static void compare(const published_file& file, conformance& to, const Form& form,
                        const Predicate& predicate) {
        const std::string set = "predicates", name = file.stem();
        recording f(number_type::double_type, std::vector<input_range>(coordinates), {});
        f.result = with_points(form, inputs_of(coordinates)).index();
        compared_rules rules(f, to.options.rules, set, name, to);
        for_each_line(file.text, [&](std::size_t line, std::string_view text) {
            std::vector<double> numbers;
            for (const std::string_view word : words_of(text))
                if (const auto x = number_in(word); x && std::isfinite(*x)) numbers.push_back(*x);
            const bool good =
                numbers.size() == coordinates + 2 && words_of(text).size() == numbers.size();
            const double sign = good ? numbers.back() : 2;
            if (text.empty() || !(std::abs(sign) <= 1)) {
                if (!text.empty()) to.skip(set, "a line is not an index, coordinates and a sign");
                return;
            }
            const std::vector<double> x(numbers.begin() + 1, numbers.end() - 1);
            const sign_type wanted = sign > 0   ? sign_type::positive
                                     : sign < 0 ? sign_type::negative
                                                : sign_type::zero;
            const std::string place = file.place(line);
            to.count(to.row(set, name, "exact"), place,
                     with_points(predicate, x) == wanted ? "" : "sign");
            rules.at(x, place);
        });
    }
};

/// [a, b], [a] or a number, with a decoration or none; nothing if empty or unbounded.
std::optional<range> range_in(std::string_view text) {
    const bool brackets = text.starts_with('[');
    if (!brackets) {
        const auto x = number_in(text);
        return x && std::isfinite(*x) ? std::optional(range(*x)) : std::nullopt;
    }
    const std::size_t end = text.find(']'), comma = text.find(',');
    const auto low = number_in(text.substr(1, std::min(comma, end) - 1));
    const auto high = comma < end ? number_in(text.substr(comma + 1, end - comma - 1)) : low;
    if (!low || !high || !(*low <= *high) || !std::isfinite(*low) || !std::isfinite(*high))
        return std::nullopt;
    return range(*low, *high);
}

/// The operation's range, or nothing if this library lacks the operation.
std::optional<range> applied(const std::string& name, const std::vector<range>& x) {
    const auto is = [&](std::string_view wanted, std::size_t operands) {
        return name == wanted && x.size() == operands;
    };
    if (is("pos", 1)) return x[0];
    if (is("neg", 1)) return -x[0];
    if (is("add", 2)) return x[0] + x[1];
    if (is("sub", 2)) return x[0] - x[1];
    if (is("mul", 2)) return x[0] * x[1];
    if (is("div", 2)) return x[0] / x[1];
    if (is("recip", 1)) return 1 / x[0];
    if (is("sqr", 1)) return square(x[0]);
    if (is("sqrt", 1)) return sqrt(x[0]);
    if (is("fma", 3)) return x[0] * x[1] + x[2];
    if (is("abs", 1)) return abs(x[0]);
    if (is("min", 2)) return min(x[0], x[1]);
    if (is("max", 2)) return max(x[0], x[1]);
    if (is("pown", 2)) return power_over(x[0], x[1]);
    for (const named_function& f : named_functions)
        if (is(f.name, has_two_arguments(f.function) ? 2 : 1) ||
            (f.function == elementary_function::log1p && is("logp1", 1)))
            return function_value(f.function, x[0], x.back());
    return std::nullopt;
}

double width_of(const range& r) {
    return r.upper() - r.lower();
}

void compare_interval(const published_file& file, std::size_t line, std::string_view text,
                      conformance& to) {
    const std::string set = "ITF1788";
    const std::vector<std::string_view> sides = split(text, '=');
    std::vector<std::string> words;
    for (const std::string_view word : words_of(sides[0], true)) words.emplace_back(word);
    if (words.empty()) return;
    if (sides.size() != 2) return to.skip(set, "a statement is no equation");
    const std::string operation = words[0];
    if (!applied(operation, std::vector<range>(words.size() - 1)))
        return to.skip(set, "the library has no such operation", operation);
    const auto results = words_of(sides[1], true);
    const auto published = results.size() == 1 ? range_in(results[0]) : std::nullopt;
    if (!published) return to.skip(set, "the result is empty, unbounded or no interval");
    std::vector<range> operands;
    for (std::size_t i = 1; i < words.size(); ++i) {
        const auto x = range_in(words[i]);
        if (!x) return to.skip(set, "an operand is empty or unbounded");
        operands.push_back(*x);
    }
    const range found = *applied(operation, operands);
    conformance_row& row = to.row(set, operation, "interval");
    to.count(row, file.place(line),
             found.lower() <= published->lower() && found.upper() >= published->upper()
                 ? ""
                 : "interval");
    if (!found.is_finite())
        ++row.uncertain;
    else if (width_of(*published) > 0)
        row.log10.add(std::log10(width_of(found)) - std::log10(width_of(*published)));
}

/// The function, and true for float; nothing if the library lacks it.
std::optional<std::pair<elementary_function, bool>> function_named(std::string name) {
    for (const bool is_float : {false, true}) {
        for (const named_function& f : named_functions)
            if (f.name == name) return std::pair(f.function, is_float);
        if (!name.ends_with('f')) break;
        name.pop_back();
    }
    return std::nullopt;
}

}  // namespace

conformance_row& conformance::row(const std::string& set, const std::string& subject,
                                  const std::string& method, bool promises) {
    const auto is_it = [&](const conformance_row& r) {
        return r.set == set && r.subject == subject && r.method == method;
    };
    const auto found = std::ranges::find_if(rows, is_it);
    if (found != rows.end()) return *found;
    return rows.emplace_back(
        conformance_row{.set = set, .subject = subject, .method = method, .promises = promises});
}

void conformance::skip(const std::string& set, const std::string& reason, const std::string& name) {
    skipped_vectors& all = skipped[{set, reason}];
    ++all.count;
    if (!name.empty() && (", " + all.names + ",").find(", " + name + ",") == std::string::npos)
        all.names += (all.names.empty() ? "" : ", ") + name;
}

void conformance::count(conformance_row& r, const std::string& place, const std::string& error) {
    ++r.cases;
    if (error.empty()) return;
    ++r.wrong;
    if (r.promises)
        wrong.push_back(place + ": the " + error + " of " + r.subject + " by " + r.method +
                        " is wrong");
}

void compare_predicates(const published_file& file, conformance& to) {
    const std::string name = file.stem();
    const auto unweighted = [](const auto& form) {
        return [form](const auto&... p) { return form(p..., forms::unweighted); };
    };
    const auto area = [](const auto&... p) { return forms::area(p...); };
    const auto volume = [](const auto&... p) { return forms::volume(p...); };
    const auto circle = [](const auto&... p) { return forms::lifted_area(p...); };
    const auto sphere = [](const auto&... p) { return forms::lifted_volume(p...); };
    if (name == "orient2d") return fixture<2, 3>::compare(file, to, area, orient2d);
    if (name == "orient3d") return fixture<3, 4>::compare(file, to, volume, orient3d);
    if (name == "incircle") return fixture<2, 4>::compare(file, to, unweighted(circle), incircle);
    if (name == "insphere") return fixture<3, 5>::compare(file, to, unweighted(sphere), insphere);
    to.skip("files", "a text file is not named by a predicate");
}

void compare_intervals(const published_file& file, conformance& to) {
    std::size_t line = 1;
    std::string statement;
    const std::string text = without_comments(file.text);
    for (const char c : text) {
        if (c == '\n') ++line;
        if (c == ';') compare_interval(file, line, statement, to);
        if (c == ';' || c == '{' || c == '}')
            statement.clear();
        else
            statement += c;
    }
}

void compare_functions(const published_file& file, conformance& to) {
    const std::string set = "functions";
    const auto named = function_named(file.stem());
    if (!named) return to.skip(set, "the library has no such function", file.stem());
    const auto function = named->first;
    const bool is_float = named->second;  // no structured binding: clang 14 captures none
    const std::size_t count = has_two_arguments(function) ? 2 : 1;
    const number_type type = is_float ? number_type::float_type : number_type::double_type;
    recording f(type, std::vector<input_range>(count), {});
    const std::vector<recorded> x = inputs_of(count);
    f.result =
        (count == 1 ? recorded::of(function, x[0]) : recorded::of(function, x[0], x[1])).index();
    // All rules take functions' errors from function_error.
    const rule tight = *std::ranges::find(rules(), "tight", &rule::name);
    compared_rules compared(f, {&tight, 1}, set, file.stem(), to);
    for_each_line(file.text, [&](std::size_t line, std::string_view text) {
        std::vector<double> arguments;
        const std::vector<std::string_view> words = words_of(text.substr(0, text.find('#')));
        if (words.empty()) return;
        for (const std::string_view word : words)
            if (const auto number = number_in(word); number && std::isfinite(*number))
                arguments.push_back(*number);
        if (arguments.size() != count || words.size() != count)
            return to.skip(set, "a line has no finite arguments, or too many or too few");
        if (is_float &&
            std::ranges::any_of(arguments, [](double a) { return static_cast<float>(a) != a; }))
            return to.skip(set, "an argument is no float");
        compared.at(arguments, file.place(line));
    });
}

void compare_cores(const published_file& file, conformance& to) {
    const std::string set = "FPBench";
    for (const fpcore& core : parse_fpcores(file.text, file.path.string())) {
        const std::string place = core.file + ": " + core.name;
        try {
            const worst_case_result found = worst_case_of(core, to.options);
            if (!std::isfinite(found.at_most)) {
                to.skip(set, no_finite_bound);
                continue;
            }
            const auto add = [&](const std::string& method, bool promises, double bound,
                                 bool is_wrong) {
                conformance_row& row = to.row(set, core.precision, method, promises);
                to.count(row, place, is_wrong ? "bound" : "");
                if (!std::isfinite(bound))
                    ++row.uncertain;
                else if (found.at_least > 0 && bound > 0)
                    row.log10.add(std::log10(bound / found.at_least));
            };
            add("worst_case", true, found.at_most, found.at_least > found.at_most);
            for (std::size_t i = 0; i < found.by_rule.size(); ++i)
                add(found.by_rule[i].rule, to.options.rules[i].promises(), found.by_rule[i].largest,
                    found.by_rule[i].broken > 0);
        } catch (const unsupported_core& e) {
            to.skip(set, e.what());
        }
    }
}

}  // namespace errbound::validation
