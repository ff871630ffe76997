// A bound rule in every case of tiny formats.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <errbound/tracked.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "errbound/expression.hpp"
#include "errbound/rule_list.hpp"
#include "errbound/tiny_float.hpp"

namespace errbound::validation {

template <class...>
struct tiny_format_types {};
/// Of 6, 7 and 8 bits. Three bits of exponent at least, so that u is a number of the format.
using tiny_formats =
    tiny_format_types<tiny_float<3, 3>, tiny_float<2, 4>, tiny_float<4, 3>, tiny_float<3, 4>,
                      tiny_float<5, 3>, tiny_float<4, 4>, tiny_float<3, 5>>;
inline constexpr std::size_t tiny_format_count = 7;

/// What a rule was found to do in one format.
struct tiny_findings {
    struct broken {
        std::string what, code;
    };
    std::string format;  ///< empty: below the rule's minimal_precision
    std::uint64_t values = 0, violations = 0;
    std::vector<broken> first;  ///< the first few
};

/// The least precision for which the rule's bounds are proved, where it names one.
template <class Rule>
inline constexpr int minimal_precision = [] {
    if constexpr (requires { Rule::minimal_precision; })
        return Rule::minimal_precision;
    else
        return 2;
}();
/// Whether the rule's bounds hold in directed rounding too.
template <class Rule>
inline constexpr bool holds_in_directed_rounding = [] {
    if constexpr (requires { Rule::holds_in_directed_rounding; })
        return Rule::holds_in_directed_rounding;
    else
        return false;
}();

/// Exact references are doubles here: every sum, difference and product of what tiny formats and
/// their bounds hold fits 53 bits, and quotients are compared multiplied out.
template <class Rule, class Tiny>
class tiny_checker {
    using number = tracked<Tiny, Rule>;

  public:
    explicit tiny_checker(tiny_findings& found) : found_(found) {
        for (int code = 0; code < Tiny::codes; ++code)
            if (const Tiny x = Tiny::from_code(code); std::isfinite(double(x))) {
                finite_.push_back(x);
                if (code < Tiny::codes / 2) bounds_.push_back(x);
            }
    }

    void check_everything(std::string_view direction) {
        direction_ = direction;
        check_exact_pairs();
        if constexpr (Tiny::precision + Tiny::exponent_bits == 6) {
            check_bounded();
            check_two_operations();
        }
    }

  private:
    /// A number and all that it may stand for: low to high.
    struct operand_range {
        number x;
        double low, high;
        Tiny error;
    };

    static operand_range exactly(Tiny x) { return {number(x), double(x), double(x), Tiny(0)}; }
    static operand_range within(Tiny x, Tiny error) {
        return {error == 0 ? number(x) : number::within(x, error), double(x) - double(error),
                double(x) + double(error), error};
    }

    /// Holds a result to what it may be the result of: the numerators at the corners of the
    /// operands' ranges, over denominators of one sign.
    template <std::size_t N, class Code>
    void check(const number& r, const std::array<std::pair<double, double>, N>& corners,
               const Code& code) {
        if (Tiny::overflowed_unnoticed()) return;  // the one thing that a rule may miss
        ++found_.values;
        const double value = double(r.value()), error = double(r.error());
        const sign_type sign = sign_of(r);
        const char* broken = nullptr;
        bool defined = std::isfinite(value);
        for (const auto& [n, d] : corners)
            if (!std::isfinite(n) || !std::isfinite(d) || d == 0 ||
                std::signbit(d) != std::signbit(corners[0].second))
                defined = false;
        if (!defined) {
            if (certain(sign) || std::isfinite(error))
                broken = "certain about what has no finite value";
        } else {
            for (const auto& [n, d] : corners) {
                if (!std::isnan(error) && !(std::abs(value * d - n) <= error * std::abs(d)))
                    broken = "the bound is too small";
                const double size = d < 0 ? -n : n;
                const sign_type exact = size > 0   ? sign_type::positive
                                        : size < 0 ? sign_type::negative
                                                   : sign_type::zero;
                if (certain(sign) && sign != exact) broken = "the sign is wrong";
            }
        }
        if (!broken) return;
        if (++found_.violations > 5) return;
        found_.first.push_back({std::string(broken) + " (rounding " + std::string(direction_) +
                                    "): value " + hexadecimal(value) + ", bound " +
                                    hexadecimal(error),
                                "using format = errbound::validation::" + found_.format +
                                    ";\nusing number = errbound::tracked<format, errbound::" +
                                    std::string(Rule::name) + ">;\n" + code()});
    }

    static std::string text(const char* name, const operand_range& a) {
        const std::string value = hexadecimal(double(a.x.value()));
        const bool is_exact = a.error == 0;
        return "const number " + std::string(name) + " = " +
               (is_exact ? "format(" + value + ")"
                         : "number::within(" + value + ", " + hexadecimal(double(a.error)) + ")") +
               ";\n";
    }

