// A rule validated against MPFR by the installed library.
#include <cstdio>
#include <errbound/validation/validation.hpp>

int main() {
    const auto rule = errbound::validation::rule_of<errbound::tight>();
    const auto found =
        errbound::validation::validate_expressions(std::span(&rule, 1), {.expressions = 100});
    std::printf("%zu counts, %llu violations\n", found.counts.size(),
                static_cast<unsigned long long>(found.violation_count()));
    return found.violation_count() == 0 ? 0 : 1;
}
