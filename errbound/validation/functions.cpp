// The C library's elementary functions against MPFR.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstdio>
#include <errbound/validation/ball.hpp>
#include <errbound/validation/validation.hpp>
#include <limits>
#include <utility>
#include <vector>

#include "errbound/validation/chunks.hpp"
#include "errbound/validation/hard_angles.hpp"
#include "errbound/validation/random_source.hpp"

namespace errbound::validation {
namespace {

constexpr std::uint64_t least_chunk = 10000;
constexpr std::uint64_t float_count = std::uint64_t{1} << 32;

struct job {
    elementary_function function{};
    number_type number{};
    bool every_float = false;
    chunks cases{0, 1};
};

/// Some C libraries document no errors for long double.
template <elementary_function F>
constexpr bool long_double_is_known = function_error<F, long double> != 0;

bool has_functions(number_type number) {
    return number == number_type::float_type || number == number_type::double_type ||
           (number == number_type::long_double_type &&
            long_double_is_known<elementary_function::exp>);
}

std::vector<job> jobs_of(const function_options& options) {
    std::vector<job> jobs;
    for (const elementary_function f : options.functions)
        for (const number_type number : options.numbers) {
            if (!has_functions(number)) continue;
            const bool all =
                options.every_float && number == number_type::float_type && !has_two_arguments(f);
            jobs.push_back({f, number, all, {all ? float_count : options.samples, least_chunk}});
        }
    return jobs;
}

template <class T>
constexpr number_type type_of = std::same_as<T, float>    ? number_type::float_type
                                : std::same_as<T, double> ? number_type::double_type
                                                          : number_type::long_double_type;

template <class T>
std::string text_of(T x) {
    if constexpr (!std::same_as<T, long double>) return hexadecimal(double{x}, type_of<T>);
    std::array<char, 64> text{};
    (void)std::snprintf(text.data(), text.size(), "%LaL", static_cast<long double>(x));
    return text.data();
}

template <class T>
void set(mpfr_number& to, T x) {
    if constexpr (std::same_as<T, long double>)
        mpfr_set_ld(to.get(), x, MPFR_RNDN);
    else
        mpfr_set_d(to.get(), x, MPFR_RNDN);
}

/// Compares results of one function of T with the exact ones.
template <elementary_function F, class T>
class comparison {
    using traits = number_traits<T>;
    static constexpr bool has_two = has_two_arguments(F);
    // Errors are known to 2^-39 units.
    static constexpr mpfr_prec_t precision = traits::digits + 40;
    static constexpr double slack = 0x1p-39;

  public:
    explicit comparison(const std::optional<double>& units)
        : exact_(precision), off_(traits::digits), first_(traits::digits), second_(traits::digits) {
        found.function = name_of(F);
        found.number = name_of(type_of<T>);
        found.assumed = units.value_or(function_error<F, T>);
    }

    void add(T x, T y = 0) {
        detail::bounded<T> result{};
        if constexpr (has_two)
            result.value = detail::system_function<F>(x, y);
        else
            result = detail::function_of_range<F>(x, T(0));
        const T v = result.value;
        if (!std::isfinite(v) || !std::isfinite(x) || !std::isfinite(y)) return;
        // The library's result for a large angle has its own bound.
        const bool is_own = detail::is_function_of_angle(F) &&
                            std::abs(x) >= static_cast<T>(detail::least_reduced_angle);
        if constexpr (std::same_as<T, float> && !has_two)
            if (const double most =
                    most_units_off(v, detail::function_of_range<F>(double{x}, 0.0).value);
                most <= found.assumed &&
                (is_own || most <= found.largest || most < met_elsewhere_)) {
                ++found.arguments;
                return;
            }
        set(first_, x);
        set(second_, y);
        if constexpr (has_two) {
            if (!has_value(F, first_.get(), second_.get())) return;
            // Tracked zeros have no sign, so the results differ.
            if (F == elementary_function::atan2 && x == 0 && std::signbit(x)) return;
            mpfr_of_two(F, exact_.get(), first_.get(), second_.get(), MPFR_RNDZ);
        } else {
            if (!has_value(F, first_.get())) return;
            mpfr_function_of(F)(exact_.get(), first_.get(), MPFR_RNDZ);
        }
        ++found.arguments;
        const double off = units_off(v);
        const double limit =
            is_own ? std::max(found.assumed, in_last_places(result.error)) : found.assumed;
        if (off > limit) ++found.violations;
        if (!(off > found.largest) || (is_own && off <= limit)) return;
        found.largest = off;
        found.at = has_two ? text_of(x) + ", " + text_of(y) : text_of(x);
    }

