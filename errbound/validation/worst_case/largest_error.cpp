// Random inputs, then hill climbing by units in the last place.
#include "errbound/validation/worst_case/largest_error.hpp"

#include <gmp.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "errbound/validation/random_source.hpp"

namespace errbound::validation {
namespace {

using std::size_t;

constexpr mpfr_prec_t constant_precision = 512;

/// The result of an operation in T. Functions are the C library's, in T or float.
template <class T>
T computed(operation_kind kind, const T& a, const T& b, const T& c) {
    using traits = number_traits<T>;
    switch (kind) {
        case operation_kind::add:
            return a + b;
        case operation_kind::subtract:
            return a - b;
        case operation_kind::multiply:
            return a * b;
        case operation_kind::divide:
            return a / b;
        case operation_kind::negate:
            return -a;
        case operation_kind::root:
            return traits::sqrt(a);
        case operation_kind::absolute:
            return traits::abs(a);
        case operation_kind::lesser:
            return b < a ? b : a;
        case operation_kind::greater:
            return a < b ? b : a;
        case operation_kind::fused:
            return traits::fma(a, b, c);
        default:
            break;
    }
    using wide = detail::function_type<T>;
    return with_function(function_of(kind), [&]<elementary_function F>() {
        const auto x = static_cast<wide>(a);
        if constexpr (has_two_arguments(F))
            return T(detail::system_function<F>(x, static_cast<wide>(b)));
        else
            return T(detail::system_function<F>(x));
    });
}

/// Precondition: T holds x.
template <class T>
T from(long double x) {
    if constexpr (fits_double<T>)
        return static_cast<T>(static_cast<double>(x));
    else
        return static_cast<T>(x);
}

template <class T>
class evaluation {
  public:
    evaluation(const recording& f, std::vector<size_t> order, int digits, int min_exponent)
        : f_(f), order_(std::move(order)), values_(f.nodes.size()) {
        mpfr_number c(constant_precision);
        for (const std::string& text : f.constants) {
            set_constant(c.get(), text, MPFR_RNDN);
            constants_.push_back(from<T>(rounded_to(c.get(), digits, min_exponent)));
        }
    }
    /// The values of all nodes; input(k) is the k-th input.
    template <class Input>
    const std::vector<T>& operator()(const Input& input) {
        for (const size_t i : order_) {
            const auto& n = f_.nodes[i];
            const auto value = [&](size_t k) -> T& { return values_[k]; };
            switch (n.kind) {
                case recording::leaf::input:
                    value(i) = input(n.left);
                    break;
                case recording::leaf::constant:
                    value(i) = constants_[n.left];
                    break;
                default:
                    value(i) =
                        computed<T>(n.operation, value(n.left), value(n.right), value(n.third));
            }
        }
        return values_;
    }

  private:
    const recording& f_;
    std::vector<size_t> order_;
    std::vector<T> constants_, values_;
};

/// The exact result in MPFR.
class exact_evaluation {
  public:
    exact_evaluation(const recording& f)
        : f_(f), order_(nodes_of(f, {f.result})), values_(f.nodes.size(), ball(2)) {}

    const ball& operator()(const std::vector<double>& inputs, const std::vector<double>& offsets,
                           mpfr_prec_t precision) {
        mpfr_number c(precision);
        for (const size_t i : order_) {
            const auto& n = f_.nodes[i];
            ball& value = values_[i];
            value.restart(precision);
            if (n.kind == recording::leaf::input) {
                exact_value x(inputs[n.left]);
                x.rest[0] = offsets[n.left];
                value.set(x);
            } else if (n.kind == recording::leaf::constant) {
                value.set_rounded(
                    [&](mpfr_ptr to) { return set_constant(to, f_.constants[n.left], MPFR_RNDN); });
            } else {
                const auto operand = [&](size_t k) -> const ball& { return values_[k]; };
                set_result(value, {.kind = n.operation}, operand(n.left), operand(n.right),
                           operand(n.third));
            }
        }
        return values_[f_.result];
    }

  private:
    const recording& f_;
    std::vector<size_t> order_;
    std::vector<ball> values_;
};

/// Half the distance from x to the next number of T towards 0, reduced so that rounding is certain.
template <class T>
double half_spacing(double x) {
    using traits = number_traits<T>;
    int e = 0;
    const bool power = std::frexp(std::abs(x), &e) == 0.5;
    e = std::max(x == 0 ? traits::min_exponent : e, traits::min_exponent);
    return std::ldexp(1 - 0x1p-10, e - traits::digits - 1 - (power ? 1 : 0));
}

template <class T>
class search {
    using traits = number_traits<T>;
    /// Estimates need more bits than T has.
    static constexpr bool estimates = number_traits<long double>::digits >= traits::digits + 8;

