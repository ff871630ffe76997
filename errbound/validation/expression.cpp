// Random expressions: generation, reference values, text.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <errbound/validation/expression.hpp>
#include <type_traits>

#include "errbound/support/hexadecimal.hpp"
#include "errbound/validation/any_number_type.hpp"
#include "errbound/validation/random_source.hpp"

namespace errbound::validation {
namespace {

enum class operand_scale {
    ordinary,           ///< between 2^-5 and 2^5
    underflowing,       ///< subnormals, and numbers with subnormal products
    overflowing,        ///< near the largest number, and numbers with products there
    mixed,              ///< the whole range
    small_integers,     ///< sums and products cancel exactly
    nearly_cancelling,  ///< one number and its neighbours
};
constexpr int operand_scales = 6;

template <class T>
class input_maker {
    using traits = number_traits<T>;
    // Numbers are doubles while being made, if these hold all of T.
    using maker = std::conditional_t<fits_double<T>, double, T>;
    using making = number_traits<maker>;

  public:
    input_maker(random_source& random, operand_scale scale)
        : random_(random), scale_(scale), middle_(of_exponent(random.between(-2, 2))) {}

    maker value() {
        if (random_.one_in(32)) return maker(0);
        switch (scale_) {
            case operand_scale::ordinary:
                return of_exponent(random_.between(-4, 5));
            case operand_scale::underflowing:
                switch (random_.below(4)) {
                    case 0: {
                        const maker sign = random_.one_in(2) ? -1 : 1;
                        return rounded(scaled(sign * maker(random_.below(20)), least_));
                    }
                    case 1:
                        return of_exponent(least_ + random_.between(1, traits::digits + 4));
                    case 2:
                        return of_exponent(random_.between(-4, 5));
                    default:
                        return of_exponent(least_ / 2 + random_.between(-4, traits::digits));
                }
            case operand_scale::overflowing:
                switch (random_.below(3)) {
                    case 0:
                        return of_exponent(most_ - random_.below(3));
                    case 1:
                        return of_exponent(random_.between(-4, 5));
                    default:
                        return of_exponent(most_ / 2 + random_.between(-2, 2));
                }
            case operand_scale::mixed:
                return of_exponent(random_.between(least_ + 1, most_));
            case operand_scale::small_integers:
                return maker(random_.between(-8, 8));
            case operand_scale::nearly_cancelling: {
                const int places = random_.one_in(4) ? random_.below(1 << 10) : random_.below(4);
                const maker near = middle_ * (1 + places * maker{traits::epsilon()});
                return signed_randomly(rounded(near));
            }
        }
        return maker(0);
    }
    /// A bound for an input: from far below its last place to its size.
    maker error(const maker& value) {
        if (value == 0 || random_.one_in(8)) return making::abs(this->value());
        const maker size = scaled(making::abs(value), -random_.between(-1, traits::digits + 8));
        return making::abs(rounded(size * (1 + 0.25 * random_.below(4))));
    }

  private:
    static maker scaled(const maker& x, int e) { return making::scale(x, e); }
    maker signed_randomly(const maker& x) {
        const maker size = making::abs(x);
        return random_.one_in(2) ? maker(-size) : size;
    }
    /// Rounds to T, at most to the largest number.
    static maker rounded(const maker& x) {
        const maker largest = maker{traits::largest()};
        return maker{static_cast<T>(x < -largest ? maker(-largest) : x > largest ? largest : x)};
    }
    /// In [2^(e−1), 2^e], with few bits or all.
    maker of_exponent(int e) {
        const int bits = random_.one_in(3) ? random_.between(2, 6) : traits::digits;
        const int first = std::min(bits, 53);
        maker mantissa = static_cast<maker>(static_cast<double>(random_.bits() >> (65 - first)) +
                                            std::ldexp(1.0, first - 1));
        for (int left = bits - first; left > 0; left -= 53) {
            const int more = std::min(left, 53);
            mantissa = scaled(mantissa, more) +
                       static_cast<maker>(static_cast<double>(random_.bits() >> (64 - more)));
        }
        return signed_randomly(rounded(scaled(mantissa, e - bits)));
    }

