// Inputs of predicates, and other libraries that decide them.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <errbound/predicate_batch.hpp>
#include <functional>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/bench/harness.hpp"
#include "tests/errbound/predicates/predicate_inputs.hpp"

namespace bench {

#ifdef ERRBOUND_HAVE_CGAL
inline constexpr bool have_cgal = true;
#else
inline constexpr bool have_cgal = false;
#endif

using signs = std::vector<errbound::sign_type>;

/// Inputs stored as ranges of points, one range for each argument.
template <std::size_t D, std::size_t N>
struct input_set {
    std::array<std::vector<std::array<double, D>>, N> points;
    std::array<std::array<std::vector<double>, D>, N> arrays;

    template <class Make>
    input_set(const Make& make, predicate_inputs::surface s, std::size_t count, int scale = 0) {
        predicate_inputs::generator random(3);
        for (std::size_t i = 0; i < count; ++i) {
            const auto p = make(random, s);
            for (std::size_t k = 0; k < N; ++k) {
                points[k].emplace_back();
                for (std::size_t d = 0; d < D; ++d) {
                    points[k].back()[d] = std::ldexp(p[k][d], scale);
                    arrays[k][d].push_back(points[k].back()[d]);
                }
            }
        }
    }
    std::size_t size() const { return points[0].size(); }
    errbound::coordinate_arrays<double, D> as_arrays(std::size_t argument) const {
        errbound::coordinate_arrays<double, D> a{{}, size()};
        for (std::size_t d = 0; d < D; ++d) a.coordinates[d] = arrays[argument][d].data();
        return a;
    }
    template <class Call>
    auto with(std::size_t i, const Call& call) const {
        return [&]<std::size_t... K>(std::index_sequence<K...>) {
            return call(points[K][i]...);
        }
        (std::make_index_sequence<N>());
    }
    /// A pass that decides the first inputs.
    template <class Decide>
    auto pass(const Decide& decide) const {
        return [this, decide](std::size_t count, signs& out) {
            for (std::size_t i = 0; i < count; ++i) out[i] = with(i, decide);
        };
    }
};

/// Decides the first `count` inputs of a set.
using deciding_pass = std::function<void(std::size_t count, signs& out)>;

struct cgal_pass {
    deciding_pass decide;        ///< empty if CGAL does not have the predicate
    bool only_negative = false;  ///< distinguishes negative signs from others, but no more
};
/// The passes of the exact predicates kernel and of the one with exact, lazy constructions. Points
/// are converted before.
template <std::size_t D, std::size_t N>
std::array<cgal_pass, 2> cgal_passes(std::string_view name, const input_set<D, N>& set);

using plane_points = std::vector<std::array<double, 2>>;
using space_points = std::vector<std::array<double, 3>>;

/// Times of algorithms made of predicates: constructions.cpp
void whole_constructions(bool quick, report& out);
// The same by CGAL: the number of cells, vertices or loops. Segments are pairs of neighbours.
std::size_t cgal_delaunay3d(const space_points& points);
std::size_t cgal_arrangement(const plane_points& ends);
std::size_t cgal_intersection(const plane_points& first, const plane_points& second);

}  // namespace bench
