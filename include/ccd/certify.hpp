// Certificates of steps: free of contact, or the pairs in contact, their times and depths.
//
//     const ccd::certificate found = ccd::certify(steps, {before, after});  // or floats as stored
//     if (!found.is_free()) ...  // found.step.pairs, found.passages
//     auto why = ccd::reasons(positions, free.first_pairs, free.first_contact);  // of advance
//
// Vertices move linearly from `before` to `after`. Pairs, times and motions are exact; depths,
// velocities and distances have certified errors. Throws std::invalid_argument for bad input.
#pragma once

#include <array>
#include <ccd/contact.hpp>
#include <ccd/kind.hpp>
#include <ccd/mesh.hpp>
#include <ccd/nearness.hpp>
#include <ccd/query.hpp>
#include <ccd/step.hpp>
#include <limits>
#include <span>
#include <vector>

namespace ccd {

/// The first contact of a pair, and its depth: the distance by which the two contact points have
/// moved past each other along the normal at t = 1. It is max(0, -normal_velocity * (1 - t)),
/// since each contact point moves linearly. The depth is 0 with an infinite error if the contact
/// has no side, as at the start, or if its normal is the relative velocity.
struct passage {
    first_contact contact;
    contact_motion motion = contact_motion::unknown;
    double depth = 0, depth_error = std::numeric_limits<double>::infinity();

    friend bool operator==(const passage&, const passage&) = default;
};

namespace detail {
template <kind K>
using passages_of_kind = std::vector<passage>;
}  // namespace detail
using passage_lists = by_kind<detail::passages_of_kind>;

struct certificate {
    /// With times, touching_at_start, first_contact and intersections_at_start.
    step_result step;
    passage_lists passages;  ///< of step.pairs

    /// True if nothing intersects at the start and no pair of the step touches. Then the mesh has
    /// no intersection (ccd/intersections.hpp) at any time of the step, if the options had no
    /// filter and t_max = 1.
    bool is_free() const {
        return number_of(step.pairs) == 0 && step.intersections_at_start.empty();
    }
    /// The number of pairs that are apart at the start and touch on the way.
    std::size_t contacts() const {
        return number_of(step.pairs) - number_of(step.touching_at_start);
    }
    /// The passage with the greatest depth among those with a finite error; a default one if there
    /// is none.
    const passage& deepest() const;
};

/// Returns the certificate of one step. Sets times, check_start and adjacent_rods of the options.
/// Throws as mesh_steps::run, and if the options have distances. Cost: the step, a contact_at for
/// each pair.
certificate certify(mesh_steps& steps, const vertex_rows& positions, step_options options = {});
certificate certify(const mesh& before, const mesh& after, const step_options& options = {});
/// Positions in floats are converted exactly.
certificate certify(mesh_steps& steps, std::span<const point<float>> before,
                    std::span<const point<float>> after, const step_options& options = {});

/// A pair that limits a step.
struct reason {
    ccd::kind kind = ccd::kind::vertex_face;
    std::array<vertex_index, 4> vertices{};  ///< in the order of its kind
    first_time time;
    /// The result of motion_after. With distances, it is `approaches` if the normal velocity is
    /// certainly negative, `slides` if it is 0 within its error, else `unknown`.
    contact_motion motion = contact_motion::unknown;
    /// Equal to first_contact::normal_velocity (ccd/contact.hpp) of the pair. With distances, it is
    /// the velocity of the nearest points at time.low along their normal.
    double normal_velocity = 0;
    double normal_velocity_error = std::numeric_limits<double>::infinity();
    nearness at_start;

    friend bool operator==(const reason&, const reason&) = default;
};

/// Returns a reason for each of `first_pairs`, in their order, from the result of a step or of
/// `advance` (ccd/advance.hpp) along `positions`. `distances` are those of that call. Throws
/// std::invalid_argument if an index is out of range or positions are null.
std::vector<reason> reasons(const vertex_rows& positions, const pair_lists& first_pairs,
                            const first_time& first_contact, const pair_distances& distances = {});

}  // namespace ccd
