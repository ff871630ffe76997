// Implicit Euler by projective dynamics: one constant matrix, factorised once for a whole run.
//
// Bouaziz, Martin, Liu, Kavan, Pauly: Projective Dynamics: Fusing Constraint Projections for Fast
// Simulation, 2014. Stable for every time step and stiffness; the stiffer the terms, the more
// iterations it takes until they are as stiff as they say.
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <vector>

#include "examples/simulation/bodies/model.hpp"
#include "examples/simulation/collision/contacts.hpp"

namespace simulation {

struct solver_options {
    double time_step = 0.01;  ///< in seconds
    int iterations = 10;      ///< local and global steps, at most
    double converged = 1e-5;  ///< the last correction over the step's largest displacement
    double damping = 0.1;     ///< share of velocity that is lost in a second
    vec3 gravity{0, 0, -9.81};
};

class projective_solver : public compliance {
  public:
    /// Keeps a reference to the model. Throws std::invalid_argument if some vertex that is not
    /// driven is held by nothing and has no mass.
    projective_solver(const model& bodies, const solver_options& options);

    /// Where the vertices would go from x with velocities v without contact: free ones by the
    /// equations of motion, driven ones to their rows of `driven`.
    rows propose(const rows& x, const rows& v, const rows& driven);
    /// One more iteration of the last proposal, from x.
    rows relaxed(const rows& x, const rows& proposed) const override;

    /// By the same matrix: terms yield as springs in the directions that they have.
    rows displacements(const rows& forces) const override;
    double of(std::size_t v) const override { return per_force_[v]; }

    /// Of all terms, in joules.
    double elastic_energy(const rows& x) const;

    const solver_options& options() const { return options_; }

  private:
    using sparse = Eigen::SparseMatrix<double>;

    /// One row for each column of each term: P(G x) − G x, how it wants to change.
    rows wanted_changes(const rows& x) const;
    void assemble();

    rows inertial(const rows& x, const rows& v, const rows& driven) const;

    const model& bodies_;
    solver_options options_;
    rows inertial_;  ///< where the last proposal's inertia and gravity alone would lead
    std::vector<Eigen::Index> unknown_;  ///< of each vertex, its row in the system, or −1
    std::vector<double>
        per_force_;  ///< of each vertex, of the matrix's inverse the diagonal; 0 of driven ones
    std::vector<Eigen::Index> first_row_;  ///< of each term, its first row of projections
    Eigen::Index unknowns_ = 0, projected_ = 0;
    Eigen::SparseMatrix<double, Eigen::RowMajor>
        forces_;  ///< Gᵀ times the weights: of changes, on unknowns
    Eigen::SimplicialLDLT<sparse> factor_;
};

}  // namespace simulation
