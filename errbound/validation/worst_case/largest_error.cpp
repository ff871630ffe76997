// Random inputs, then hill climbing by units in the last place.
#include "errbound/validation/worst_case/largest_error.hpp"

#include <gmp.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "errbound/validation/random_source.hpp"
#include "errbound/validation/worst_case/evaluation.hpp"

namespace errbound::validation {
namespace {

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
        observed_error found;
        const auto add = [&](const candidate& c) {
            const double error = measured(c);
            if (error < found.at_least && !found.where.empty()) return;
            found.at_least = std::max(error, found.at_least);
            found.where = c.inputs;
            found.offsets = c.offsets;
        };
        const auto size = [&](const candidate& c, const T& computed, long double real) {
            if constexpr (estimates)
                return static_cast<double>(std::abs(static_cast<long double>(computed) - real));
            else
                return measured(c);
        };
        const std::size_t tries = estimates ? f_.options.samples : f_.options.samples / 64;
        for (const candidate& c : climbed(boxes, tries, size)) add(c);
        for (std::size_t i = 0; i < f_.options.measured; ++i)
            if (candidate c = drawn(f_.inputs); estimate(c, size)) add(c);
        return found;
    }

    /// The largest error() that the search finds. Compares with the exact result there.
    rule_bound run(const rule& r, const std::vector<std::vector<input_range>>& boxes,
                   const observed_error& worst) {
        rule_check check(f_);
        rule_bound found{std::string(r.name), infinity};
        if (!check.applies(r)) return found;
        const auto size = [&](const candidate& c, const T&, long double) {
            return rounded_up(check.evaluate(r, c.inputs).error);
        };
        found.largest = 0;
        const auto add = [&](const candidate& c) {
            const claim claimed = check.evaluate(r, c.inputs);
            found.largest = std::max(found.largest, rounded_up(claimed.error));
            found.broken += is_violation(check.compare(r, claimed, c.inputs, c.offsets));
        };
        for (const candidate& c : climbed(boxes, f_.options.samples / 10, size)) add(c);
        if (worst.where.size() == f_.inputs.size()) add({worst.where, worst.offsets});
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
    static double rounded_up(const exact_value& x) {
        if (!(x.leading >= 0)) return infinity;
        const double sum = std::ldexp(x.leading, x.exponent);
        return x.is_double() ? sum : sum * (1 + 0x1p-50) + doubles_underflow;
    }
    /// Inputs of large `size(candidate, computed, real)`, the largest first.
    template <class Size>
    std::vector<candidate> climbed(const std::vector<std::vector<input_range>>& boxes,
                                   std::size_t tries, const Size& size) {
        constexpr std::size_t kept = 8;
        std::vector<candidate> best;
        for (std::size_t i = 0; i < tries / 4; ++i) {
            const auto& hot = boxes[random_.bits() % boxes.size()];
            candidate c = drawn(random_.one_in(2) ? hot : f_.inputs);
            if (!estimate(c, size)) continue;
            if (best.size() == kept && c.error <= best.back().error) continue;
            if (best.size() == kept) best.pop_back();
            best.insert(
                std::ranges::upper_bound(best, c.error, std::greater<>(), &candidate::error),
                std::move(c));
        }
        for (candidate& c : best)
            for (std::size_t i = 0; i < tries * 3 / 4 / kept; ++i) {
                candidate next = moved(c);
                if (estimate(next, size) && next.error >= c.error) c = std::move(next);
            }
        return best;
    }
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
        return program_(input)[f_.result].value();
    }
    /// Sets the error to the size. False if the inputs are not in the box, or the result is not
    /// finite.
    template <class Size>
    bool estimate(candidate& c, const Size& size) {
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
            if (!(real[left].value() <= real[right].value())) return false;
        c.error = size(c, result, real[f_.result].value());
        return c.error >= 0;
    }

