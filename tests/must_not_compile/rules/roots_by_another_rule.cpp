// Roots are counted by rules that store the absolute error and nothing else.
#include <errbound/polynomial.hpp>

int main() {
    using number = errbound::tracked<double, errbound::interval>;
    const errbound::polynomial<number> p{number(-2), number(0), number(1)};
    return errbound::count_roots(p, 0, 10) == 1;
}
