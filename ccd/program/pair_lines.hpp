// Pairs as lines of text: vf,v,f0,f1,f2 and so on.
#pragma once

#include <array>
#include <ccd/kind.hpp>
#include <ccd/step.hpp>
#include <cstddef>
#include <span>
#include <string>

#include "ccd/program/options.hpp"

namespace ccd::program {

template <class Number, std::size_t N>
const std::array<Number, N>& vertices_of(const std::array<Number, N>& numbers) {
    return numbers;
}

/// With times if `times` is not null.
template <class Lists>
std::string lines_of_pairs(const Lists& pairs, const time_lists* times = nullptr) {
    std::string lines;
    for_each_kind([&]<kind K>() {
        const auto& of_kind = pairs.template of<K>();
        for (std::size_t i = 0; i < of_kind.size(); ++i) {
            lines += short_name(K);
            for (const auto v : vertices_of(of_kind[i])) lines += ',' + std::to_string(v);
            if (times) lines += ',' + text_of_time(times->of<K>()[i]);
            lines += '\n';
        }
    });
    return lines;
}

inline std::string lines_of_intersections(std::span<const intersection> pairs) {
    std::string lines;
    for (const intersection& pair : pairs) {
        lines += short_name(pair.kind());
        for (const mesh_element& element : {pair.a, pair.b})
            for (const vertex_index v : element.vertices()) lines += ',' + std::to_string(v);
        lines += ',' + std::string(name(pair.relation)) + '\n';
    }
    return lines;
}

inline std::string lines_of_edge_faces(std::span<const edge_face_pair> pairs) {
    std::string lines;
    for (const auto& [e, f] : pairs) {
        lines += "ef";
        for (const vertex_index v : {e[0], e[1], f[0], f[1], f[2]})
            lines += ',' + std::to_string(v);
        lines += '\n';
    }
    return lines;
}

}  // namespace ccd::program
