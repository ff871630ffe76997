// Expressions are evaluated with recorded numbers, preconditions on one input with ranges.
#include "errbound/program/published/fpcore.hpp"

#include <cmath>
#include <errbound/support/error.hpp>
#include <map>

#include "errbound/support/command_line.hpp"
#include "errbound/validation/worst_case/largest_error.hpp"
#include "errbound/validation/worst_case/range.hpp"

namespace errbound::validation {
namespace {

class parser {
  public:
    parser(std::string_view text, const std::string& file) : text_(text), file_(file) {}

    bool at_end() {
        for (; i_ < text_.size(); ++i_) {
            if (text_[i_] == ';')
                while (i_ + 1 < text_.size() && text_[i_ + 1] != '\n') ++i_;
            else if (text_[i_] == '\n')
                ++line_;
            else if (!is_space(text_[i_]))
                return false;
        }
        return true;
    }
    fpcore_expression expression(int depth = 0) {
        if (at_end()) fail("the file ends", "an expression");
        if (depth > 1000) fail("the expression is nested too deeply", "at most 1000 levels");
        fpcore_expression e{"", {}, line_};
        const char c = text_[i_];
        if (c == '(' || c == '[') {
            for (++i_; !at_end() && text_[i_] != ')' && text_[i_] != ']';)
                e.items.push_back(expression(depth + 1));
            if (at_end()) fail("the file ends", "a closing parenthesis");
            if (text_[i_] != (c == '(' ? ')' : ']')) fail("a bracket is unmatched", "its partner");
            ++i_;
        } else if (c == ')' || c == ']') {
            fail("a bracket is unmatched", "an expression");
        } else if (c == '"') {
            const std::size_t end = text_.find('"', i_ + 1);
            if (end == std::string_view::npos) fail("a text does not end", "a quotation mark");
            e.atom = text_.substr(i_, end + 1 - i_);
            line_ += static_cast<std::uint_least32_t>(std::ranges::count(e.atom, '\n'));
            i_ = end + 1;
        } else {
            const std::size_t begin = i_;
            while (i_ < text_.size() && !is_space(text_[i_]) && !is_one_of(text_[i_], "()[]\";"))
                ++i_;
            e.atom = text_.substr(begin, i_ - begin);
        }
        return e;
    }
    [[noreturn]] void fail(const std::string& what, const std::string& expected) const {
        fail_at(line_, what, expected);
    }
    [[noreturn]] void fail_at(std::uint_least32_t line, const std::string& what,
                              const std::string& expected) const {
        throw support::file_error(file_ + ':' + std::to_string(line) + ": " + what + "; expected " +
                                  expected);
    }

  private:
    static bool is_one_of(char c, std::string_view all) {
        return all.find(c) != std::string_view::npos;
    }
    static bool is_space(char c) { return is_one_of(c, " \t\r\n\f\v"); }

    std::string_view text_;
    const std::string& file_;
    std::size_t i_ = 0;
    std::uint_least32_t line_ = 1;
};

const std::string mixed = "the program has several precisions";

const std::map<std::string, number_type> precisions {
    {"binary64", number_type::double_type}, {"binary32", number_type::float_type},
        {"binary16", number_type::float16_type}, {"bfloat16", number_type::bfloat16_type},
        {"e5m2", number_type::float8_e5m2_type}, {"e4m3", number_type::float8_e4m3_type},
#if LDBL_MANT_DIG == 64
    {
        "binary80", number_type::long_double_type
    }
#endif
};

/// The operator of a list; empty if there is none.
const std::string& operator_of(const fpcore_expression& e) {
    static const std::string none;
    return e.items.empty() ? none : e.items[0].atom;
}
/// For messages; the end of a long list is left out.
std::string text_of(const fpcore_expression& e) {
    if (!e.atom.empty()) return e.atom;
    constexpr std::size_t most = 60;
    std::string text = "(";
    for (const fpcore_expression& item : e.items) {
        if (text.size() > 1) text += ' ';
        text += text.size() < most ? text_of(item) : "...";
        if (text.size() > most) break;
    }
    return text + ')';
}
bool is_comparison(const std::string& op) {
    return op == "<" || op == ">" || op == "<=" || op == ">=";
}

using names = std::map<std::string, recorded>;

class evaluator {
  public:
    evaluator(const fpcore& core, const std::string& precision)
        : core_(core), precision_(precision) {}

