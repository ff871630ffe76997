// Nearest points of two (moving) features in plain doubles. They do not decide collisions.
#pragma once

#include <array>

#include "examples/simulation/bodies/positions.hpp"

namespace simulation {

/// Weights of the four points of a pair. For each feature their sizes add up to 1, and the second's
/// are negative: Σ w x points from the second feature's nearest point to the first's.
struct nearest_points {
    std::array<double, 4> weights;
    vec3 between;  ///< Σ w x
    double distance() const { return between.norm(); }
};

/// Points: v, f0, f1, f2. Source: Ericson, Real-Time Collision Detection, 2005, section 5.1.5.
nearest_points nearest_vertex_face(const std::array<vec3, 4>& points);
/// Points: a0, a1, b0, b1. Source: Ericson, section 5.1.9.
nearest_points nearest_edges(const std::array<vec3, 4>& points);
/// Points: v, e0, e1, and an unused one.
nearest_points nearest_vertex_edge(const std::array<vec3, 4>& points);

/// Returns the nearest points of a pair in linear motion, until it first comes within a tenth of
/// its initial distance. Source: additive conservative advancement (Li and others, Codimensional
/// Incremental Potential Contact, 2021).
template <class Nearest>
nearest_points approach(const std::array<vec3, 4>& before, const std::array<vec3, 4>& after,
                        const Nearest& nearest) {
    constexpr int max_steps = 40;
    constexpr double near_enough = 0.1;
    const auto at = [&](double t) {
        std::array<vec3, 4> x;
        for (std::size_t i = 0; i < 4; ++i) x[i] = before[i] + t * (after[i] - before[i]);
        return x;
    };
    vec3 mean = vec3::Zero();
    for (std::size_t i = 0; i < 4; ++i) mean += (after[i] - before[i]) / 4;
    // The distance of two features decreases at most by the motion of the fastest points of both.
    double fastest = 0;
    for (std::size_t i = 0; i < 4; ++i)
        fastest = std::max(fastest, (after[i] - before[i] - mean).norm());
    const double speed = 2 * fastest;
    nearest_points closest = nearest(before);
    const double enough = near_enough * closest.distance();
    double t = 0, distance = closest.distance();
    for (int k = 0; k < max_steps && t < 1 && distance > enough && speed > 0; ++k) {
        t = std::min(1.0, t + 0.9 * distance / speed);
        const nearest_points now = nearest(at(t));
        distance = now.distance();
        if (distance > 0 && distance < closest.distance()) closest = now;
    }
    return closest;
}

}  // namespace simulation
