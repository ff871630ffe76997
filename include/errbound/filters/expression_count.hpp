// Counts an expression's operations at compile time: the maxima of several runs. There is one run
// for each sequence of signs that the expression may evaluate, up to a limit.
#pragma once

#include <array>
#include <compare>
#include <concepts>
#include <cstddef>
#include <errbound/sign.hpp>
#include <type_traits>

namespace errbound::filters {

struct expression_counts {
    int roundings = 0;  ///< that affect a sign (errbound/filters/static_filter.hpp)
    /// bits[d]: the bits of the longest number of degree d whose sign is evaluated; 0 if there is
    /// none.
    static constexpr int max_degree = 63;
    std::array<int, max_degree + 1> bits{};
    int degree = 0;        ///< highest degree of these numbers
    bool mixed = false;    ///< terms of different degree are added
    bool complete = true;  ///< all branches were seen
};

/// Not constexpr: an expression that calls it does not compile.
inline void too_many_signs() {}

struct counting_run {
    static constexpr int max_signs = 256;

    expression_counts counts;
    std::array<sign_type, max_signs> answers{};  ///< by default `negative`, the first of its type
    std::size_t evaluated = 0;
    int coordinate_bits = 0;
    bool lacks_coordinates = false;   ///< used a coordinate that the points do not have
    bool number_after_signs = false;  ///< evaluated signs and returned a number

    /// The next sequence of signs; false if there is none.
    constexpr bool advance() {
        while (evaluated > 0) {
            sign_type& last = answers[evaluated - 1];
            if (last != sign_type::positive) {
                last = last == sign_type::negative ? sign_type::zero : sign_type::positive;
                evaluated = 0;
                return true;
            }
            last = sign_type::negative;
            --evaluated;
        }
        return false;
    }
};

class expression_count {
  public:
    constexpr explicit expression_count(counting_run& run, int degree = 1)
        : run_(&run), bits_(run.coordinate_bits), degree_(degree) {}
    /// A whole number. Other types do not convert, since 0.5 would become 0.
    template <class X>
    requires std::is_arithmetic_v<X>
    constexpr expression_count(X) : bits_(32) {
        static_assert(
            std::same_as<X, int>,
            "errbound: constants in a predicate's expression must be int: for 0.5 * x multiply "
            "all the rest by 2, for 2.0 write 2, for a size_t static_cast<int>");
    }

    friend constexpr expression_count operator+(const expression_count& x,
                                                const expression_count& y) {
        const auto run = x.run_ != nullptr ? x.run_ : y.run_;
        // A separate case: compilers limit the number of statements, and the common case has fewer.
        if (x.degree_ == y.degree_)
            return {run, (x.bits_ < y.bits_ ? y.bits_ : x.bits_) + 1, x.degree_,
                    (x.roundings_ < y.roundings_ ? y.roundings_ : x.roundings_) + 1};
        run->counts.mixed = true;
        return {run, larger(x.raised(y), y.raised(x)) + 1, larger(x.degree_, y.degree_),
                larger(x.roundings_, y.roundings_) + 1};
    }
    friend constexpr expression_count operator-(const expression_count& x,
                                                const expression_count& y) {
        return x + y;
    }
    friend constexpr expression_count operator*(const expression_count& x,
                                                const expression_count& y) {
        return {x.run_ != nullptr ? x.run_ : y.run_, x.bits_ + y.bits_, x.degree_ + y.degree_,
                x.roundings_ + y.roundings_ + 1};
    }
    // Not available in expressions; each message names the replacement.
    template <class X>
    friend constexpr expression_count operator/(const expression_count& x, const X&) {
        static_assert(!sizeof(X),
                      "errbound: a predicate's expression has only +, - and *: multiply by the "
                      "divisor, and by its sign");
        return x;
    }
    template <class X>
    friend constexpr std::strong_ordering operator<=>(const expression_count&, const X&) {
        static_assert(!sizeof(X), "errbound: a predicate's expression compares by sign_of(a - b)");
        return std::strong_ordering::equal;
    }
    template <class X>
    friend constexpr bool operator==(const expression_count& x, const X& y) {
        return (x <=> y) == 0;
    }
    constexpr expression_count(const expression_count&) = default;
    expression_count& operator=(const expression_count&) = delete;
    template <class X>
    constexpr expression_count& operator=(X&&) {
        static_assert(!sizeof(X*),
                      "errbound: every result of a predicate's expression has its own type: "
                      "write const auto sum = a + b; and never =, += or *= afterwards");
        return *this;
    }
    template <class X>
    constexpr expression_count& operator+=(const X& x) {
        return *this = *this + x;
    }
    template <class X>
    constexpr expression_count& operator-=(const X& x) {
        return *this = *this - x;
    }
    template <class X>
    constexpr expression_count& operator*=(const X& x) {
        return *this = *this * x;
    }
    template <class X>
    requires std::is_arithmetic_v<X>
    constexpr explicit operator X() const {
        static_assert(!sizeof(X),
                      "errbound: a predicate's expression does not convert its numbers: keep them "
                      "as const auto, and branch on sign_of(x)");
        return X();
    }

    constexpr expression_count operator-() const { return {run_, bits_, degree_, roundings_}; }
    friend constexpr sign_type sign_of(const expression_count& x) {
        auto& run = *x.run_;
        const int roundings = x.roundings_ == 0 ? 0 : x.roundings_ - 1;
        run.counts.roundings = larger(run.counts.roundings, roundings);
        run.counts.degree = larger(run.counts.degree, x.degree_);
        if (x.degree_ <= expression_counts::max_degree) {
            int& bits = run.counts.bits[static_cast<std::size_t>(x.degree_)];
            bits = larger(bits, x.bits_);
        }
        if (run.evaluated == counting_run::max_signs) too_many_signs();
        return run.answers[run.evaluated++];
    }

  private:
    constexpr expression_count(counting_run* run, int bits, int degree, int roundings)
        : run_(run), bits_(bits), degree_(degree), roundings_(roundings) {}
    static constexpr int larger(int a, int b) { return a < b ? b : a; }
    constexpr int raised(const expression_count& other) const {
        return other.degree_ > degree_
                   ? bits_ + (other.degree_ - degree_) * other.run_->coordinate_bits
                   : bits_;
    }

    counting_run* run_ = nullptr;
    int bits_ = 0, degree_ = 0, roundings_ = 0;
};

struct expression_findings {
    expression_counts counts;
    bool lacks_coordinates, number_after_signs;
    bool has_one_answer = true;  ///< all runs so far gave the same answer
};

/// Enough for any expression that evaluates five signs.
inline constexpr int most_counting_runs = 250;
/// For expressions that branch too much but are declared homogeneous, so that only bits are
/// counted.
inline constexpr int few_counting_runs = 28;

/// `run(counting_run&)` runs the expression on counting coordinates and returns its answer's sign.
template <class Run>
constexpr expression_findings count_expression(int coordinate_bits, int max_runs, const Run& run) {
    counting_run state;
    state.coordinate_bits = coordinate_bits;
    const sign_type first = run(state);
    bool has_one_answer = true;
    for (int runs = 1; state.advance(); ++runs) {
        if (runs == max_runs) {
            state.counts.complete = false;
            break;
        }
        if (run(state) != first) has_one_answer = false;
    }
    return {state.counts, state.lacks_coordinates, state.number_after_signs, has_one_answer};
}

}  // namespace errbound::filters
