// Tracked numbers that store the sources of their errors (errbound/explain).
#include <errbound/explain/explain.hpp>

#include "tests/bench/rules/contestants.hpp"

namespace bench {
namespace {

using explained_number = errbound::tracked<double, errbound::explained<errbound::tight>>;

/// Each operand is a sum of products in separate scopes. All operands have the same scopes.
template <int Sources>
struct of_sources : operators<explained_number> {
    static explained_number made(double x, double y) {
        explained_number sum = 0;
        for (int i = 1; i < Sources; ++i) {
            const errbound::scope s("product " + std::to_string(i));
            sum += explained_number(x) * explained_number(y);
        }
        return sum;  // has the errors of the products and of the sum
    }
};

}  // namespace

contestant explained_contestant() {
    return contestant_of<explained_number>("explained, one source");
}
contestant explained_contestant_of_32_sources() {
    return contestant_of<explained_number, of_sources<32>>("explained, 32 sources");
}

}  // namespace bench