  public:
    struct candidate {
        std::vector<double> inputs, offsets{};  ///< exact input = input + offset
        double error = -1;                      ///< estimated
    };

    explicit search(const recording& f)
        : f_(f),
          random_(f.options.seed),
          program_(f, nodes_of(f, {f.result}), traits::digits, traits::min_exponent),
          real_(f, nodes_of(f, compared(f)), number_traits<long double>::digits,
                number_traits<long double>::min_exponent),
          exact_(f) {}

    observed_error run(const std::vector<std::vector<input_range>>& boxes) {
        constexpr std::size_t kept = 8;
        const std::size_t tries = estimates ? f_.options.samples : f_.options.samples / 64;
        std::vector<candidate> best;
        for (std::size_t i = 0; i < tries / 4; ++i) {
            const auto& hot = boxes[random_.bits() % boxes.size()];
            candidate c = drawn(random_.one_in(2) ? hot : f_.inputs);
            if (!estimate(c)) continue;
            if (best.size() == kept && c.error <= best.back().error) continue;
            if (best.size() == kept) best.pop_back();
            best.insert(
                std::ranges::upper_bound(best, c.error, std::greater<>(), &candidate::error),
                std::move(c));
        }
        observed_error found;
        for (candidate& c : best) {
            for (std::size_t i = 0; i < tries * 3 / 4 / kept; ++i) {
                candidate next = moved(c);
                if (estimate(next) && next.error >= c.error) c = std::move(next);
            }
            const double error = measured(c);
            if (error >= found.at_least || found.where.empty()) {
                found.at_least = std::max(error, found.at_least);
                found.where = c.inputs;
            }
        }
        return found;
    }

    double measured(const candidate& c) {
        const T result = value_of(c);
        if (!traits::is_finite(result)) return 0;
        for (mpfr_prec_t precision = 192; precision <= 3072; precision *= 4) {
            const ball& exact = exact_(c.inputs, c.offsets, precision);
            if (!exact.is_defined()) return 0;
            if (exact.is_unknown()) continue;
            deviation d;
            d.compute(exactly(result), exact);
            if (d.is_zero()) return 0;
            if (!d.is_negligible()) return d.lower();
        }
        return 0;
    }

  private:
    static std::vector<size_t> compared(const recording& f) {
        std::vector<size_t> all{f.result};
        for (const auto& [left, right] : f.constraints) all.insert(all.end(), {left, right});
        return all;
    }
    double uniform() { return static_cast<double>(random_.bits() >> 11) * 0x1p-53; }

    candidate drawn(const std::vector<input_range>& box) {
        candidate c;
        for (const input_range& r : box) {
            const double t = random_.one_in(8) ? 0 : random_.one_in(8) ? 1 : uniform();
            c.inputs.push_back(in_format(r.lower + t * (r.upper - r.lower)));
        }
        set_offsets(c);
        return c;
    }
    /// The largest offsets, with random signs or the ones before.
    void set_offsets(candidate& c) {
        const bool keeps = !c.offsets.empty() && random_.one_in(2);
        c.offsets.resize(c.inputs.size(), 0);
        for (size_t k = 0; k < c.inputs.size(); ++k) {
            const double most = f_.inputs[k].error * (1 - 0x1p-10) +
                                (f_.options.round_inputs ? half_spacing<T>(c.inputs[k]) : 0);
            c.offsets[k] = (keeps ? c.offsets[k] >= 0 : random_.one_in(2)) ? most : -most;
        }
    }
    static double in_format(double x) { return static_cast<double>(static_cast<T>(x)); }
    /// Moves one or all inputs by a random power of two of units in the last place.
    candidate moved(const candidate& from) {
        candidate c = from;
        const size_t count = c.inputs.size();
        const size_t only = count == 0 ? 0 : random_.bits() % (2 * count);
        for (size_t k = 0; k < count; ++k) {
            if (only < count && k != only) continue;
            double& x = c.inputs[k];
            const int unit =
                std::max(x == 0 ? traits::min_exponent : std::ilogb(x) + 1, traits::min_exponent) -
                traits::digits;
            const double step = std::ldexp(1 + uniform(), unit + random_.below(traits::digits));
            x = in_format(random_.one_in(2) ? x + step : x - step);
        }
        set_offsets(c);
        return c;
    }
    T value_of(const candidate& c) {
        const auto input = [&](std::size_t k) { return static_cast<T>(c.inputs[k]); };
        return program_(input)[f_.result];
    }
    /// False if the inputs are not in the box, or the result is not finite.
    bool estimate(candidate& c) {
        for (std::size_t k = 0; k < c.inputs.size(); ++k) {
            const double x = c.inputs[k], off = c.offsets[k];
            const input_range& r = f_.inputs[k];
            if (!(x >= r.lower && x <= r.upper)) return false;
            if ((x == r.lower && off < 0) || (x == r.upper && off > 0)) c.offsets[k] = 0;
        }
        const T result = value_of(c);
        if (!traits::is_finite(result)) return false;
        const auto& real = real_(
            [&](std::size_t k) { return static_cast<long double>(c.inputs[k]) + c.offsets[k]; });
        for (const auto& [left, right] : f_.constraints)
            if (!(real[left] <= real[right])) return false;
        if constexpr (estimates)
            c.error =
                static_cast<double>(std::abs(static_cast<long double>(result) - real[f_.result]));
        else
            c.error = measured(c);
        return c.error >= 0;
    }

