// Published test vectors, compared with the library: the sets of `errbound conformance`. Internal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <errbound/validation/distribution.hpp>
#include <errbound/validation/rule.hpp>
#include <errbound/validation/worst_case.hpp>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace errbound::validation {

/// The answers of one method on one subject of a set.
struct conformance_row {
    std::string set, subject, method;
    bool promises = true;  ///< false: the method only estimates, so that no answer is wrong
    std::uint64_t cases = 0, wrong = 0;
    std::uint64_t uncertain = 0;  ///< no sign, or no finite bound
    distribution log10{};         ///< of bound/true error, or of the ratio of two widths
};

struct skipped_vectors {
    std::uint64_t count = 0;
    std::string names;  ///< of operations, for a reason that concerns them
};

struct conformance {
    worst_case_options options;  ///< with the rules to compare
    std::vector<conformance_row> rows;
    std::map<std::pair<std::string, std::string>, skipped_vectors> skipped;  ///< by set and reason
    std::vector<std::string> wrong;                                          ///< FILE:LINE: answer

    void skip(const std::string& set, const std::string& reason, const std::string& name = "");
    conformance_row& row(const std::string& set, const std::string& subject,
                         const std::string& method, bool promises = true);
    /// Counts an answer, which is wrong if `error` is not empty.
    void count(conformance_row& r, const std::string& place, const std::string& error);
};

/// A published file and its text.
struct published_file {
    std::filesystem::path path;
    std::string text;

    std::string place(std::size_t line) const { return path.string() + ':' + std::to_string(line); }
    std::string stem() const { return path.stem().string(); }
};

/// Lines of an index, coordinates and a sign; the file is named by its predicate.
void compare_predicates(const published_file& file, conformance& to);
/// Interval tests of ITF1788.
void compare_intervals(const published_file& file, conformance& to);
/// Lines of one or two arguments; the file is named by its function, with an f for float.
void compare_functions(const published_file& file, conformance& to);
/// A polynomial in MPSolve's form; `results` are its roots, or empty.
void compare_polynomial(const published_file& file, const std::string& results, conformance& to);
/// Programs in FPCore.
void compare_cores(const published_file& file, conformance& to);

}  // namespace errbound::validation
