// A tracked number with its exact value: every operation is done in both and compared. It replaces
// the scalar in the library's templates and follows its signs, so it validates the code as used.
#pragma once

#include <cstdint>
#include <errbound/bernstein.hpp>
#include <errbound/tracked.hpp>
#include <errbound/validation/distribution.hpp>
#include <errbound/validation/findings.hpp>
#include <errbound/validation/rule_list.hpp>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace errbound::validation {

/// Collects the shadowed operations of one thread, at one precision.
class shadow_session {
  public:
    explicit shadow_session(mpfr_prec_t precision) : precision_(precision), outer_(current_) {
        current_ = this;
    }
    ~shadow_session() { current_ = outer_; }
    shadow_session(const shadow_session&) = delete;
    shadow_session& operator=(const shadow_session&) = delete;

    static shadow_session& current() { return *current_; }
    mpfr_prec_t precision() const { return precision_; }

    /// Compares a result; `how` describes its operands on demand.
    template <class Describe>
    void check(const claim& c, const ball& x, const Describe& how) {
        ++values_;
        if (c.value.is_finite() && x.is_defined()) off_.compute(c.value, x);
        const finding f = compare(c, x, off_);
        if (f == finding::undetermined) ++undetermined_;
        if (!is_violation(f)) return;
        if (violations_++ == 0) first_ = {sentence(f, c, x, off_), how()};
    }
    /// A named quantity, for its tightness.
    void note(std::string_view quantity, const claim& c, const ball& x, error_meaning meaning);

    struct described {
        std::string what, operation;
    };
    std::uint64_t values() const { return values_; }
    std::uint64_t violations() const { return violations_; }
    std::uint64_t undetermined() const { return undetermined_; }
    const described& first_violation() const { return first_; }
    const std::map<std::string, distribution, std::less<>>& quantities() const {
        return quantities_;
    }

  private:
    inline static thread_local shadow_session* current_ = nullptr;

    mpfr_prec_t precision_;
    shadow_session* outer_;
    deviation off_;
    std::uint64_t values_ = 0, violations_ = 0, undetermined_ = 0;
    described first_;
    std::map<std::string, distribution, std::less<>> quantities_;
};

/// Requires a shadow_session on the thread.
template <class Rule>
class shadowed {
  public:
    using value_type = double;
    using number = tracked<double, Rule>;

    shadowed() : exact_(shadow_session::current().precision()) {}
    shadowed(double value) : shadowed(number(value)) { exact_.set(value); }
    shadowed(int value) : shadowed(static_cast<double>(value)) {}

    const double& value() const { return number_.value(); }
    double error() const { return number_.error(); }
    const ball& exact() const { return exact_; }
    claim claimed() const { return {number_.value(), number_.error(), sign_of(number_)}; }

    friend shadowed operator+(const shadowed& a, const shadowed& b) {
        shadowed r(a.number_ + b.number_);
        r.exact_.set_sum(a.exact_, b.exact_);
        return r.checked("+", a, &b);
    }
    friend shadowed operator-(const shadowed& a, const shadowed& b) {
        shadowed r(a.number_ - b.number_);
        r.exact_.set_difference(a.exact_, b.exact_);
        return r.checked("-", a, &b);
    }
    friend shadowed operator*(const shadowed& a, const shadowed& b) {
        shadowed r(a.number_ * b.number_);
        r.exact_.set_product(a.exact_, b.exact_);
        return r.checked("*", a, &b);
    }
    shadowed operator-() const {
        shadowed r(-number_);
        r.exact_.set_negative(exact_);
        return r;
    }
    friend shadowed scale(const shadowed& a, int e) {
        shadowed r(scale(a.number_, e));
        r.exact_.set_scaled(a.exact_, e);
        return r.checked("scale", a, nullptr, e);
    }
    friend sign_type sign_of(const shadowed& x) { return sign_of(x.number_); }

  private:
    explicit shadowed(const number& x)
        : number_(x), exact_(shadow_session::current().precision()) {}

    std::string text() const {
        return hexadecimal(value()) + " known to within " + hexadecimal(error());
    }
    shadowed& checked(const char* operation, const shadowed& a, const shadowed* b, int e = 0) {
        if constexpr (promises_bound<Rule>)
            shadow_session::current().check(claimed(), exact_, [&] {
                return std::string(operation) + " of " + a.text() + " and " +
                       (b ? b->text() : std::to_string(e));
            });
        return *this;
    }

    number number_;
    ball exact_;
};

}  // namespace errbound::validation

namespace errbound {
/// So that `normalized` (errbound/bernstein.hpp) scales shadowed numbers as tracked ones.
template <class Rule>
inline constexpr bool is_tracked<validation::shadowed<Rule>> = true;
}  // namespace errbound
