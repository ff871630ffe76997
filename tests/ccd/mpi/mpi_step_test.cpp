// Steps of distributed meshes compared with ccd::step of the whole mesh: pairs, times, first
// contact, candidates, with every placing. mpirun runs it on several ranks; every rank makes the
// same meshes.
#include <algorithm>
#include <ccd/mpi.hpp>
#include <limits>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/ccd/mpi/distributed.hpp"

namespace {

using namespace distributed;

struct step_case {
    std::string name;
    ccd::step_options options;
    bool groups = false, pinned = false, thickness = false;
};

/// Values of the whole mesh's or of a rank's vertices: one entry for each vertex.
struct of_vertices {
    std::vector<int> groups;
    std::vector<std::uint8_t> pinned;
    std::vector<double> thickness;

    of_vertices(const step_case& test, const std::vector<ccd::vertex_index>& vertices) {
        for (const ccd::vertex_index v : vertices) {
            if (test.groups) groups.push_back(static_cast<int>(v % 3));
            if (test.pinned) pinned.push_back(v % 2 == 0);
            if (test.thickness) thickness.push_back(0.001 * (v % 5));
        }
    }
    ccd::step_options fill(ccd::step_options options) const {
        options.filter.groups = groups;
        options.filter.pinned = pinned;
        options.distances.thickness = thickness;
        return options;
    }
};

/// Intersections at the start, also by their own call.
void compare_start(const scene& s, const std::string& name, const ccd::mpi::mesh_part& part,
                   const ccd::step_options& options, const ccd::mpi::step_result& at_root,
                   const ccd::step_result& expected) {
    ccd::intersection_options at_rest;
    at_rest.filter = options.filter;
    const auto by_root =
        ccd::mpi::intersections(MPI_COMM_WORLD, part, at_rest, ccd::mpi::placement::root);
    const auto by_owners = ccd::mpi::intersections(MPI_COMM_WORLD, part, at_rest);
    if (rank == 0) {
        expect(same_pairs(at_root.intersections_at_start, expected.intersections_at_start),
               name + "intersections at the start differ");
        expect(same_pairs(by_root.pairs, expected.intersections_at_start),
               name + "intersections differ");
    } else {
        expect(by_root.pairs.empty(), name + "intersections that are not at the root");
    }
    const std::set<ccd::mpi::vertex_number> here(part.numbers.begin(), part.numbers.end());
    for (const auto& pair : by_owners.pairs)
        expect(here.contains(pair.a.numbers[0]), name + "an intersection that is elsewhere");
    unsigned long long found = by_owners.pairs.size(), all = 0;
    MPI_Allreduce(&found, &all, 1, MPI_UNSIGNED_LONG_LONG, MPI_SUM, MPI_COMM_WORLD);
    expect(all == expected.intersections_at_start.size(), name + "intersections at owners differ");
    expect(by_owners.counts.total() == all, name + "numbers of intersections differ");
    if (s.name == "soup of 600") expect(all > 0, name + "no intersections");
}

void compare(const scene& s, const step_case& test, const std::string& placed, const placing& place,
             const ccd::step_result& expected) {
    const std::string name = s.name + ", " + test.name + ", " + placed + ": ";
    const share own = share_of(s, place, placed == "doubled");
    const of_vertices lists(test, own.of_whole);
    const ccd::step_options options = lists.fill(test.options);

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
    if (test.options.check_start) compare_start(s, name, own.part(), options, at_root, expected);
    expect(same(at_root.first_contact, expected.first_contact), name + "first contacts differ");
    expect(at_root.candidates == expected.candidates, name + "candidates differ");
}

std::vector<step_case> step_cases() {
    std::vector<step_case> all;
    all.push_back({"contacts", {}});
    all.push_back({"candidates", {.count_candidates = true}});
    all.push_back(
        {"no unused", {.count_candidates = true, .times = true, .filter = {.skip_unused = true}}});
    all.push_back({"tight", {.method = ccd::method::tight, .initial_contact = true}});
    all.push_back({"times", {.times = true}});
    all.push_back({"the first", {.first_contact = true, .t_max = 0.5}});
    all.push_back({"within 0.01", {.times = true, .distances = {.all = 0.01}}});
    all.push_back({"thickness", {.count_candidates = true}, false, false, true});
    all.push_back({"groups", {.count_candidates = true}, true, true, false});
    all.push_back({"start", {.check_start = true}});
    all.push_back({"start of groups", {.check_start = true, .distances = {.all = 0.01}}, true});
    return all;
}

void compare_scene(const scene& s) {
    std::vector<ccd::vertex_index> all(s.before.vertices.size());
    for (ccd::vertex_index v = 0; v < all.size(); ++v) all[v] = v;
    for (const step_case& test : step_cases()) {
        const of_vertices lists(test, all);
        const auto expected = ccd::step(s.before, s.after, lists.fill(test.options));
        const auto [name, place] = next_placing(s);
        compare(s, test, name, place, expected);
    }
}

/// Many small scenes with the same request.
void compare_few_corners() {
    std::mt19937 random(11);
    const step_case counted{"candidates", {.count_candidates = true, .check_start = true}};
    for (int i = 0; i < (size <= 3 ? 60 : 20); ++i) {
        const scene s = distributed::few_corners(random, 4 + random() % 6, 1 + random() % 80);
        const auto expected = ccd::step(s.before, s.after, counted.options);
        const auto [name, place] = placings(s).front();
        compare(s, counted, name, place, expected);
    }
}

/// An error on one rank throws on all.
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
    refuse(who + "ccd::mpi::step: number of a vertex is 7 twice; expected unique numbers",
           {is_last ? twice : numbers, {points, points}, faces});
    refuse(who + "ccd::mpi::step: ", {numbers, {points, points}, is_last ? beyond : faces});
    if (is_last) others[2].x = std::numeric_limits<double>::quiet_NaN();
    refuse(who + "ccd::mpi::step: x of vertex 9 at t = 1 is nan; expected a finite number",
           {numbers, {points, others}, faces});
    refuse("expected only groups and pinned flags", {numbers, {points, points}, faces},
           {.filter = {.can_collide = [](auto, auto) { return true; }}});
    if (size > 1) {
        others = points;
        others[1].y = is_last ? 1e-300 : 0;
        refuse("differs from its copy on rank", {numbers, {points, others}, faces});
        refuse(who + "ccd::mpi::step: options differ from those on rank 0",
               {numbers, {points, points}, faces}, {.times = is_last});
        const std::vector<int> groups(is_last ? 3 : 0);
        refuse("lists of groups, flags", {numbers, {points, points}, faces},
               {.filter = {.groups = groups}});
    }
}

}  // namespace

int main(int argc, char** argv) {
    return distributed::run(argc, argv, [] {
        std::mt19937 random(5);
        compare_scene(distributed::sheets(3, 12));
        compare_scene(distributed::soup(random, 600, 0.05));
        compare_scene(distributed::soup(random, 40, 1));
        compare_scene(distributed::huge_face_and_heap());
        compare_few_corners();
        compare_scene({"nothing", {}, {}});
        refuse_all();
    });
}
