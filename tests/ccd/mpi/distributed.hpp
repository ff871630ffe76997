// Distributed meshes for tests: every rank makes the same meshes and takes its share.
#pragma once

#include <algorithm>
#include <ccd/mpi.hpp>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace distributed {

inline int rank = 0, size = 1, failures = 0;

inline void expect(bool holds, const std::string& what) {
    if (holds) return;
    std::printf("rank %d of %d: %s\n", rank, size, what.c_str());
    ++failures;
}

struct scene {
    std::string name;
    ccd::mesh before, after;
};

/// Faces of a few vertices, whose boxes have common corners on any side of the origin. Regions of
/// space are then split although nothing is inside.
inline scene few_corners(std::mt19937& random, std::size_t vertices, std::size_t faces) {
    std::uniform_real_distribution<double> move(-0.5, 0.5);
    scene s{std::to_string(faces) + " faces of " + std::to_string(vertices), {}, {}};
    const ccd::point<double> middle{4 * move(random), 4 * move(random), 4 * move(random)};
    const auto vertex = [&] { return static_cast<ccd::vertex_index>(random() % vertices); };
    for (std::size_t v = 0; v < vertices; ++v)
        for (ccd::mesh* m : {&s.before, &s.after})
            m->vertices.push_back(
                {middle.x + move(random), middle.y + move(random), middle.z + move(random)});
    for (std::size_t f = 0; f < faces; ++f)
        s.before.faces.push_back({vertex(), vertex(), vertex()});
    s.after.faces = s.before.faces;
    return s;
}

/// Random triangles, rods and points in the unit cube. `length` is the largest motion on each axis.
/// Every third vertex lies anywhere, and the next two near it, so that the boxes of faces are
/// small.
inline scene soup(std::mt19937& random, std::size_t vertices, double length) {
    std::uniform_real_distribution<double> place(0, 1), near(-0.1, 0.1), move(-length, length);
    const auto moved = [&](const ccd::point<double>& p, auto& by) -> ccd::point<double> {
        return {p.x + by(random), p.y + by(random), p.z + by(random)};
    };
    scene s{"soup of " + std::to_string(vertices), {}, {}};
    for (std::size_t v = 0; v < vertices; ++v) {
        s.before.vertices.push_back(v % 3 == 0 ? moved({}, place)
                                               : moved(s.before.vertices[v / 3 * 3], near));
        s.after.vertices.push_back(moved(s.before.vertices.back(), move));
    }
    for (std::size_t i = 0; i < vertices / 3; ++i) {
        const auto a = static_cast<ccd::vertex_index>(random() % (vertices - 2));
        s.before.faces.push_back({a, a + 1, a + 2});
        if (i % 4 == 0)
            s.before.edges.push_back({static_cast<ccd::vertex_index>(random() % vertices), a});
    }
    s.after.faces = s.before.faces;
    s.after.edges = s.before.edges;
    return s;
}

/// Copies of a bumpy sheet, one above the other, that fall onto each other: `n` by `n` squares
/// each.
inline scene sheets(std::size_t layers, std::size_t n) {
    scene s{"sheets of " + std::to_string(layers * n * n * 2) + " triangles", {}, {}};
    for (std::size_t l = 0; l < layers; ++l) {
        const auto first = static_cast<ccd::vertex_index>(s.before.vertices.size());
        for (std::size_t i = 0; i <= n; ++i)
            for (std::size_t j = 0; j <= n; ++j) {
                const double x = static_cast<double>(i), y = static_cast<double>(j);
                const double z =
                    0.3 * std::sin(7 * x + 3 * static_cast<double>(l)) * std::cos(5 * y);
                const double height = 2 * static_cast<double>(l);
                s.before.vertices.push_back({x, y, z + height});
                s.after.vertices.push_back({x + 0.1, y, z + 0.8 * height});
            }
        const auto at = [&](std::size_t i, std::size_t j) {
            return first + static_cast<ccd::vertex_index>(i * (n + 1) + j);
        };
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j) {
                s.before.faces.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
                s.before.faces.push_back({at(i + 1, j + 1), at(i, j + 1), at(i + 1, j)});
            }
    }
    s.after.faces = s.before.faces;
    return s;
}

/// A sheet, one face over all of it, and many points at one position.
inline scene huge_face_and_heap() {
    scene s = sheets(1, 20);
    s.name = "a huge face and a heap";
    const auto add = [&s](const ccd::point<double>& p, const ccd::point<double>& q) {
        s.before.vertices.push_back(p);
        s.after.vertices.push_back(q);
        return static_cast<ccd::vertex_index>(s.before.vertices.size() - 1);
    };
    const auto a = add({-100, -100, 5}, {-100, -100, -5}), b = add({200, -100, 5}, {200, -100, -5}),
               c = add({0, 300, 5}, {0, 300, -5});
    s.before.faces.push_back({a, b, c});
    for (int i = 0; i < 30; ++i) add({3, 3, 3}, {3, 3, 3.0 + i % 3});
    s.after.faces = s.before.faces;
    return s;
}

