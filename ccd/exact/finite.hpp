// A fast test that coordinates are finite. Internal.
#pragma once

#include <array>
#include <bit>
#include <ccd/query.hpp>
#include <cstddef>

namespace ccd::detail {

/// x − x is 0, or NaN if x is not finite. Four independent sums let the compiler vectorise.
inline bool all_finite(const double* numbers, std::size_t count) {
    double zeros[4] = {0, 0, 0, 0};
    const std::size_t whole = count / 4 * 4;
    for (std::size_t i = 0; i < whole; i += 4)
        for (std::size_t k = 0; k < 4; ++k) zeros[k] += numbers[i + k] - numbers[i + k];
    for (std::size_t i = whole; i < count; ++i) zeros[0] += numbers[i] - numbers[i];
    return (zeros[0] + zeros[1]) + (zeros[2] + zeros[3]) == 0;
}

template <template <class> class Query>
bool is_finite(const Query<double>& query) {
    constexpr std::size_t count = sizeof(query) / sizeof(double);
    const auto numbers = std::bit_cast<std::array<double, count>>(query);
    return all_finite(numbers.data(), count);
}

}  // namespace ccd::detail
