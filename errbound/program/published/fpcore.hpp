// FPCore, the exchange format of FPBench (fpbench.org/spec), without loops. Internal.
#pragma once

#include <cstdint>
#include <errbound/validation/worst_case.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace errbound::validation {

/// An atom, or a list of expressions in parentheses or brackets.
struct fpcore_expression {
    std::string atom;  ///< empty: a list
    std::vector<fpcore_expression> items;
    std::uint_least32_t line = 0;
};

struct fpcore {
    std::string name, file;
    std::vector<fpcore_expression> arguments;
    std::string precision = "binary64", rounding = "nearestEven";
    std::optional<fpcore_expression> precondition;
    fpcore_expression body;
};

/// Returns the cores in a file. Throws errbound::support::file_error with file and line.
std::vector<fpcore> parse_fpcores(std::string_view text, const std::string& file);

/// The reason if worst_case returns infinity.
inline constexpr const char* no_finite_bound =
    "there is no finite bound: an operation may overflow or leave its domain";

/// A core that worst_case cannot bound; what() is the reason, a sentence.
struct unsupported_core : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Bounds the error of a core, in its own precision or the one named. The precondition gives the
/// box and constraints; its parts that are no comparisons are ignored, so that the bound still
/// holds. Throws unsupported_core.
worst_case_result worst_case_of(const fpcore& core, const worst_case_options& options,
                                const std::string& precision = "");

}  // namespace errbound::validation
