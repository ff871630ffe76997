// The reference decisions: see include/ccd/reference.hpp for what they promise.
//
// A query collides exactly if one of these holds (algebra in brackets):
//  * VF, EE: Y = 0, N ≠ 0 and all G_i >= 0 at some t in [0, 1]    [roots of the cubic Y]
//  * one of three (VF) or four (EE) vertex/edge contacts
//  * VE: W × E = 0 and W·(W − E) <= 0 at some t, with W = v − e0, E = e1 − e0. (On the line, v lies
//    between e0 and e1 exactly if W and W − E do not point the same way; this holds for E = 0
//    too, where it says W = 0.)                                   [roots of a common factor]
// Complete: a contact with N ≠ 0 satisfies the first. If N = 0 at the contact, the triangle is then
// a segment, which its edges cover, or the two edges are parallel, and an end of one lies on the
// other. If Y ≡ 0 the first case is asked at t = 0 and 1 only: a contact inside a triangle (or
// crossing edges) that did not hold at t = 0 began at an edge (or an end).
#include <algorithm>
#include <bit>
#include <ccd/forms.hpp>
#include <ccd/reference.hpp>
#include <ccd/transform.hpp>
#include <cmath>
#include <cstdint>
#include <errbound/multiprecision.hpp>
#include <errbound/real_roots.hpp>
#include <limits>

#include "ccd/features.hpp"
#include "ccd/finite.hpp"
#ifdef ERRBOUND_HAVE_GMP
#include <boost/multiprecision/gmp.hpp>
#else
#include <boost/multiprecision/cpp_int.hpp>
#endif

namespace ccd {
namespace {

namespace mp = boost::multiprecision;
#ifdef ERRBOUND_HAVE_GMP
using integer = mp::number<mp::gmp_int, mp::et_off>;
#else
using integer = mp::number<mp::cpp_int_backend<>, mp::et_off>;
#endif

using errbound::bernstein;
using errbound::sign_type;
using form = errbound::integer_form<integer>;

/// x = mantissa·2^exponent with an odd mantissa, for x finite and not zero.
struct decomposed {
    std::int64_t mantissa;
    int exponent;

    explicit decomposed(double x) {
        int e = 0;
        const auto m = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &e), 53));
        const int zeros = std::countr_zero(static_cast<std::uint64_t>(m));
        mantissa = m >> zeros;
        exponent = e - 53 + zeros;
    }
};

/// The query with integer coordinates: each axis times a power of two of its own. Contact does not
/// depend on the axes' units: they scale all three kinds of equation at a contact by positive
/// factors, and integers stay short when one axis is much smaller than the others.
template <template <class> class Query>
Query<integer> to_integers(const Query<double>& query) {
    constexpr int none = std::numeric_limits<int>::max();
    point<int> lowest{none, none, none};
    const auto lower = [](int& bound, double x) {
        if (x != 0) bound = std::min(bound, decomposed(x).exponent);
    };
    for (const auto& p : points_of(query))
        for (const auto& x : {p.t0, p.t1}) {
            lower(lowest.x, x.x);
            lower(lowest.y, x.y);
            lower(lowest.z, x.z);
        }
    const auto to_integer = [](double x, int unit) {
        if (x == 0) return integer(0);
        const decomposed d(x);
        return integer(integer(d.mantissa) << (d.exponent - unit));
    };
    return transformed_points(query, [&](const point<double>& p) {
        return point<integer>{to_integer(p.x, lowest.x), to_integer(p.y, lowest.y),
                              to_integer(p.z, lowest.z)};
    });
}

