// Checks a bound rule in formats of 6 to 8 bits: every pair of numbers, and in 6 bits every pair of
// bounds.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <errbound/small_floats.hpp>
#include <errbound/tracked.hpp>
#include <errbound/validation/expression.hpp>
#include <errbound/validation/rule_list.hpp>
#include <errbound/validation/tiny_float.hpp>
#include <iterator>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace errbound::validation {

template <class...>
struct tiny_format_types {};
/// Three bits of exponent at least, so that u is a number of the format.
using tiny_formats = tiny_format_types<tiny_float<3, 3>, tiny_float<2, 4>, tiny_float<4, 3>,
                                       tiny_float<3, 4>, tiny_float<5, 3>, tiny_float<4, 4>,
                                       tiny_float<3, 5>, float8_e5m2, float8_e4m3>;
inline constexpr std::size_t tiny_format_count = 9;

/// Names of a format, and the directions in which its operations round.
template <class Tiny>
struct tiny_format;

template <int P, int E>
struct tiny_format<tiny_float<P, E>> {
    static constexpr bool for_users = false;
    static std::string name() {
        return "tiny_float<" + std::to_string(P) + ", " + std::to_string(E) + ">";
    }
    static std::string cpp_name() { return "errbound::validation::" + name(); }
    /// Calls check(direction), to nearest first, then in the other directions if `all`.
    template <class Check>
    static void in_directions(bool all, const Check& check) {
        constexpr std::array<std::pair<mpfr_rnd_t, std::string_view>, 4> directions{
            {{MPFR_RNDN, "to nearest"},
             {MPFR_RNDZ, "towards zero"},
             {MPFR_RNDU, "upwards"},
             {MPFR_RNDD, "downwards"}}};
        for (const auto& [direction, name] : directions) {
            if (direction != MPFR_RNDN && !all) continue;
            const tiny_rounding<tiny_float<P, E>> rounding(direction);
            check(name);
        }
    }
    static bool overflowed_unnoticed() { return tiny_float<P, E>::overflowed_unnoticed(); }
    static void clear_flag() { tiny_float<P, E>::clear_flag(); }
};

template <int P, int E, bool HasInfinity>
struct tiny_format<small_float<P, E, HasInfinity>> {
    static constexpr bool for_users = true;
    static std::string name() {
        return "float8_e" + std::to_string(E) + "m" + std::to_string(P - 1);
    }
    static std::string cpp_name() { return "errbound::" + name(); }
    template <class Check>
    static void in_directions(bool, const Check& check) {
        check("to nearest");
    }
    static constexpr bool overflowed_unnoticed() { return false; }
    static constexpr void clear_flag() {}
};

/// A rule's violations in one format.
struct tiny_findings {
    struct broken {
        std::string what, code;
    };
    std::string format;    ///< empty: below the rule's minimal_precision
    std::string cpp_name;  ///< of the format
    std::uint64_t values = 0, violations = 0;
    std::vector<broken> first;  ///< the first few
};

/// The least precision that the rule's proof needs, if stated.
template <class Rule>
inline constexpr int minimal_precision = [] {
    if constexpr (requires { Rule::minimal_precision; })
        return Rule::minimal_precision;
    else
        return 2;
}();
template <class Rule>
inline constexpr bool holds_in_directed_rounding = [] {
    if constexpr (requires { Rule::holds_in_directed_rounding; })
        return Rule::holds_in_directed_rounding;
    else
        return false;
}();

/// The range of an exact result; by default there is none.
struct exact_range {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool defined() const { return std::isfinite(low) && std::isfinite(high); }
};

/// How a result was computed, from operands a, b and c. If `inner` is set, it combines a and b
/// first; texts call that result d.
struct tiny_account {
    struct operand {
        double value, error;
    };
    std::array<operand, 3> operands{};
    std::size_t count = 0;
    const char* inner = nullptr;
    const char* operation = "";
    int exponent = 0;  ///< of the operation "scale"
};

/// A rule's result.
struct tiny_claim {
    double value, error;
    sign_type sign;
};

struct fused_value {
    double left, right, addend;
};

/// Compares results with their exact ranges. References are doubles: sums and differences of
/// numbers and bounds of 8-bit formats fit 53 bits; products and quotients are compared exactly.
class claim_checker {
  public:
    claim_checker(tiny_findings& found, std::string_view rule, std::string_view direction)
        : found_(found), rule_(rule), direction_(direction) {}

