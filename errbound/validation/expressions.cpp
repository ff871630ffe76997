// Random expressions under every rule against one reference.
#include <algorithm>
#include <errbound/validation/findings.hpp>
#include <errbound/validation/validation.hpp>
#include <map>
#include <utility>

#include "errbound/validation/chunks.hpp"
#include "errbound/validation/minimise.hpp"

namespace errbound::validation {
namespace {

/// The third precision holds every sum of doubles, the last every sum of long doubles and
/// binary128.
constexpr std::array<mpfr_prec_t, 5> precisions{192, 768, 3072, 12288, 49152};
/// Errors are distinguished from zero up to this precision; promises use higher ones, too.
constexpr mpfr_prec_t precision_for_errors = 3072;
/// At higher precisions, only sums and products are evaluated: other operations are exact in no
/// precision.
constexpr mpfr_prec_t precision_for_functions = 12288;
constexpr std::uint64_t least_chunk = 1000;

void evaluate(const rule& r, number_type type, const expression& e, claim* claims) {
    r.evaluate[static_cast<std::size_t>(type)](e, claims);
}

/// Exact values of one expression, and the deviations of the computed ones.
class reference {
  public:
    reference() : values_(expression::max_values, ball(precisions[0])), off_(values_.size()) {}

    void compute(const expression& e, mpfr_prec_t precision, const claim* computed) {
        for (std::size_t n = 0; n < e.size(); ++n)
            if (mpfr_get_prec(values_[n].middle()) != precision) values_[n].restart(precision);
        validation::evaluate(e, values_.data());
        measure(e, computed, nullptr);
    }
    /// Computes deviations, except for values equal to those of `before` (another rule's claims).
    /// Rules mostly have equal values, but atan2 turns zeros of different signs into π and −π.
    void measure(const expression& e, const claim* computed, const claim* before) {
        for (std::size_t n = 0; n < e.size(); ++n) {
            const bool known = before && before[n].value == computed[n].value;
            // If one input is far smaller, no precision separates it from its exact value.
            if (n < e.input_count && e.inputs[n].value == computed[n].value)
                off_[n].set(e.inputs[n].error, e.inputs[n].quarters);
            else if (!known && computed[n].value.is_finite() && values_[n].is_defined())
                off_[n].compute(computed[n].value, values_[n]);
        }
    }
    const ball& value(std::size_t n) const { return values_[n]; }
    const deviation& off(std::size_t n) const { return off_[n]; }

    /// If false, an operand has no exact value, and the result is not checked.
    bool operands_defined(const expression& e, std::size_t n) const {
        if (n < e.input_count) return true;
        const expression_operation& o = e.operations[n - e.input_count];
        return values_[o.left].is_defined() && (!o.has_right() || values_[o.right].is_defined()) &&
               (!o.has_third() || values_[o.third].is_defined());
    }
    /// True if every error is zero or has a known size.
    bool has_all_errors(const expression& e, const claim* computed) const {
        for (std::size_t n = e.input_count; n < e.size(); ++n)
            if (computed[n].value.is_finite() && values_[n].is_defined() && !off_[n].is_zero() &&
                off_[n].is_negligible())
                return false;
        return true;
    }
    finding finding_at(const expression& e, std::size_t n, const claim& c) const {
        return operands_defined(e, n) ? compare(c, values_[n], off_[n]) : finding::holds;
    }

  private:
    std::vector<ball> values_;
    std::vector<deviation> off_;
};

struct tally {
    std::uint64_t expressions = 0, values = 0, violations = 0, undetermined = 0;
    std::array<distribution, operation_kinds> log10;
    std::vector<std::uint64_t> violating;  ///< indices of the first violating expressions
};

struct examination {
    reference exact;
    std::vector<std::array<claim, expression::max_values>> claims;  // one per rule
    std::map<number_type, std::vector<tally>> tallies;              // one per rule

    void check(std::span<const rule> rules, const expression& e, number_type type,
               std::uint64_t index) {
        const bool divides = e.divides();
        const auto left_out = [&](const rule& r) {
            return !r.supports(type) || (divides && !r.has_division);
        };
        claims.resize(rules.size());
        const claim* computed = nullptr;  // claims whose errors `exact` has
        for (std::size_t k = 0; k < rules.size(); ++k) {
            if (left_out(rules[k])) continue;
            evaluate(rules[k], type, e, claims[k].data());
            if (!computed) computed = claims[k].data();
        }
        if (!computed) return;
        const auto measure = [&](std::size_t k) {
            exact.measure(e, claims[k].data(), std::exchange(computed, claims[k].data()));
        };
        for (const mpfr_prec_t precision : precisions) {
            if (precision > precision_for_functions && !e.is_polynomial()) break;
            exact.compute(e, precision, computed);
            const auto undetermined = [&](std::size_t k) {
                if (left_out(rules[k]) || !rules[k].promises()) return false;
                measure(k);
                for (std::size_t n = 0; n < e.size(); ++n)
                    if (exact.finding_at(e, n, claims[k][n]) == finding::undetermined) return true;
                return false;
            };
            bool more = precision < precision_for_errors && !exact.has_all_errors(e, computed);
            for (std::size_t k = 0; k < rules.size() && !more; ++k) more = undetermined(k);
            if (!more) break;
        }
        auto& of_type = tallies[type];
        of_type.resize(rules.size());
        for (std::size_t k = 0; k < rules.size(); ++k) {
            if (left_out(rules[k])) continue;
            measure(k);
            count(rules[k], e, claims[k].data(), of_type[k], index);
        }
    }