    random_source& random_;
    operand_scale scale_;
    // 2^least_ is the smallest positive number, 2^most_ just too large.
    int least_ = has_subnormals<T> ? traits::min_exponent - traits::digits
                                   : traits::exponent(traits::smallest_normal()) - 1;
    int most_ = traits::exponent(traits::largest());
    maker middle_;
};

/// Relative frequencies of + − × ÷, −x, ·2^e, √x, |x|, min, max, fma, dot product, polynomial,
/// copysign, midpoint, lerp, hypot, x^n, elementary functions.
using operation_mix = std::array<int, first_function + 1>;
constexpr std::array<operation_mix, 6> mixes{
    {{3, 3, 6, 0, 1, 1, 0, 0, 0, 0, 0, 2, 2, 0, 0, 0, 0, 0, 0},  // polynomials
     {4, 6, 1, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0},  // sums
     {1, 1, 6, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0},  // products
     {4, 3, 6, 0, 1, 1, 6, 4, 2, 2, 4, 1, 1, 2, 2, 3, 3, 2, 0},  // functions
     {2, 3, 3, 4, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0},
     {3, 3, 4, 0, 1, 2, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 9}}};
constexpr std::size_t mix_with_quotients = 4, mix_with_elementary_functions = 5;

operation_kind kind_from(const operation_mix& mix, random_source& random) {
    int sum = 0;
    for (const int share : mix) sum += share;
    int left = random.below(sum);
    std::size_t kind = 0;
    while ((left -= mix[kind]) >= 0) ++kind;
    if (kind == first_function)
        kind += static_cast<std::size_t>(random.below(static_cast<int>(named_functions.size())));
    return static_cast<operation_kind>(kind);
}

template <class T>
expression made(random_source& random, std::uint64_t index, int longest) {
    expression e;
    input_maker<T> inputs(random, static_cast<operand_scale>(random.below(operand_scales)));
    const int bounded = random.below(3);  // inputs with bounds: none, some or all
    e.input_count = static_cast<std::size_t>(random.between(1, expression::max_inputs));
    for (std::size_t i = 0; i < e.input_count; ++i) {
        expression_input& in = e.inputs[i];
        const auto value = inputs.value();
        in.value = exactly(value);
        if (bounded == 0 || (bounded == 1 && !random.one_in(3))) continue;
        in.error = exactly(inputs.error(value));
        in.quarters = random.one_in(2) ? (random.one_in(2) ? 4 : -4) : random.between(-4, 4);
    }

    const operation_mix& mix = mixes[index % 4 == 3   ? mix_with_quotients
                                     : index % 4 == 1 ? mix_with_elementary_functions
                                                      : static_cast<std::size_t>(random.below(4))];
    // Operands among the latest values make an expression deep, others wide.
    const bool deep = random.one_in(2);
    e.operation_count = static_cast<std::size_t>(random.between(1, longest));
    for (std::size_t i = 0; i < e.operation_count; ++i) {
        const int values = static_cast<int>(e.input_count + i);
        expression_operation& o = e.operations[i];
        do o.kind = kind_from(mix, random);
        while (!has_operation<T>(o.kind));
        const int recent =
            deep && i > 0 ? values - 1 - random.below(std::min(values, 2)) : random.below(values);
        const int other = random.below(values);
        const bool exchanged = random.one_in(2);
        o.left = static_cast<expression_operation::index>(exchanged ? other : recent);
        o.right = static_cast<expression_operation::index>(exchanged ? recent : other);
        if (o.has_third()) o.third = static_cast<expression_operation::index>(random.below(values));
        const int reach = random.one_in(4) ? number_traits<T>::max_exponent : 8;
        if (o.kind == operation_kind::scale) o.exponent = random.between(-reach, reach);
        if (o.kind == operation_kind::power) o.exponent = random.between(-3, 6);
    }
    return e;
}

char letter(std::size_t value) {
    return static_cast<char>('a' + value % 26);
}

std::string name_of_value(std::size_t value) {
    return letter(value) + (value < 26 ? std::string() : std::to_string(value / 26));
}

}  // namespace

std::string_view name_of(operation_kind kind) {
    if (is_function(kind)) return name_of(function_of(kind));
    constexpr std::array<std::string_view, first_function> names{
        "add", "subtract", "multiply", "divide", "negate",   "scale",    "sqrt", "abs",   "min",
        "max", "fma",      "dot",      "horner", "copysign", "midpoint", "lerp", "hypot", "power"};
    return names[static_cast<std::size_t>(kind)];
}

expression random_expression(std::uint64_t seed, std::uint64_t index, number_type type,
                             int longest) {
    random_source mixed(seed);
    const auto t = static_cast<std::uint64_t>(type);
    random_source random(mixed.bits() ^ (2 * index + t % 2) ^ (t / 2 << 60));
    return with_any_number_type(type, [&]<class T>() { return made<T>(random, index, longest); });
}

namespace {

/// Finds values that are ±2^k times others. Two such can cancel under `affine`; the enclosure of a
/// rounded quotient or root does not show this.
class multiples {
  public:
    multiples() {
        for (std::size_t n = 0; n < known_.size(); ++n) known_[n].of = n;
    }
    /// Records value n, already computed. Sets it to zero if the operands cancel.
    void note(const expression_operation& o, std::size_t n, ball* values) {
        const multiple left = known_[o.left], right = known_[o.right];
        switch (o.kind) {
            case operation_kind::add:
            case operation_kind::subtract: {
                if (left.of != right.of || left.power != right.power) return;
                const bool cancel =
                    (left.negative != right.negative) == (o.kind == operation_kind::add);
                known_[n] = {left.of, left.negative, left.power + 1};
                if (!cancel) return;
                known_[n] = {n, false, 0};
                if (values[n].is_defined() && !values[n].is_unknown()) values[n].set(0);
                return;
            }
            case operation_kind::negate:
                known_[n] = {left.of, !left.negative, left.power};
                return;
            case operation_kind::scale:
                known_[n] = {left.of, left.negative, left.power + o.exponent};
                return;
            case operation_kind::absolute:
                if (const sign_type sign = values[o.left].sign(); certain(sign))
                    known_[n] = {left.of, left.negative != (sign == sign_type::negative),
                                 left.power};
                return;
            case operation_kind::lesser:
            case operation_kind::greater: {
                ball apart(mpfr_get_prec(values[n].middle()));
                apart.set_difference(values[o.left], values[o.right]);
                const sign_type order = apart.sign();
                if (!certain(order)) return;
                known_[n] = (order == sign_type::negative) == (o.kind == operation_kind::lesser)
                                ? left
                                : right;
                return;
            }
            default:
                return;
        }
    }

