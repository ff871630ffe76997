// The sources of the error of a variance, in the naive and the compensated formula
// (docs/how-wrong.md).
//
// usage: variance [FILE]; FILE is written for `errbound explain`.
#include <cstdio>
#include <errbound/explain/explain.hpp>
#include <exception>
#include <vector>

template <class S>
S naive_variance(const std::vector<S>& x) {
    const errbound::scope s("naive");
    const S n = static_cast<int>(x.size());
    S sum = 0, squares = 0;
    for (const S& y : x) {
        const errbound::scope s_sum("sum");
        sum += y;
    }
    for (const S& y : x) {
        const errbound::scope s_squares("squares");
        squares += y * y;
    }
    const errbound::scope s_difference("difference");
    return (squares - sum * sum / n) / (n - 1);
}

// The formula of Chan, Golub and LeVeque: squares of deviations, corrected for the error of the
// mean.
template <class S>
S compensated_variance(const std::vector<S>& x) {
    const errbound::scope s("compensated");
    const S n = static_cast<int>(x.size());
    S mean = 0, sum = 0, squares = 0;
    {
        const errbound::scope s_mean("mean");
        for (const S& y : x) mean += y;
        mean /= n;
    }
    for (const S& y : x) {
        const errbound::scope s_deviations("deviations");
        const S d = y - mean;
        sum += d;
        squares += d * d;
    }
    const errbound::scope s_difference("difference");
    return (squares - sum * sum / n) / (n - 1);
}

// Readings of an almost constant height in metres, far from zero. Each is exactly a double.
template <class S>
std::vector<S> readings() {
    std::vector<S> x;
    for (int i = 0; i < 100; ++i) x.push_back(S(8848.86 + 0.001 * (i * 37 % 11)));
    return x;
}

int main(int argc, char** argv) try {
    std::printf("double:  %.17g\n", naive_variance(readings<double>()));

    using tracked = errbound::tracked<double>;
    const tracked v = naive_variance(readings<tracked>());
    std::printf("tracked: %.17g, to within %.2g\n", v.value(), v.error());

    using number = errbound::tracked<double, errbound::explained<errbound::tight>>;
    const std::vector<number> x = readings<number>();
    const auto naive = errbound::explain(naive_variance(x), "naive variance");
    const auto compensated = errbound::explain(compensated_variance(x), "compensated variance");
    std::fputs(text_of(naive).c_str(), stdout);
    std::fputs(text_of(compensated).c_str(), stdout);

    using signed_number = errbound::tracked<double, errbound::explained<errbound::residual>>;
    const auto seen = errbound::explain(compensated_variance(readings<signed_number>()),
                                        "compensated variance, errors with signs");
    std::fputs(text_of(seen).c_str(), stdout);

    if (argc > 1) errbound::write_explanations(argv[1], {naive, compensated, seen});
} catch (const std::exception& error) {
    std::fprintf(stderr, "variance: %s\n", error.what());
    return 1;
}
