// Straight-line programs for validation: expressions with shared subexpressions. Values are
// numbered: the inputs, then the results of operations on earlier values.
#pragma once

#include <array>
#include <cfloat>
#include <cstddef>
#include <cstdint>
#include <errbound/binary128.hpp>
#include <errbound/elementary.hpp>
#include <errbound/functions.hpp>
#include <errbound/small_floats.hpp>
#include <errbound/tracked.hpp>
#include <errbound/validation/ball.hpp>
#include <errbound/validation/exact_value.hpp>
#include <errbound/validation/rule_list.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace errbound::validation {

enum class operation_kind : std::uint8_t {
    add,
    subtract,
    multiply,
    divide,
    negate,
    scale,
    root,
    absolute,
    lesser,
    greater,
    fused,
    dot,
    horner,
    copy_sign,
    middle,
    interpolate,
    hypotenuse,
    power,
    function  ///< followed by all of elementary_function, in its order
};
inline constexpr std::size_t first_function = static_cast<std::size_t>(operation_kind::function);
inline constexpr std::size_t operation_kinds = first_function + named_functions.size();
std::string_view name_of(operation_kind kind);

constexpr bool is_function(operation_kind kind) {
    return kind >= operation_kind::function;
}
/// Precondition: is_function(kind).
constexpr elementary_function function_of(operation_kind kind) {
    return static_cast<elementary_function>(static_cast<std::size_t>(kind) - first_function);
}

/// Stands for value + error·quarters/4, known to within error; error 0: exact.
struct expression_input {
    exact_value value = 0, error = 0;
    int quarters = 0;
};

/// left ∘ right; −left, √left, |left|; left·2^exponent; left·right + third; left·right + third·left
/// (dot); third + right·left + third·left² (horner); |left| with right's sign; the midpoint; left +
/// third·(right − left); √(left² + right²); left^exponent; a function of left, or of left and
/// right.
struct expression_operation {
    using index = std::uint16_t;

    operation_kind kind = operation_kind::add;
    index left = 0, right = 0, third = 0;
    int exponent = 0;

    bool has_right() const {
        if (is_function(kind)) return has_two_arguments(function_of(kind));
        return kind != operation_kind::negate && kind != operation_kind::scale &&
               kind != operation_kind::root && kind != operation_kind::absolute &&
               kind != operation_kind::power;
    }
    bool has_third() const {
        return kind == operation_kind::fused || kind == operation_kind::dot ||
               kind == operation_kind::horner || kind == operation_kind::interpolate;
    }
    template <class Visit>
    void for_each_operand(const Visit& visit) {
        visit(left);
        if (has_right()) visit(right);
        if (has_third()) visit(third);
    }
};

struct expression {
    static constexpr std::size_t max_inputs = 8;
    static constexpr std::size_t max_values = max_inputs + static_cast<std::size_t>(max_operations);

    std::array<expression_input, max_inputs> inputs;
    std::size_t input_count = 0;
    std::array<expression_operation, max_operations> operations;
    std::size_t operation_count = 0;

    std::size_t size() const { return input_count + operation_count; }
    bool divides() const {
        return has([](operation_kind kind) { return kind == operation_kind::divide; });
    }
    /// True if enough bits hold all values exactly.
    bool is_polynomial() const {
        return !has([](operation_kind kind) {
            return kind == operation_kind::divide || kind == operation_kind::root ||
                   kind == operation_kind::hypotenuse || kind == operation_kind::power ||
                   is_function(kind);
        });
    }

  private:
    template <class Condition>
    bool has(const Condition& condition) const {
        for (std::size_t i = 0; i < operation_count; ++i)
            if (condition(operations[i].kind)) return true;
        return false;
    }
};

/// An expression of any length.
struct expression_view {
    std::span<const expression_input> inputs;
    std::span<const expression_operation> operations;

    expression_view(const expression& e)
        : inputs(e.inputs.data(), e.input_count),
          operations(e.operations.data(), e.operation_count) {}
    expression_view(std::span<const expression_input> i, std::span<const expression_operation> o)
        : inputs(i), operations(o) {}
};

