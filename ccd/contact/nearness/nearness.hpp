// The data of one query, from columns of ccd/batch/nearness_kernels.hpp or one by one. Internal.
#pragma once

#include <array>
#include <ccd/kind.hpp>
#include <ccd/nearness.hpp>

#include "ccd/batch/nearness_kernels.hpp"

namespace ccd::detail {

/// A row of nearness_columns.
using nearness_row = std::array<double, nearness_columns::columns>;

inline nearness_row row_of(const nearness_columns& columns, std::size_t i) {
    nearness_row row;
    for (std::size_t c = 0; c < row.size(); ++c) row[c] = columns.at[c][i];
    return row;
}

/// Precondition: the region is not -1.
template <kind K>
nearness nearness_of_row(const nearness_row& row);

}  // namespace ccd::detail
