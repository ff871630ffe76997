// Contact forces, the solver for them, and zones, in cases with known results.
#include "examples/simulation/collision/contacts.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>
#include <vector>

#include "examples/simulation/bodies/projective_solver.hpp"
#include "examples/simulation/bodies/selected_inverse.hpp"
#include "examples/simulation/bodies/shapes.hpp"
#include "examples/simulation/collision/zones.hpp"

namespace {

using simulation::contact;
using simulation::rows;
using simulation::vec3;

contact on_triangle(double least) {
    return {{0, 1, 2, 3}, {1, -0.5, -0.25, -0.25}, vec3::UnitZ(), least};
}

TEST(Contacts, StopAParticleAndHoldItByFriction) {
    const simulation::particle_compliance bodies({2, 0, 0, 0}, 0.1);
    const rows before = rows::Zero(4, 3);
    rows after = before;
    after.row(0) << 0.2, 0, -1;
    std::vector<contact> contacts{on_triangle(0)};
    const simulation::contact_options options{0.5, 1e-12, 50, 0};
    after = simulation::solve_contacts(contacts, bodies, options, before, after);
    // With mass/h² = 200, a force of 200 stops the fall. Its friction, up to 0.5 of it, suffices.
    EXPECT_NEAR(contacts[0].force.z(), 200, 1e-9);
    EXPECT_NEAR(after.row(0).norm(), 0, 1e-12);

    after.row(0) << 0.8, 0, -1;
    contacts = {on_triangle(0)};
    after = simulation::solve_contacts(contacts, bodies, options, before, after);
    EXPECT_NEAR(after(0, 0), 0.3, 1e-9);  // friction removes 0.5 of 1
    EXPECT_NEAR(after(0, 2), 0, 1e-12);
    EXPECT_TRUE(after.bottomRows(3).isZero(0));
}

TEST(Contacts, DoNotPullOrPushWithoutNeed) {
    const simulation::particle_compliance bodies({2, 0, 0, 0}, 0.1);
    const rows before = rows::Zero(4, 3);
    rows after = before;
    after.row(0) << 0.2, 0, 0.5;
    const rows free = after;
    std::vector<contact> contacts{on_triangle(0.25)};
    EXPECT_EQ(simulation::solve_contacts(contacts, bodies, {0.5, 1e-12, 50, 3}, before, after),
              free);
    EXPECT_EQ(simulation::finish_contacts(contacts, bodies, 10, 1e-12, before, after), 0);
    EXPECT_EQ(after, free);
}

TEST(Contacts, AChainOfParticlesIsFinished) {
    std::vector<double> masses(11, 1.0);
    masses[0] = 0;
    const simulation::particle_compliance bodies(masses, 1);
    rows before = rows::Zero(11, 3), after;
    for (int i = 0; i <= 10; ++i) before(i, 2) = i;
    after = before;
    after.col(2).tail(10).array() -= 1;
    std::vector<contact> contacts;
    for (simulation::vertex_index i = 0; i < 10; ++i)
        contacts.push_back({{i + 1, i, i, i}, {1, -1, 0, 0}, vec3::UnitZ(), -0.5});
    after = simulation::solve_contacts(contacts, bodies, {0, 1e-9, 2000, 0}, before, after);
    for (int i = 1; i <= 10; ++i) EXPECT_GE(after(i, 2) - after(i - 1, 2), 0.5 - 1e-8);
}

TEST(SelectedInverse, IsTheInversesDiagonal) {
    std::mt19937 random(7);
    std::vector<Eigen::Triplet<double>> entries;
    const int n = 60;
    for (int i = 0; i < n; ++i) entries.emplace_back(i, i, 10);
    for (int k = 0; k < 150; ++k) {
        const int i = int(random() % n), j = int(random() % n);
        const double x = double(random() % 100) / 100;
        entries.emplace_back(i, j, x);
        entries.emplace_back(j, i, x);
    }
    Eigen::SparseMatrix<double> a(n, n);
    a.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(a);
    const Eigen::MatrixXd inverse = Eigen::MatrixXd(a).inverse();
    EXPECT_LT((simulation::diagonal_of_inverse(factor) - inverse.diagonal()).cwiseAbs().maxCoeff(),
              1e-12);
}

TEST(Zones, TurnAsOneBody) {
    simulation::impact_zones zones(5);
    const std::vector<simulation::vertex_index> three{0, 1, 2};
    zones.join(three);
    EXPECT_EQ(zones.count(), 1U);
    rows before(5, 3), after(5, 3);
    before << 1, 0, 0, -1, 0, 0, 0, 1, 0, 5, 5, 5, 6, 6, 6;
    // A quarter turn about z and a translation of three vertices; the first deviates slightly.
    after << 0, 1, 2, 0, -1, 2, -1, 0, 2, 5, 5, 5, 6, 6, 6;
    const rows rigid = after;
    zones.move({1, 1, 1, 1, 1}, before, after);
    EXPECT_LT((after - rigid).cwiseAbs().maxCoeff(), 1e-12);
    after.row(0) += vec3(0.1, 0.05, 0).transpose();
    zones.move({1, 1, 1, 1, 1}, before, after);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            EXPECT_NEAR((after.row(i) - after.row(j)).norm(),
                        (before.row(i) - before.row(j)).norm(), 1e-12);
    after = before;
    after.row(0) += vec3(0, 0, 3).transpose();
    zones.move({0, 1, 1, 1, 1}, before, after);
    EXPECT_EQ(after.row(2), before.row(2) + vec3(0, 0, 3).transpose());
}

TEST(Solver, FallsFreelyAndReturnsToRest) {
    simulation::model bodies;
    const auto sheet = simulation::square(6, 1, 0);
    bodies.add_cloth(sheet.points, sheet.faces, {});
    simulation::solver_options options;
    options.damping = 0;
    options.iterations = 200;
    options.converged = 1e-12;
    simulation::projective_solver solver(bodies, options);
    const rows x = bodies.start, still = rows::Zero(x.rows(), 3);
    const rows fallen = solver.propose(x, still, x);
    const double by = 9.81 * options.time_step * options.time_step;
    EXPECT_LT((fallen - (x.rowwise() - vec3(0, 0, by).transpose())).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT(solver.elastic_energy(x), 1e-20);
    rows stretched = x;
    stretched.col(0) *= 1.02;
    EXPECT_GT(solver.elastic_energy(stretched), 1e-3);
    EXPECT_LT(solver.elastic_energy(solver.propose(stretched, still, x)),
              0.3 * solver.elastic_energy(stretched));
}

}  // namespace
