// Steps of many bodies: from their motions to the pairs that touch, with first times.
//
//     ccd::body_steps steps({gear, pinion, base});               // meshes at rest
//     const std::vector<ccd::body_motion> motions{turn_left, turn_right, ccd::resting{}};
//     const ccd::body_step_result found = steps.run(motions);    // pairs and first times
//     const ccd::body_advance free = steps.advance(motions);     // motions without contact
//
// Exact, as one query (ccd/bodies/motion.hpp): no pair is missed, none is reported without contact.
// Pairs are of elements of different bodies, as in ccd/step.hpp. An edge that goes through the
// inside of another body's face throughout is in no pair, and advance() does not see it:
// body_step_options::check_start reports it. Results do not depend on the number of threads.
// Throws std::invalid_argument for bad input.
#pragma once

#include <ccd/bodies/motion.hpp>
#include <ccd/execution.hpp>
#include <ccd/intersections.hpp>
#include <ccd/kind.hpp>
#include <ccd/mesh.hpp>
#include <ccd/query.hpp>
#include <ccd/step.hpp>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace ccd {

struct body_step_options {
    separation distance = {};  ///< report pairs within this distance instead of pairs in contact
    double t_max = 1;          ///< report only pairs with a contact in [0, t_max]
    bool check_start = false;  ///< fill crossing_at_start
    int threads = 0;           ///< at most; 0: one per core
    stop_query stop = {};      ///< ends the call by throwing ccd::stopped
    /// True for two bodies whose pairs are tested; empty: all. Called once for each two bodies
    /// whose swept boxes touch and of which one moves, the lesser index first.
    std::function<bool(std::size_t, std::size_t)> may_touch = {};
};

/// Lists are as in step_result. Vertices are numbered consecutively over all bodies,
/// in their order.
struct body_step_result {
    pair_lists pairs;
    time_lists times;              ///< the first time of each of `pairs`
    pair_lists touching_at_start;  ///< those of `pairs` in contact, or in the distance, at t = 0

    /// With check_start: edges that go through the inside of another body's face at t = 0, sorted.
    /// If two tested bodies have no pair here and none in touching_at_start, their surfaces are
    /// apart at t = 0. Without a distance, the reverse holds, too. Exact for the poses as given,
    /// without rounding.
    std::vector<edge_face_pair> crossing_at_start;
    first_time first_contact;    ///< the earliest not at t = 0; `separate` if there is none
    pair_lists first_pairs;      ///< the members of `pairs` with that time
    std::size_t body_pairs = 0;  ///< two bodies whose swept boxes touch, and that were tested
    pair_counts candidates;      ///< pairs whose swept boxes touch
};

struct body_advance_options {
    body_step_options step = {};  ///< its t_max is ignored
    /// The share of the way to the first contact (or distance) that is used: in (0, 1].
    double conservative = 1;
};

struct body_advance {
    /// From the given starts to the poses at `fraction`, rounded: exact queries about these motions
    /// find no contact, except of pairs that touch at the start. To continue, start from their
    /// ends; do not normalise the quaternions.
    std::vector<body_motion> motions;
    double fraction = 1;           ///< the same for all bodies
    first_time first_contact;      ///< on the whole way, as in body_step_result
    pair_lists first_pairs;        ///< the pairs with that time: they limit the step
    pair_lists touching_at_start;  ///< skipped: no step of these pairs is free
    std::vector<edge_face_pair> crossing_at_start;  ///< as in body_step_result
};

/// Returns a motion with the same start. Its pose at t = 1 is that of `motion` at `fraction`,
/// rounded.
body_motion until(const body_motion& motion, double fraction);

/// Bodies with meshes in their own coordinates. Keeps a tree of each at rest, whose nodes are moved
/// where needed. One call at a time. Results do not depend on earlier steps.
///
/// Two bodies whose swept boxes touch cost a search for the elements near the other body, and their
/// pairs. Two bodies that do not move (see `moves`) are not tested: they cost nothing and are never
/// reported, even if they touch. Memory: about 100 bytes a vertex, edge or face of bodies that met
/// another.
class body_steps {
  public:
    /// Throws std::invalid_argument if an index is out of range, a coordinate is not finite, or
    /// there are 2^32 or more vertices.
    explicit body_steps(std::vector<mesh> bodies);
    ~body_steps();
    /// A moved-from object may only be destroyed or assigned to.
    body_steps(body_steps&&) noexcept;
    body_steps& operator=(body_steps&&) noexcept;

    std::size_t bodies() const;
    /// The number of a body's first vertex; for bodies(), the number of all vertices.
    vertex_index first_vertex(std::size_t body) const;
    std::size_t body_of(vertex_index vertex) const;
    const mesh& rest(std::size_t body) const;
    /// The query of a pair of a result. Precondition: `motions` outlives it.
    template <any_pair Pair>
    auto query_of(const Pair& pair, std::span<const body_motion> motions) const {
        const auto at = [&](vertex_index v) -> body_point {
            const std::size_t b = body_of(v);
            return {&motions[b], rest(b).vertices[v - first_vertex(b)]};
        };
        return detail::with_members(pair,
                                    [&](auto... v) { return query_of_points<Pair>(at(v)...); });
    }

    /// Returns the pairs that touch. `motions` has one motion for each body.
    ///
    /// Throws std::invalid_argument if the numbers of motions and bodies differ, if fault_of
    /// reports a motion, or if t_max or the distance is invalid.
    body_step_result run(std::span<const body_motion> motions,
                         const body_step_options& options = {});

    /// Returns the longest common step that was found to be free. Its fraction is the time of the
    /// first contact, or a few units in the last place less, times `conservative`. It is less, at
    /// worst 0, if the rounded ends touch. Throws as run(). Cost: one step if the whole way is
    /// free, else usually two, at most 30.
    body_advance advance(std::span<const body_motion> motions,
                         const body_advance_options& options = {});

  private:
    template <class Pair, class... Points>
    static auto query_of_points(const Points&... points) {
        if constexpr (kind_of<Pair> == kind::vertex_face)
            return vertex_face_of<body_point>{points...};
        else if constexpr (kind_of<Pair> == kind::edge_edge)
            return edge_edge_of<body_point>{points...};
        else if constexpr (kind_of<Pair> == kind::vertex_edge)
            return vertex_edge_of<body_point>{points...};
        else
            return vertex_vertex_of<body_point>{points...};
    }

    struct state;
    std::unique_ptr<state> state_;
};

}  // namespace ccd
