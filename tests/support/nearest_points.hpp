// Exact nearest points of two features, for checks of the library's contacts and distances.
#pragma once

#include <algorithm>
#include <array>
#include <boost/multiprecision/gmp.hpp>
#include <ccd/contact.hpp>
#include <ccd/kind.hpp>
#include <ccd/methods/transform.hpp>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "tests/support/special_values.hpp"

namespace support {

using ::rational;
using real = boost::multiprecision::number<boost::multiprecision::gmp_float<120>,
                                           boost::multiprecision::et_off>;

template <class S>
using vector = std::array<S, 3>;
template <class S>
vector<S> operator-(const vector<S>& a, const vector<S>& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class S>
vector<S> operator*(const S& f, const vector<S>& a) {
    return {f * a[0], f * a[1], f * a[2]};
}
template <class S>
S dot(const vector<S>& a, const vector<S>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class S>
vector<S> cross(const vector<S>& a, const vector<S>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline bool is_zero(const vector<rational>& a) {
    return a[0] == 0 && a[1] == 0 && a[2] == 0;
}
template <class S = rational>
vector<S> of(const ccd::point<double>& p) {
    return {S(p.x), S(p.y), S(p.z)};
}
/// Precondition: a is not zero.
inline vector<real> unit(const vector<rational>& a) {
    // Divides by the largest first, so that every size is in range.
    rational largest = 0;
    for (const rational& x : a)
        if (abs(x) > largest) largest = abs(x);
    vector<real> r;
    for (std::size_t i = 0; i < 3; ++i) r[i] = real(rational(a[i] / largest));
    const real length = sqrt(dot(r, r));
    return {r[0] / length, r[1] / length, r[2] / length};
}

/// The points of a query at a time, and their velocities.
struct moment {
    std::vector<vector<rational>> at, velocity;

    template <class Query>
    moment(const Query& query, const rational& t) {
        for (const auto& p : points_of(query)) {
            velocity.push_back(of(p.t1) - of(p.t0));
            at.push_back(of(p.t0) - rational(-t) * velocity.back());
        }
    }
};

/// All features between which a distance can be attained, the smallest first, in the order of
/// ccd/nearness.hpp.
template <ccd::kind K>
std::vector<ccd::meeting_features> features_of() {
    using enum ccd::kind;
    if constexpr (K == vertex_face)
        return {{vertex_vertex, {0, 1}},    {vertex_vertex, {0, 2}},  {vertex_vertex, {0, 3}},
                {vertex_edge, {0, 1, 2}},   {vertex_edge, {0, 2, 3}}, {vertex_edge, {0, 3, 1}},
                {vertex_face, {0, 1, 2, 3}}};
    else if constexpr (K == edge_edge)
        return {{vertex_vertex, {0, 2}},  {vertex_vertex, {0, 3}},  {vertex_vertex, {1, 2}},
                {vertex_vertex, {1, 3}},  {vertex_edge, {0, 2, 3}}, {vertex_edge, {1, 2, 3}},
                {vertex_edge, {2, 0, 1}}, {vertex_edge, {3, 0, 1}}, {edge_edge, {0, 1, 2, 3}}};
    else if constexpr (K == vertex_edge)
        return {{vertex_vertex, {0, 1}}, {vertex_vertex, {0, 2}}, {vertex_edge, {0, 1, 2}}};
    else
        return {{vertex_vertex, {0, 1}}};
}

/// Nearest points of two features' planes or lines. They are not unique if the divisor is 0.
template <class S>
struct feet {
    ccd::meeting_features features;
    std::array<S, 4> weights{};  ///< of the query's points, times `divisor`
    S divisor = 1;
    S square = 0;         ///< of the distance, times `divisor`
    vector<S> between{};  ///< from the second towards the first, times a positive number

    feet(const ccd::meeting_features& of, const std::vector<vector<S>>& at) : features(of) {
        const auto& i = of.points;
        const auto set = [&](std::size_t k, const S& weight) { weights[i[k]] = weight; };
        if (of.kind == ccd::kind::vertex_vertex) {
            between = at[i[0]] - at[i[1]];
            set(0, 1), set(1, 1);
            square = dot(between, between);
        } else if (of.kind == ccd::kind::vertex_edge) {
            const vector<S> e = at[i[2]] - at[i[1]], w = at[i[0]] - at[i[1]];
            const S we = dot(w, e);
            divisor = dot(e, e);
            set(0, divisor), set(1, divisor - we), set(2, we);
            between = divisor * w - we * e;
            square = dot(w, w) * divisor - we * we;
        } else {
            // The least squares solution of x·p + y·q = r.
            const bool face = of.kind == ccd::kind::vertex_face;
            const vector<S> p = face ? at[2] - at[1] : at[1] - at[0];
            const vector<S> q = face ? at[3] - at[1] : at[2] - at[3];
            const vector<S> r = face ? at[0] - at[1] : at[2] - at[0];
            const S pp = dot(p, p), pq = dot(p, q), qq = dot(q, q), pr = dot(p, r), qr = dot(q, r);
            divisor = pp * qq - pq * pq;
            const S x = pr * qq - qr * pq, y = qr * pp - pr * pq;
            if (face)
                set(0, divisor), set(1, divisor - x - y), set(2, x), set(3, y);
            else
                set(0, divisor - x), set(1, x), set(2, divisor - y), set(3, y);
            const vector<S> n = cross(p, q);
            const S height = dot(n, r);
            square = height * height;
            // r is towards v from the face, but towards edge b from edge a.
            between = S((height > 0) == face ? 1 : -1) * n;
        }
    }
    /// True if the points are unique and in the features.
    bool inside() const {
        return divisor > 0 &&
               std::ranges::all_of(weights, [&](const S& w) { return w >= 0 && w <= divisor; });
    }
};

/// Faults of weights of two features, of which the first has the first `first` points; "" if none.
inline std::string faults_of_weights(const std::array<double, 4>& weights, std::size_t first) {
    std::string faults;
    std::array<double, 2> sums{};
    for (std::size_t i = 0; i < 4; ++i) {
        if (!(weights[i] >= 0 && weights[i] <= 1)) faults += "a weight out of [0, 1]; ";
        sums[i >= first] += weights[i];
    }
    for (const double sum : sums)
        if (std::abs(sum - 1) > 0x1p-52) faults += "weights that do not add up to 1; ";
    return faults;
}

}  // namespace support
