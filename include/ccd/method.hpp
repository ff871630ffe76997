// The methods by name: what each promises, its source, and one call to decide a query with it.
//
// decide() allocates only inside `exact`, `bsc-exact` and `root-parity` (unbounded integers, in
// `exact` seldom), throws only std::bad_alloc there (or aborts if built with GMP), and may be
// called from any thread. Coordinates must be finite: an infinity or NaN gives `uncertain` with
// cause `range`.
#pragma once

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

/// All methods, in the order in which tables show them.
std::span<const method_info> methods();

/// The method of that command-line name, if there is one.
std::optional<method> find_method(std::string_view name);

/// The entry of methods(); for any other value one of the name "unknown", which promises nothing.
method_info info(method m);

/// By any method. Worst known (./run bench --worst): a hundredth of a millisecond or two in
/// floating point, a third of a millisecond by integers where coordinates are of 1e-3 to 1e3, a
/// tenth of a second where they are of all magnitudes. (Programs that need `exact` alone call
/// decide_exact of ccd/exact.hpp, which links no other method and can report its stages.) A value
/// that is none of methods() leaves every query `uncertain`.
verdict decide(method m, const vertex_face<double>& query);
verdict decide(method m, const edge_edge<double>& query);

}  // namespace ccd