enum class number_type : std::uint8_t {
    float_type,
    double_type,
    float16_type,
    bfloat16_type,
    float8_e5m2_type,
    float8_e4m3_type,
    long_double_type,
    float128_type,
    cpp_bin_float_type,
    mpfr_float_type
};
inline constexpr std::size_t number_type_count = 10;
/// A number type and its names in tables and in C++.
struct named_number_type {
    number_type type;
    std::string_view name, cpp_name;
};
/// The system's types: long double if it has more bits than double, float128 if that differs and
/// the C library has its functions. The last two are Boost.Multiprecision's.
inline constexpr named_number_type number_types[] = {
    {number_type::double_type, "double", "double"},
    {number_type::float_type, "float", "float"},
    {number_type::float16_type, "float16", "errbound::float16"},
    {number_type::bfloat16_type, "bfloat16", "errbound::bfloat16"},
    {number_type::float8_e5m2_type, "float8_e5m2", "errbound::float8_e5m2"},
    {number_type::float8_e4m3_type, "float8_e4m3", "errbound::float8_e4m3"},
#if LDBL_MANT_DIG == 64 || LDBL_MANT_DIG == 113
    {number_type::long_double_type, "long_double", "long double"},
#endif
#if LDBL_MANT_DIG != 113 && defined(__SIZEOF_FLOAT128__) && defined(__GLIBC__)
    {number_type::float128_type, "float128", "errbound::float128"},
#endif
    {number_type::cpp_bin_float_type, "cpp_bin_float_quad",
     "boost::multiprecision::cpp_bin_float_quad"},
    {number_type::mpfr_float_type, "mpfr_float_50", "boost::multiprecision::mpfr_float_50"}};
constexpr const named_number_type& entry_of(number_type type) {
    std::size_t i = 0;
    while (number_types[i].type != type) ++i;
    return number_types[i];
}
constexpr std::string_view name_of(number_type type) {
    return entry_of(type).name;
}
constexpr bool is_boost(number_type type) {
    return type == number_type::cpp_bin_float_type || type == number_type::mpfr_float_type;
}

/// Calls `f.operator()<T>()` for the type. Precondition: among number_types and !is_boost(type).
template <class F>
constexpr decltype(auto) with_number_type(number_type type, const F& f) {
    switch (type) {
        case number_type::float_type:
            return f.template operator()<float>();
        case number_type::float16_type:
            return f.template operator()<float16>();
        case number_type::bfloat16_type:
            return f.template operator()<bfloat16>();
        case number_type::float8_e5m2_type:
            return f.template operator()<float8_e5m2>();
        case number_type::float8_e4m3_type:
            return f.template operator()<float8_e4m3>();
#if LDBL_MANT_DIG == 64 || LDBL_MANT_DIG == 113
        case number_type::long_double_type:
            return f.template operator()<long double>();
#endif
#if LDBL_MANT_DIG != 113 && defined(__SIZEOF_FLOAT128__) && defined(__GLIBC__)
        case number_type::float128_type:
            return f.template operator()<float128>();
#endif
        default:
            return f.template operator()<double>();
    }
}

/// True if T has elementary functions with known errors.
template <class T>
inline constexpr bool has_elementary_functions =
    detail::has_system_functions<detail::function_type<T>>&&
        function_error<elementary_function::exp, detail::function_type<T>> != 0;

/// True if tracked numbers of type T have the operation. Roots and fused products, and operations
/// made of them, need subnormal numbers.
template <class T>
constexpr bool has_operation(operation_kind kind) {
    if (kind == operation_kind::root || kind == operation_kind::fused ||
        kind == operation_kind::interpolate)
        return has_subnormals<T>;
    if (kind == operation_kind::hypotenuse)
        return has_subnormals<T> && number_traits<T>::digits >= 8;
    if (is_function(kind)) return has_elementary_functions<T>;
    return true;
}

/// The expression with this index; equal for equal seeds. Every fourth one may divide, another
/// fourth has elementary functions. At most `longest` operations.
expression random_expression(std::uint64_t seed, std::uint64_t index, number_type type,
                             int longest);

/// A rule's result.
struct claim {
    exact_value value, error;
    sign_type sign;
};

