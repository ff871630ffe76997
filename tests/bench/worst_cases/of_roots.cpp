#include <boost/multiprecision/cpp_int.hpp>
#include <errbound/multiprecision.hpp>
#include <errbound/polynomial.hpp>
#include <limits>
#include <vector>

#include "ccd/report/measuring/timing.hpp"
#include "tests/bench/worst_cases/subjects.hpp"

namespace worst_cases {
namespace {

subject counting(std::size_t degree) {
    const auto call = [degree](const double* numbers) {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        const errbound::polynomial<double> p(std::vector<double>(numbers, numbers + degree + 1));
        ccd::report::keep(
            errbound::count_roots<boost::multiprecision::cpp_int>(p, -infinity, infinity));
    };
    return {"count_roots, degree " + std::to_string(degree), degree + 1, call};
}

}  // namespace

std::vector<subject> of_roots() {
    return {counting(3), counting(8), counting(20)};
}

}  // namespace worst_cases
