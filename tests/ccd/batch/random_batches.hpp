// Random vertices on a small grid, so that contacts, ties and contacts at the start are frequent,
// and random pairs of them.
#pragma once

#include <ccd/batch.hpp>
#include <cstddef>
#include <cstdint>
#include <random>
#include <tuple>
#include <vector>

namespace random_batches {

inline constexpr ccd::vertex_index vertices = 60;

inline std::vector<ccd::point<double>> grid(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto coordinate = [&random] { return static_cast<double>(random() % 6); };
    std::vector<ccd::point<double>> points(vertices);
    for (auto& p : points) p = {coordinate(), coordinate(), coordinate()};
    return points;
}

template <class Pair>
std::vector<Pair> random_pairs(std::size_t count) {
    std::mt19937_64 random(count);
    std::vector<Pair> pairs(count);
    for (Pair& pair : pairs) {
        auto of_pair = vertices_of(pair);
        for (auto& v : of_pair) v = static_cast<ccd::vertex_index>(random() % vertices);
        std::apply([&pair](auto... v) { pair = {v...}; }, of_pair);
    }
    return pairs;
}

}  // namespace random_batches
