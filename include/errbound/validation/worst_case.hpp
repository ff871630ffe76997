// The largest rounding error of a computation over all inputs in a box.
//   const auto f = [](const auto& x, const auto& y) { return x / (x + y); };
//   const auto e = errbound::worst_case<float>(f, {{1, 4}, {1, 4}});
//   e.at_most, e.at_least;  // certified, and observed at e.where
//
// `at_most` holds whenever the bisection stops, under the assumptions of the bound rules: rounding
// to nearest, and function_error for elementary functions. It is infinite if an operation may
// overflow or leave its domain. Method and proof: docs/how-wrong.md. Cost: microseconds per
// operation and box, up to the limits of the options. Links to errbound::validation.
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <errbound/explain/explanation.hpp>
#include <errbound/validation/expression.hpp>
#include <errbound/validation/rule.hpp>
#include <limits>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace errbound {

/// An input takes every number of the format in [lower, upper]. With an error, it stands for a real
/// number in [lower, upper], and differs from it by at most the error.
struct input_range {
    double lower = 0, upper = 0, error = 0;
};

struct worst_case_options {
    bool round_inputs = false;  ///< inputs stand for real numbers, rounded to nearest
    double gap = 0.01;          ///< stop if bisection can lower the bound by at most this share
    double seconds = 10;        ///< for the bound; once more for the relative one
    std::size_t boxes = 1'000'000;
    std::size_t samples = 200'000;  ///< inputs that the search for the largest error tries
    std::size_t measured = 0;       ///< further random inputs at which MPFR measures the error
    std::uint64_t seed = 1;
    bool relative = false;  ///< bound the relative error, too
    double function_units =
        0;  ///< errors of functions in units in the last place; 0: function_error
    /// Compares these rules: validation::rules(), or validation::rule_of<mine>().
    std::vector<validation::rule> rules{};
};

/// A bound rule on one computation over a box.
struct rule_bound {
    std::string rule;
    double largest = 0;  ///< error() of the result at an input found by search; infinite: no bound
    /// The number of inputs, of those with the largest bounds or errors, whose true error exceeds
    /// the bound, or whose certain sign is wrong.
    std::size_t broken = 0;
};

struct worst_case_result {
    double at_most = 0;   ///< bound of |computed − exact result|; infinite if none was found
    double at_least = 0;  ///< an error that occurs, rounded down
    std::vector<double> where;    ///< inputs with that error; empty if no input was evaluated
    double lower = 0, upper = 0;  ///< enclosure of the exact result
    double relative_at_most = std::numeric_limits<double>::infinity();
    /// The share of each operation in the bound, in the box with the largest bound. Amounts are
    /// scaled to add up to at_most.
    explanation by_operation;
    std::vector<rule_bound> by_rule;  ///< one for each of the options' rules
    std::size_t boxes = 0;
    double seconds = 0;    ///< for the bound and the search
    bool complete = true;  ///< false if bisection ended before the gap was reached
};

/// A comparison of recorded numbers has no unique result in the box.
struct undecided_comparison : std::runtime_error {
    using std::runtime_error::runtime_error;
};

namespace validation {

/// A computation as a graph: operations on earlier ones. Equal operations on equal operands are
/// one.
class recording {
  public:
    enum class leaf : std::uint8_t { none, input, constant };
    struct node {
        leaf kind = leaf::none;
        operation_kind operation = operation_kind::add;
        std::size_t left = 0;  ///< an operand; of an input or constant, its index
        std::size_t right = 0, third = 0;
        std::uint32_t scope = 0;

        using identity = std::tuple<leaf, operation_kind, std::size_t, std::size_t, std::size_t>;
        identity key() const { return {kind, operation, left, right, third}; }
    };
    /// Inputs outside of left <= right are not in the box.
    struct constraint {
        std::size_t left = 0, right = 0;
    };

    /// Becomes the thread's recording until destroyed; they nest. Throws std::invalid_argument for
    /// an empty or infinite input range.
    recording(number_type type, std::vector<input_range> inputs, const worst_case_options& options);
    ~recording() { current() = outer_; }
    recording(const recording&) = delete;
    recording& operator=(const recording&) = delete;
    static recording*& current() {
        thread_local recording* now = nullptr;
        return now;
    }

