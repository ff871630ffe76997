#include "examples/simulation/bodies/projective_solver.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "examples/simulation/bodies/selected_inverse.hpp"

namespace simulation {
namespace {

using gradient = Eigen::Matrix3d;  ///< the term's columns come first

gradient gradient_of(const elastic_term& term, const rows& x) {
    gradient g = gradient::Zero();
    for (std::size_t i = 0; i < std::size_t(term.vertices); ++i)
        for (int c = 0; c < term.columns; ++c)
            g.col(c) += term.gradients[i][std::size_t(c)] * x.row(term.vertex[i]).transpose();
    return g;
}

/// Three columns: returns the nearest matrix with singular values within the limits and a positive
/// determinant.
gradient clamped_solid(const gradient& f, double low, double high) {
    const Eigen::JacobiSVD<gradient> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
    vec3 s = svd.singularValues();
    gradient u = svd.matrixU();
    if ((u * svd.matrixV().transpose()).determinant() < 0) {
        u.col(2) = -u.col(2);  // of the least singular value
        s[2] = -s[2];
    }
    for (double& value : s) value = std::clamp(value, low, high);
    return u * s.asDiagonal() * svd.matrixV().transpose();
}

/// Two columns: uses the eigenvectors of FᵀF, a rotation by an angle.
gradient clamped_sheet(const gradient& f, double low, double high) {
    const double a = f.col(0).squaredNorm(), b = f.col(0).dot(f.col(1)), c = f.col(1).squaredNorm();
    const double angle = std::atan2(2 * b, a - c) / 2, cosine = std::cos(angle),
                 sine = std::sin(angle);
    vec3 first = cosine * f.col(0) + sine * f.col(1), second = cosine * f.col(1) - sine * f.col(0);
    const auto clamp = [&](vec3& stretched) {
        const double s = stretched.norm();
        if (s > 0) stretched *= std::clamp(s, low, high) / s;
    };
    clamp(first);
    clamp(second);
    gradient g = gradient::Zero();
    g.col(0) = cosine * first - sine * second;
    g.col(1) = sine * first + cosine * second;
    return g;
}

gradient projected(const elastic_term& term, const gradient& g) {
    if (term.kind == elastic_term::target::length) {
        const double length = g.col(0).norm();
        return length > 0 ? gradient(g * (std::clamp(length, term.low, term.high) / length)) : g;
    }
    return term.columns == 3 ? clamped_solid(g, term.low, term.high)
                             : clamped_sheet(g, term.low, term.high);
}

}  // namespace

projective_solver::projective_solver(const model& bodies, const solver_options& options)
    : bodies_(bodies), options_(options) {
    for (std::size_t v = 0; v < bodies.vertices(); ++v)
        unknown_.push_back(bodies.driven(v) ? -1 : unknowns_++);
    for (const elastic_term& term : bodies.terms) {
        first_row_.push_back(projected_);
        projected_ += term.columns;
    }
    assemble();
}

void projective_solver::assemble() {
    using triplet = Eigen::Triplet<double>;
    std::vector<triplet> matrix, forces;
    const double per_square = 1 / (options_.time_step * options_.time_step);
    for (std::size_t v = 0; v < bodies_.vertices(); ++v)
        if (unknown_[v] >= 0)
            matrix.emplace_back(unknown_[v], unknown_[v], bodies_.mass[v] * per_square);
    for (std::size_t t = 0; t < bodies_.terms.size(); ++t) {
        const elastic_term& term = bodies_.terms[t];
        for (std::size_t i = 0; i < std::size_t(term.vertices); ++i) {
            const Eigen::Index row = unknown_[term.vertex[i]];
            if (row < 0) continue;
            for (std::size_t c = 0; c < std::size_t(term.columns); ++c) {
                const double force = term.weight * term.gradients[i][c];
                forces.emplace_back(row, first_row_[t] + Eigen::Index(c), force);
                for (std::size_t j = 0; j < std::size_t(term.vertices); ++j) {
                    const Eigen::Index column = unknown_[term.vertex[j]];
                    if (column >= 0) matrix.emplace_back(row, column, force * term.gradients[j][c]);
                }
            }
        }
    }
    forces_.resize(unknowns_, projected_);
    forces_.setFromTriplets(forces.begin(), forces.end());
    sparse a(unknowns_, unknowns_);
    a.setFromTriplets(matrix.begin(), matrix.end());
    factor_.compute(a);
    if (factor_.info() != Eigen::Success)
        throw std::invalid_argument("projective_solver: the system is not positive definite");
    const Eigen::VectorXd diagonal = diagonal_of_inverse(factor_);
    for (const Eigen::Index row : unknown_) per_force_.push_back(row < 0 ? 0 : diagonal[row]);
}

rows projective_solver::wanted_changes(const rows& x) const {
    rows all(projected_, 3);
    for (std::size_t t = 0; t < bodies_.terms.size(); ++t) {
        const elastic_term& term = bodies_.terms[t];
        const gradient g = gradient_of(term, x);
        const gradient change = projected(term, g) - g;
        for (int c = 0; c < term.columns; ++c)
            all.row(first_row_[t] + c) = change.col(c).transpose();
    }
    return all;
}

rows projective_solver::inertial(const rows& x, const rows& v, const rows& driven) const {
    const double h = options_.time_step, kept = std::pow(1 - options_.damping, h);
    rows there = driven;
    for (std::size_t i = 0; i < bodies_.vertices(); ++i)
        if (const auto at = Eigen::Index(i); unknown_[i] >= 0)
            there.row(at) = x.row(at) + h * kept * v.row(at) + h * h * options_.gravity.transpose();
    return there;
}

/// Solves for a change of x: next to positions, small differences in stiff terms would be lost.
rows projective_solver::relaxed(const rows& x, const rows&) const {
    const double per_square = 1 / (options_.time_step * options_.time_step);
    Eigen::MatrixX3d right = forces_ * wanted_changes(x);
    for (std::size_t i = 0; i < bodies_.vertices(); ++i)
        if (const auto at = Eigen::Index(i); unknown_[i] >= 0)
            right.row(unknown_[i]) +=
                per_square * bodies_.mass[i] * (inertial_.row(at) - x.row(at));
    const Eigen::MatrixX3d change = factor_.solve(right);
    rows next = x;
    for (std::size_t i = 0; i < bodies_.vertices(); ++i)
        if (unknown_[i] >= 0) next.row(Eigen::Index(i)) += change.row(unknown_[i]);
    return next;
}

rows projective_solver::propose(const rows& x, const rows& v, const rows& driven) {
    inertial_ = inertial(x, v, driven);
    rows next = inertial_;
    const double moved = (next - x).cwiseAbs().maxCoeff();
    for (int k = 0; k < options_.iterations; ++k) {
        rows better = relaxed(next, next);
        const double changed = (better - next).cwiseAbs().maxCoeff();
        next = std::move(better);
        if (changed <= options_.converged * moved) break;
    }
    return next;
}

rows projective_solver::displacements(const rows& forces) const {
    Eigen::MatrixX3d right(unknowns_, 3);
    for (std::size_t v = 0; v < unknown_.size(); ++v)
        if (unknown_[v] >= 0) right.row(unknown_[v]) = forces.row(Eigen::Index(v));
    const Eigen::MatrixX3d solved = factor_.solve(right);
    rows all = rows::Zero(forces.rows(), 3);
    for (std::size_t v = 0; v < unknown_.size(); ++v)
        if (unknown_[v] >= 0) all.row(Eigen::Index(v)) = solved.row(unknown_[v]);
    return all;
}

double projective_solver::elastic_energy(const rows& x) const {
    double energy = 0;
    for (const elastic_term& term : bodies_.terms) {
        const gradient g = gradient_of(term, x);
        energy += term.weight / 2 * (g - projected(term, g)).squaredNorm();
    }
    return energy;
}

}  // namespace simulation