/// A rank's faces and edges, and vertices beyond theirs.
struct share {
    std::vector<ccd::mpi::vertex_number> numbers;
    std::vector<ccd::vertex_index> of_whole;
    std::vector<ccd::point<double>> before, after;
    std::vector<ccd::face> faces;
    std::vector<ccd::edge> edges;

    ccd::mpi::mesh_part part() const { return {numbers, {before, after}, faces, edges}; }
};

/// The global index of a vertex for MPI. Indices are unique and keep the vertices' order, with
/// gaps.
inline ccd::mpi::vertex_number number_of(ccd::vertex_index v) {
    return (std::uint64_t(1) << 40) + 1000 * std::uint64_t(v);
}

using placing = std::function<int(std::size_t)>;  ///< the rank of an element

inline share share_of(const scene& s, const placing& place, bool doubled) {
    share own;
    std::map<ccd::vertex_index, ccd::vertex_index> local;
    const auto use = [&](ccd::vertex_index v) {
        const auto [at, is_new] =
            local.try_emplace(v, static_cast<ccd::vertex_index>(own.numbers.size()));
        if (is_new) {
            own.numbers.push_back(number_of(v));
            own.of_whole.push_back(v);
            own.before.push_back(s.before.vertices[v]);
            own.after.push_back(s.after.vertices[v]);
        }
        return at->second;
    };
    // Some elements are also on the next rank.
    const auto is_here = [&](std::size_t i) {
        return place(i) == rank || (doubled && i % 7 == 0 && (place(i) + 1) % size == rank);
    };
    for (std::size_t i = 0; i < s.before.faces.size(); ++i)
        if (is_here(i)) {
            const ccd::face& f = s.before.faces[i];
            own.faces.push_back({use(f[0]), use(f[1]), use(f[2])});
        }
    for (std::size_t i = 0; i < s.before.edges.size(); ++i)
        if (is_here(i)) own.edges.push_back({use(s.before.edges[i][0]), use(s.before.edges[i][1])});
    for (ccd::vertex_index v = 0; v < s.before.vertices.size(); ++v)
        if (is_here(v)) use(v);
    return own;
}

template <ccd::kind K>
std::vector<ccd::mpi::numbered_pair<K>> numbered(const std::vector<ccd::pair_of_kind<K>>& pairs) {
    std::vector<ccd::mpi::numbered_pair<K>> all;
    for (const auto& p : pairs) {
        ccd::mpi::numbered_pair<K> n{};
        std::ranges::transform(vertices_of(p), n.begin(), number_of);
        all.push_back(n);
    }
    return all;
}

/// Compares intersections, without segments.
inline bool same_pairs(const std::vector<ccd::mpi::numbered_intersection>& found,
                       const std::vector<ccd::intersection>& expected) {
    const auto equal = [](const ccd::mpi::numbered_element& a, const ccd::mesh_element& b) {
        return std::ranges::equal(a.vertices(), b.vertices(), {}, {}, number_of);
    };
    return std::ranges::equal(found, expected, [&](const auto& a, const auto& b) {
        return equal(a.a, b.a) && equal(a.b, b.b) && a.relation == b.relation;
    });
}
inline bool same(const ccd::first_time& a, const ccd::first_time& b) {
    return a.outcome == b.outcome &&
           (a.outcome != ccd::outcome::collides || (a.low == b.low && a.high == b.high));
}

/// All placings of elements on ranks, with their names.
inline std::vector<std::pair<std::string, placing>> placings(const scene& s) {
    const auto faces = s.before.faces.size(), ranks = static_cast<std::size_t>(size);
    const auto as_rank = [](std::size_t i) { return static_cast<int>(i); };
    return {{"blocks",
             [=](std::size_t i) { return as_rank(std::min(ranks - 1, i * ranks / (faces + 1))); }},
            {"interleaved", [=](std::size_t i) { return as_rank(i % ranks); }},
            {"doubled", [=](std::size_t i) { return as_rank(i * 7919 % ranks); }},
            {"all on the last", [](std::size_t) { return size - 1; }},
            {"every other rank empty",
             [=](std::size_t i) { return as_rank(i % ((ranks + 1) / 2) * 2); }}};
}

/// A different placing for each case. If five consecutive scenes have the same number of cases, not
/// a multiple of five, every case gets every placing. All placings of all cases would take minutes
/// if ranks share cores: each call waits for all ranks hundreds of times.
inline std::pair<std::string, placing> next_placing(const scene& s) {
    static std::size_t calls = 0;
    const auto all = placings(s);
    return all[calls++ % all.size()];
}

/// Runs tests between MPI_Init and MPI_Finalize; returns the exit status.
inline int run(int argc, char** argv, const std::function<void()>& tests) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    tests();
    int all = 0;
    MPI_Allreduce(&failures, &all, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
    if (rank == 0) std::printf("%d ranks: %d failures\n", size, all);
    MPI_Finalize();
    return all != 0;
}

}  // namespace distributed