/// An elementary function of earlier values. Precondition: T has it.
template <class Rule, class T>
tracked<T, Rule> applied_elementary(elementary_function f, const tracked<T, Rule>& left,
                                    const tracked<T, Rule>& right) {
    if constexpr (has_operation<T>(operation_kind::function))
        return with_function(f, [&]<elementary_function F>() {
            if constexpr (F == elementary_function::pow)
                return pow(left, right);
            else if constexpr (F == elementary_function::atan2)
                return atan2(left, right);
            else
                return detail::function_of<F>(left);
        });
    return {};
}

template <class Rule, class T>
tracked<T, Rule> applied_compound(const expression_operation& o, const tracked<T, Rule>* x) {
    const auto &left = x[o.left], &right = x[o.right], &third = x[o.third];
    switch (o.kind) {
        case operation_kind::root:
            if constexpr (has_operation<T>(operation_kind::root)) return sqrt(left);
            break;
        case operation_kind::fused:
            if constexpr (has_operation<T>(operation_kind::fused)) return fma(left, right, third);
            break;
        case operation_kind::dot:
            return dot(std::array{left, third}, std::array{right, left});
        case operation_kind::horner:
            return horner(std::array{third, right, third}, left);
        case operation_kind::copy_sign:
            return copysign(left, right);
        case operation_kind::middle:
            return midpoint(left, right);
        case operation_kind::interpolate:
            if constexpr (has_operation<T>(operation_kind::interpolate))
                return lerp(left, right, third);
            break;
        case operation_kind::hypotenuse:
            if constexpr (has_operation<T>(operation_kind::hypotenuse)) return hypot(left, right);
            break;
        case operation_kind::power:
            return pow(left, o.exponent);
        default:
            break;
    }
    return {};
}

/// The result of an operation on earlier values. Precondition: T has it, and the rule has division
/// if needed.
template <class Rule, class T>
tracked<T, Rule> applied(const expression_operation& o, const tracked<T, Rule>* x) {
    const auto &left = x[o.left], &right = x[o.right];
    switch (o.kind) {
        case operation_kind::add:
            return left + right;
        case operation_kind::subtract:
            return left - right;
        case operation_kind::multiply:
            return left * right;
        case operation_kind::divide:
            if constexpr (has_division<Rule>) return left / right;
            return {};
        case operation_kind::negate:
            return -left;
        case operation_kind::scale:
            return scale(left, o.exponent);
        case operation_kind::absolute:
            return abs(left);
        case operation_kind::lesser:
            return min<>(left, right);
        case operation_kind::greater:
            return max<>(left, right);
        default:
            return is_function(o.kind) ? applied_elementary(function_of(o.kind), left, right)
                                       : applied_compound(o, x);
    }
}

/// All values of the expression in tracked<T, Rule>. Precondition: T has its operations, and the
/// rule has division if needed.
template <class Rule, class T>
void evaluate(const expression_view& e, claim* claims) {
    using number = tracked<T, Rule>;
    const std::size_t size = e.inputs.size() + e.operations.size();
    std::array<number, expression::max_values> few;
    std::vector<number> many(size > few.size() ? size : 0);
    number* const x = many.empty() ? few.data() : many.data();
    std::size_t n = 0;
    for (const expression_input& in : e.inputs) {
        const T value = number_of<T>(in.value);
        x[n++] = in.error == 0 ? number(value) : number::within(value, number_of<T>(in.error));
    }
    for (const expression_operation& o : e.operations) x[n++] = applied(o, x);
    for (std::size_t i = 0; i < n; ++i)
        claims[i] = {exactly(T(x[i].value())), exactly(T(x[i].error())), sign_of(x[i])};
}

/// Encloses the result of an operation; operands that it lacks are ignored.
void set_result(ball& result, const expression_operation& o, const ball& left, const ball& right,
                const ball& third);

/// Enclosures of all values.
void evaluate(const expression& e, ball* values);

/// The expression in C++, a line per value, ready to paste.
std::string cpp_text(const expression& e, number_type type, std::string_view rule);

/// "0x1.8p-3"; for other types a constant, "0x1.8p-3F" or "errbound::float16(0x1.8p-3)", or an
/// expression for more bits or larger exponents.
std::string hexadecimal(const exact_value& x, number_type type = number_type::double_type);

}  // namespace errbound::validation