  private:
    struct multiple {
        std::size_t of = 0;
        bool negative = false;
        std::int64_t power = 0;
    };
    std::array<multiple, expression::max_values> known_;
};

void set_dot(ball& result, const ball& left, const ball& right, const ball& third) {
    ball product(mpfr_get_prec(result.middle()));
    product.set_product(left, right);
    result.set_fused(third, left, product);
}
void set_polynomial(ball& result, const ball& left, const ball& right, const ball& third) {
    ball inner(mpfr_get_prec(result.middle()));
    inner.set_fused(third, left, right);
    result.set_fused(inner, left, third);
}

void set_hypotenuse(ball& result, const ball& left, const ball& right) {
    ball square(mpfr_get_prec(result.middle())), sum(square);
    square.set_product(left, left);
    sum.set_fused(right, right, square);
    result.set_root_of_squares(sum);
}
void set_interpolated(ball& result, const ball& left, const ball& right, const ball& third) {
    const bool defined = left.is_defined() && right.is_defined() && third.is_defined();
    const bool whole = third.is_exact() && mpfr_cmp_ui(third.middle(), 1) == 0;
    if (defined && (whole || third.is_zero())) {
        result = whole ? right : left;  // without the difference's rounding
        return;
    }
    ball difference(mpfr_get_prec(result.middle()));
    difference.set_difference(right, left);
    result.set_fused(third, difference, left);
}
void set_power(ball& result, const ball& x, int n) {
    ball one(mpfr_get_prec(result.middle())), power(one);
    one.set(1);
    power.set_product(one, x);  // as undefined as x
    if (n == 0 && x.is_defined()) power = one;
    for (int i = 1; i < std::abs(n); ++i) {
        const ball before = power;
        power.set_product(before, x);
    }
    if (n < 0)
        result.set_quotient(one, power);
    else
        result = power;
}

void set_compound(ball& result, const expression_operation& o, const ball& left, const ball& right,
                  const ball& third) {
    switch (o.kind) {
        case operation_kind::fused:
            return result.set_fused(left, right, third);
        case operation_kind::dot:
            return set_dot(result, left, right, third);
        case operation_kind::horner:
            return set_polynomial(result, left, right, third);
        case operation_kind::copy_sign:
            return result.set_with_sign(left, right);
        case operation_kind::middle: {
            ball sum(mpfr_get_prec(result.middle()));
            sum.set_sum(left, right);
            return result.set_scaled(sum, -1);
        }
        case operation_kind::interpolate:
            return set_interpolated(result, left, right, third);
        case operation_kind::hypotenuse:
            return set_hypotenuse(result, left, right);
        default:
            return set_power(result, left, o.exponent);
    }
}

}  // namespace

void set_result(ball& result, const expression_operation& o, const ball& left, const ball& right,
                const ball& third) {
    switch (o.kind) {
        case operation_kind::add:
            return result.set_sum(left, right);
        case operation_kind::subtract:
            return result.set_difference(left, right);
        case operation_kind::multiply:
            return result.set_product(left, right);
        case operation_kind::divide:
            return result.set_quotient(left, right);
        case operation_kind::negate:
            return result.set_negative(left);
        case operation_kind::scale:
            return result.set_scaled(left, o.exponent);
        case operation_kind::root:
            return result.set_root(left);
        case operation_kind::absolute:
            return result.set_absolute(left);
        case operation_kind::lesser:
            return result.set_lesser(left, right);
        case operation_kind::greater:
            return result.set_greater(left, right);
        default:
            if (is_function(o.kind))
                result.set_function(function_of(o.kind), left, right);
            else
                set_compound(result, o, left, right, third);
    }
}

void evaluate(const expression& e, ball* values) {
    multiples cancelling;
    std::size_t n = 0;
    for (; n < e.input_count; ++n) {
        const expression_input& in = e.inputs[n];
        if (in.error == 0)
            values[n].set(in.value);
        else
            values[n].set(in.value, in.error, in.quarters);
    }
    for (std::size_t i = 0; i < e.operation_count; ++i, ++n) {
        const expression_operation& o = e.operations[i];
        set_result(values[n], o, values[o.left], values[o.right], values[o.third]);
        cancelling.note(o, n, values);
    }
}

namespace {

std::string hexadecimal_double(double x, number_type type) {
    const std::string text = support::hexadecimal(x);
    if (type == number_type::double_type) return text;
    if (type == number_type::float_type) return text + "F";
    if (type == number_type::long_double_type) return text + "L";
    return std::string(entry_of(type).cpp_name) + "(" + text + ")";
}

}  // namespace

std::string hexadecimal(const exact_value& x, number_type type) {
    std::string sum = hexadecimal_double(x.leading, type);
    for (const double part : x.rest)
        if (part != 0) sum += " + " + hexadecimal_double(part, type);
    if (x.exponent == 0) return sum;
    return "errbound::number_traits<" + std::string(entry_of(type).cpp_name) + ">::scale(" + sum +
           ", " + std::to_string(x.exponent) + ")";
}

namespace {

std::string cpp_text(const expression_operation& o) {
    const std::string left = name_of_value(o.left), right = name_of_value(o.right),
                      third = name_of_value(o.third);
    switch (o.kind) {
        case operation_kind::add:
            return left + " + " + right;
        case operation_kind::subtract:
            return left + " - " + right;
        case operation_kind::multiply:
            return left + " * " + right;
        case operation_kind::divide:
            return left + " / " + right;
        case operation_kind::negate:
            return "-" + left;
        case operation_kind::scale:
            return "scale(" + left + ", " + std::to_string(o.exponent) + ")";
        case operation_kind::power:
            return "pow(" + left + ", " + std::to_string(o.exponent) + ")";
        case operation_kind::dot:
            return "dot(std::array{" + left + ", " + third + "}, std::array{" + right + ", " +
                   left + "})";
        case operation_kind::horner:
            return "horner(std::array{" + third + ", " + right + ", " + third + "}, " + left + ")";
        default:
            break;
    }
    return std::string(name_of(o.kind)) + "(" + left + (o.has_right() ? ", " + right : "") +
           (o.has_third() ? ", " + third : "") + ")";
}

}  // namespace

std::string cpp_text(const expression& e, number_type type, std::string_view rule) {
    const std::string number(entry_of(type).cpp_name);
    // A directive: a custom rule may be in no namespace.
    std::string text = "using namespace errbound;\nusing number = tracked<" + number + ", " +
                       std::string(rule) + ">;\n";
    for (std::size_t i = 0; i < e.input_count; ++i) {
        const expression_input& in = e.inputs[i];
        text += "const number " + name_of_value(i) + " = ";
        if (in.error == 0) {
            text += hexadecimal(in.value, type) + ";\n";
        } else {
            text += "number::within(" + hexadecimal(in.value, type) + ", " +
                    hexadecimal(in.error, type) + ");  // stands for value + " +
                    std::to_string(in.quarters) + "/4 error\n";
        }
    }
    for (std::size_t i = 0; i < e.operation_count; ++i) {
        text +=
            "const number " + name_of_value(e.input_count + i) + " = " + cpp_text(e.operations[i]);
        text += ";\n";
    }
    return text;
}

}  // namespace errbound::validation
