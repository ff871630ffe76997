// What an expression asks of the stages of a predicate, found at compile time by running it on a
// scalar that counts.
//
// An expression may branch on signs. Then it is run once for each sequence of signs that it can be
// given, up to `max_runs`; the counts are the largest of all.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <errbound/sign.hpp>

namespace errbound::filters {

struct expression_counts {
    int roundings = 0;  ///< that bear on a sign: errbound/filters/static_filter.hpp
    /// Of the longest number of each degree whose sign is asked, for the coordinates' bits given;
    /// 0: none.
    static constexpr int max_degree = 63;
    std::array<int, max_degree + 1> bits{};
    int degree = 0;        ///< the highest of these numbers
    bool mixed = false;    ///< terms of different degree are added
    bool complete = true;  ///< all branches were seen
};

/// Not for constant expressions: an expression that gets to one of them does not compile.
inline void degree_that_is_too_high() {}
inline void too_many_signs() {}

/// One run: the signs that it asks for, and the answers that it gets.
struct counting_run {
    static constexpr std::size_t max_signs = 256;

    expression_counts counts;
    std::array<sign_type, max_signs> answers{};  ///< by default `negative`, the first of its type
    std::size_t asked = 0;
    int coordinate_bits = 0;

    /// The next sequence of signs; false if there is none.
    constexpr bool advance() {
        while (asked > 0) {
            sign_type& last = answers[asked - 1];
            if (last != sign_type::positive) {
                last = last == sign_type::negative ? sign_type::zero : sign_type::positive;
                asked = 0;
                return true;
            }
            last = sign_type::negative;
            --asked;
        }
        return false;
    }
};

class expression_count {
  public:
    /// A coordinate.
    constexpr explicit expression_count(counting_run& run)
        : run_(&run), bits_(run.coordinate_bits), degree_(1) {}
    /// A whole number in the expression. No other type: 0.5 would become 0.
    constexpr expression_count(std::same_as<int> auto) : bits_(32) {}

    friend constexpr expression_count operator+(const expression_count& x,
                                                const expression_count& y) {
        const auto run = x.run_ != nullptr ? x.run_ : y.run_;
        if (x.degree_ != y.degree_) run->counts.mixed = true;
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
    template <class X>
    friend constexpr expression_count operator/(const expression_count& x, const X&) {
        static_assert(!sizeof(X),
                      "errbound: a predicate's expression has only +, - and *: multiply by what "
                      "you would divide by, and by its sign");
        return x;
    }
    template <class X>
    friend constexpr bool operator<(const expression_count&, const X&) {
        static_assert(!sizeof(X), "errbound: a predicate's expression compares by sign_of(a - b)");
        return false;
    }
    template <class X>
    friend constexpr bool operator>(const expression_count& x, const X& y) {
        return x < y;
    }
    constexpr expression_count operator-() const { return {run_, bits_, degree_, roundings_}; }
    friend constexpr sign_type sign_of(const expression_count& x) {
        auto& run = *x.run_;
        const int roundings = x.roundings_ == 0 ? 0 : x.roundings_ - 1;
        run.counts.roundings = larger(run.counts.roundings, roundings);
        if (x.degree_ > expression_counts::max_degree) degree_that_is_too_high();
        int& bits = run.counts.bits[static_cast<std::size_t>(x.degree_)];
        bits = larger(bits, x.bits_);
        run.counts.degree = larger(run.counts.degree, x.degree_);
        if (run.asked == counting_run::max_signs) too_many_signs();
        return run.answers[run.asked++];
    }

  private:
    constexpr expression_count(counting_run* run, int bits, int degree, int roundings)
        : run_(run), bits_(bits), degree_(degree), roundings_(roundings) {}
    static constexpr int larger(int a, int b) { return a < b ? b : a; }
    /// The bits, brought to another's degree where that is higher.
    constexpr int raised(const expression_count& other) const {
        return other.degree_ > degree_
                   ? bits_ + (other.degree_ - degree_) * other.run_->coordinate_bits
                   : bits_;
    }

    counting_run* run_ = nullptr;
    int bits_ = 0, degree_ = 0, roundings_ = 0;
};

/// `run(counting_run&)` runs the expression, whose coordinates are made of that argument,
/// and asks for its sign if it does not end in one.
template <class Run>
constexpr expression_counts count_expression(int coordinate_bits, const Run& run) {
    constexpr int max_runs = 250;
    counting_run state;
    state.coordinate_bits = coordinate_bits;
    for (int i = 0; i < max_runs; ++i) {
        run(state);
        if (!state.advance()) return state.counts;
    }
    state.counts.complete = false;
    return state.counts;
}

}  // namespace errbound::filters