    /// Sets an error met at another float; add() skips smaller errors.
    void is_met_elsewhere(double units) { met_elsewhere_ = units; }

    function_errors found;

  private:
    /// Returns an upper bound of units_off(v), or NaN. w is the double function's value. It is
    /// within 2^-20 units in the last place of a float (512 of double's) of f. About 20 times as
    /// fast as units_off.
    static double most_units_off(float v, double w) {
        constexpr double slack_of_w = 0x1p-20;
        constexpr int least = -149, digits = 24;
        int exponent = 0;
        (void)std::frexp(w * (1 - slack_of_w), &exponent);  // of f, or one less
        const int last = w == 0 ? least : std::max(exponent - digits, least);
        return std::ldexp(std::abs(v - w), -last) + slack_of_w;
    }
    /// |v − f| in units in the last place of f, rounded up. exact_ has f's exponent.
    double units_off(T v) {
        set(off_, v);
        mpfr_sub(off_.get(), off_.get(), exact_.get(), MPFR_RNDU);
        if (mpfr_zero_p(off_.get())) return 0;
        mpfr_mul_2si(off_.get(), off_.get(), -last_place(), MPFR_RNDU);
        mpfr_abs(off_.get(), off_.get(), MPFR_RNDU);
        return mpfr_get_d(off_.get(), MPFR_RNDU) + slack;
    }

    mpfr_exp_t last_place() const {
        constexpr mpfr_exp_t least = traits::min_exponent - traits::digits;
        if (mpfr_zero_p(exact_.get()) != 0) return least;
        return std::max(mpfr_get_exp(exact_.get()) - traits::digits, least);
    }
    double in_last_places(T error) const {
        return static_cast<double>(std::ldexp(error, -static_cast<int>(last_place())));
    }

    mpfr_number exact_, off_, first_, second_;
    double met_elsewhere_ = 0;
};

template <class T>
class argument_maker {
    using limits = std::numeric_limits<T>;
    using traits = number_traits<T>;
    using code = std::conditional_t<std::same_as<T, float>, std::uint32_t, std::uint64_t>;

  public:
    argument_maker(elementary_function f, std::uint64_t seed, std::uint64_t chunk)
        : function_(f), random_(mixed(seed, chunk)) {}

    T argument() {
        switch (random_.below(8)) {
            case 0:
                return any_bits();
            case 1:  // small
                return signed_by(uniform(4));
            case 2:  // near multiples of π/2
                return random_.below(2) == 0 ? hard_angle()
                                             : near(half_pi * std::floor(std::exp2(uniform(30))));
            case 3:  // near numbers of few digits, ends of domains among them
                return near(signed_by(std::ldexp(T(random_.below(9)), random_.between(-3, 1))));
            case 4:  // near ±1
                return signed_by(1 + signed_by(std::exp2(-uniform(traits::digits))));
            case 5:  // where results pass powers of two
                return near(static_cast<T>(random_.between(least, most) * unit_of_exponent()));
            case 6:  // over the range of exponentials
                return static_cast<T>(unit_of_exponent() * (least + uniform(most - least)));
            default:
                return of_any_size();
        }
    }
    /// Two arguments; for powers often without overflow or underflow.
    std::pair<T, T> two() {
        T x = argument(), y = argument();
        if (function_ == elementary_function::atan2) {
            if (random_.below(2) == 0) y = x * signed_by(std::exp2(uniform(60) - 30));
        } else if (random_.below(4) != 0) {
            if (random_.below(2) == 0) x = std::abs(x);
            const T log = std::log2(std::abs(x));
            if (log != 0 && std::isfinite(log)) y = near(T(least + uniform(most - least)) / log);
            if (random_.below(4) == 0) y = std::trunc(y);
        }
        return {x, y};
    }