    std::size_t add(node n) {
        n.scope = detail::current_scope();
        const auto [place, is_new] = known_.try_emplace(n.key(), nodes.size());
        if (is_new) nodes.push_back(n);
        return place->second;
    }
    /// A decimal, a quotient of two integers, a hexadecimal number as printf writes it, or PI and
    /// other names of FPCore. Throws std::invalid_argument.
    std::size_t constant(const std::string& text);
    /// The sign of left − right over the box, for exact and for computed operands. Throws
    /// undecided_comparison if it is not unique.
    sign_type order(std::size_t left, std::size_t right) const;

    number_type type;
    std::vector<input_range> inputs;
    worst_case_options options;
    std::vector<node> nodes;  ///< the inputs first
    std::vector<std::string> constants;
    std::vector<constraint> constraints;
    std::size_t result = 0;

  private:
    std::map<node::identity, std::size_t> known_;
    recording* outer_;
};

worst_case_result worst_case_of(const recording& f);

template <class T>
constexpr number_type number_type_of() {
    if constexpr (std::same_as<T, float>) return number_type::float_type;
    if constexpr (std::same_as<T, double>) return number_type::double_type;
    if constexpr (std::same_as<T, long double>)
        return number_traits<T>::digits == number_traits<double>::digits
                   ? number_type::double_type
                   : number_type::long_double_type;
    if constexpr (std::same_as<T, float16>) return number_type::float16_type;
    if constexpr (std::same_as<T, bfloat16>) return number_type::bfloat16_type;
    if constexpr (std::same_as<T, float8_e5m2>) return number_type::float8_e5m2_type;
    return number_type::float8_e4m3_type;
}

}  // namespace validation

template <class T>
concept worst_case_format = std::same_as<T, float> || std::same_as<T, double> ||
    std::same_as<T, long double> || std::same_as<T, float16> || std::same_as<T, bfloat16> ||
    std::same_as<T, float8_e5m2> || std::same_as<T, float8_e4m3>;

/// The number with which worst_case calls f. Comparisons throw undecided_comparison if their result
/// depends on the input. A built-in constant stands for exactly its C++ value; if the format does
/// not have it, its rounding counts as an error.
class recorded {
    using kind = validation::operation_kind;

  public:
    recorded() : recorded(0) {}
    template <class X>
    requires std::is_arithmetic_v<X> recorded(X x) : index_(current().constant(text_of(x))) {}
    explicit recorded(validation::recording::node n) : index_(current().add(n)) {}
    /// The exact constant of this text (see recording::constant).
    static recorded constant(const std::string& text) {
        recorded r;
        r.index_ = current().constant(text);
        return r;
    }
    template <class... More>
    static recorded of(kind k, const recorded& a, const More&... more) {
        validation::recording::node n{.operation = k, .left = a.index_};
        const std::array operands{a.index_, more.index_...};
        if (sizeof...(more) > 0) n.right = operands[std::min<std::size_t>(1, sizeof...(more))];
        if (sizeof...(more) > 1) n.third = operands.back();
        return recorded(n);
    }
    template <class... More>
    static recorded of(elementary_function f, const recorded& a, const More&... more) {
        const auto k = validation::first_function + static_cast<std::size_t>(f);
        return of(static_cast<kind>(k), a, more...);
    }
    std::size_t index() const { return index_; }

    recorded operator-() const { return of(kind::negate, *this); }
    recorded operator+() const { return *this; }
    friend recorded operator+(const recorded& a, const recorded& b) { return of(kind::add, a, b); }
    friend recorded operator-(const recorded& a, const recorded& b) {
        return of(kind::subtract, a, b);
    }
    friend recorded operator*(const recorded& a, const recorded& b) {
        return of(kind::multiply, a, b);
    }
    friend recorded operator/(const recorded& a, const recorded& b) {
        return of(kind::divide, a, b);
    }
    recorded& operator+=(const recorded& b) { return *this = *this + b; }
    recorded& operator-=(const recorded& b) { return *this = *this - b; }
    recorded& operator*=(const recorded& b) { return *this = *this * b; }
    recorded& operator/=(const recorded& b) { return *this = *this / b; }
    friend std::strong_ordering operator<=>(const recorded& a, const recorded& b) {
        return static_cast<int>(current().order(a.index_, b.index_)) <=>
               static_cast<int>(sign_type::zero);
    }
    friend bool operator==(const recorded& a, const recorded& b) { return (a <=> b) == 0; }

