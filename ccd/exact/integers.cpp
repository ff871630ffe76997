// Decisions in integers of fixed width: see ccd/exact/integers.hpp for what they promise.
#include "ccd/exact/integers.hpp"

#include "ccd/exact/axis_units.hpp"
#include "ccd/exact/features.hpp"
#include "ccd/exact/integer_decision.hpp"

namespace ccd::detail {
namespace {

template <template <class> class Query>
verdict decide_any(const Query<double>& query) {
    const integer_units units(query);
    if (!units.finite()) return {outcome::uncertain, cause::range};
    if (units.bits() > extent_limit(2)) {
        // What comparing coordinates tells, at whatever scale.
        if (separated_by_coordinates(query)) return {outcome::separate, cause::none};
        return {outcome::uncertain, cause::range};
    }
    const outcome found = units.bits() <= extent_limit(1) ? decide_in_words<1>(query, units)
                                                          : decide_in_words<2>(query, units);
    return {found, found == outcome::uncertain ? cause::inside : cause::none};
}

}  // namespace

verdict decide_in_integers(const vertex_face<double>& q) {
    return decide_any(q);
}
verdict decide_in_integers(const edge_edge<double>& q) {
    return decide_any(q);
}
verdict decide_in_integers(const vertex_edge<double>& q) {
    return decide_any(q);
}
verdict decide_in_integers(const vertex_vertex<double>& q) {
    return decide_any(q);
}

}  // namespace ccd::detail
