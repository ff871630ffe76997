// Validation of bound rules against MPFR, and the tightness of their bounds: the functions behind
// `errbound validate`, which return structs and print nothing.
//
// Evidence: random expressions, and every case of tiny number formats. Each rule must keep two
// promises: |value − exact value| <= error(), and every certain sign is the exact one. The assumed
// errors of the C library's functions are tested, too. `ccd validate` adds stored collision
// queries. Results: docs/measured.md.
#pragma once

#include <cstdint>
#include <errbound/validation/distribution.hpp>
#include <errbound/validation/mpfr_functions.hpp>
#include <errbound/validation/rule.hpp>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace errbound::validation {

/// Every rule of errbound/validation/rule_list.hpp.
std::span<const rule> rules();

/// A broken promise, reproducible.
struct violation {
    std::string rule, number;
    std::uint64_t index = 0;  ///< of the expression, from 0
    std::string what;         ///< one sentence: the promise, and by how much it is broken
    std::string code;         ///< C++ that shows it, minimised; lines end in \n
};

/// Tightness of bounds, or size of errors, of one quantity under one rule.
struct tightness {
    std::string rule, number, quantity;
    /// "bound/error"; under a rule that promises no bound "estimate/error" or "error/value".
    std::string measure;
    distribution log10;
    double claimed = 0;  ///< the rule's claimed_rate

    /// The share of results with a finite estimate whose error is no larger.
    double observed() const {
        const std::uint64_t all = log10.ratios() + log10.exact();
        return static_cast<double>(log10.covered() + log10.exact()) / static_cast<double>(all);
    }
};

/// Counts for one rule and number type.
struct rule_counts {
    std::string rule, number;
    std::uint64_t cases = 0;   ///< expressions, or operations of tiny formats
    std::uint64_t values = 0;  ///< compared with the reference
    std::uint64_t violations = 0;
    std::uint64_t undetermined = 0;  ///< even the largest precision did not decide
};

/// Errors of a C library function, in units in the last place of the exact result.
struct function_errors {
    std::string function, number;
    std::uint64_t arguments = 0;   ///< compared: those with a value and a finite result
    double largest = 0;            ///< rounded up, by less than 2^-30
    std::string at;                ///< argument with the largest error: hexadecimal, as in C++
    double assumed = 0;            ///< function_error, or the options' units
    std::uint64_t violations = 0;  ///< errors above `assumed`
};

struct report {
    /// Violations kept per entry of counts; all are counted.
    static constexpr std::size_t kept_violations = 5;

    std::vector<rule_counts> counts;
    std::vector<violation> violations;  ///< the first of each entry of counts, in its order
    std::vector<tightness> distributions;
    std::vector<function_errors> functions;

    /// Violations of rules and of function_error.
    std::uint64_t violation_count() const;
    /// Adds the results of further cases. New entries of counts come last.
    void merge(report later);
};

/// Evidence in numbered chunks, independent of the number of threads.
struct evidence {
    std::uint64_t chunks = 0;
    /// The result of a chunk. Called from several threads at once.
    std::function<report(std::uint64_t chunk)> report_of;
    /// Fills `what` and `code` of the violations in the merged report of all chunks, in order; they
    /// may be empty before.
    std::function<void(report&)> describe;
};

/// Called periodically, from the calling thread only.
using progress = std::function<void(std::uint64_t done, std::uint64_t all)>;

/// The merged result of all chunks, independent of the number of threads (0: one per core).
/// Rethrows a chunk's exception after all threads have ended.
report examine(const evidence& examined, int threads, const progress& show = {});

struct expression_options {
    std::uint64_t expressions = 10'000'000;  ///< at least this many per rule and number type
    std::uint64_t seed = 1;
    /// The number of skipped expressions of the seed's sequence. Consecutive ranges partition the
    /// sequence.
    std::uint64_t first = 0;
    int operations = 16;  ///< in one expression, at most; 1 to 48
    int threads = 0;      ///< 0: one per core
    std::vector<number_type> numbers{number_type::double_type, number_type::float_type};
};

/// Random expressions in each number type under all rules, against one reference. Rules without
/// division skip expressions that divide, but get their full number. Cost: some microseconds per
/// expression.
evidence evidence_of_expressions(std::span<const rule> rules, const expression_options& options);
report validate_expressions(std::span<const rule> rules, const expression_options& options,
                            const progress& show = {});

struct function_options {
    std::vector<elementary_function> functions{};  ///< none: does nothing
    std::uint64_t samples = 1'000'000;             ///< arguments, or pairs, per function and type
    bool every_float = false;       ///< all floats instead, for functions of one argument
    std::optional<double> units{};  ///< the limit, instead of function_error
    std::uint64_t seed = 1;
    std::vector<number_type> numbers{number_type::double_type, number_type::float_type};
};

/// Compares the C library's functions with MPFR's, against function_error. Arguments are random
/// bits and hard cases: near multiples of π/2, near zeros and ends of domains, and where results
/// overflow, underflow or pass a power of two. sin, cos and tan from 2^20 on are this library's and
/// are compared with their bounds. float, double and long double only. Cost: about a microsecond
/// per argument.
evidence evidence_of_functions(const function_options& options);

/// Every operation on every pair of numbers of formats of 6 to 8 bits, in every rounding direction
/// that a rule promises; in 6 bits also with every pair of bounds. float8_e5m2 and float8_e4m3
/// are tested with some pairs of bounds. If every_bound, they are tested with all pairs, and
/// float8_e4m3 also with every sequence of two operations (takes long).
evidence evidence_of_tiny(std::span<const rule> rules, bool every_bound = false);
report validate_tiny(std::span<const rule> rules, int threads, const progress& show = {});

}  // namespace errbound::validation
