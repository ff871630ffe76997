// Checks the data of a contact by rationals, with separate formulas and times.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/contact.hpp>
#include <ccd/kind.hpp>
#include <ccd/methods/transform.hpp>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "tests/support/nearest_points.hpp"
#include "tests/support/oracle.hpp"

namespace support::contact_data {

/// (f1 − f0) × (f2 − f0) or (a1 − a0) × (b1 − b0).
inline vector<rational> cross_product(ccd::kind k, const moment& m) {
    if (k == ccd::kind::vertex_face) return cross(m.at[2] - m.at[1], m.at[3] - m.at[1]);
    return cross(m.at[1] - m.at[0], m.at[3] - m.at[2]);
}
/// The height of the first feature above the second along the cross product: Y or −Y.
inline rational height(ccd::kind k, const moment& m) {
    const std::size_t base = k == ccd::kind::vertex_face ? 1 : 2;
    return dot(cross_product(k, m), m.at[0] - m.at[base]);
}

/// The velocity of the first feature's contact point relative to the second's.
inline vector<rational> velocity(std::size_t first_points, const std::array<rational, 4>& w,
                                 const moment& m) {
    vector<rational> sum{};
    for (std::size_t i = 0; i < m.at.size(); ++i)
        sum = sum - rational(i < first_points ? -w[i] : w[i]) * m.velocity[i];
    return sum;
}

/// Checks one answer of find_first_contact that reports a contact, and collects the faults.
template <class Query>
class check {
    static constexpr ccd::kind whole = ccd::kind_of<Query>;
    static constexpr bool has_normal =
        whole == ccd::kind::vertex_face || whole == ccd::kind::edge_edge;
    static constexpr std::size_t first_points = ccd::kind_traits<whole>::first_vertices;
    using exact_vector = vector<rational>;

  public:
    check(const Query& query, const ccd::first_contact& found) : query_(query), found_(found) {
        check_features();
        faults_ += faults_of_weights(found.weights, first_points);
        const rational low(found.time.low), high(found.time.high);
        for (const rational& t : {low, rational((low + high) / 2), high}) check_at(t);
        if (found.sided && found.normal_from == ccd::normal_source::cross_product) check_side();
        if (found.sided && found.normal_velocity > found.normal_velocity_error)
            fault("a sided normal along which the features move apart");
    }
    const std::string& faults() const { return faults_; }

  private:
    void fault(const std::string& what) { faults_ += what + "; "; }
    static bool at_most(const real& x, double bound) {
        return !(bound < 1e300) || x <= real(bound);
    }

    /// True if these smaller features of the query meet at some time of the bracket.
    bool meet(const ccd::meeting_features& of) const {
        const auto p = points_of(query_);
        const auto& [met, i] = of;
        const auto& t = found_.time;
        const bool one = t.low == t.high;
        const oracle::interval when{t.low, t.high, one, one};
        return met == ccd::kind::vertex_vertex
                   ? oracle::collides(ccd::vertex_vertex<double>{p[i[0]], p[i[1]]},
                                      oracle::shortcuts::on, when)
                   : oracle::collides(ccd::vertex_edge<double>{p[i[0]], p[i[1]], p[i[2]]},
                                      oracle::shortcuts::on, when);
    }
    void check_features() {
        const auto all = features_of<whole>();
        const auto smallest = std::ranges::find_if(
            all, [&](const ccd::meeting_features& of) { return of.kind == whole || meet(of); });
        if (found_.features.kind != smallest->kind) fault("not the smallest features");
        if (!ccd::is_cubic(found_.features.kind) && !meet(found_.features))
            fault("features that do not meet");
    }

    void check_at(const rational& t) {
        const moment m(query_, t);
        const feet<rational> exact(found_.features, m.at);
        if (exact.divisor == 0) return;
        std::array<rational, 4> w;
        std::ranges::transform(exact.weights, w.begin(),
                               [&](const rational& x) { return rational(x / exact.divisor); });
        // At times of the bracket other than the contact, weights may leave [0, 1]. The found
        // weights were clamped, which is then not an error.
        rational outside = 0;
        for (const rational& x : w) outside += x < 0 ? -x : rational(0);
        for (std::size_t i = 0; i < m.at.size(); ++i)
            if (!at_most(real(rational(abs(w[i] - rational(found_.weights[i])) - outside)),
                         found_.weight_error))
                fault("weight " + std::to_string(i) + " off by more than its error");
        check_normal(m, velocity(first_points, w, m));
    }
    void check_normal(const moment& m, const exact_vector& u) {
        exact_vector along{};
        const auto minus_u = rational(-1) * u;
        switch (found_.normal_from) {
            case ccd::normal_source::cross_product:
                if constexpr (has_normal) along = cross_product(whole, m);
                break;
            case ccd::normal_source::nearest_points:
                along = minus_u;
                if (found_.features.kind == ccd::kind::vertex_edge) {
                    const auto& i = found_.features.points;
                    const exact_vector e = m.at[i[2]] - m.at[i[1]];
                    along = along - rational(dot(along, e) / dot(e, e)) * e;
                }
                break;
            case ccd::normal_source::relative_velocity:
                along = minus_u;
                break;
            case ccd::normal_source::none:
                return;
        }
        if (is_zero(along)) {
            if (found_.normal_error < 1) fault("a normal where there is none");
            return;
        }
        auto n = unit(along);
        const auto claimed = of<real>(found_.normal);
        if (found_.normal_from == ccd::normal_source::cross_product && dot(n, claimed) < 0)
            n = real(-1) * n;
        const auto off = claimed - n;
        if (!at_most(sqrt(dot(off, off)), found_.normal_error))
            fault("normal off by more than its error");
        const vector<real> speed{real(u[0]), real(u[1]), real(u[2])};
        if (found_.normal_velocity_error < 1e300 &&
            abs(dot(n, speed) - real(found_.normal_velocity)) > real(found_.normal_velocity_error))
            fault("velocity off by more than its error");
    }
    /// Compares the side shortly before the contact, if it is the same at two such times.
    void check_side() {
        if constexpr (has_normal) {
            const rational t(found_.time.low), high(found_.time.high);
            const rational width = t < high ? rational(high - t) : t;
            const auto side = [&](int exponent) {
                const rational little = width * power_of(2, -exponent);
                const moment m(query_, t < high ? rational(t + little) : rational(t - little));
                const auto n = cross_product(whole, m);
                return (height(whole, m) * dot(n, of(found_.normal))).sign();
            };
            const int near = side(2000), nearer = side(4000);
            if (near == nearer && near < 0) fault("the other side");
        }
    }

    const Query& query_;
    const ccd::first_contact& found_;
    std::string faults_;
};

}  // namespace support::contact_data
