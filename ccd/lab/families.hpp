// The families of `ccd stress`: stiff, degenerate and badly scaled queries, each with a knob.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "ccd/lab/queries.hpp"

namespace ccd::lab {

/// The value of a logarithmic knob that stands for exactly zero.
inline constexpr double exact_zero = -std::numeric_limits<double>::infinity();

struct family {
    std::string_view name;
    std::string_view description;  ///< one sentence
    std::string_view knob_name;    ///< meaning of the numbers; no comma, for CSV
    std::vector<double> knobs;  ///< ascending: whole numbers, and exact_zero where it makes sense
    /// Makes queries on both sides of the decision if possible.
    points (*make)(source& random, kind which, double knob);
    /// One query in this many suffices, where the truth costs up to tenths of a second.
    unsigned (*thinning)(double knob) = [](double) { return 1u; };
    /// If false, every query has a coordinate that is NaN or infinite, and no truth.
    bool finite = true;
};

std::span<const family> families();

/// Makes query `index`, the same on every machine, without making the others.
points make(const family& f, double knob, kind which, std::uint64_t seed, std::uint64_t index);

}  // namespace ccd::lab
