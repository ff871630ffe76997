// Checks of the input of batches; they throw std::invalid_argument. Internal.
#pragma once

#include <algorithm>
#include <ccd/contact.hpp>
#include <ccd/kind.hpp>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>

namespace ccd::detail {

/// Throws if an index is >= `vertices`. `first` is the index of the first pair.
template <class Pair>
void check_indices(const char* caller, std::span<const Pair> pairs, std::size_t first,
                   std::size_t vertices) {
    vertex_index largest = 0;
    for (const Pair& q : pairs)
        for (const vertex_index v : vertices_of(q)) largest = std::max(largest, v);
    if (largest < vertices) return;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        for (const vertex_index v : vertices_of(pairs[i]))
            if (v >= vertices)
                throw std::invalid_argument(std::string(caller) + ": vertex index of query " +
                                            std::to_string(first + i) + " is " + std::to_string(v) +
                                            "; expected less than " + std::to_string(vertices));
}

inline void check_pointers(const char* caller, const vertex_rows& rows) {
    if (rows.vertices > 0 && (rows.before == nullptr || rows.after == nullptr))
        throw std::invalid_argument(std::string(caller) +
                                    ": pointer to positions is null; expected positions");
}

/// The shortest decimal that converts to x.
inline std::string text_of(double x) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, x).ptr};
}

inline void check_t_max(const char* caller, double t_max) {
    if (!(std::abs(t_max) <= std::numeric_limits<double>::max()))
        throw std::invalid_argument(std::string(caller) + ": t_max is " + text_of(t_max) +
                                    "; expected a finite number");
}

inline void check_distances(const char* caller, const pair_distances& distances,
                            std::size_t vertices) {
    const auto check = [caller](double distance, const std::string& of) {
        if (!(distance >= 0 && distance <= std::numeric_limits<double>::max()))
            throw std::invalid_argument(std::string(caller) + ": " + of + " is " +
                                        text_of(distance) + "; expected a finite number >= 0");
    };
    check(distances.all, "distance");
    if (distances.thickness.empty()) return;
    if (distances.all != 0)
        throw std::invalid_argument(std::string(caller) +
                                    ": distance and thicknesses are given; expected one of them");
    if (distances.thickness.size() != vertices)
        throw std::invalid_argument(std::string(caller) + ": number of thicknesses is " +
                                    std::to_string(distances.thickness.size()) + "; expected " +
                                    std::to_string(vertices) + ", one for each vertex");
    for (std::size_t v = 0; v < vertices; ++v)
        check(distances.thickness[v], "thickness of vertex " + std::to_string(v));
}

}  // namespace ccd::detail
