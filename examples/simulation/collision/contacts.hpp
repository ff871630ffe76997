// Contacts as inequalities on displacements, and the impulses that satisfy them, with friction.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "examples/simulation/bodies/positions.hpp"

namespace simulation {

/// Along the normal the first feature must move away from the second by at least `least` over the
/// step: normal · Σ weight (after − before) >= least. Inelastic: no more than needed is given.
struct contact {
    std::array<vertex_index, 4> vertex;
    std::array<double, 4> weight;  ///< the second feature's are negative
    vec3 normal;                   ///< of length 1, from the second feature to the first
    double least;
    vec3 force = vec3::Zero();  ///< on the first feature, in newtons
};

/// How bodies yield to forces within a step: what a solver of one's own provides.
class compliance {
  public:
    virtual ~compliance() = default;
    /// Where they would go without contact forces, told better from positions x that are nearer to
    /// where they will be: the next iterate of an implicit solver. Where forces act linearly, as on
    /// particles, that is `proposed`, which is what the solver proposed.
    virtual rows relaxed(const rows& x, const rows& proposed) const = 0;
    /// Displacements by forces, a row a vertex; 0 for driven vertices. Linear, symmetric.
    virtual rows displacements(const rows& forces) const = 0;
    /// How far v goes by a force of 1 on it alone, along that; 0 for driven vertices.
    virtual double of(std::size_t v) const = 0;
};

/// Of free particles: displacement = h²/mass · force.
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
    double friction;   ///< Coulomb's coefficient
    double tolerance;  ///< of an inequality, in metres
    int iterations;    ///< of forces, at most, after each relaxation
    int relaxations;   ///< of bodies, at most
};

/// Where bodies go from `before` that contact forces keep from where they would go, `proposed`: of
/// all positions with which all inequalities hold, nearly the nearest in the norm of the
/// compliance; friction holds what it can. By accelerated projected gradients on the forces (after
/// Mazhar and others, Using Nesterov's Method to Accelerate Multibody Dynamics with Friction and
/// Contact, 2015), from those that the contacts have on; in turns with relaxations of the bodies.
/// Cost: one call of displacements() an iteration, one of relaxed() a relaxation.
rows solve_contacts(std::vector<contact>& contacts, const compliance& bodies,
                    const contact_options& options, const rows& before, const rows& proposed);

/// What little is missing then, contact by contact (Gauss-Seidel), as of particles, without
/// friction: at most `sweeps` times. Returns the largest violation that is left.
double finish_contacts(const std::vector<contact>& contacts, const compliance& particles,
                       int sweeps, double tolerance, const rows& before, rows& after);

}  // namespace simulation
