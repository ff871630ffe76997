// Steps of distributed meshes against ccd::step of the whole mesh: pairs, times, first contact,
// candidates, whoever has what. Run by mpirun on several ranks; every rank makes the same meshes.
#include <algorithm>
#include <ccd/mpi.hpp>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

int rank = 0, size = 1, failures = 0;

void expect(bool holds, const std::string& what) {
    if (holds) return;
    std::printf("rank %d of %d: %s\n", rank, size, what.c_str());
    ++failures;
}

struct scene {
    std::string name;
    ccd::mesh before, after;
};

/// Triangles, rods and points at random; `crowd` says how near to one another, in last places at
/// worst.
scene soup(std::mt19937& random, std::size_t vertices, double length) {
    std::uniform_real_distribution<double> place(0, 1), move(-length, length);
    const auto vertex = [&] { return static_cast<ccd::vertex_index>(random() % vertices); };
    scene s{"soup of " + std::to_string(vertices), {}, {}};
    for (std::size_t v = 0; v < vertices; ++v) {
        s.before.vertices.push_back({place(random), place(random), place(random)});
        const auto& p = s.before.vertices.back();
        s.after.vertices.push_back({p.x + move(random), p.y + move(random), p.z + move(random)});
    }
    for (std::size_t i = 0; i < vertices / 3; ++i) {
        // Corners near one another, so that boxes are not of the size of all.
        const ccd::vertex_index a = vertex();
        const auto near = [&] {
            ccd::vertex_index best = vertex();
            const auto far = [&](ccd::vertex_index v) {
                const auto &p = s.before.vertices[a], &q = s.before.vertices[v];
                return std::abs(p.x - q.x) + std::abs(p.y - q.y) + std::abs(p.z - q.z);
            };
            for (int k = 0; k < 60; ++k) {
                const ccd::vertex_index v = vertex();
                if (v != a && (best == a || far(v) < far(best))) best = v;
            }
            return best;
        };
        s.before.faces.push_back({a, near(), near()});
        if (i % 4 == 0) s.before.edges.push_back({vertex(), near()});
    }
    s.after.faces = s.before.faces;
    s.after.edges = s.before.edges;
    return s;
}

