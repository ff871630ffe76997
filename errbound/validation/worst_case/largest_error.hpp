// Inputs of a recorded computation with large rounding errors, found by search. Internal.
#pragma once

#include <mpfr.h>

#include <errbound/validation/worst_case.hpp>
#include <string>
#include <vector>

namespace errbound::validation {

/// Sets `to` to a constant of recording::constant, rounded once. Returns MPFR's ternary value.
/// Throws std::invalid_argument.
int set_constant(mpfr_ptr to, const std::string& text, mpfr_rnd_t direction);

/// The number of a format nearest to x, ties to even. Precondition: x has at least 200 bits.
long double rounded_to(mpfr_srcptr x, int digits, int min_exponent);

/// The nodes that `result` depends on, in order.
std::vector<std::size_t> nodes_of(const recording& f, const std::vector<std::size_t>& results);

struct observed_error {
    double at_least = 0;                 ///< rounded down
    std::vector<double> where, offsets;  ///< exact input = input + offset
};

/// Tries inputs in the boxes, which are lists of lower and upper ends, and hill-climbs from the
/// worst ones. Errors are estimated in long double, and those of the worst inputs enclosed by MPFR.
observed_error largest_error(const recording& f,
                             const std::vector<std::vector<input_range>>& boxes);

/// Searches for inputs of a large error() under the rule, in the same way. Starts at `worst`, too.
rule_bound largest_bound(const recording& f, const rule& r,
                         const std::vector<std::vector<input_range>>& boxes,
                         const observed_error& worst);

/// The error at one input, as a lower bound; 0 if MPFR's precision does not suffice.
double error_at(const recording& f, const std::vector<double>& inputs,
                const std::vector<double>& offsets);

}  // namespace errbound::validation
