// The stress run: every method on every family at every value of its knob, beside the exact answer.
#pragma once

#include <ccd/kind.hpp>
#include <ccd/method.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ccd/io/stored_kinds.hpp"
#include "ccd/stress/families.hpp"

namespace ccd::stress {

/// Decides queries[i] into verdicts[i].
template <class Query>
using decider = std::function<void(std::span<const Query>, std::span<verdict>)>;

/// A method as the run sees it: what it promises, and how to ask it.
struct subject {
    std::string name;
    bool may_lose_collisions = false;
    bool may_report_false_collisions = false;
    by_stored_kind<decider> decide;
};

subject subject_of(const method_info& method);

/// How a method broke its promise, and on which query of the cell: make(...) makes it again.
struct broken_promise {
    std::string what;  ///< a clause: "it said ..."
    std::uint64_t index = 0;
    bool collides = false;  ///< the truth, of finite coordinates
};

/// A cell: one method on one family at one value of its knob, queries of one kind.
struct cell {
    const stress::family* family = nullptr;
    double knob = 0;
    ccd::kind kind{};
    std::size_t subject = 0;  ///< which of the plan's
    std::size_t queries = 0;
    std::size_t collisions = 0;                            ///< by ccd::decide_reference
    std::size_t false_positives = 0, false_negatives = 0;  ///< uncertain counts as a collision
    std::size_t uncertain = 0;
    std::size_t wrong_certain = 0;    ///< `collides` or `separate`, and the contrary is true
    std::size_t from_not_finite = 0;  ///< certain answers to coordinates that are not finite
    double ns_per_query = 0;
    std::optional<broken_promise> broken;  ///< the first
};

struct plan {
    std::vector<const stress::family*> families;
    std::vector<subject> subjects;
    std::uint64_t seed = 1;
    std::size_t queries = 0;  ///< of a cell; fewer where the family is thinned, and at least one
    int threads = 0;          ///< for the truth; 0: one per core
    /// A subject's time on a cell is that of the fastest pass: of at least three, which together
    /// take so long, or of fewer where passes take ten times as long.
    double seconds = 0;
};

/// Says that so many of all cells (methods apart) are done, and which family is next.
using progress = std::function<void(std::size_t done, std::size_t all, const family& next)>;

/// All cells, by family, knob, kind and subject. The truth is found on several threads; methods are
/// timed on this one while nothing else runs. Deterministic but for the times.
std::vector<cell> run(const plan& what, const progress& show);

/// How `said` breaks what `who` promises, if it does. `truth` is uncertain if coordinates are not
/// finite. Promised are: no collision lost and none reported falsely, as far as the method says so;
/// by a method that promises any of these, that `collides` and `separate` are certain; by one that
/// promises both, an answer; by all, `uncertain` with cause `range` for what is not finite.
std::optional<std::string_view> broken_by(const subject& who, verdict said, outcome truth);

}  // namespace ccd::stress
