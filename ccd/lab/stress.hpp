// The stress run: methods on families of stiff and extreme queries, compared with the reference.
#pragma once

#include <ccd/kind.hpp>
#include <ccd/method.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ccd/io/stored_kinds.hpp"
#include "ccd/lab/families.hpp"
#include "ccd/lab/tables.hpp"

namespace ccd::lab {

template <class Query>
using decider = std::function<void(std::span<const Query>, std::span<verdict>)>;

struct subject {
    std::string name;
    bool may_lose_collisions = false;
    bool may_report_false_collisions = false;
    by_stored_kind<decider> decide;
};

/// The name of `exact` in batches, as a separate method.
inline constexpr std::string_view batch_name = "exact, batch";

/// Precondition: `name` is batch_name or that of a method.
subject subject_named(std::string_view name);

/// The first query with which a method broke its promise; make(...) makes it again.
struct broken_promise {
    std::string clause;  ///< such as: "it lost a collision"
    std::uint64_t index = 0;
    bool collides = false;  ///< the truth, if coordinates are finite
};

/// One method on one family at one value of its knob, queries of one kind.
struct cell {
    const lab::family* family = nullptr;
    double knob = 0;
    ccd::kind kind{};
    std::size_t subject = 0;          ///< index in the plan
    std::size_t queries = 0;          ///< finite or not
    tally finite = {};                ///< of finite queries, by ccd::decide_reference
    std::size_t uncertain = 0;        ///< of all queries
    std::size_t wrong_certain = 0;    ///< `collides` or `separate`, against the truth
    std::size_t from_not_finite = 0;  ///< certain answers to coordinates that are not finite
    double ns_per_query = 0;
    std::optional<broken_promise> broken = {};
};

struct plan {
    std::vector<const lab::family*> families;
    std::vector<subject> subjects;
    std::uint64_t seed = 1;
    std::size_t queries = 0;  ///< of a cell; fewer where the family is thinned, and at least one
    int threads = 0;          ///< for the truth; 0: one per core
    double seconds = 0;       ///< of all passes of a cell and method (fastest_of)
};

/// `done` and `all` count the values of knobs of all families.
using stress_progress = std::function<void(std::size_t done, std::size_t all, const family& next)>;

/// All cells, by family, knob, kind and subject. The truth is computed on several threads; methods
/// are timed on the calling one. Deterministic except for times.
std::vector<cell> run(const plan& wanted, const stress_progress& show);

/// Returns the promise that `answer` breaks, if any. `truth` is uncertain if coordinates are not
/// finite; then answers must be `uncertain` with cause `range`. If a method promises no lost
/// collisions, `separate` must be right; if it promises anything, so must `collides`. If it
/// promises neither lost nor false collisions, it may not be `uncertain`.
std::optional<std::string_view> broken_by(const subject& who, verdict answer, outcome truth);

extern const std::vector<std::string> stress_columns;

/// The cell, with `wrong_certain` and `from_not_finite`; and, if a promise is broken, `broken`
/// (how) and `query` (its index). A knob of exactly zero is "-inf".
row row_of(const cell& c, const plan& wanted);

struct stress_outputs {
    std::optional<std::filesystem::path> folder;  ///< for stress.csv
    std::optional<std::filesystem::path> json;
};

/// Makes the folder, runs the plan and writes its cells. Returns true if all promises were kept.
/// Otherwise the text names the broken ones, and the folder, or the current one, has a query for
/// each. Throws errbound::support::file_error.
bool run_and_write(const plan& wanted, const stress_outputs& to, std::ostream& text);

}  // namespace ccd::lab
