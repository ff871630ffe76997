// Validation of bound rules against MPFR, and how tight their bounds are: what `errbound validate`
// runs, as functions that return structs and print nothing.
//
// Three kinds of evidence: random expressions, the polynomials and the sign classification of
// stored collision queries, and number formats so small that every case can be tried. In all of
// them a rule is held to two promises: |value − exact value| <= error(), and every certain sign is
// the exact one. A fourth is of what tracked elementary functions assume of the system's.
// docs/measured.md tells more.
#pragma once

#include <ccd/query.hpp>
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

/// A broken promise, with what it takes to see it again.
struct violation {
    std::string rule, number;
    std::uint64_t index = 0;  ///< of the expression or query, from 0
    std::string what;         ///< one sentence: which promise, and by how much it is broken
    std::string code;         ///< C++ that shows it, as small as it could be made; lines end in \n
};

/// How tight bounds are, or how large errors, of one quantity under one rule.
struct tightness {
    std::string rule, number, quantity;
    /// "bound/error"; under a rule that promises no bound "estimate/error" or "error/value".
    std::string measure;
    distribution log10;
    double claimed = 0;  ///< claimed_rate of the rule

    /// Of the results about which something is said: of how many the error is no larger.
    double observed() const {
        const std::uint64_t all = log10.ratios() + log10.exact();
        return static_cast<double>(log10.covered() + log10.exact()) / static_cast<double>(all);
    }
};

/// What was done under one rule and number type.
struct rule_counts {
    std::string rule, number;
    std::uint64_t cases = 0;   ///< expressions, queries, or operations of tiny formats
    std::uint64_t values = 0;  ///< that were compared with the reference
    std::uint64_t violations = 0;
    std::uint64_t undetermined = 0;  ///< where even the largest precision did not tell
};

/// How far the system's function is off, in units in the last place of the exact result.
struct function_errors {
    std::string function, number;
    std::uint64_t arguments = 0;   ///< those with a value and a finite result: what was compared
    double largest = 0;            ///< rounded up, by less than 2^-30
    std::string at;                ///< where it is the largest: hexadecimal, as in C++
    double assumed = 0;            ///< function_error, or what the options say
    std::uint64_t violations = 0;  ///< errors that are larger than that
};

struct report {
    /// Violations that are told, of each entry of counts; all are counted.
    static constexpr std::size_t kept_violations = 5;

    std::vector<rule_counts> counts;
    std::vector<violation> violations;  ///< the first of each entry of counts, in its order
    std::vector<tightness> distributions;
    std::vector<function_errors> functions;

    /// Of rules, and of what is assumed of functions.
    std::uint64_t violation_count() const;
    /// Adds what was found of further cases. Entries of counts that are not here come last.
    void merge(report later);
};

/// Evidence in numbered chunks, which do not depend on the number of threads.
struct evidence {
    std::uint64_t chunks = 0;
    /// What a chunk finds. May be called from several threads at once.
    std::function<report(std::uint64_t chunk)> report_of;
    /// Tells the violations of a report that all chunks' were merged into, in their order: before,
    /// `what` and `code` may be empty.
    std::function<void(report&)> tell;
};

/// Called now and then, from the calling thread only, with how much of all is done.
using progress = std::function<void(std::uint64_t done, std::uint64_t all)>;

/// What all chunks find; the same for every number of threads (0: one per core). Throws what a
/// chunk throws, once all threads have ended.
report examine(const evidence& what, int threads, const progress& show = {});

struct expression_options {
    std::uint64_t expressions = 10'000'000;  ///< at least so many per rule and number type
    std::uint64_t seed = 1;
    /// The number of skipped expressions of the seed's sequence. Ranges that follow one another
    /// partition it.
    std::uint64_t first = 0;
    int operations = 16;  ///< at most, in one expression; 1 to 48
    int threads = 0;      ///< 0: one per core
    std::vector<number_type> numbers{number_type::double_type, number_type::float_type};
};

/// Random expressions in each number type under all the rules against one reference. Rules
/// without division are left out of expressions that divide; each gets its number all the same.
/// Cost: some microseconds an expression.
evidence evidence_of_expressions(std::span<const rule> rules, const expression_options& options);
report validate_expressions(std::span<const rule> rules, const expression_options& options,
                            const progress& show = {});

struct function_options {
    std::vector<elementary_function> functions{};  ///< none: nothing is done
    std::uint64_t samples = 1'000'000;  ///< arguments, or pairs, of each function and type
    bool every_float = false;           ///< all floats instead, of functions of one argument
    std::optional<double> units{};      ///< what they are held to, instead of function_error
    std::uint64_t seed = 1;
    std::vector<number_type> numbers{number_type::double_type, number_type::float_type};
};

/// Compares the system's functions with MPFR's: whether function_error holds. Arguments are random
/// bits, and hard ones: near multiples of π/2 of every size, near zeros and ends of domains, and
/// where results overflow, underflow or pass a power of two. sin, cos and tan of 2^20 and more are
/// the library's own, and are compared with their bounds. For float, double and long double; other
/// types are skipped. Cost: about a microsecond an argument.
evidence evidence_of_functions(const function_options& options);

/// The forms of stored queries and BSC itself on them, operation by operation, in double. The
/// evidence looks at the queries as long as it is used. Cost: about a millisecond a query and rule.
template <class Query>
evidence evidence_of_queries(std::span<const rule> rules, std::span<const Query> queries);
template <class Query>
report validate_queries(std::span<const rule> rules, std::span<const Query> queries, int threads,
                        const progress& show = {}) {
    return examine(evidence_of_queries(rules, queries), threads, show);
}

/// Every operation on every pair of numbers of formats of 6 to 8 bits, in every rounding direction
/// that a rule promises; in 6 bits also with every pair of bounds that operands can have. Of
/// float8_e5m2 and float8_e4m3 with some of these pairs, or, if so asked, with every one, and for
/// float8_e4m3 every two operations in a row: long.
evidence evidence_of_tiny(std::span<const rule> rules, bool every_bound = false);
report validate_tiny(std::span<const rule> rules, int threads, const progress& show = {});

}  // namespace errbound::validation