  private:
    static constexpr T half_pi = static_cast<T>(1.57079632679489661923132169163975144L);
    static constexpr int least = limits::min_exponent - limits::digits - 2,
                         most = limits::max_exponent + 1;

    static std::uint64_t mixed(std::uint64_t seed, std::uint64_t chunk) {
        random_source random(seed);
        return random.bits() ^ chunk * 0x9e3779b97f4a7c15U;
    }
    /// In [0, end).
    T uniform(double end) {
        if constexpr (std::same_as<T, long double>)
            return static_cast<T>(end) * std::ldexp(static_cast<T>(random_.bits()), -64);
        else
            return static_cast<T>(end * std::ldexp(static_cast<double>(random_.bits() >> 11), -53));
    }
    T signed_by(T x) { return random_.below(2) == 0 ? x : -x; }
    T any_bits() {
        if constexpr (std::same_as<T, long double>)
            return std::ldexp(static_cast<T>(random_.bits()), random_.between(least, most) - 64);
        else
            return std::bit_cast<T>(static_cast<code>(random_.bits()));
    }
    T of_any_size() { return std::ldexp(signed_by(1 + uniform(1)), random_.between(least, most)); }
    T hard_angle() {
        while (hard_.empty()) hard_ = hard_angles<T>(random_.between(0, limits::max_exponent - 1));
        const T angle = hard_.back();
        hard_.pop_back();
        return signed_by(angle);
    }
    T near(T x) {
        for (int steps = random_.below(4); steps > 0; --steps)
            x = std::nextafter(x, random_.below(2) == 0 ? limits::max() : limits::lowest());
        return x;
    }
    double unit_of_exponent() const {
        return function_ == elementary_function::exp2 ? 1.0 : 0.693147180559945309417;
    }

    elementary_function function_;
    random_source random_;
    std::vector<T> hard_;
};

/// The largest error among some 65,000 floats. Chunks then call MPFR only for larger errors.
template <elementary_function F>
double largest_of_some(const function_options& options) {
    constexpr std::uint64_t step = 65537;
    comparison<F, float> some(options.units);
    for (std::uint64_t code = 0; code < float_count; code += step)
        some.add(std::bit_cast<float>(static_cast<std::uint32_t>(code)));
    return some.found.largest;
}

template <elementary_function F, class T>
function_errors compared(const job& what, const function_options& options, std::uint64_t chunk) {
    comparison<F, T> all(options.units);
    auto [begin, end] = what.cases.of(chunk);
    if (what.every_float) {
        if constexpr (!has_two_arguments(F)) all.is_met_elsewhere(largest_of_some<F>(options));
        for (std::uint64_t code = begin; code < end; ++code)
            all.add(std::bit_cast<float>(static_cast<std::uint32_t>(code)));
        return all.found;
    }
    argument_maker<T> make(F, options.seed, chunk);
    for (; begin < end; ++begin)
        if constexpr (has_two_arguments(F)) {
            const auto [x, y] = make.two();
            all.add(x, y);
        } else {
            all.add(make.argument());
        }
    return all.found;
}

report report_of(const std::vector<job>& jobs, const function_options& options,
                 std::uint64_t chunk) {
    auto one = jobs.begin();
    for (; chunk >= one->cases.count(); ++one) chunk -= one->cases.count();
    report found;
    with_function(one->function, [&]<elementary_function F>() {
        if (one->number == number_type::float_type)
            found.functions.push_back(compared<F, float>(*one, options, chunk));
        else if (one->number == number_type::double_type)
            found.functions.push_back(compared<F, double>(*one, options, chunk));
        else if constexpr (long_double_is_known<F>)
            found.functions.push_back(compared<F, long double>(*one, options, chunk));
    });
    return found;
}

}  // namespace

evidence evidence_of_functions(const function_options& options) {
    const std::vector<job> jobs = jobs_of(options);
    std::uint64_t chunks = 0;
    for (const job& one : jobs) chunks += one.cases.count();
    return with_mpfr(
        {.chunks = chunks,
         .report_of = [jobs,
                       options](std::uint64_t chunk) { return report_of(jobs, options, chunk); },
         .describe = [](report&) {}});
}

}  // namespace errbound::validation
