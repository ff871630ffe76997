// Implicit Euler by projective dynamics, with one constant matrix that is factorised once per run.
// Source: Bouaziz, Martin, Liu, Kavan, Pauly: Projective Dynamics: Fusing Constraint Projections
// for Fast Simulation, 2014. Always stable; stiff terms need more iterations to be as stiff.
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <vector>

#include "examples/simulation/bodies/model.hpp"
#include "examples/simulation/collision/contacts.hpp"

namespace simulation {

struct solver_options {
    double time_step = 0.01;  ///< in seconds
    int iterations = 10;      ///< maximum of local and global steps
    double converged = 1e-5;  ///< the last correction over the step's largest displacement
    double damping = 0.1;     ///< share of velocity lost per second
    vec3 gravity{0, 0, -9.81};
};

class projective_solver : public compliance {
  public:
    /// Keeps a reference to the model. Throws std::invalid_argument if a vertex that is not driven
    /// has no mass and no elastic term.
    projective_solver(const model& bodies, const solver_options& options);

    /// Returns positions after a step from x with velocities v without contact: free vertices by
    /// the equations of motion, driven ones at their rows of `driven`.
    rows propose(const rows& x, const rows& v, const rows& driven);
    rows relaxed(const rows& x, const rows& proposed) const override;

    /// Terms yield as springs in their current directions.
    rows displacements(const rows& forces) const override;
    double of(std::size_t v) const override { return per_force_[v]; }

    /// The energy of all terms, in joules.
    double elastic_energy(const rows& x) const;

    const solver_options& options() const { return options_; }

  private:
    using sparse = Eigen::SparseMatrix<double>;

    /// Returns P(G x) − G x, one row for each column of each term.
    rows wanted_changes(const rows& x) const;
    void assemble();

    rows inertial(const rows& x, const rows& v, const rows& driven) const;

    const model& bodies_;
    solver_options options_;
    rows inertial_;  ///< positions by inertia and gravity only, in the last proposal
    std::vector<Eigen::Index> unknown_;    ///< of each vertex: its row in the system, or −1
    std::vector<double> per_force_;        ///< of each vertex: diagonal of the inverse; 0 if driven
    std::vector<Eigen::Index> first_row_;  ///< of each term: its first row of projections
    Eigen::Index unknowns_ = 0, projected_ = 0;
    Eigen::SparseMatrix<double, Eigen::RowMajor> forces_;  ///< Gᵀ times the weights
    Eigen::SimplicialLDLT<sparse> factor_;
};

}  // namespace simulation
