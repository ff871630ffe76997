// A bound rule in every case of tiny formats.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <errbound/tracked.hpp>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "errbound/validation/expression.hpp"
#include "errbound/validation/rule_list.hpp"
#include "errbound/validation/tiny_float.hpp"

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

    static constexpr double infinity = std::numeric_limits<double>::infinity();
    static constexpr std::uint64_t max_described = 5;

    static bool is_finite(const operand_range& a, const operand_range& b) {
        return std::isfinite(a.low) && std::isfinite(b.low);
    }
    static operand_range exactly(Tiny x) { return {number(x), double(x), double(x), Tiny(0)}; }
    static operand_range within(Tiny x, Tiny error) {
        return {error == 0 ? number(x) : number::within(x, error), double(x) - double(error),
                double(x) + double(error), error};
    }

    /// Where the exact result may lie; ends that are not finite: there is none.
    struct exact_range {
        double low, high;
        bool defined() const { return std::isfinite(low) && std::isfinite(high); }
    };

    /// Holds a result to what it may be the result of.
    template <class Code>
    void check(const number& r, const exact_range& exact, const Code& code) {
        if (Tiny::overflowed_unnoticed()) return;  // the one thing that a rule may miss
        ++found_.values;
        const double value = double(r.value()), error = double(r.error());
        const sign_type sign = sign_of(r);
        if (!std::isfinite(value) || !exact.defined()) {
            if (certain(sign) || std::isfinite(error))
                add(r, "certain about what has no finite value", code);
            return;
        }
        if (!std::isnan(error) && !(value - exact.low <= error && exact.high - value <= error))
            add(r, "the bound is too small", code);
        check_sign(r, exact.low, exact.high, code);
    }
    /// A quotient of what lies in these ranges: compared multiplied by the divisor, at the corners,
    /// among which are the extremes if the divisor cannot be zero.
    template <class Code>
    void check_quotient(const number& r, const exact_range& n, const exact_range& d,
                        const Code& code) {
        if (!n.defined() || !d.defined() || !(d.low > 0 || d.high < 0) ||
            !number_traits<Tiny>::is_finite(r.value())) {
            check(r, {-infinity, infinity}, code);
            return;
        }
        if (Tiny::overflowed_unnoticed()) return;
        ++found_.values;
        const double value = double(r.value()), error = double(r.error());
        for (const double divisor : {d.low, d.high})
            for (const double dividend : {n.low, n.high})
                if (!std::isnan(error) &&
                    !(std::abs(value * divisor - dividend) <= error * std::abs(divisor))) {
                    add(r, "the bound is too small", code);
                    return;
                }
        if (d.low > 0)
            check_sign(r, n.low, n.high, code);
        else
            check_sign(r, -n.high, -n.low, code);
    }
    /// A certain sign must be that of all numbers from low to high.
    template <class Code>
    void check_sign(const number& r, double low, double high, const Code& code) {
        const sign_type sign = sign_of(r);
        if ((sign == sign_type::positive && !(low > 0)) ||
            (sign == sign_type::negative && !(high < 0)) ||
            (sign == sign_type::zero && !(low == 0 && high == 0)))
            add(r, "the sign is wrong", code);
    }
    template <class Code>
    void add(const number& r, const char* broken, const Code& code) {
        if (++found_.violations > max_described) return;
        found_.first.push_back({std::string(broken) + " (rounding " + std::string(direction_) +
                                    "): value " + hexadecimal(double(r.value())) + ", bound " +
                                    hexadecimal(double(r.error())),
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
        Tiny::clear_flag();
        check(a.x + b.x, {a.low + b.low, a.high + b.high}, code("a + b"));
        Tiny::clear_flag();
        check(a.x - b.x, {a.low - b.high, a.high - b.low}, code("a - b"));
        Tiny::clear_flag();
        const double products[] = {a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high};
        const auto [low, high] = std::minmax_element(std::begin(products), std::end(products));
        check(a.x * b.x,
              is_finite(a, b) ? exact_range{*low, *high} : exact_range{-infinity, infinity},
              code("a * b"));
        if constexpr (has_division<Rule>) {
            Tiny::clear_flag();
            check_quotient(a.x / b.x, {a.low, a.high}, {b.low, b.high}, code("a / b"));
        }
    }
    /// The operand itself, −x, and x·2^e for every e that leaves something.
    void check_one(const operand_range& a) {
        const auto code = [&](const std::string& operation) {
            return
                [&a, operation] { return text("a", a) + "const number c = " + operation + ";\n"; };
        };
        Tiny::clear_flag();
        check(a.x, {a.low, a.high}, code("a"));
        Tiny::clear_flag();
        check(-a.x, {-a.high, -a.low}, code("-a"));
        constexpr int reach = (1 << Tiny::exponent_bits) + Tiny::precision;
        for (int e = -reach; e <= reach; ++e) {
            Tiny::clear_flag();
            check(scale(a.x, e), {std::ldexp(a.low, e), std::ldexp(a.high, e)},
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
        for (const Tiny c : finite_) {
            const auto code = [&](const char* operation) {
                return [=] {
                    return text("a", exactly(a)) + text("b", exactly(b)) + text("c", exactly(c)) +
                           "const number d = " + how + ";\nconst number e = " + operation + ";\n";
                };
            };
            const number outer(c);
            const double z = double(c);
            Tiny::clear_flag();
            check(inner + outer, {exact + z, exact + z}, code("d + c"));
            Tiny::clear_flag();
            check(inner - outer, {exact - z, exact - z}, code("d - c"));
            Tiny::clear_flag();
            check(outer - inner, {z - exact, z - exact}, code("c - d"));
            Tiny::clear_flag();
            check(inner * outer, {exact * z, exact * z}, code("d * c"));
            if constexpr (has_division<Rule>) {
                Tiny::clear_flag();
                check_quotient(inner / outer, {exact, exact}, {z, z}, code("d / c"));
                Tiny::clear_flag();
                check_quotient(outer / inner, {z, z}, {exact, exact}, code("c / d"));
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
