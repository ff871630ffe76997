// Recorded computations, evaluated in a number format, in MPFR and under bound rules. Internal.
#pragma once

#include <cmath>
#include <concepts>
#include <errbound/validation/ball.hpp>
#include <errbound/validation/findings.hpp>
#include <errbound/validation/rule.hpp>
#include <string>
#include <utility>
#include <vector>

#include "errbound/validation/worst_case/largest_error.hpp"
#include "errbound/validation/worst_case/number_format.hpp"

namespace errbound::validation {

inline constexpr mpfr_prec_t constant_precision = 512;

/// Precondition: T holds x.
template <class T>
T from(long double x) {
    if constexpr (fits_double<T>)
        return static_cast<T>(static_cast<double>(x));
    else
        return static_cast<T>(x);
}

template <class T>
class format_evaluation {
  public:
    using number = tracked<T, none>;

    format_evaluation(const recording& f, std::vector<size_t> order, int digits, int min_exponent)
        : f_(f), order_(std::move(order)), values_(f.nodes.size()) {
        mpfr_number c(constant_precision);
        for (const std::string& text : f.constants) {
            set_constant(c.get(), text, MPFR_RNDN);
            constants_.emplace_back(from<T>(rounded_to(c.get(), digits, min_exponent)));
        }
    }
    /// The values of all nodes; input(k) is the k-th input.
    template <class Input>
    const std::vector<number>& operator()(const Input& input) {
        for (const size_t i : order_) {
            const auto& n = f_.nodes[i];
            if (n.kind == recording::leaf::input) {
                values_[i] = input(n.left);
            } else if (n.kind == recording::leaf::constant) {
                values_[i] = constants_[n.left];
            } else {
                const number operands[]{values_[n.left], values_[n.right], values_[n.third]};
                values_[i] = applied({n.operation, 0, 1, 2}, operands);
            }
        }
        return values_;
    }

  private:
    const recording& f_;
    std::vector<size_t> order_;
    std::vector<number> constants_, values_;
};

/// The exact result in MPFR.
class exact_evaluation {
  public:
    explicit exact_evaluation(const recording& f)
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

/// The computation as a program for bound rules, and its exact result. Inputs that are rounded, and
/// constants that the format does not have, are known to within their errors.
class rule_check {
  public:
    explicit rule_check(const recording& f);

    /// False if the rule lacks the format or an operation.
    bool applies(const rule& r) const {
        return fits_ && r.supports(f_.type) && (r.has_division || !divides_);
    }
    /// The rule's result. Precondition: applies(r), and the inputs are numbers of the format.
    const claim& evaluate(const rule& r, const std::vector<double>& inputs);
    /// Compares such a result with the exact one. Adds the measure of the rule to `ratios`, if
    /// given.
    finding compare(const rule& r, const claim& c, const std::vector<double>& inputs,
                    const std::vector<double>& offsets, distribution* ratios = nullptr);

  private:
    const recording& f_;
    number_format format_;
    std::vector<expression_input> leaves_;
    std::vector<size_t> inputs_;  ///< input_[k]: the input that is leaf k, or none
    std::vector<expression_operation> operations_;
    std::vector<claim> claims_;
    size_t result_ = 0;  ///< index in claims_
    bool fits_ = true, divides_ = false;
    exact_evaluation exact_;
};

}  // namespace errbound::validation
