// What views refuse.
#pragma once

#include <ccd/io/step_view.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

namespace ccd::io::detail {

inline void require_in_range(std::string_view what, std::size_t row, vertex_index found,
                             std::size_t vertices) {
    if (found < vertices) return;
    throw std::invalid_argument(std::string(what) + ": row " + std::to_string(row) +
                                ": found vertex " + std::to_string(found) +
                                ", expected less than " + std::to_string(vertices));
}

/// Throws std::invalid_argument for a name with control characters: XML has no place for them, and
/// readers replace line ends by blanks.
inline void require_xml_name(std::string_view name) {
    for (const char c : name)
        if (static_cast<unsigned char>(c) < 0x20)
            throw std::invalid_argument("found '" + std::string(name) +
                                        "', expected a name without control characters");
}

/// Throws std::invalid_argument that names list, row, found and expected.
inline void require_view(const step_view& step) {
    const std::size_t vertices = step.positions.vertices;
    for (std::size_t i = 0; i < step.faces.size(); ++i)
        for (const vertex_index v : step.faces[i]) require_in_range("faces", i, v, vertices);
    for (std::size_t i = 0; i < step.edges.size(); ++i)
        for (const vertex_index v : step.edges[i]) require_in_range("edges", i, v, vertices);
    const bool timed = step.times != time_lists{};
    for_each_kind([&]<kind K>() {
        const auto& pairs = step.pairs.of<K>();
        for (std::size_t i = 0; i < pairs.size(); ++i)
            for (const vertex_index v : vertices_of(pairs[i]))
                require_in_range(name(K), i, v, vertices);
        if (timed && step.times.of<K>().size() != pairs.size())
            throw std::invalid_argument(
                std::string(name(K)) + ": found " + std::to_string(step.times.of<K>().size()) +
                " times, expected one a pair, " + std::to_string(pairs.size()));
    });
}

}  // namespace ccd::io::detail
