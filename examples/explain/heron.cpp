// Heron's formula on a needle: the sum causes the error, not the subtractions. Kahan's order helps.
//
// usage: heron [FILE]; FILE is written for `errbound explain`.
#include <cstdio>
#include <errbound/explain/explain.hpp>
#include <exception>

template <class S>
S heron(const S& a, const S& b, const S& c) {
    const errbound::scope s("Heron");
    S half;
    {
        const errbound::scope s_half("half perimeter");
        half = (a + b + c) / S(2);
    }
    const errbound::scope s_factors("factors");
    return sqrt(half * (half - a) * (half - b) * (half - c));
}

// Precondition: a >= b >= c. Source: Kahan 1986, Miscalculating Area ... of a Needle-like Triangle.
template <class S>
S kahan(const S& a, const S& b, const S& c) {
    const errbound::scope s("Kahan");
    return sqrt((a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c))) / S(4);
}

int main(int argc, char** argv) try {
    using number = errbound::tracked<double, errbound::explained<errbound::sharp>>;
    const number a = 100000, b = 99999.99979, c = 0.00029;
    const auto naive = errbound::explain(heron(a, b, c), "area by Heron");
    const auto ordered = errbound::explain(kahan(a, b, c), "area by Kahan");
    std::fputs(text_of(naive).c_str(), stdout);
    std::fputs(text_of(ordered).c_str(), stdout);
    std::printf("Kahan's bound is %.0e of Heron's\n", ordered.error / naive.error);
    if (argc > 1) errbound::write_explanations(argv[1], {naive, ordered});
} catch (const std::exception& error) {
    std::fprintf(stderr, "heron: %s\n", error.what());
    return 1;
}