    recorded value(const fpcore_expression& e, const names& in) const {
        if (!e.atom.empty()) {
            if (const auto found = in.find(e.atom); found != in.end()) return found->second;
            return constant(e.atom);
        }
        const std::string& op = operator_of(e);
        const std::size_t count = e.items.empty() ? 0 : e.items.size() - 1;
        if ((op == "let" || op == "let*") && count == 2) {
            names inner = in;
            for (const fpcore_expression& b : e.items[1].items) {
                if (b.items.size() != 2 || b.items[0].atom.empty())
                    throw unsupported_core("the binding " + text_of(b) +
                                           " has no name and value; expected (NAME VALUE)");
                inner.insert_or_assign(b.items[0].atom,
                                       value(b.items[1], op == "let" ? in : inner));
            }
            return value(e.items[2], inner);
        }
        if (op == "if" && count == 3) return value(e.items[holds(e.items[1], in) ? 2 : 3], in);
        if (op == "!" && count >= 1) {
            require_supported(e);
            return value(e.items.back(), in);
        }
        if (op.starts_with("while") || op.starts_with("for"))
            throw unsupported_core("the program has a loop");
        if (op.empty())
            throw unsupported_core("the expression " + text_of(e) +
                                   " has no operation; expected (OPERATION ARGUMENT...)");
        std::vector<recorded> x;
        for (std::size_t i = 1; i <= count; ++i) x.push_back(value(e.items[i], in));
        const errbound::scope here(core_.name, core_.file, e.line);
        return applied(op, x);
    }

    /// Throws unsupported_core if a list (! PROPERTY... EXPRESSION) changes how numbers are
    /// rounded.
    void require_supported(const fpcore_expression& e) const {
        for (std::size_t i = 1; i + 2 < e.items.size(); i += 2) {
            const std::string &property = e.items[i].atom, &to = e.items[i + 1].atom;
            if (property == ":precision" && to != precision_) throw unsupported_core(mixed);
            if (property == ":round") require_nearest(to);
        }
    }
    static void require_nearest(const std::string& rounding) {
        if (rounding != "nearestEven")
            throw unsupported_core("rounding is " + rounding + ", not to nearest");
    }
    /// The name of an argument, which may have properties.
    std::string name_of_argument(const fpcore_expression& e) const {
        if (!e.atom.empty()) return e.atom;
        const bool has_properties = operator_of(e) == "!";
        if (e.items.empty() ||
            (has_properties && (e.items.size() == 1 || e.items.back().atom.empty())))
            throw unsupported_core("the argument " + text_of(e) +
                                   " has no name; expected NAME or (! PROPERTY... NAME)");
        if (!has_properties) throw unsupported_core("an argument is an array");
        require_supported(e);
        return e.items.back().atom;
    }

    /// Narrows the box by the part of a precondition, or adds it as a constraint.
    void require(const fpcore_expression& e, const std::map<std::string, std::size_t>& inputs,
                 std::vector<input_range>& box,
                 std::vector<std::pair<fpcore_expression, fpcore_expression>>& constraints) const {
        const std::string& op = operator_of(e);
        if (op == "and")
            for (std::size_t i = 1; i < e.items.size(); ++i)
                require(e.items[i], inputs, box, constraints);
        if (!is_comparison(op)) return;
        for (std::size_t i = 1; i + 1 < e.items.size(); ++i) {
            const bool ascends = op[0] == '<';
            const fpcore_expression &low = e.items[ascends ? i : i + 1],
                                    &high = e.items[ascends ? i + 1 : i];
            const auto input = [&](const fpcore_expression& x) {
                const auto found = inputs.find(x.atom);
                return found == inputs.end() ? nullptr : &box[found->second];
            };
            // An argument hides the constant of its name.
            const auto constant = [&](const fpcore_expression& x) {
                return input(x) == nullptr ? constant_range(x) : std::nullopt;
            };
            const std::optional<range> from = constant(low), to = constant(high);
            if (input(low) != nullptr && to)
                input(low)->upper = std::min(input(low)->upper, to->upper());
            else if (input(high) != nullptr && from)
                input(high)->lower = std::max(input(high)->lower, from->lower());
            else
                constraints.emplace_back(low, high);
        }
    }

