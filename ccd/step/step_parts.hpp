// What steps on the host and on a device share: checks of the input, pairs, a stopwatch. Internal.
#pragma once

#include <algorithm>
#include <ccd/batch.hpp>
#include <ccd/mesh.hpp>
#include <ccd/step.hpp>
#include <chrono>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "ccd/exact/finite.hpp"

namespace ccd {

/// Throws std::invalid_argument where the two frames cannot be a step's.
inline void check_step(const mesh& before, const mesh& after) {
    if (before.vertices.size() != after.vertices.size())
        throw std::invalid_argument("ccd::step: " + std::to_string(before.vertices.size()) +
                                    " vertices before, " + std::to_string(after.vertices.size()) +
                                    " after");
    if (before.faces != after.faces)
        throw std::invalid_argument("ccd::step: the two frames differ in their faces");
    if (before.vertices.size() > std::numeric_limits<index>::max())
        throw std::invalid_argument("ccd::step: more vertices than an index can name");
    for (const face& f : before.faces)
        for (const index v : f)
            if (v >= before.vertices.size())
                throw std::invalid_argument("ccd::step: a face names vertex " + std::to_string(v) +
                                            " of " + std::to_string(before.vertices.size()));
    for (const mesh* frame : {&before, &after})
        if (!detail::all_finite(reinterpret_cast<const double*>(frame->vertices.data()),
                                3 * frame->vertices.size()))
            throw std::invalid_argument("ccd::step: a coordinate is not finite");
}

/// Seconds since it was made or last read.
class stopwatch {
  public:
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
    }

  private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// A candidate in canonical form.
inline vertex_face_pair canonical(const vertex_face_pair& p) {
    face f{p.f0, p.f1, p.f2};
    std::ranges::sort(f);
    return {p.v, f[0], f[1], f[2]};
}
inline edge_edge_pair canonical(const edge_edge_pair& p) {
    return p;  // edges are ascending, the lesser one first
}

}  // namespace ccd
