// To C++ 010 is eight, to a reader of decimals ten.
#include <errbound/decimal.hpp>

int main() {
    using namespace errbound::literals;
    return (010_tracked).value() == 8;
}
