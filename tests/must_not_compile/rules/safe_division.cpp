// SafeBound has no rule for division: the message must say why.
#include <errbound/tracked.hpp>

int main() {
    const errbound::tracked<double, errbound::safe> a = 1.0, b = 3.0;
    return (a / b).value() > 0;
}
