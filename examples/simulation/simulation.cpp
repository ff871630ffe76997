#include "examples/simulation/simulation.hpp"

#include <chrono>
#include <random>
#include <stdexcept>
#include <utility>

namespace simulation {
namespace {

void perturb(const model& bodies, std::uint64_t seed, rows& positions) {
    std::mt19937_64 random(seed);
    const auto offset = [&random] {
        return (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5) * 2e-5;
    };
    for (std::size_t v = 0; v < bodies.vertices(); ++v)
        if (!bodies.driven(v))
            for (int axis = 0; axis < 3; ++axis) positions(Eigen::Index(v), axis) += offset();
}

}  // namespace

simulation_run::simulation_run(scene made, std::uint64_t seed)
    : scene_(std::move(made)),
      solver_(scene_.bodies, scene_.solver),
      collisions_(scene_.bodies.faces, scene_.bodies.edges, scene_.bodies.mass, scene_.bodies.body,
                  scene_.solver.time_step, scene_.collision) {
    state_.positions = scene_.bodies.start;
    if (seed != 0) perturb(scene_.bodies, seed, state_.positions);
    state_.velocities = scene_.velocities;
    if (state_.velocities.rows() == 0) state_.velocities = rows::Zero(state_.positions.rows(), 3);
    const ccd::mesh start = scene_.bodies.surface(state_.positions);
    ccd::step_options options{.threads = scene_.collision.threads};
    if (const std::size_t found = number_of(ccd::step(start, start, options).pairs); found > 0)
        throw std::invalid_argument("number of pairs in contact at the start is " +
                                    std::to_string(found) + "; expected 0");
}

void simulation_run::restore(run_state state) {
    state_ = std::move(state);
    collisions_.restore(state_.forces);
}

frame_record simulation_run::next_frame() {
    using clock = std::chrono::steady_clock;
    frame_record record;
    record.frame = state_.frame + 1;
    const clock::time_point begin = clock::now();
    rows driven = state_.positions;
    scene_.drive(record.frame, driven);
    rows next = solver_.propose(state_.positions, state_.velocities, driven);
    proposed_ = next;
    record.solver_seconds = std::chrono::duration<double>(clock::now() - begin).count();

    record.response = collisions_.resolve(state_.positions, next, solver_);
    state_.velocities = (next - state_.positions) / solver_.options().time_step;
    state_.positions = next;
    state_.forces = collisions_.last_forces();
    state_.frame = record.frame;

    const model& bodies = scene_.bodies;
    for (std::size_t v = 0; v < bodies.vertices(); ++v) {
        const auto at = Eigen::Index(v);
        record.kinetic_energy += bodies.mass[v] / 2 * state_.velocities.row(at).squaredNorm();
        record.potential_energy -=
            bodies.mass[v] * solver_.options().gravity.dot(next.row(at).transpose());
    }
    record.elastic_energy = solver_.elastic_energy(next);
    return record;
}

}  // namespace simulation