    void check(const tiny_claim& r, const exact_range& exact, const tiny_account& how);
    /// A product over these ranges; its extremes are at the corners.
    void check_product(const tiny_claim& r, const exact_range& a, const exact_range& b,
                       const tiny_account& how);
    /// A quotient over these ranges, compared after multiplication by the divisor, at the corners.
    void check_quotient(const tiny_claim& r, const exact_range& n, const exact_range& d,
                        const tiny_account& how);

    /// A root over a range; squares are compared.
    void check_root(const tiny_claim& r, const exact_range& x, const tiny_account& how);
    /// A fused result over ranges whose extremes are among these values.
    void check_fused(const tiny_claim& r, std::span<const fused_value> ends,
                     const tiny_account& how);

  private:
    /// A certain sign must hold for all numbers from low to high.
    void check_sign(const tiny_claim& r, double low, double high, const tiny_account& how);
    void add(const tiny_claim& r, const char* broken, const tiny_account& how);

    tiny_findings& found_;
    std::string_view rule_, direction_;
};

template <class Rule, class Tiny>
class tiny_checker {
    using number = tracked<Tiny, Rule>;
    using format = tiny_format<Tiny>;

  public:
    tiny_checker(tiny_findings& found, std::string_view direction)
        : claims_(found, Rule::name, direction) {
        for (int code = 0; code < Tiny::codes; ++code)
            if (const Tiny x = Tiny::from_code(code); std::isfinite(double(x))) {
                finite_.push_back(x);
                if (code < Tiny::codes / 2) bounds_.push_back(x);
            }
    }

    void check_everything(bool every_bound) {
        check_exact_pairs();
        constexpr int bits = Tiny::precision + Tiny::exponent_bits;
        const bool all = bits == 6 || (format::for_users && every_bound);
        if (all)
            check_bounded();
        else if (format::for_users)
            check_some_bounded();
        // References fit 53 bits if exponents have few bits.
        if (all && Tiny::exponent_bits <= 4) check_two_operations();
    }

  private:
    /// A number and the range of its exact value.
    struct operand_range {
        number x;
        double low, high;
        tiny_account::operand as_operand;
    };

    static operand_range exactly(Tiny x) {
        return {number(x), double(x), double(x), {double(x), 0}};
    }
    static operand_range within(Tiny x, Tiny error) {
        const double value = double(x), off = double(error);
        return {error == 0 ? number(x) : number::within(x, error),
                value - off,
                value + off,
                {value, off}};
    }

    /// Clears the flag that an overflow went unnoticed after each comparison, before the next
    /// operation.
    template <class Check>
    void check_by(const Check& check, const number& r, tiny_account& how, const char* operation) {
        if (!format::overflowed_unnoticed()) {  // the one thing that a rule may miss
            how.operation = operation;
            check({double(r.value()), double(r.error()), sign_of(r)});
        }
        format::clear_flag();
    }
    void check(const number& r, const exact_range& exact, tiny_account& how,
               const char* operation) {
        check_by([&](const tiny_claim& c) { claims_.check(c, exact, how); }, r, how, operation);
    }
    void check_product(const number& r, const exact_range& a, const exact_range& b,
                       tiny_account& how, const char* operation) {
        check_by([&](const tiny_claim& c) { claims_.check_product(c, a, b, how); }, r, how,
                 operation);
    }
    void check_quotient(const number& r, const exact_range& n, const exact_range& d,
                        tiny_account& how, const char* operation) {
        check_by([&](const tiny_claim& c) { claims_.check_quotient(c, n, d, how); }, r, how,
                 operation);
    }

