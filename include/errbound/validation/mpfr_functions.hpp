// Elementary functions by MPFR, correctly rounded, and their domains.
#pragma once

#include <mpfr.h>

#include <array>
#include <cstddef>
#include <errbound/elementary.hpp>
#include <string_view>
#include <utility>

namespace errbound::validation {

struct named_function {
    elementary_function function;
    std::string_view name;
};
/// In the order of elementary_function.
inline constexpr std::array<named_function, 22> named_functions{
    {{elementary_function::exp, "exp"},     {elementary_function::exp2, "exp2"},
     {elementary_function::expm1, "expm1"}, {elementary_function::log, "log"},
     {elementary_function::log2, "log2"},   {elementary_function::log10, "log10"},
     {elementary_function::log1p, "log1p"}, {elementary_function::sin, "sin"},
     {elementary_function::cos, "cos"},     {elementary_function::tan, "tan"},
     {elementary_function::asin, "asin"},   {elementary_function::acos, "acos"},
     {elementary_function::atan, "atan"},   {elementary_function::sinh, "sinh"},
     {elementary_function::cosh, "cosh"},   {elementary_function::tanh, "tanh"},
     {elementary_function::asinh, "asinh"}, {elementary_function::acosh, "acosh"},
     {elementary_function::atanh, "atanh"}, {elementary_function::cbrt, "cbrt"},
     {elementary_function::pow, "pow"},     {elementary_function::atan2, "atan2"}}};

constexpr std::string_view name_of(elementary_function f) {
    return named_functions[static_cast<std::size_t>(f)].name;
}
/// pow and atan2 have two arguments, the others one.
constexpr bool has_two_arguments(elementary_function f) {
    return f == elementary_function::pow || f == elementary_function::atan2;
}

template <elementary_function F, class Visit>
constexpr decltype(auto) call_with(const Visit& visit) {
    return visit.template operator()<F>();
}

/// Returns `visit.operator()<F>()` for F = f.
template <class Visit>
constexpr decltype(auto) with_function(elementary_function f, const Visit& visit) {
    return [&]<std::size_t... I>(std::index_sequence<I...>)->decltype(auto) {
        constexpr std::array calls{&call_with<static_cast<elementary_function>(I), Visit>...};
        return calls[static_cast<std::size_t>(f)](visit);
    }
    (std::make_index_sequence<named_functions.size()>());
}

using mpfr_function = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_rnd_t);
inline mpfr_function mpfr_function_of(elementary_function f) {
    static constexpr mpfr_function all[] = {
        mpfr_exp,  mpfr_exp2, mpfr_expm1, mpfr_log,   mpfr_log2,  mpfr_log10, mpfr_log1p,
        mpfr_sin,  mpfr_cos,  mpfr_tan,   mpfr_asin,  mpfr_acos,  mpfr_atan,  mpfr_sinh,
        mpfr_cosh, mpfr_tanh, mpfr_asinh, mpfr_acosh, mpfr_atanh, mpfr_cbrt};
    return all[static_cast<std::size_t>(f)];
}
/// x^y or atan2(y, x), in the function's argument order. Zeros have no sign here: +0 is used.
inline int mpfr_of_two(elementary_function f, mpfr_ptr to, mpfr_srcptr a, mpfr_srcptr b,
                       mpfr_rnd_t direction) {
    if (f == elementary_function::pow) return mpfr_pow(to, a, b, direction);
    if (!mpfr_zero_p(a)) return mpfr_atan2(to, a, b, direction);
    MPFR_DECL_INIT(zero, 2);
    mpfr_set_zero(zero, 1);
    return mpfr_atan2(to, zero, b, direction);
}

/// True if f has a value at x; poles have none.
inline bool has_value(elementary_function f, mpfr_srcptr x) {
    using enum elementary_function;
    switch (f) {
        case log:
        case log2:
        case log10:
            return mpfr_sgn(x) > 0;
        case log1p:
            return mpfr_cmp_si(x, -1) > 0;
        case asin:
        case acos:
            return mpfr_cmp_si(x, -1) >= 0 && mpfr_cmp_si(x, 1) <= 0;
        case acosh:
            return mpfr_cmp_si(x, 1) >= 0;
        case atanh:
            return mpfr_cmp_si(x, -1) > 0 && mpfr_cmp_si(x, 1) < 0;
        default:
            return true;
    }
}
/// True if f has a value at two arguments; 0^0 is 1.
inline bool has_value(elementary_function f, mpfr_srcptr a, mpfr_srcptr b) {
    if (f == elementary_function::atan2) return !mpfr_zero_p(a) || !mpfr_zero_p(b);
    if (mpfr_sgn(a) > 0 || mpfr_zero_p(b)) return true;
    return mpfr_zero_p(a) ? mpfr_sgn(b) > 0 : mpfr_integer_p(b) != 0;
}

}  // namespace errbound::validation
