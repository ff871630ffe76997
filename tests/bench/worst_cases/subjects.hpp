// Public functions, each asked by a row of doubles, of which some row takes the longest.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace worst_cases {

struct subject {
    std::string name;
    std::size_t numbers;  ///< that `call` reads; at most those of a query of four points
    std::function<void(const double*)> call;
    int calls = 1;  ///< that a call stands for: a batch decides the same query many times
};

std::vector<subject> of_queries();     ///< exact, the other methods, batches, steps
std::vector<subject> of_predicates();  ///< errbound/predicates.hpp
std::vector<subject> of_roots();       ///< errbound/polynomial.hpp

}  // namespace worst_cases