    const recording& f_;
    random_source random_;
    evaluation<T> program_;
    evaluation<long double> real_;
    exact_evaluation exact_;
};

}  // namespace

int set_constant(mpfr_ptr to, const std::string& text, mpfr_rnd_t direction) {
    const auto wrong = [&]() -> std::invalid_argument {
        return std::invalid_argument("constant is '" + text + "'; expected a number");
    };
    if (text == "PI") return mpfr_const_pi(to, direction);
    if (text == "LN2") return mpfr_const_log2(to, direction);
    if (text == "PI_2" || text == "PI_4") {
        const int off = mpfr_const_pi(to, direction);
        mpfr_div_2ui(to, to, text == "PI_2" ? 1 : 2, direction);
        return off;
    }
    const auto of = [&](mpfr_function f, double x) {
        MPFR_DECL_INIT(argument, 53);
        mpfr_set_d(argument, x, MPFR_RNDN);
        return f(to, argument, direction);
    };
    if (text == "E") return of(mpfr_exp, 1);
    if (text == "LN10") return of(mpfr_log, 10);
    if (text == "SQRT2") return of(mpfr_sqrt, 2);
    if (text == "SQRT1_2") return of(mpfr_sqrt, 0.5);
    if (text.find('/') != std::string::npos) {
        mpq_t q;
        mpq_init(q);
        const bool good =
            mpq_set_str(q, text[0] == '+' ? text.c_str() + 1 : text.c_str(), 10) == 0 &&
            mpz_sgn(mpq_denref(q)) != 0;
        int off = 0;
        if (good) {
            mpq_canonicalize(q);
            off = mpfr_set_q(to, q, direction);
        }
        mpq_clear(q);
        if (!good) throw wrong();
        return off;
    }
    char* end = nullptr;
    const bool hexadecimal = text.find('x') != std::string::npos;
    const int off = mpfr_strtofr(to, text.c_str(), &end, hexadecimal ? 16 : 10, direction);
    if (text.empty() || *end != '\0' || mpfr_number_p(to) == 0) throw wrong();
    return off;
}

long double rounded_to(mpfr_srcptr x, int digits, int min_exponent) {
    if (mpfr_regular_p(x) == 0) return mpfr_get_ld(x, MPFR_RNDN);
    const mpfr_exp_t unit = std::max<mpfr_exp_t>(mpfr_get_exp(x), min_exponent) - digits;
    mpfr_number r(mpfr_get_prec(x));
    mpfr_mul_2si(r.get(), x, -unit, MPFR_RNDN);
    mpfr_rint(r.get(), r.get(), MPFR_RNDN);
    mpfr_mul_2si(r.get(), r.get(), unit, MPFR_RNDN);
    return mpfr_get_ld(r.get(), MPFR_RNDN);
}

std::vector<size_t> nodes_of(const recording& f, const std::vector<size_t>& results) {
    std::vector<bool> used(f.nodes.size());
    for (const size_t r : results) used[r] = true;
    for (std::size_t i = f.nodes.size(); i-- > 0;) {
        const auto& n = f.nodes[i];
        if (!used[i] || n.kind != recording::leaf::none) continue;
        for (const size_t k : {n.left, n.right, n.third}) used[k] = true;
    }
    std::vector<size_t> order;
    for (std::size_t i = 0; i < used.size(); ++i)
        if (used[i]) order.push_back(i);
    return order;
}

observed_error largest_error(const recording& f,
                             const std::vector<std::vector<input_range>>& boxes) {
    const exponents range = exponents::widest();
    return with_number_type(f.type, [&]<class T>() {
        observed_error found;
        if constexpr (fits_double<T> || std::same_as<T, long double>)
            found = search<T>(f).run(boxes);
        return found;
    });
}

double error_at(const recording& f, const std::vector<double>& inputs,
                const std::vector<double>& offsets) {
    const exponents range = exponents::widest();
    return with_number_type(f.type, [&]<class T>() {
        double error = 0;
        if constexpr (fits_double<T> || std::same_as<T, long double>)
            error = search<T>(f).measured({inputs, offsets});
        return error;
    });
}

}  // namespace errbound::validation