/// Y = 0, N ≠ 0 and all G_i >= 0 at some t in [0, 1].
template <template <class> class Query>
bool regular_contact(const Query<integer>& query) {
    const auto forms = forms_of(query);
    const auto y = forms.y();
    if (errbound::certainly_rootless(y)) return false;
    const auto g = forms.inside();
    for (const auto& f : g)
        if (errbound::sign_throughout(f) == sign_type::negative) return false;
    const auto n2 = forms.normal_squared();

    const auto contact_at = [&](const auto& sign_there) {
        if (sign_there(n2) == sign_type::zero) return false;
        for (const auto& f : g)
            if (sign_there(f) == sign_type::negative) return false;
        return true;
    };
    const auto at_start = [](const auto& f) { return errbound::sign_of(f.h.front()); };
    const auto at_end = [](const auto& f) { return errbound::sign_of(f.h.back()); };
    if (y.h.front() == 0 && contact_at(at_start)) return true;
    if (y.h.back() == 0 && contact_at(at_end)) return true;

    const form inner = errbound::without_end_roots(y);
    if (inner.size() < 2) return false;
    errbound::real_roots<integer> roots(inner);
    for (std::size_t k = 0; k < roots.size(); ++k) {
        const auto at_root = [&roots, k](const auto& f) {
            return roots.sign_at_root(errbound::without_end_roots(f), k);
        };
        if (contact_at(at_root)) return true;
    }
    return false;
}

bool contact(const vertex_edge<integer>& query) {
    const auto e = difference(query.e1, query.e0);
    const auto w = difference(query.v, query.e0);
    const auto off_line = cross(w, e);
    for (const auto* f : {&off_line.x, &off_line.y, &off_line.z})
        if (errbound::certainly_rootless(*f)) return false;
    // W·(W − E), not positive between the ends.
    const auto beyond = dot(w, difference(query.v, query.e1));
    const auto on_line_at = [&](std::size_t i) {
        return off_line.x.h[i] == 0 && off_line.y.h[i] == 0 && off_line.z.h[i] == 0;
    };
    if (on_line_at(0) && beyond.h[0] <= 0) return true;
    if (on_line_at(2) && beyond.h[2] <= 0) return true;

    form on_line;  // the common factor of the three; empty: the motion is collinear throughout
    for (const auto* f : {&off_line.x, &off_line.y, &off_line.z})
        on_line = errbound::common_factor(on_line, errbound::without_end_roots(*f));
    if (on_line.empty()) {
        // Both ends are positive by now, so a value <= 0 inside needs real roots with t/s > 0.
        return beyond.h[1] < 0 && beyond.h[1] * beyond.h[1] >= 4 * beyond.h[0] * beyond.h[2];
    }
    if (on_line.size() < 2) return false;
    errbound::real_roots<integer> roots(on_line);
    for (std::size_t k = 0; k < roots.size(); ++k)
        if (roots.sign_at_root(errbound::without_end_roots(beyond), k) != sign_type::positive)
            return true;
    return false;
}

/// VF and EE: the union stated at the head of this file.
template <template <class> class Query>
bool contact(const Query<integer>& query, const Query<double>& original) {
    if (regular_contact(query)) return true;
    const auto edges = vertex_edge_queries(query);
    const auto original_edges = vertex_edge_queries(original);
    for (std::size_t i = 0; i < edges.size(); ++i)
        if (!parted(original_edges[i]) && contact(edges[i])) return true;
    return false;
}
bool contact(const vertex_edge<integer>& query, const vertex_edge<double>& original) {
    return !parted(original) && contact(query);
}
bool contact(const vertex_vertex<integer>& query, const vertex_vertex<double>&) {
    return contact(query);
}

template <template <class> class Query>
verdict decide_finite(const Query<double>& query) {
    if (!is_finite(query)) return {outcome::uncertain, cause::range};
    return {contact(to_integers(query), query) ? outcome::collides : outcome::separate,
            cause::none};
}

}  // namespace

verdict decide_reference(const vertex_face<double>& q) {
    return decide_finite(q);
}
verdict decide_reference(const edge_edge<double>& q) {
    return decide_finite(q);
}
verdict decide_reference(const vertex_edge<double>& q) {
    return decide_finite(q);
}
verdict decide_reference(const vertex_vertex<double>& q) {
    return decide_finite(q);
}

}  // namespace ccd