    void check_pair(const operand_range& a, const operand_range& b) {
        tiny_account how{{a.as_operand, b.as_operand}, 2};
        format::clear_flag();
        check(a.x + b.x, {a.low + b.low, a.high + b.high}, how, "a + b");
        check(a.x - b.x, {a.low - b.high, a.high - b.low}, how, "a - b");
        check_product(a.x * b.x, {a.low, a.high}, {b.low, b.high}, how, "a * b");
        if constexpr (has_division<Rule>)
            check_quotient(a.x / b.x, {a.low, a.high}, {b.low, b.high}, how, "a / b");
        const bool both = std::isfinite(a.low) && std::isfinite(b.low);
        check(min<>(a.x, b.x),
              both ? exact_range{(std::min)(a.low, b.low), (std::min)(a.high, b.high)}
                   : exact_range{},
              how, "min(a, b)");
        check(max<>(a.x, b.x),
              both ? exact_range{(std::max)(a.low, b.low), (std::max)(a.high, b.high)}
                   : exact_range{},
              how, "max(a, b)");
        check_product(dot(std::array{a.x, b.x}, std::array{b.x, a.x}), {2 * a.low, 2 * a.high},
                      {b.low, b.high}, how, "dot(std::array{a, b}, std::array{b, a})");
        // References fit 53 bits if exponents have few bits.
        if (Tiny::exponent_bits == 3 && a.as_operand.error == 0)
            check(horner(std::array{a.x, number(1), a.x}, b.x), values_of_square(a.low, b), how,
                  "horner(std::array{a, number(1), a}, b)");
        check(midpoint(a.x, b.x), {(a.low + b.low) / 2, (a.high + b.high) / 2}, how,
              "midpoint(a, b)");
        check(copysign(a.x, b.x), both ? signed_sizes(a, b) : exact_range{}, how, "copysign(a, b)");
        check_fused_pair(a, b, how);
    }
    /// |x| with the sign of y; zero counts as positive.
    static exact_range signed_sizes(const operand_range& x, const operand_range& y) {
        const exact_range sizes = sizes_of(x);
        if (y.low >= 0) return sizes;
        return {-sizes.high, y.high < 0 ? -sizes.low : sizes.high};
    }
    static exact_range sizes_of(const operand_range& x) {
        const double sizes[] = {std::abs(x.low), std::abs(x.high)};
        return {x.low <= 0 && x.high >= 0 ? 0 : (std::min)(sizes[0], sizes[1]),
                (std::max)(sizes[0], sizes[1])};
    }
    void check_fused(const number& r, std::span<const fused_value> ends, tiny_account& how,
                     const char* operation) {
        check_by([&](const tiny_claim& c) { claims_.check_fused(c, ends, how); }, r, how,
                 operation);
    }
    /// ab + a and a + t(b − a), which lie between their values at the ends.
    void check_fused_pair(const operand_range& a, const operand_range& b, tiny_account& how) {
        constexpr double t = -1.5;
        std::array<fused_value, 4> fused, between;
        std::size_t i = 0;
        for (const double x : {a.low, a.high})
            for (const double y : {b.low, b.high}) {
                fused[i] = {x, y, x};
                between[i++] = {t, y - x, x};
            }
        check_fused(fma(a.x, b.x, a.x), fused, how, "fma(a, b, a)");
        check_fused(lerp(a.x, b.x, number(Tiny(t))), between, how,
                    "lerp(a, b, number(format(-1.5)))");
    }
    /// The range of c + t + ct²: its values at the ends and in the middle.
    static exact_range values_of_square(double c, const operand_range& t) {
        exact_range values;
        if (!std::isfinite(c) || !std::isfinite(t.low)) return values;
        values = {std::numeric_limits<double>::infinity(),
                  -std::numeric_limits<double>::infinity()};
        for (const double x : {t.low, (t.low + t.high) / 2, t.high}) {
            const double value = c + x + c * x * x;
            values = {(std::min)(values.low, value), (std::max)(values.high, value)};
        }
        return values;
    }
    /// x, −x, |x|, x², 1/x, √x, for an exact x also x³, and x·2^e for every e with an effect.
    void check_one(const operand_range& a) {
        tiny_account how{{a.as_operand}, 1};
        format::clear_flag();
        check(a.x, {a.low, a.high}, how, "a");
        check(-a.x, {-a.high, -a.low}, how, "-a");
        const exact_range sizes = sizes_of(a);
        check(abs(a.x), sizes, how, "abs(a)");
        check_product(pow(a.x, 2), sizes, sizes, how, "pow(a, 2)");
        if (a.low == a.high) {
            const double cube = a.low * a.low * a.low;
            check(pow(a.x, 3), {cube, cube}, how, "pow(a, 3)");
        }
        check_quotient(pow(a.x, -1), {1, 1}, {a.low, a.high}, how, "pow(a, -1)");
        check_by(
            [&](const tiny_claim& c) {
                claims_.check_root(c, {a.low, a.high}, how);
            },
            sqrt(a.x), how, "sqrt(a)");
        constexpr int reach = (1 << Tiny::exponent_bits) + Tiny::precision;
        for (int e = -reach; e <= reach; ++e) {
            how.exponent = e;
            check(scale(a.x, e), {std::ldexp(a.low, e), std::ldexp(a.high, e)}, how, "scale");
        }
    }

