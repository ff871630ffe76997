// Pairs as lines of text: vf,v,f0,f1,f2 and so on.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/kind.hpp>
#include <ccd/step.hpp>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "ccd/program/options.hpp"
#include "errbound/support/table.hpp"

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

template <class Intersection>
std::size_t number_of(const std::vector<Intersection>& pairs, errbound::relation r) {
    return static_cast<std::size_t>(std::ranges::count(pairs, r, &Intersection::relation));
}

/// True for vertex/face and edge/edge; for other kinds only if the step has any.
template <kind K, class Result>
bool is_shown(const Result& found) {
    return is_cubic(K) || !found.pairs.template of<K>().empty() ||
           (found.candidates && found.candidates->template of<K>() > 0);
}

/// The numbers of candidates, if counted, and of colliding pairs.
template <class Result>
errbound::support::table table_of_counts(const std::string& method, const Result& found) {
    errbound::support::table rows = {{method, "collisions"}};
    if (found.candidates) rows[0].insert(rows[0].begin() + 1, "candidates");
    for_each_kind([&]<kind K>() {
        if (!is_shown<K>(found)) return;
        auto& row = rows.emplace_back(std::vector{std::string(path_name(K))});
        if (found.candidates) row.push_back(std::to_string(found.candidates->template of<K>()));
        row.push_back(std::to_string(found.pairs.template of<K>().size()));
    });
    return rows;
}

template <class Result>
nlohmann::ordered_json json_of_counts(const std::string& method, const Result& found) {
    nlohmann::ordered_json document = {{"method", method},
                                       {"candidates", nullptr},
                                       {"collisions", nlohmann::ordered_json::object()}};
    for_each_kind([&]<kind K>() {
        if (!is_shown<K>(found)) return;
        const std::string kind(name(K));
        if (found.candidates) document["candidates"][kind] = found.candidates->template of<K>();
        document["collisions"][kind] = found.pairs.template of<K>().size();
    });
    return document;
}

inline void add_unused(nlohmann::ordered_json& document, std::size_t unused, bool skipped) {
    if (unused > 0) document["unused_vertices"] = {{"count", unused}, {"skipped", skipped}};
}

inline nlohmann::ordered_json json_of_contact(const first_time& first) {
    if (first.outcome != outcome::collides) return nullptr;
    return {first.low, first.high};
}
inline std::string text_of_contact(const first_time& first) {
    using errbound::support::fixed;
    if (first.outcome != outcome::collides) return "-";
    return fixed(first.low, "%.17g") + " to " + fixed(first.high, "%.17g");
}

/// The intersections at the start of a step.
template <class Intersection>
std::string text_of_start(const std::vector<Intersection>& pairs) {
    if (pairs.empty()) return "\nFRAME0 is free of intersections\n";
    std::string parts;
    for (const errbound::relation r : intersection_relations)
        if (const std::size_t n = number_of(pairs, r); n > 0)
            parts += (parts.empty() ? "" : ", ") + std::to_string(n) + ' ' + std::string(name(r));
    return "\nFRAME0 has " + std::to_string(pairs.size()) +
           (pairs.size() == 1 ? " intersection (" : " intersections (") + parts +
           "); ccd check --pairs lists them\n";
}

/// Adds their numbers, if there are any.
template <class Intersection>
void add_start(nlohmann::ordered_json& document, const std::vector<Intersection>& pairs) {
    if (pairs.empty()) return;
    for (const errbound::relation r : intersection_relations)
        document["intersections_at_start"][std::string(name(r))] = number_of(pairs, r);
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
