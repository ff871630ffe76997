// Collision response: changes the positions that a solver proposes to positions that are reached
// without collision, by a chosen method (docs/simulation.md).
//
//   simulation::collision_handler handler(faces, edges, masses, bodies, time_step, options);
//   rows next = solver's proposal;
//   const simulation::response_report report = handler.resolve(positions, next, solver);
//
// The solver implements compliance; particle_compliance is the simplest one.
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
    /// In metres. Pairs within this are pushed apart; pairs within twice this may be contacts.
    double thickness = 1e-3;
    double friction = 0.3;  ///< Coulomb's coefficient
    double push = 0.1;      ///< share of the missing thickness that is restored per step
    int impulse_rounds = 12;
    int finishing_rounds = 10;   ///< last impulse rounds, which also move vertices as particles
    int finishing_sweeps = 100;  ///< Gauss-Seidel, over the contacts in each of these
    double tolerance = 0.01;     ///< of contacts, in thicknesses
    int iterations = 8;          ///< of contact forces, after each relaxation of the bodies
    int relaxations = 9;         ///< in the first round; a third of it in others
    int rounds = 40;             ///< in total; then the response has not converged
    bool certify = true;         ///< test accepted steps by `exact`
    int threads = 0;             ///< maximum; 0: one per core
};

struct response_report {
    int iterations = 0;                     ///< tests of the step by the method
    std::size_t near_at_start = 0;          ///< pairs nearer than the thickness
    double least_distance = 0;              ///< of these, in metres; `thickness` if there are none
    std::size_t contacts = 0;               ///< pairs reported by the first test
    std::size_t reported = 0;               ///< pairs reported by all tests
    std::size_t uncertain = 0;              ///< of these, pairs that the method cannot decide
    std::optional<std::size_t> candidates;  ///< of all tests, if the method counts them
    std::size_t zones = 0;                  ///< rigid zones at the last test
    bool converged = true;                  ///< the method reports no pair any more
    double fraction = 1;                    ///< of the step, if it has not converged
    std::optional<std::size_t> passed_through;  ///< pairs that collide in the step, by `exact`
    double detection_seconds = 0, response_seconds = 0, certification_seconds = 0;
};

using forces_of_pairs = std::map<std::array<vertex_index, 4>, vec3>;

class collision_handler {
  public:
    /// A vertex of mass 0 is driven. If the last resort is ccd::advance, each body moves by one
    /// fraction. Throws std::invalid_argument unless each vertex has a body and a finite mass, and
    /// time step and options are valid; also the exceptions of ccd::mesh_steps.
    collision_handler(const std::vector<ccd::face>& faces, const std::vector<ccd::edge>& edges,
                      const std::vector<double>& masses, std::vector<int> bodies, double time_step,
                      const collision_options& options);

    /// Moves `after`; driven vertices only if it has not converged. Pairs of driven vertices only
    /// are skipped and may pass through each other. Precondition: `before` has no contact, and
    /// surfaces do not intersect there (ccd/intersections.hpp). Throws std::invalid_argument if a
    /// coordinate is not finite or the number of rows differs from that of vertices.
    response_report resolve(const rows& before, rows& after, const compliance& bodies);

    /// The last contact forces, which start the next search: part of a run's state.
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
