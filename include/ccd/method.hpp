// The methods by name: the promise and source of each, and one call to decide a query.
//
//     ccd::verdict v = ccd::decide(ccd::method::tight, query);
//
// Coordinates that are not finite give `uncertain` with cause `range`. Thread-safe. Allocates only
// for unbounded integers, in `exact` (seldom), `bsc-exact` and `root-parity`, and throws only
// std::bad_alloc there.
#pragma once

#include <ccd/kind.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>
#include <optional>
#include <span>
#include <string_view>

namespace ccd {

enum class method {
    float_,
    safe,
    tight,
    sharp,
    interval,
    residual,
    bsc_exact,
    safeccd,
    safeccd_tight,
    provot,
    root_parity,
    exact
};

struct method_info {
    ccd::method method;
    std::string_view name;  ///< as on the command line: "float", "bsc-exact", "exact"
    bool may_lose_collisions;
    bool may_report_false_collisions;
    std::string_view promise;  ///< one sentence
    std::string_view source;   ///< paper or section
};

/// Returns all methods, in the order of tables.
std::span<const method_info> methods();

/// Returns the method with that command-line name; nothing for any other name.
std::optional<method> find_method(std::string_view name);

/// Returns the entry of methods(); for any other value an entry named "unknown", with no promise.
method_info info(method m);

/// Decides by any method; the query is `uncertain` if `m` is not among methods(). Programs that
/// need only `exact` call decide_exact (ccd/exact.hpp), which links no other method. Worst cost
/// known (./run bench --worst): some 20 µs in floating point. Integers cost a third of a
/// millisecond for coordinates of 1e-3 to 1e3, and a tenth of a second for all magnitudes.
template <cubic_query Query>
verdict decide(method m, const Query& query);

}  // namespace ccd