    void check_exact_pairs() {
        // All codes, infinities and NaN included.
        for (int a = 0; a < Tiny::codes; ++a) {
            check_one(exactly(Tiny::from_code(a)));
            for (int b = 0; b < Tiny::codes; ++b)
                check_pair(exactly(Tiny::from_code(a)), exactly(Tiny::from_code(b)));
        }
    }
    /// Every pair of numbers, with some pairs of bounds, drawn at random.
    void check_some_bounded() {
        constexpr std::size_t pairs_of_bounds = 8;
        std::size_t next = 0;
        const auto bound = [&] {
            return bounds_[(next = next * 1103515245 + 12345) / 64 % bounds_.size()];
        };
        for (const Tiny x : finite_)
            for (const Tiny e : bounds_)
                if (e != 0) check_one(within(x, e));
        for (const Tiny x : finite_)
            for (const Tiny y : finite_)
                for (std::size_t i = 0; i < pairs_of_bounds; ++i)
                    check_pair(within(x, bound()), within(y, bound()));
    }
    /// Every pair of numbers with every pair of bounds.
    void check_bounded() {
        // Made twice: a rule may treat a number and its copy as one.
        std::vector<operand_range> first, second;
        for (auto* const all : {&first, &second})
            for (const Tiny x : finite_)
                for (const Tiny e : bounds_) all->push_back(within(x, e));
        for (const operand_range& a : first) {
            if (a.as_operand.error != 0) check_one(a);
            for (const operand_range& b : second) check_pair(a, b);
        }
    }
    /// Every (a ∘ b) ∘ c and c ∘ (a ∘ b) of exact numbers, without an inner division: tests bounds
    /// that rules compute.
    void check_two_operations() {
        for (const Tiny a : finite_)
            for (const Tiny b : finite_) {
                const double x = double(a), y = double(b);
                tiny_account how{{{{x, 0}, {y, 0}}}, 3};
                format::clear_flag();
                check_with_third(number(a) + number(b), x + y, how, "a + b");
                check_with_third(number(a) - number(b), x - y, how, "a - b");
                check_with_third(number(a) * number(b), x * y, how, "a * b");
                how.inner = nullptr;
                for (const Tiny c : finite_) {
                    const double z = double(c);
                    how.operands[2] = {z, 0};
                    format::clear_flag();
                    check_fused(fma(number(a), number(b), number(c)),
                                std::array{fused_value{x, y, z}}, how, "fma(a, b, c)");
                    check_fused(lerp(number(a), number(b), number(c)),
                                std::array{fused_value{z, y - x, x}}, how, "lerp(a, b, c)");
                }
            }
    }
    void check_with_third(const number& inner, double exact, tiny_account& how,
                          const char* inner_operation) {
        const bool usable = !format::overflowed_unnoticed();
        format::clear_flag();
        if (!usable) return;
        how.inner = inner_operation;
        for (const Tiny c : finite_) {
            const number outer(c);
            const double z = double(c);
            how.operands[2] = {z, 0};
            format::clear_flag();
            check(inner + outer, {exact + z, exact + z}, how, "d + c");
            check(inner - outer, {exact - z, exact - z}, how, "d - c");
            check(outer - inner, {z - exact, z - exact}, how, "c - d");
            check(inner * outer, {exact * z, exact * z}, how, "d * c");
            check(dot(std::array{inner, outer}, std::array{outer, number(1)}),
                  {exact * z + z, exact * z + z}, how,
                  "dot(std::array{d, c}, std::array{c, number(1)})");
            if constexpr (has_division<Rule>) {
                check_quotient(inner / outer, {exact, exact}, {z, z}, how, "d / c");
                check_quotient(outer / inner, {z, z}, {exact, exact}, how, "c / d");
            }
        }
    }

    claim_checker claims_;
    std::vector<Tiny> finite_, bounds_;
};

template <class Rule, class Tiny>
void check_tiny_format(bool every_bound, tiny_findings& found) {
    if (!promises_bound<Rule> || Tiny::precision < minimal_precision<Rule>) return;
    using format = tiny_format<Tiny>;
    found.format = format::name();
    found.cpp_name = format::cpp_name();
    format::in_directions(holds_in_directed_rounding<Rule>, [&](std::string_view direction) {
        tiny_checker<Rule, Tiny>(found, direction).check_everything(every_bound);
    });
}

/// The rule in format number `format` < tiny_format_count. For users' 8-bit types, `every_bound`
/// tries every pair of bounds.
template <class Rule>
void check_tiny(std::size_t format, bool every_bound, tiny_findings& found) {
    [&]<class... Tiny>(tiny_format_types<Tiny...>) {
        static_assert(sizeof...(Tiny) == tiny_format_count);
        std::size_t i = 0;
        ((i++ == format ? check_tiny_format<Rule, Tiny>(every_bound, found) : void()), ...);
    }(tiny_formats());
}

}  // namespace errbound::validation