  private:
    static recorded constant(const std::string& text) {
        try {
            return recorded::constant(text);
        } catch (const std::invalid_argument&) {
            throw unsupported_core("the name " + text + " is unknown");
        }
    }
    /// Encloses a constant.
    static std::optional<range> constant_range(const fpcore_expression& e) {
        if (e.atom.empty()) return std::nullopt;
        try {
            mpfr_number low(53), high(53);
            set_constant(low.get(), e.atom, MPFR_RNDD);
            set_constant(high.get(), e.atom, MPFR_RNDU);
            return range(mpfr_get_d(low.get(), MPFR_RNDD), mpfr_get_d(high.get(), MPFR_RNDU));
        } catch (const std::invalid_argument&) {
            return std::nullopt;
        }
    }
    bool holds(const fpcore_expression& e, const names& in) const {
        const std::string& op = operator_of(e);
        if (e.atom == "TRUE" || e.atom == "FALSE") return e.atom == "TRUE";
        if (op == "not" && e.items.size() == 2) return !holds(e.items[1], in);
        if (op == "and" || op == "or") {
            for (std::size_t i = 1; i < e.items.size(); ++i)
                if (holds(e.items[i], in) == (op == "or")) return op == "or";
            return op == "and";
        }
        if (!is_comparison(op) && op != "==" && op != "!=")
            throw unsupported_core("the condition " + (op.empty() ? text_of(e) : op) +
                                   " is not supported; expected a comparison, and, or, not");
        std::vector<recorded> x;
        for (std::size_t i = 1; i < e.items.size(); ++i) x.push_back(value(e.items[i], in));
        bool all = true;
        if (op == "!=") {
            for (std::size_t i = 0; i < x.size(); ++i)
                for (std::size_t j = 0; j < i && all; ++j) all = x[j] != x[i];
            return all;
        }
        for (std::size_t i = 0; i + 1 < x.size() && all; ++i)
            all = op == "<"    ? x[i] < x[i + 1]
                  : op == ">"  ? x[i] > x[i + 1]
                  : op == "<=" ? x[i] <= x[i + 1]
                  : op == ">=" ? x[i] >= x[i + 1]
                               : x[i] == x[i + 1];
        return all;
    }
    static recorded applied(const std::string& op, const std::vector<recorded>& x) {
        if (x.size() == 1 && op == "-") return -x[0];
        if (x.size() >= 2 && (op == "+" || op == "-" || op == "*" || op == "/")) {
            recorded r = x[0];
            for (std::size_t i = 1; i < x.size(); ++i)
                r = op == "+" ? r + x[i] : op == "-" ? r - x[i] : op == "*" ? r * x[i] : r / x[i];
            return r;
        }
        if (x.size() == 1 && op == "sqrt") return sqrt(x[0]);
        if (x.size() == 1 && op == "fabs") return abs(x[0]);
        if (x.size() == 2 && op == "fmin") return min(x[0], x[1]);
        if (x.size() == 2 && op == "fmax") return max(x[0], x[1]);
        if (x.size() == 3 && op == "fma") return fma(x[0], x[1], x[2]);
        for (const named_function& f : named_functions)
            if (f.name == op && x.size() == (has_two_arguments(f.function) ? 2 : 1))
                return x.size() == 1 ? recorded::of(f.function, x[0])
                                     : recorded::of(f.function, x[0], x[1]);
        throw unsupported_core(op == "cast" ? mixed : "the operation " + op + " is not supported");
    }

    const fpcore& core_;
    std::string precision_;
};

}  // namespace

std::vector<fpcore> parse_fpcores(std::string_view text, const std::string& file) {
    std::vector<fpcore> all;
    parser p(text, file);
    while (!p.at_end()) {
        fpcore_expression e = p.expression();
        std::size_t i = e.items.size() > 1 && !e.items[1].atom.empty() ? 2 : 1;  // after a name
        if (operator_of(e) != "FPCore" || e.items.size() < i + 2 || !e.items[i].atom.empty())
            p.fail_at(e.line, "expression is '" + text_of(e) + "'",
                      "a core, (FPCore (ARGUMENT...) BODY)");
        fpcore core;
        core.file = file;
        core.name = file + ':' + std::to_string(e.line);
        core.arguments = e.items[i].items;
        for (++i; i + 1 < e.items.size(); i += 2) {
            const std::string& property = e.items[i].atom;
            const fpcore_expression& value = e.items[i + 1];
            if (!property.starts_with(':')) break;
            if (property == ":name" && value.atom.size() >= 2)
                core.name = value.atom.substr(1, value.atom.size() - 2);
            if (property == ":precision") core.precision = text_of(value);
            if (property == ":round") core.rounding = text_of(value);
            if (property == ":pre") core.precondition = value;
        }
        // Some cores have :alt without a value: the loop then takes the body for it.
        core.body = e.items.back();
        all.push_back(std::move(core));
    }
    return all;
}

worst_case_result worst_case_of(const fpcore& core, const worst_case_options& options,
                                const std::string& precision) {
    const std::string& name = precision.empty() ? core.precision : precision;
    const auto type = precisions.find(name);
    if (type == precisions.end())
        throw unsupported_core("the precision " + name + " is not supported; expected one of " +
                               support::listed(precisions, [](const auto& p) { return p.first; }));
    const evaluator e(core, core.precision);
    evaluator::require_nearest(core.rounding);
    std::map<std::string, std::size_t> inputs;
    std::vector<input_range> box(core.arguments.size(), {-HUGE_VAL, HUGE_VAL});
    for (const fpcore_expression& a : core.arguments)
        if (const auto [place, is_new] = inputs.emplace(e.name_of_argument(a), inputs.size());
            !is_new)
            throw unsupported_core("two arguments have the name " + place->first);
    std::vector<std::pair<fpcore_expression, fpcore_expression>> constraints;
    if (core.precondition) e.require(*core.precondition, inputs, box, constraints);
    for (const auto& [argument, k] : inputs)
        if (!std::isfinite(box[k].lower) || !std::isfinite(box[k].upper))
            throw unsupported_core("the precondition gives no finite range of " + argument);
        else if (box[k].lower > box[k].upper)
            throw unsupported_core("the precondition gives an empty range of " + argument);
    recording r(type->second, box, options);
    names known;
    for (const auto& [argument, k] : inputs)
        known.emplace(argument,
                      recorded(recording::node{.kind = recording::leaf::input, .left = k}));
    try {
        r.result = e.value(core.body, known).index();
        for (const auto& [low, high] : constraints)
            r.constraints.push_back({e.value(low, known).index(), e.value(high, known).index()});
    } catch (const undecided_comparison&) {
        throw unsupported_core("a branch depends on the input");
    }
    return worst_case_of(r);
}

}  // namespace errbound::validation