    /// Every operation on two operands.
    void check_pair(const operand_range& a, const operand_range& b) {
        const auto code = [&](const char* operation) {
            return [&a, &b, operation] {
                return text("a", a) + text("b", b) + "const number c = " + operation + ";\n";
            };
        };
        const auto corners = [&](const auto& f) {
            return std::array{f(a.low, b.low), f(a.low, b.high), f(a.high, b.low),
                              f(a.high, b.high)};
        };
        using fraction = std::pair<double, double>;
        Tiny::clear_flag();
        check(a.x + b.x, corners([](double x, double y) { return fraction(x + y, 1); }),
              code("a + b"));
        Tiny::clear_flag();
        check(a.x - b.x, corners([](double x, double y) { return fraction(x - y, 1); }),
              code("a - b"));
        Tiny::clear_flag();
        check(a.x * b.x, corners([](double x, double y) { return fraction(x * y, 1); }),
              code("a * b"));
        if constexpr (has_division<Rule>) {
            Tiny::clear_flag();
            check(a.x / b.x, corners([](double x, double y) { return fraction(x, y); }),
                  code("a / b"));
        }
    }
    /// The operand itself, −x, and x·2^e for every e that leaves something.
    void check_one(const operand_range& a) {
        using fraction = std::pair<double, double>;
        const auto code = [&](const std::string& operation) {
            return
                [&a, operation] { return text("a", a) + "const number c = " + operation + ";\n"; };
        };
        Tiny::clear_flag();
        check(a.x, std::array{fraction(a.low, 1), fraction(a.high, 1)}, code("a"));
        Tiny::clear_flag();
        check(-a.x, std::array{fraction(-a.low, 1), fraction(-a.high, 1)}, code("-a"));
        constexpr int reach = (1 << Tiny::exponent_bits) + Tiny::precision;
        for (int e = -reach; e <= reach; ++e) {
            Tiny::clear_flag();
            check(scale(a.x, e),
                  std::array{fraction(std::ldexp(a.low, e), 1), fraction(std::ldexp(a.high, e), 1)},
                  code("scale(a, " + std::to_string(e) + ")"));
        }
    }

    void check_exact_pairs() {
        // Infinities and NaN among them: all codes.
        for (int a = 0; a < Tiny::codes; ++a) {
            check_one(exactly(Tiny::from_code(a)));
            for (int b = 0; b < Tiny::codes; ++b)
                check_pair(exactly(Tiny::from_code(a)), exactly(Tiny::from_code(b)));
        }
    }
    /// Every pair of numbers with every pair of bounds.
    void check_bounded() {
        std::vector<operand_range> all;
        for (const Tiny x : finite_)
            for (const Tiny e : bounds_)
                if (all.push_back(within(x, e)); e != 0) check_one(all.back());
        for (const operand_range& a : all)
            for (const operand_range& b : all) check_pair(a, b);
    }
    /// Every (a ∘ b) ∘ c and c ∘ (a ∘ b) of exact numbers, the inner operation not a division:
    /// bounds as rules make them themselves.
    void check_two_operations() {
        for (const Tiny a : finite_)
            for (const Tiny b : finite_) {
                Tiny::clear_flag();
                const double x = double(a), y = double(b);
                check_with_third(number(a) + number(b), x + y, a, b, "a + b");
                Tiny::clear_flag();
                check_with_third(number(a) - number(b), x - y, a, b, "a - b");
                Tiny::clear_flag();
                check_with_third(number(a) * number(b), x * y, a, b, "a * b");
            }
    }
    void check_with_third(const number& inner, double exact, Tiny a, Tiny b, const char* how) {
        if (Tiny::overflowed_unnoticed()) return;
        using fraction = std::pair<double, double>;
        for (const Tiny c : finite_) {
            const auto code = [&](const char* operation) {
                return [=] {
                    return text("a", exactly(a)) + text("b", exactly(b)) + text("c", exactly(c)) +
                           "const number d = " + how + ";\nconst number e = " + operation + ";\n";
                };
            };
            const number outer(c);
            const double z = double(c);
            const auto one = [](double n, double d) { return std::array{fraction(n, d)}; };
            Tiny::clear_flag();
            check(inner + outer, one(exact + z, 1), code("d + c"));
            Tiny::clear_flag();
            check(inner - outer, one(exact - z, 1), code("d - c"));
            Tiny::clear_flag();
            check(outer - inner, one(z - exact, 1), code("c - d"));
            Tiny::clear_flag();
            check(inner * outer, one(exact * z, 1), code("d * c"));
            if constexpr (has_division<Rule>) {
                Tiny::clear_flag();
                check(inner / outer, one(exact, z), code("d / c"));
                Tiny::clear_flag();
                check(outer / inner, one(z, exact), code("c / d"));
            }
        }
    }

    tiny_findings& found_;
    std::string_view direction_;
    std::vector<Tiny> finite_, bounds_;
};

template <class Rule, class Tiny>
void check_tiny_format(tiny_findings& found) {
    if (!promises_bound<Rule> || Tiny::precision < minimal_precision<Rule>) return;
    found.format = "tiny_float<" + std::to_string(Tiny::precision) + ", " +
                   std::to_string(Tiny::exponent_bits) + ">";
    constexpr std::array<std::pair<mpfr_rnd_t, std::string_view>, 4> directions{
        {{MPFR_RNDN, "to nearest"},
         {MPFR_RNDZ, "towards zero"},
         {MPFR_RNDU, "upwards"},
         {MPFR_RNDD, "downwards"}}};
    for (const auto& [direction, name] : directions) {
        if (direction != MPFR_RNDN && !holds_in_directed_rounding<Rule>) continue;
        const tiny_rounding<Tiny> rounding(direction);
        tiny_checker<Rule, Tiny>(found).check_everything(name);
    }
}

/// The rule in the format of this index, 0 <= format < tiny_format_count.
template <class Rule>
void check_tiny(std::size_t format, tiny_findings& found) {
    [&]<class... Tiny>(tiny_format_types<Tiny...>) {
        static_assert(sizeof...(Tiny) == tiny_format_count);
        std::size_t i = 0;
        ((i++ == format ? check_tiny_format<Rule, Tiny>(found) : void()), ...);
    }(tiny_formats());
}

}  // namespace errbound::validation
