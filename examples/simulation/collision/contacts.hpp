// Contacts as inequalities on displacements, and the impulses with friction that satisfy them.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "examples/simulation/bodies/positions.hpp"

namespace simulation {

/// In the step, the first feature must move away from the second by at least `least` along the
/// normal: normal · Σ weight (after − before) >= least. The contact is inelastic.
struct contact {
    std::array<vertex_index, 4> vertex;
    std::array<double, 4> weight;  ///< the second feature's are negative
    vec3 normal;                   ///< a unit vector from the second feature to the first
    double least;
    vec3 force = vec3::Zero();  ///< on the first feature, in newtons
};

/// The displacements of bodies by forces in a step; implemented by solvers.
class compliance {
  public:
    virtual ~compliance() = default;
    /// Returns the solver's next iterate from x, without contact forces. If forces act linearly, as
    /// on particles, returns `proposed`.
    virtual rows relaxed(const rows& x, const rows& proposed) const = 0;
    /// Returns one row per vertex; 0 for driven vertices. Linear and symmetric.
    virtual rows displacements(const rows& forces) const = 0;
    /// Returns the displacement of v by a unit force on v only, along it; 0 for driven vertices.
    virtual double of(std::size_t v) const = 0;
};

/// Free particles: displacement = h²/mass · force.
class particle_compliance : public compliance {
  public:
    particle_compliance(const std::vector<double>& masses, double time_step);
    rows relaxed(const rows&, const rows& proposed) const override { return proposed; }
    rows displacements(const rows& forces) const override;
    double of(std::size_t v) const override { return per_force_[v]; }

  private:
    std::vector<double> per_force_;
};

struct contact_options {
    double friction;
    double tolerance;  ///< of an inequality, in metres
    int iterations;    ///< maximum for forces, after each relaxation
    int relaxations;
};

/// Returns positions with contact forces: among those that satisfy all inequalities, nearly the
/// nearest to `proposed` in the norm of the compliance, with friction. Accelerated projected
/// gradients on the forces, from their initial values, alternate with relaxations of the bodies.
/// Source: Mazhar and others, Using Nesterov's Method to Accelerate Multibody Dynamics with
/// Friction and Contact, 2015. Cost: one call of displacements() per iteration, one of relaxed()
/// per relaxation.
rows solve_contacts(std::vector<contact>& contacts, const compliance& bodies,
                    const contact_options& options, const rows& before, const rows& proposed);

/// Removes remaining violations contact by contact (Gauss-Seidel), as of particles, without
/// friction, in at most `sweeps` sweeps. Returns the largest remaining violation.
double finish_contacts(const std::vector<contact>& contacts, const compliance& particles,
                       int sweeps, double tolerance, const rows& before, rows& after);

}  // namespace simulation
