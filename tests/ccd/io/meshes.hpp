// Comparison of meshes bit for bit, and texts of meshes.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <ccd/mesh.hpp>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace test_meshes {

inline bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

inline bool same_mesh(const ccd::mesh& a, const ccd::mesh& b) {
    return a.faces == b.faces && a.edges == b.edges &&
           std::ranges::equal(a.vertices, b.vertices,
                              [](const ccd::point<double>& p, const ccd::point<double>& q) {
                                  return same_bits(p.x, q.x) && same_bits(p.y, q.y) &&
                                         same_bits(p.z, q.z);
                              });
}

/// True if all coordinates are finite and all indices in range, as readers promise.
inline bool is_sound(const ccd::mesh& m) {
    const auto finite = [](const ccd::point<double>& p) {
        return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    };
    const auto in_range = [&m](const auto& element) {
        return std::ranges::max(element) < m.vertices.size();
    };
    return std::ranges::all_of(m.vertices, finite) && std::ranges::all_of(m.faces, in_range) &&
           std::ranges::all_of(m.edges, in_range);
}

/// The shortest text that is read as the same number.
template <class Number>
std::string shortest(Number x) {
    std::array<char, 32> digits;
    return {digits.data(), std::to_chars(digits.begin(), digits.end(), x).ptr};
}

/// The texts between '|'.
inline std::vector<std::string> texts(const std::string& all) {
    std::vector<std::string> found;
    for (std::size_t begin = 0, end = 0; end != all.npos; begin = end + 1) {
        end = all.find('|', begin);
        found.push_back(all.substr(begin, end - begin));
    }
    return found;
}

/// The text with other ends of its lines.
inline std::string with_line_ends(const std::string& text, const std::string& end) {
    std::string result;
    for (const char c : text) result += c == '\n' ? end : std::string(1, c);
    return result;
}

inline std::string obj_of(const ccd::mesh& m) {
    std::string text;
    const auto add = [&text](char keyword, const auto& elements) {
        for (const auto& e : elements) {
            text += keyword;
            for (const ccd::vertex_index i : e) text += ' ' + std::to_string(std::uint64_t{i} + 1);
            text += '\n';
        }
    };
    for (const auto& p : m.vertices)
        text += "v " + shortest(p.x) + ' ' + shortest(p.y) + ' ' + shortest(p.z) + '\n';
    add('f', m.faces);
    add('l', m.edges);
    return text;
}

}  // namespace test_meshes
