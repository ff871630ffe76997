// The oracle: a second exact decision of every query, made to share nothing with the library's own
// but the query types. Tests hold the library against it.
#pragma once

#include <ccd/curves.hpp>
#include <ccd/query.hpp>

namespace oracle {

/// Whether shortcuts may answer at once; off only to test them: disjoint swept boxes, and for
/// distances that instants are enough at which some nearest points' distance can be the one asked.
enum class shortcuts { on, off };

/// Times t, low <= t <= high, without `low` or `high` where they are said not to belong to it; for
/// 0 <= low <= high <= 1, which must be finite.
struct interval {
    double low = 0, high = 1;
    bool with_low = true, with_high = true;

    static interval instant(double t) { return {t, t}; }
};

/// Do the two closed features share a point at some t in the interval? Coordinates must be finite.
bool collides(const ccd::vertex_face<double>& query, shortcuts use = shortcuts::on,
              const interval& when = {});
bool collides(const ccd::edge_edge<double>& query, shortcuts use = shortcuts::on,
              const interval& when = {});
bool collides(const ccd::vertex_edge<double>& query, shortcuts use = shortcuts::on,
              const interval& when = {});
bool collides(const ccd::vertex_vertex<double>& query, shortcuts use = shortcuts::on,
              const interval& when = {});

/// Is the Euclidean distance of the two closed features at most d1 + d2, the exact sum of two
/// finite numbers >= 0, at some t in the interval?
bool within(const ccd::vertex_face<double>& query, double d1, double d2,
            shortcuts use = shortcuts::on, const interval& when = {});
bool within(const ccd::edge_edge<double>& query, double d1, double d2,
            shortcuts use = shortcuts::on, const interval& when = {});
bool within(const ccd::vertex_edge<double>& query, double d1, double d2,
            shortcuts use = shortcuts::on, const interval& when = {});
bool within(const ccd::vertex_vertex<double>& query, double d1, double d2,
            shortcuts use = shortcuts::on, const interval& when = {});

/// The same of motion along curves, with one control point or more each.
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