    void count(const rule& r, const expression& e, const claim* c, tally& to,
               std::uint64_t index) const {
        ++to.expressions;
        bool violated = false;
        for (std::size_t n = 0; n < e.size(); ++n) {
            if (!exact.operands_defined(e, n)) continue;
            ++to.values;
            const finding f = r.promises() ? exact.finding_at(e, n, c[n]) : finding::holds;
            if (is_violation(f)) {
                ++to.violations;
                violated = true;
            } else if (f == finding::undetermined) {
                ++to.undetermined;
            } else if (n >= e.input_count) {
                const auto kind = e.operations[n - e.input_count].kind;
                add_ratio(to.log10[static_cast<std::size_t>(kind)], r.error_is, c[n],
                          exact.value(n), exact.off(n));
            }
        }
        if (violated && to.violating.size() < report::kept_violations)
            to.violating.push_back(index);
    }
};

/// Describes a violation by the smallest expression that shows it.
void describe(violation& to, const rule& r, number_type type, const expression& e) {
    reference exact;
    std::array<claim, expression::max_values> claims;
    const auto finding_of = [&](const expression& tried, std::size_t n) {
        finding f = finding::undetermined;
        for (std::size_t i = 0; i < precisions.size() && f == finding::undetermined; ++i) {
            exact.compute(tried, precisions[i], claims.data());
            f = exact.finding_at(tried, n, claims[n]);
        }
        return f;
    };
    const auto search = [&](const expression& tried) -> std::optional<std::size_t> {
        evaluate(r, type, tried, claims.data());
        for (std::size_t n = 0; n < tried.size(); ++n)
            if (is_violation(finding_of(tried, n))) return n;
        return std::nullopt;
    };
    const expression small = minimised(e, type, search);
    const std::size_t last = search(small).value();
    const finding f = finding_of(small, last);
    to.what = sentence(f, claims[last], exact.value(last), exact.off(last));
    to.code = cpp_text(small, type, r.name);
}

struct study {
    std::vector<rule> rules;
    expression_options options;

    /// The number of indices that hold n expressions for rules without division, which skip every
    /// fourth index.
    static std::uint64_t indices(std::uint64_t n) { return n + (n + 2) / 3; }
    std::uint64_t first() const { return indices(options.first); }
    chunks expressions() const {
        return {indices(options.first + options.expressions) - first(), least_chunk};
    }
    expression at(std::uint64_t index, number_type type) const {
        return random_expression(options.seed, index, type,
                                 std::clamp(options.operations, 1, max_operations));
    }

    report report_of(std::uint64_t chunk) const {
        examination found;
        const auto [begin, end] = expressions().of(chunk);
        for (std::uint64_t index = first() + begin; index < first() + end; ++index)
            for (const number_type type : options.numbers)
                found.check(rules, at(index, type), type, index);
        report result;
        for (std::size_t k = 0; k < rules.size(); ++k)
            for (const number_type type : options.numbers) {
                if (!rules[k].supports(type)) continue;
                auto& of_type = found.tallies[type];
                of_type.resize(rules.size());
                add(result, rules[k], name_of(type), of_type[k]);
            }
        return result;
    }

    static void add(report& to, const rule& r, std::string_view number_name, const tally& found) {
        const std::string name(r.name), number(number_name);
        to.counts.push_back(
            {name, number, found.expressions, found.values, found.violations, found.undetermined});
        for (std::size_t i = 0; i < operation_kinds; ++i)
            if (found.log10[i].count() > 0)
                to.distributions.push_back(
                    {name, number, std::string(name_of(static_cast<operation_kind>(i))),
                     std::string(measure_of(r.error_is)), found.log10[i], r.claimed_rate});
        for (const std::uint64_t index : found.violating)
            to.violations.push_back({name, number, index, {}, {}});
    }

    void describe_all(report& found) const {
        for (violation& v : found.violations) {
            const auto by_rule = [&v](const rule& r) { return r.name == v.rule; };
            const number_type type =
                std::ranges::find(number_types, v.number, &named_number_type::name)->type;
            describe(v, *std::ranges::find_if(rules, by_rule), type, at(v.index, type));
        }
    }
};

}  // namespace

evidence evidence_of_expressions(std::span<const rule> rules, const expression_options& options) {
    const study s{{rules.begin(), rules.end()}, options};
    return with_mpfr({.chunks = s.expressions().count(),
                      .report_of = [s](std::uint64_t chunk) { return s.report_of(chunk); },
                      .describe = [s](report& found) { s.describe_all(found); }});
}

report validate_expressions(std::span<const rule> rules, const expression_options& options,
                            const progress& show) {
    return examine(evidence_of_expressions(rules, options), options.threads, show);
}

}  // namespace errbound::validation
