// Meshes that are hard for orders, trees and rounding.
#pragma once

#include <ccd/mesh.hpp>
#include <ccd/query.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>

namespace nasty_shapes {

using generator = std::mt19937_64;
inline double uniform(generator& random) {
    return std::uniform_real_distribution<double>(-1, 1)(random);
}
inline ccd::point<double> in_cube(generator& random, double size) {
    return {size * uniform(random), size * uniform(random), size * uniform(random)};
}
inline ccd::point<double> operator+(const ccd::point<double>& p, const ccd::point<double>& q) {
    return {p.x + q.x, p.y + q.y, p.z + q.z};
}

/// A function that places patch i of a soup: initial and final positions of its vertices.
struct shape {
    const char* name;
    ccd::moving_point<double> (*vertex)(generator&, unsigned patch);
};

inline const shape shapes[] = {
    {"AllInOnePoint",
     [](auto&, unsigned) {
         return ccd::moving_point<double>{{1, 2, 3}, {1, 2, 3}};
     }},
    {"AllInOnePlane",
     [](auto& random, unsigned) {
         const auto p = in_cube(random, 1), q = in_cube(random, 0.1);
         return ccd::moving_point<double>{{p.x, p.y, 0.0}, {p.x + q.x, p.y + q.y, -0.0}};
     }},
    {"OneLine",
     [](auto& random, unsigned patch) {
         const double x = patch + uniform(random);
         return ccd::moving_point<double>{{x, x, x}, {x, x, x}};
     }},
    {"Clusters",
     [](auto& random, unsigned patch) {
         generator of_cluster(patch % 5);
         const auto p = in_cube(of_cluster, 1e6) + in_cube(random, 1e-3);
         return ccd::moving_point<double>{p, p + in_cube(random, 1e-3)};
     }},
    {"CloserThanFloats",
     [](auto& random, unsigned patch) {
         generator of_cluster(patch % 3);
         const auto p = in_cube(of_cluster, 1) + in_cube(random, 1e-9);
         return ccd::moving_point<double>{p, p + in_cube(random, 1e-9)};
     }},
    {"OneFarOff",
     [](auto& random, unsigned patch) {
         const auto p = in_cube(random, 1);
         return patch == 0 ? ccd::moving_point<double>{{1e200, 1, 1}, {1e200, 1, 1}}
                           : ccd::moving_point<double>{p, p + in_cube(random, 0.1)};
     }},
    {"FewBigAmongManySmall",
     [](auto& random, unsigned patch) {
         generator of_patch(patch);
         const double size = patch % 20 == 0 ? 1 : 0.02;
         const auto p = in_cube(of_patch, 1) + in_cube(random, size);
         return ccd::moving_point<double>{p, p + in_cube(random, 0.02)};
     }},
    {"FlyingFar",
     [](auto& random, unsigned patch) {
         generator of_patch(patch);
         const auto p = in_cube(of_patch, 100) + in_cube(random, 0.1);
         return ccd::moving_point<double>{p, p + in_cube(of_patch, 1000)};
     }},
    {"Needles",
     [](auto& random, unsigned patch) {
         generator of_patch(patch);
         auto p = in_cube(of_patch, 1);
         (patch % 3 == 0 ? p.x : patch % 3 == 1 ? p.y : p.z) += uniform(random);
         return ccd::moving_point<double>{p, p};
     }},
    {"Huge",
     [](auto& random, unsigned) {
         constexpr double most = std::numeric_limits<double>::max();
         return ccd::moving_point<double>{in_cube(random, most), in_cube(random, most)};
     }},
    {"FewUlpsOfTheLeast",
     [](auto& random, unsigned) {
         constexpr double least = std::numeric_limits<double>::denorm_min();
         const auto few = [&random] { return least * static_cast<double>(random() % 3); };
         return ccd::moving_point<double>{{few(), few(), few()}, {few(), few(), few()}};
     }},
    {"AllMagnitudes",
     [](auto& random, unsigned patch) {
         generator of_patch(patch);
         const double size = std::ldexp(1, static_cast<int>(of_patch() % 2000) - 1000);
         return ccd::moving_point<double>{in_cube(random, size), in_cube(random, size)};
     }},
};

/// Both frames of sixteen triangles, one a patch.
inline std::pair<ccd::mesh, ccd::mesh> triangles(const shape& of, std::uint64_t seed) {
    generator random(seed);
    ccd::mesh before, after;
    for (unsigned patch = 0; patch < 16; ++patch) {
        const auto v = ccd::vertex_index(before.vertices.size());
        for (int i = 0; i < 3; ++i) {
            const auto p = of.vertex(random, patch);
            before.vertices.push_back(p.t0);
            after.vertices.push_back(p.t1);
        }
        before.faces.push_back({v, v + 1, v + 2});
    }
    after.faces = before.faces;
    return {before, after};
}

}  // namespace nasty_shapes
