// The oracle: a second exact decision of every query. It shares only the query types with the
// library, and tests compare the library with it.
#pragma once

#include <ccd/curves.hpp>
#include <ccd/query.hpp>

namespace oracle {

/// Enables early exits; tests of the shortcuts turn them off. One is disjoint swept boxes. For
/// distances, the other tests only instants at which the distance of some nearest points can equal
/// the given one.
enum class shortcuts { on, off };

/// Times t with low <= t <= high, without an end that is marked as excluded. Precondition: 0 <= low
/// <= high <= 1.
struct interval {
    double low = 0, high = 1;
    bool with_low = true, with_high = true;

    static interval instant(double t) { return {t, t}; }
};

/// True if the two closed features share a point at some t in the interval. Precondition:
/// coordinates are finite.
bool collides(const ccd::vertex_face<double>& query, shortcuts use = shortcuts::on,
              const interval& when = {});
bool collides(const ccd::edge_edge<double>& query, shortcuts use = shortcuts::on,
              const interval& when = {});
bool collides(const ccd::vertex_edge<double>& query, shortcuts use = shortcuts::on,
              const interval& when = {});
bool collides(const ccd::vertex_vertex<double>& query, shortcuts use = shortcuts::on,
              const interval& when = {});

/// True if the Euclidean distance of the two closed features is at most d1 + d2 at some t in the
/// interval. The sum is exact. Precondition: d1 and d2 are finite and >= 0.
bool within(const ccd::vertex_face<double>& query, double d1, double d2,
            shortcuts use = shortcuts::on, const interval& when = {});
bool within(const ccd::edge_edge<double>& query, double d1, double d2,
            shortcuts use = shortcuts::on, const interval& when = {});
bool within(const ccd::vertex_edge<double>& query, double d1, double d2,
            shortcuts use = shortcuts::on, const interval& when = {});
bool within(const ccd::vertex_vertex<double>& query, double d1, double d2,
            shortcuts use = shortcuts::on, const interval& when = {});

/// The same functions for motion along curves with at least one control point each.
bool collides(const ccd::vertex_face_curves& query, shortcuts use = shortcuts::on,
              const interval& when = {});
bool collides(const ccd::edge_edge_curves& query, shortcuts use = shortcuts::on,
              const interval& when = {});
bool collides(const ccd::vertex_edge_curves& query, shortcuts use = shortcuts::on,
              const interval& when = {});
bool collides(const ccd::vertex_vertex_curves& query, shortcuts use = shortcuts::on,
              const interval& when = {});
bool within(const ccd::vertex_face_curves& query, double d1, double d2,
            shortcuts use = shortcuts::on, const interval& when = {});
bool within(const ccd::edge_edge_curves& query, double d1, double d2, shortcuts use = shortcuts::on,
            const interval& when = {});
bool within(const ccd::vertex_edge_curves& query, double d1, double d2,
            shortcuts use = shortcuts::on, const interval& when = {});
bool within(const ccd::vertex_vertex_curves& query, double d1, double d2,
            shortcuts use = shortcuts::on, const interval& when = {});

}  // namespace oracle
