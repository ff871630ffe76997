// From positions that a solver proposes to positions that can be gone to without a collision, by a
// method of choice: the part to put into a simulation of one's own.
//
//   simulation::collision_handler handler(faces, edges, masses, bodies, time_step, options);
//   ...
//   rows next = solver's proposal;
//   const simulation::response_report report = handler.resolve(positions, next, solver);
//
// where the solver says how its bodies yield to forces (compliance), or as particles would.
//
// A step is looked at by the method (ccd::mesh_steps). What it reports, uncertain pairs too, is
// responded to, and the step looked at again, until nothing is reported:
//  1. for some rounds by impulses with friction that keep all contacts found in this step apart
//     (collision/contacts.hpp), also those that are nearer than a thickness at its start;
//  2. then by rigid zones of what is still reported (collision/zones.hpp);
//  3. in the end, and this is said, by ccd::advance, which goes as far as is free.
// Where and along which normal a pair meets is told by its nearest points, in plain doubles, the
// same for all methods. No method but `exact` is helped by exact answers, except in 3.
//
// Of the positions that are accepted `exact` tells, if it is asked, which pairs pass through each
// other on the straight way there.
#pragma once

#include <ccd/advance.hpp>
#include <ccd/method.hpp>
#include <ccd/step.hpp>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "examples/simulation/bodies/positions.hpp"
#include "examples/simulation/collision/contacts.hpp"
#include "examples/simulation/collision/neighbours.hpp"

namespace simulation {

struct collision_options {
    ccd::method method = ccd::method::exact;
    double thickness = 1e-3;  ///< in metres: nearer than that is pushed apart
    double friction = 0.3;    ///< Coulomb's coefficient
    double push = 0.1;        ///< share of what lacks to the thickness that is given back a step
    int impulse_rounds = 12;
    int finishing_rounds = 10;   ///< the last of these, with what particles would do, too
    int finishing_sweeps = 100;  ///< of that
    double tolerance = 0.01;     ///< of contacts, in thicknesses
    int iterations = 8;          ///< of contact forces, after each relaxation of the bodies
    int relaxations = 9;         ///< in the first round, a third of it in others
    int rounds = 40;             ///< all together; then the response has not converged
    bool certify = true;         ///< ask `exact` about what is accepted
    int threads = 0;             ///< at most; 0: one per core
};

struct response_report {
    int iterations = 0;                     ///< looks at the step by the method
    std::size_t near_at_start = 0;          ///< pairs nearer than the thickness
    double least_distance = 0;              ///< of these, in metres; meaningless if there are none
    std::size_t contacts = 0;               ///< pairs reported at the first look
    std::size_t reported = 0;               ///< pairs reported at all looks
    std::size_t uncertain = 0;              ///< those of them that the method cannot decide
    std::optional<std::size_t> candidates;  ///< of all looks, where the method counts them
    std::size_t zones = 0;                  ///< rigid zones at the last look
    bool converged = true;                  ///< the method reports nothing any more
    double fraction = 1;                    ///< of the way, where it has not converged
    std::optional<std::size_t> passed_through;  ///< pairs that collide on the way, by `exact`
    double detection_seconds = 0, response_seconds = 0, certification_seconds = 0;
};

/// Of a pair, by its vertices.
using forces_of_pairs = std::map<std::array<vertex_index, 4>, vec3>;

class collision_handler {
  public:
    /// Of a mesh whose vertices have these masses (0: driven, and not moved by any response) and
    /// bodies (each advances by a fraction of its own, if need be). Throws what ccd::mesh_steps
    /// throws, and std::invalid_argument if there is not a body and a finite mass of each vertex,
    /// or the time step or an option makes no sense.
    collision_handler(const std::vector<ccd::face>& faces, const std::vector<ccd::edge>& edges,
                      const std::vector<double>& masses, std::vector<int> bodies, double time_step,
                      const collision_options& options);

    /// Moves `after`, rows of driven vertices only where it has not converged. `before` must be
    /// without contact, and surfaces there must not reach through each other: of what is already
    /// through, no step tells. Pairs of driven vertices alone are left out, and may pass through
    /// each other. Throws std::invalid_argument if a coordinate is not finite or there are not as
    /// many rows as vertices.
    response_report resolve(const rows& before, rows& after, const compliance& bodies);

    /// What the last step's contacts took, from which the next one's are looked for: with
    /// positions and velocities all that a run goes on from.
    const forces_of_pairs& last_forces() const { return last_forces_; }
    void restore(forces_of_pairs forces) { last_forces_ = std::move(forces); }

  private:
    ccd::pair_filter filter() const;
    std::vector<contact> near_at_start(const rows& before, response_report& report);
    ccd::pair_lists detect(const rows& before, const rows& after, response_report& report);
    void add_contacts(const ccd::pair_lists& pairs, const rows& before, const rows& after,
                      std::vector<contact>& contacts) const;
    void push_apart(std::vector<contact>& contacts, const compliance& bodies, const rows& before,
                    const rows& proposed, rows& after, int round) const;
    std::optional<std::size_t> passed_through(const rows& before, const rows& after,
                                              response_report& report);
    void advance_instead(const rows& before, rows& after, response_report& report);

    ccd::mesh_steps steps_;
    neighbours neighbours_;
    particle_compliance particles_;
    std::vector<double> masses_;
    std::vector<std::uint8_t> pinned_;
    forces_of_pairs last_forces_;
    std::vector<int> bodies_;
    collision_options options_;
};

}  // namespace simulation