/// Copies of a bumpy sheet, one above the other, that fall onto each other: `n` by `n` squares
/// each.
scene sheets(std::size_t layers, std::size_t n) {
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

/// Beside a sheet, one face over all of it and points in a heap at one place.
scene huge_face_and_heap() {
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

/// A rank's share: which faces and edges, and which vertices beyond theirs.
struct share {
    std::vector<ccd::mpi::vertex_number> numbers;
    std::vector<ccd::vertex_index> of_whole;
    std::vector<ccd::point<double>> before, after;
    std::vector<ccd::face> faces;
    std::vector<ccd::edge> edges;

    ccd::mpi::mesh_part part() const { return {numbers, {before, after}, faces, edges}; }
};

/// The number that a vertex has for MPI: none is another's, they do not ascend by ones, but keep
/// their order.
ccd::mpi::vertex_number number_of(ccd::vertex_index v) {
    return (std::uint64_t(1) << 40) + 1000 * std::uint64_t(v);
}

using placing = std::function<int(std::size_t)>;  ///< the rank of an element

share share_of(const scene& s, const placing& place, bool doubled) {
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
    // Some elements are on the next rank as well.
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

bool same(const ccd::first_time& a, const ccd::first_time& b) {
    return a.outcome == b.outcome &&
           (a.outcome != ccd::outcome::collides || (a.low == b.low && a.high == b.high));
}

struct question {
    std::string name;
    ccd::step_options options;
    bool groups = false, pinned = false, thickness = false;
};

/// Of the whole mesh, or of a rank's part: one entry a vertex.
struct of_vertices {
    std::vector<int> groups;
    std::vector<std::uint8_t> pinned;
    std::vector<double> thickness;

    of_vertices(const question& asked, const std::vector<ccd::vertex_index>& vertices) {
        for (const ccd::vertex_index v : vertices) {
            if (asked.groups) groups.push_back(static_cast<int>(v % 3));
            if (asked.pinned) pinned.push_back(v % 2 == 0);
            if (asked.thickness) thickness.push_back(0.001 * (v % 5));
        }
    }
    ccd::step_options fill(ccd::step_options options) const {
        options.filter.groups = groups;
        options.filter.pinned = pinned;
        options.distances.thickness = thickness;
        return options;
    }
};

void compare(const scene& s, const question& asked, const std::string& placed, const placing& place,
             const ccd::step_result& expected) {
    const std::string name = s.name + ", " + asked.name + ", " + placed + ": ";
    const share own = share_of(s, place, placed == "doubled");
    const of_vertices lists(asked, own.of_whole);
    const ccd::step_options options = lists.fill(asked.options);

    const auto at_root =
        ccd::mpi::step(MPI_COMM_WORLD, own.part(), options, ccd::mpi::placement::root);
    const auto at_owners = ccd::mpi::step(MPI_COMM_WORLD, own.part(), options);
    ccd::for_each_kind([&]<ccd::kind K>() {
        const std::string kind(ccd::kind_traits<K>::name);
        if (rank == 0) {
            expect(at_root.pairs.of<K>() == numbered<K>(expected.pairs.of<K>()),
                   name + kind + " pairs differ");
            expect(at_root.touching_at_start.of<K>() ==
                       numbered<K>(expected.touching_at_start.of<K>()),
                   name + kind + " pairs touching at the start differ");
            expect(std::ranges::equal(at_root.times.of<K>(), expected.times.of<K>(), same),
                   name + kind + " times differ");
        } else {
            expect(at_root.pairs.of<K>().empty(), name + "pairs that are not at the root");
        }
        const std::set<ccd::mpi::vertex_number> here(own.numbers.begin(), own.numbers.end());
        for (const auto& p : at_owners.pairs.of<K>())
            expect(here.contains(p[0]), name + kind + ": a pair whose first element is elsewhere");
        unsigned long long found = at_owners.pairs.of<K>().size(), all = 0;
        MPI_Allreduce(&found, &all, 1, MPI_UNSIGNED_LONG_LONG, MPI_SUM, MPI_COMM_WORLD);
        expect(all == expected.pairs.of<K>().size(), name + kind + " pairs at owners differ");
    });
    expect(same(at_root.first_contact, expected.first_contact), name + "first contacts differ");
    expect(at_root.candidates == expected.candidates, name + "candidates differ");
}

std::vector<question> questions() {
    std::vector<question> all;
    all.push_back({"contacts", {}});
    all.push_back({"candidates", {.count_candidates = true}});
    all.push_back({"tight", {.method = ccd::method::tight, .initial_contact = true}});
    all.push_back({"times", {.times = true}});
    all.push_back({"the first", {.first_contact = true, .t_max = 0.5}});
    all.push_back({"within 0.01", {.times = true, .distances = {.all = 0.01}}});
    all.push_back({"thickness", {.count_candidates = true}, false, false, true});
    all.push_back({"groups", {.count_candidates = true}, true, true, false});
    return all;
}

void compare_scene(const scene& s) {
    std::vector<ccd::vertex_index> all(s.before.vertices.size());
    for (ccd::vertex_index v = 0; v < all.size(); ++v) all[v] = v;
    for (const question& asked : questions()) {
        const of_vertices lists(asked, all);
        const auto expected = ccd::step(s.before, s.after, lists.fill(asked.options));
        const auto faces = s.before.faces.size();
        const auto of_size = static_cast<std::size_t>(size);
        const auto as_rank = [](std::size_t i) { return static_cast<int>(i); };
        compare(
            s, asked, "blocks",
            [&](std::size_t i) {
                return as_rank(std::min(of_size - 1, i * of_size / (faces + 1)));
            },
            expected);
        compare(
            s, asked, "interleaved", [&](std::size_t i) { return as_rank(i % of_size); }, expected);
        compare(
            s, asked, "doubled", [&](std::size_t i) { return as_rank(i * 7919 % of_size); },
            expected);
        compare(
            s, asked, "all on the last", [&](std::size_t) { return size - 1; }, expected);
        compare(
            s, asked, "every other rank empty",
            [&](std::size_t i) { return as_rank(i % ((of_size + 1) / 2) * 2); }, expected);
    }
}

/// What one rank finds wrong is thrown on all.
void refuse(const std::string& expected, const ccd::mpi::mesh_part& mesh,
            const ccd::step_options& options = {}) {
    try {
        ccd::mpi::step(MPI_COMM_WORLD, mesh, options);
        expect(false, "not refused: " + expected);
    } catch (const std::invalid_argument& error) {
        expect(std::string(error.what()).find(expected) != std::string::npos,
               std::string("found the message '") + error.what() + "', expected " + expected);
    }
}
void refuse_all() {
    const std::vector<ccd::point<double>> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    std::vector<ccd::point<double>> others = points;
    const bool is_last = rank == size - 1;
    const std::string who = "rank " + std::to_string(size - 1) + ": ";
    const std::vector<ccd::mpi::vertex_number> numbers{7, 8, 9}, twice{7, 8, 7};
    const std::vector<ccd::face> faces{{0, 1, 2}}, beyond{{0, 1, 3}};
    refuse(who + "ccd::mpi::step: found a vertex's number given twice",
           {is_last ? twice : numbers, {points, points}, faces});
    refuse(who + "ccd::mpi::step: ", {numbers, {points, points}, is_last ? beyond : faces});
    if (is_last) others[2].x = std::numeric_limits<double>::quiet_NaN();
    refuse(who + "ccd::step: ", {numbers, {points, others}, faces});
    refuse("expected groups and pinned flags alone", {numbers, {points, points}, faces},
           {.filter = {.can_collide = [](auto, auto) { return true; }}});
    if (size > 1) {
        others = points;
        others[1].y = is_last ? 1e-300 : 0;
        refuse("found vertex 8 with other positions", {numbers, {points, others}, faces});
    }
}

}  // namespace

int main(int argc, char** argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    std::mt19937 random(5);
    compare_scene(sheets(3, 12));
    compare_scene(soup(random, 600, 0.05));
    compare_scene(soup(random, 40, 1));
    compare_scene(huge_face_and_heap());
    compare_scene({"nothing", {}, {}});
    refuse_all();
    int all = 0;
    MPI_Allreduce(&failures, &all, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
    if (rank == 0) std::printf("%d ranks: %d failures\n", size, all);
    MPI_Finalize();
    return all != 0;
}