    const recording& f_;
    random_source random_;
    format_evaluation<T> program_;
    format_evaluation<long double> real_;
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

rule_check::rule_check(const recording& f)
    : f_(f),
      format_(with_number_type(f.type, []<class T>() { return number_format::of<T>(0); })),
      exact_(f) {
    std::vector<expression_operation::index> index(f.nodes.size());
    const std::vector<size_t> order = nodes_of(f, {f.result});
    fits_ = order.size() <= std::numeric_limits<expression_operation::index>::max();
    mpfr_number precise(constant_precision), off(53);
    for (const size_t i : order) {
        const recording::node& n = f.nodes[i];
        if (n.kind == recording::leaf::none) continue;
        index[i] = static_cast<expression_operation::index>(leaves_.size());
        inputs_.push_back(n.kind == recording::leaf::input ? n.left : f.inputs.size());
        expression_input& leaf = leaves_.emplace_back();
        if (n.kind == recording::leaf::input) continue;
        const int ternary = set_constant(precise.get(), f.constants[n.left], MPFR_RNDN);
        const long double c = rounded_to(precise.get(), format_.digits, format_.min_exponent);
        leaf.value = exactly(c);
        MPFR_DECL_INIT(rounded, 64);
        mpfr_set_ld(rounded, c, MPFR_RNDN);
        mpfr_sub(off.get(), rounded, precise.get(), MPFR_RNDA);
        double error = std::abs(mpfr_get_d(off.get(), MPFR_RNDA));
        if (ternary != 0)
            error = error * (1 + 0x1p-50) + std::ldexp(std::abs(static_cast<double>(c)), -500) +
                    doubles_underflow;
        leaf.error = format_.rounded_up(error);
    }
    for (const size_t i : order) {
        const recording::node& n = f.nodes[i];
        if (n.kind != recording::leaf::none) continue;
        index[i] = static_cast<expression_operation::index>(leaves_.size() + operations_.size());
        operations_.push_back({n.operation, index[n.left], index[n.right], index[n.third]});
        divides_ |= n.operation == operation_kind::divide;
    }
    claims_.resize(order.size());
    result_ = index[f.result];
}

const claim& rule_check::evaluate(const rule& r, const std::vector<double>& inputs) {
    for (size_t i = 0; i < leaves_.size(); ++i) {
        const size_t k = inputs_[i];
        if (k == inputs.size()) continue;
        leaves_[i].value = inputs[k];
        double error = f_.inputs[k].error;
        if (f_.options.round_inputs) error += format_.half_ulp_beyond(inputs[k]);
        leaves_[i].error = format_.rounded_up(error);
    }
    r.evaluate[static_cast<size_t>(f_.type)]({leaves_, operations_}, claims_.data());
    return claims_[result_];
}

finding rule_check::compare(const rule& r, const claim& c, const std::vector<double>& inputs,
                            const std::vector<double>& offsets, distribution* ratios) {
    const exponents widest = exponents::widest();
    for (mpfr_prec_t precision = 192;; precision *= 4) {
        const ball& exact = exact_(inputs, offsets, precision);
        deviation off;
        if (c.value.is_finite() && exact.is_defined()) off.compute(c.value, exact);
        const finding f = validation::compare(c, exact, off);
        const bool decided = f != finding::undetermined && (off.is_zero() || !off.is_negligible());
        if (!decided && precision < 20'000) continue;
        if (ratios != nullptr && exact.is_defined() && c.value.is_finite())
            add_ratio(*ratios, r.error_is, c, exact, off);
        return f;
    }
}

template <class Result, class... Arguments>
Result searched(const recording& f, const Arguments&... arguments) {
    const exponents widest = exponents::widest();
    return with_number_type(f.type, [&]<class T>() {
        Result found;
        if constexpr (fits_double<T> || std::same_as<T, long double>)
            found = search<T>(f).run(arguments...);
        return found;
    });
}

observed_error largest_error(const recording& f,
                             const std::vector<std::vector<input_range>>& boxes) {
    return searched<observed_error>(f, boxes);
}
rule_bound largest_bound(const recording& f, const rule& r,
                         const std::vector<std::vector<input_range>>& boxes,
                         const observed_error& worst) {
    return searched<rule_bound>(f, r, boxes, worst);
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
