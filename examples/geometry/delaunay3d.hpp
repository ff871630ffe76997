// Delaunay triangulations in space, also of points of which very many are on common spheres:
// perturbed weights choose one triangulation without flat simplices.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <errbound/predicates.hpp>
#include <errbound/predicates/perturbation.hpp>
#include <map>
#include <vector>

#include "examples/geometry/signs.hpp"

namespace delaunay3d {

using errbound::sign_type;
using point = std::array<double, 3>;
constexpr std::size_t none = ~std::size_t{0};

/// Returns the sign of insphere for weights that are infinitesimal. Zero only if all points are
/// coplanar.
template <bool Exact>
sign_type in_sphere(const std::array<std::size_t, 5>& i, const std::vector<point>& p) {
    const sign_type s =
        sign_by<Exact>(errbound::insphere)(p[i[0]], p[i[1]], p[i[2]], p[i[3]], p[i[4]]);
    if (!Exact || s != sign_type::zero) return s;
    constexpr auto by_weight = errbound::perturbed<3>(errbound::power_insphere);
    const auto at = [&](std::size_t k) {
        return std::array{p[i[k]][0], p[i[k]][1], p[i[k]][2], 0.0};
    };
    return by_weight(i, at(0), at(1), at(2), at(3), at(4));
}

/// Neighbour i is opposite to vertex i. The orientation of the vertices is positive. Beyond each
/// face of the hull is a simplex with a vertex at infinity, for which any point beyond stands.
struct simplex {
    std::array<std::size_t, 4> vertex{none, none, none, none}, neighbour = vertex;
    std::size_t corner_of(std::size_t v) const {  // 4 if v is no corner
        return static_cast<std::size_t>(std::ranges::find(vertex, v) - vertex.begin());
    }
};

using face_map = std::map<std::array<std::size_t, 4>, std::array<std::size_t, 2>>;
/// Joins face i of simplex t to the face of the same vertices, now or when that is added.
inline void join(std::vector<simplex>& simplices, face_map& faces, std::size_t t, std::size_t i) {
    auto face = simplices[t].vertex;
    face[i] = none;
    std::ranges::sort(face);
    const auto [at, is_new] = faces.try_emplace(face, std::array{t, i});
    if (is_new) return;
    const auto [u, j] = at->second;
    simplices[t].neighbour[i] = u;
    simplices[u].neighbour[j] = t;
}

/// Incremental algorithm (Bowyer 1981, Watson 1981).
template <bool Exact>
class triangulation {
  public:
    /// Precondition: distinct points, not all coplanar.
    explicit triangulation(const std::vector<point>& points)
        : infinity(points.size()), points_(points) {
        simplex first{{0, 1, 2, 3}};
        auto& v = first.vertex;
        while (orient(v) == sign_type::zero)
            if (++v[3] == points.size()) v[3] = ++v[2] + 1;
        const auto used = v;
        if (orient(v) == sign_type::negative) std::swap(v[0], v[1]);
        simplices.push_back(first);
        for (std::size_t i = 0; i < 4; ++i) {
            simplex ghost{first.vertex};
            ghost.vertex[i] = infinity;
            std::swap(ghost.vertex[(i + 1) % 4], ghost.vertex[(i + 2) % 4]);
            simplices.push_back(ghost);
        }
        face_map faces;
        for (std::size_t t = 0; t < 5; ++t)
            for (std::size_t i = 0; i < 4; ++i) join(simplices, faces, t, i);
        inside_of_.assign(5, none);
        for (std::size_t p = 0; p < points.size(); ++p)
            if (std::ranges::find(used, p) == used.end()) insert(p);
    }

    const std::size_t infinity;
    std::vector<simplex> simplices;  ///< removed ones have no vertices

  private:
    sign_type orient(const std::array<std::size_t, 4>& v) const {
        return sign_by<Exact>(errbound::orient3d)(points_[v[0]], points_[v[1]], points_[v[2]],
                                                  points_[v[3]]);
    }
    sign_type orient_with(simplex t, std::size_t corner, std::size_t p) const {
        t.vertex[corner] = p;
        return orient(t.vertex);
    }

    std::size_t locate(std::size_t p) const {
        std::size_t at = simplices.size() - 1;
        const std::size_t ghost = simplices[at].corner_of(infinity);
        if (ghost < 4) at = simplices[at].neighbour[ghost];
        for (;;) {
            const simplex& t = simplices[at];
            if (t.corner_of(infinity) < 4) return at;
            std::size_t i = 0;
            while (i < 4 && orient_with(t, i, p) != sign_type::negative) ++i;
            if (i == 4) return at;
            at = t.neighbour[i];
        }
    }

    /// True if p is in the sphere; at infinity, beyond the face, or in its plane and circle.
    bool encloses(const simplex& t, std::size_t p) const {
        const auto& v = t.vertex;
        const std::size_t ghost = t.corner_of(infinity);
        if (ghost == 4)
            return in_sphere<Exact>({v[0], v[1], v[2], v[3], p}, points_) == sign_type::positive;
        const sign_type side = orient_with(t, ghost, p);
        if (side != sign_type::zero) return side == sign_type::positive;
        return encloses(simplices[t.neighbour[ghost]], p);
    }

    void insert(std::size_t p) {
        std::vector<std::size_t> cavity{locate(p)};
        face_map faces;
        inside_of_[cavity[0]] = p;
        for (std::size_t k = 0; k < cavity.size(); ++k)
            for (std::size_t i = 0; i < 4; ++i) {
                simplex t = simplices[cavity[k]];
                const std::size_t beyond = t.neighbour[i], added = simplices.size();
                if (inside_of_[beyond] == p) continue;
                if (encloses(simplices[beyond], p)) {
                    inside_of_[beyond] = p;
                    cavity.push_back(beyond);
                    continue;
                }
                // The point and a face of the cavity's border. It replaces the neighbour inside.
                *std::ranges::find(simplices[beyond].neighbour, cavity[k]) = added;
                t.vertex[i] = p;
                simplices.push_back(t);
                inside_of_.push_back(none);
                for (std::size_t j = 0; j < 4; ++j)
                    if (j != i) join(simplices, faces, added, j);
            }
        for (const std::size_t t : cavity) simplices[t] = simplex();
    }

    const std::vector<point>& points_;
    std::vector<std::size_t> inside_of_;  ///< by simplex: the last point found in its sphere
};

}  // namespace delaunay3d
