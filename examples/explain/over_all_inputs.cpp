// The largest error of a quotient over all inputs in a box, in three number formats. Needs MPFR.
#include <cstdio>
#include <errbound/validation/worst_case.hpp>  // links to errbound::validation

const auto f = [](const auto& x, const auto& y) { return x / (x + y); };

template <class T>
void print(const char* format) {
    const errbound::worst_case_result e = errbound::worst_case<T>(f, {{1, 4}, {1, 4}});
    std::printf("%-8s error at most %.3g, at least %.3g at %a, %a; result in [%.3g, %.3g]\n",
                format, e.at_most, e.at_least, e.where[0], e.where[1], e.lower, e.upper);
}

int main() {
    print<errbound::float16>("float16");
    print<float>("float");
    print<double>("double");
    std::fputs(text_of(errbound::worst_case<float>(f, {{1, 4}, {1, 4}}).by_operation).c_str(),
               stdout);
}
