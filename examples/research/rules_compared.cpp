// An experiment: the ratio of bounds to errors in dot products, also by a custom rule that
// estimates.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <errbound/rules/derived.hpp>
#include <errbound/validation/rule_list.hpp>
#include <random>
#include <vector>

// An estimate for independent errors of mean zero: it adds squares, where `sharp` adds sizes
// (Higham, Mary 2019). For errors uniform within their bounds, it is √3 standard deviations.
struct probable : errbound::derived_rule<probable, errbound::sharp> {
    static constexpr const char* name = "probable";
    static constexpr errbound::error_meaning error_is = errbound::error_meaning::estimate;

    template <class T>
    using operand = errbound::rule_operand<T, probable>;
    template <class T>
    static bound<T> add(const T& v, operand<T> a, operand<T> b) {
        return root_of_squares<T>(v, a.bound.error, b.bound.error);
    }
    template <class T>
    static bound<T> subtract(const T& v, operand<T> a, operand<T> b) {
        return add<T>(v, a, b);
    }
    template <class T>
    static bound<T> multiply(const T& v, operand<T> a, operand<T> b) {
        return root_of_squares<T>(v, a.value * b.bound.error, b.value * a.bound.error);
    }

  private:
    template <class T>
    static bound<T> root_of_squares(const T& v, const T& x, const T& y) {
        using traits = errbound::number_traits<T>;
        const T own = v * traits::unit_roundoff();
        return {traits::sqrt(own * own + (x * x + y * y))};
    }
};

template <class Number>
Number dot(const std::vector<float>& x, const std::vector<float>& y) {
    Number sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i) sum += Number(x[i]) * Number(y[i]);
    return sum;
}

double median(std::vector<double> x) {
    std::sort(x.begin(), x.end());
    return x[x.size() / 2];
}

std::vector<float> drawn(std::size_t n, std::mt19937_64& random) {
    std::vector<float> x(n);
    for (float& y : x) y = std::ldexp(static_cast<float>(random() >> 40) - 0x1p23F, -23);
    return x;
}

// Prints the median of bound / error for dot products of n terms, and the percentage of bounds that
// are not less than the error. True if the rule keeps its guarantee.
template <class Rule>
bool show(std::size_t n) {
    std::mt19937_64 random(1);
    std::vector<double> ratios;
    constexpr int times = 200;
    int covered = 0;
    for (int k = 0; k < times; ++k) {
        const std::vector<float> x = drawn(n, random), y = drawn(n, random);
        const auto by_rule = dot<errbound::tracked<float, Rule>>(x, y);
        const auto reference = dot<errbound::tracked<double, errbound::residual>>(x, y);
        const double error = std::abs(by_rule.value() - reference.value());
        ratios.push_back(by_rule.error() / error);
        covered += error - reference.error() <= by_rule.error();
    }
    std::printf("  %8.1f %3d", median(ratios), 100 * covered / times);
    return !errbound::promises_bound<Rule> || covered == times;
}

int main() {
    using rules =
        errbound::rule_types<errbound::safe, errbound::tight, errbound::sharp, errbound::interval,
                             errbound::residual, errbound::stochastic, probable>;
    bool kept = true;
    std::printf("     n");
    errbound::for_each_rule(rules(), []<class Rule>() { std::printf("  %12s", Rule::name); });
    std::printf("\n");
    for (const std::size_t n : {10U, 100U, 1000U, 10'000U}) {
        std::printf("%6zu", n);
        errbound::for_each_rule(rules(), [&]<class Rule>() { kept = show<Rule>(n) && kept; });
        std::printf("\n");
    }
    return kept ? 0 : 1;
}
