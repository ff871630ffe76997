// A fuzzer's numbers as the points of a query.
#pragma once

#include "tests/support/fuzz_numbers.hpp"
#include "tests/support/query_families.hpp"

namespace fuzz {

/// Axis by axis, so that copies of earlier numbers stay on one axis.
inline query_families::points points_from(numbers& from) {
    query_families::points p{};
    for (const auto axis : {&ccd::point<double>::x, &ccd::point<double>::y, &ccd::point<double>::z})
        for (auto& m : p) {
            m.t0.*axis = from.next();
            m.t1.*axis = from.next();
        }
    return p;
}

}  // namespace fuzz
