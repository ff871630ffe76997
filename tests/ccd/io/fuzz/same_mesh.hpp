// What the mesh fuzzers share: comparing meshes bit for bit.
#pragma once

#include <algorithm>
#include <bit>
#include <ccd/mesh.hpp>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace ccd::fuzz {

inline bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

inline bool same_mesh(const mesh& a, const mesh& b) {
    return a.faces == b.faces && a.edges == b.edges &&
           std::equal(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end(),
                      [](const point<double>& p, const point<double>& q) {
                          return same_bits(p.x, q.x) && same_bits(p.y, q.y) && same_bits(p.z, q.z);
                      });
}

/// Aborts unless the mesh is one that a reader may return.
inline void require_sound(const mesh& m) {
    for (const point<double>& p : m.vertices) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) std::abort();
    }
    const auto require_in_range = [&m](const auto& elements) {
        for (const auto& e : elements)
            if (*std::max_element(e.begin(), e.end()) >= m.vertices.size()) std::abort();
    };
    require_in_range(m.faces);
    require_in_range(m.edges);
}

}  // namespace ccd::fuzz