    friend recorded sqrt(const recorded& x) { return of(kind::root, x); }
    friend recorded abs(const recorded& x) { return of(kind::absolute, x); }
    friend recorded fabs(const recorded& x) { return of(kind::absolute, x); }
    friend recorded fma(const recorded& a, const recorded& b, const recorded& c) {
        return of(kind::fused, a, b, c);
    }
    friend recorded(min)(const recorded& a, const recorded& b) { return of(kind::lesser, a, b); }
    friend recorded(max)(const recorded& a, const recorded& b) { return of(kind::greater, a, b); }
    friend recorded exp(const recorded& x) { return of(elementary_function::exp, x); }
    friend recorded exp2(const recorded& x) { return of(elementary_function::exp2, x); }
    friend recorded expm1(const recorded& x) { return of(elementary_function::expm1, x); }
    friend recorded log(const recorded& x) { return of(elementary_function::log, x); }
    friend recorded log2(const recorded& x) { return of(elementary_function::log2, x); }
    friend recorded log10(const recorded& x) { return of(elementary_function::log10, x); }
    friend recorded log1p(const recorded& x) { return of(elementary_function::log1p, x); }
    friend recorded sin(const recorded& x) { return of(elementary_function::sin, x); }
    friend recorded cos(const recorded& x) { return of(elementary_function::cos, x); }
    friend recorded tan(const recorded& x) { return of(elementary_function::tan, x); }
    friend recorded asin(const recorded& x) { return of(elementary_function::asin, x); }
    friend recorded acos(const recorded& x) { return of(elementary_function::acos, x); }
    friend recorded atan(const recorded& x) { return of(elementary_function::atan, x); }
    friend recorded sinh(const recorded& x) { return of(elementary_function::sinh, x); }
    friend recorded cosh(const recorded& x) { return of(elementary_function::cosh, x); }
    friend recorded tanh(const recorded& x) { return of(elementary_function::tanh, x); }
    friend recorded asinh(const recorded& x) { return of(elementary_function::asinh, x); }
    friend recorded acosh(const recorded& x) { return of(elementary_function::acosh, x); }
    friend recorded atanh(const recorded& x) { return of(elementary_function::atanh, x); }
    friend recorded cbrt(const recorded& x) { return of(elementary_function::cbrt, x); }
    /// The C library's pow, also for whole exponents.
    friend recorded pow(const recorded& x, const recorded& y) {
        return of(elementary_function::pow, x, y);
    }
    friend recorded atan2(const recorded& y, const recorded& x) {
        return of(elementary_function::atan2, y, x);
    }

  private:
    static validation::recording& current() {
        if (validation::recording* const r = validation::recording::current()) return *r;
        throw std::logic_error("errbound: recorded numbers exist only while worst_case calls f");
    }
    template <class X>
    static std::string text_of(X x) {
        if constexpr (std::is_integral_v<X>) return std::to_string(+x);
        std::array<char, 64> text{};
        std::snprintf(text.data(), text.size(), "%La", static_cast<long double>(x));
        return text.data();
    }

    std::size_t index_;
};

/// The largest |computed − exact f| over the box, for f computed in T. Calls f once, with a
/// recorded number per input, or with std::span<const recorded>. T is float, double, long double,
/// float16, bfloat16 or an 8-bit type. Throws std::invalid_argument for an empty or infinite input
/// range, undecided_comparison, and what f throws.
template <worst_case_format T, class F>
worst_case_result worst_case(const F& f, std::span<const input_range> box,
                             const worst_case_options& options = {}) {
    validation::recording r(validation::number_type_of<T>(), {box.begin(), box.end()}, options);
    std::vector<recorded> inputs;
    for (std::size_t k = 0; k < box.size(); ++k)
        inputs.emplace_back(
            validation::recording::node{.kind = validation::recording::leaf::input, .left = k});
    r.result = recorded(f(std::span<const recorded>(inputs))).index();
    return worst_case_of(r);
}
template <worst_case_format T, class F, std::size_t N>
worst_case_result worst_case(const F& f, const input_range (&box)[N],
                             const worst_case_options& options = {}) {
    return worst_case<T>(
        [&](std::span<const recorded> x) {
            return [&]<std::size_t... I>(std::index_sequence<I...>) {
                return f(x[I]...);
            }
            (std::make_index_sequence<N>());
        },
        std::span<const input_range>(box), options);
}

}  // namespace errbound
