// Advances of distributed meshes compared bit for bit with ccd::advance of the whole mesh, with
// every placing. mpirun runs it on several ranks; every rank makes the same meshes.
#include <ccd/advance.hpp>
#include <ccd/mpi.hpp>
#include <random>
#include <string>
#include <vector>

#include "tests/ccd/mpi/distributed.hpp"

namespace {

using namespace distributed;

struct advance_case {
    std::string name;
    std::vector<int> groups;  ///< of the whole mesh's vertices
    double distance = 0;
    bool thickness = false, filtered = false;
};

std::vector<advance_case> advance_cases(const scene& s) {
    const auto& mesh = s.before;
    std::vector<int> parts, single, few;
    for (const auto part : ccd::connected_parts(mesh.faces, mesh.edges, mesh.vertices.size()))
        parts.push_back(int(part));
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        single.push_back(int(v));
        few.push_back(int(v % 7) - 3);
    }
    return {{"as one", {}},
            {"by part", parts},
            {"by vertex", single},
            {"by few groups", few},
            {"as one, within 0.01", {}, 0.01},
            {"by part, within 0.01", parts, 0.01},
            {"by part, with thickness", parts, 0, true},
            {"by vertex, filtered", single, 0, false, true}};
}

template <class T>
std::vector<T> of(const std::vector<T>& whole, const std::vector<ccd::vertex_index>& vertices) {
    std::vector<T> own;
    if (!whole.empty())
        for (const ccd::vertex_index v : vertices) own.push_back(whole[v]);
    return own;
}

void compare(const scene& s, const advance_case& test) {
    std::vector<double> thickness;
    std::vector<std::uint8_t> pinned;
    for (std::size_t v = 0; v < s.before.vertices.size(); ++v) {
        if (test.thickness) thickness.push_back(0.001 * double(v % 5));
        if (test.filtered) pinned.push_back(v % 3 == 0);
    }
    const auto expected =
        ccd::advance(s.before, s.after,
                     {.groups = test.groups,
                      .distances = {test.distance, thickness},
                      .filter = {.pinned = pinned, .skip_unused = test.filtered}});
    const auto [placed, place] = next_placing(s);
    const std::string name = s.name + ", " + test.name + ", " + placed + ": ";
    const share own = share_of(s, place, placed == "doubled");
    const auto groups = of(test.groups, own.of_whole);
    const auto own_thickness = of(thickness, own.of_whole);
    const auto own_pinned = of(pinned, own.of_whole);
    const auto found =
        ccd::mpi::advance(MPI_COMM_WORLD, own.part(),
                          {.groups = groups,
                           .distances = {test.distance, own_thickness},
                           .filter = {.pinned = own_pinned, .skip_unused = test.filtered}});
    expect(found.fraction == expected.fraction, name + "fractions differ");
    expect(same(found.first_contact, expected.first_contact), name + "first contacts differ");
    expect(found.positions == of(expected.positions, own.of_whole), name + "positions differ");
    expect(found.fractions == of(expected.fractions, own.of_whole),
           name + "fractions of vertices differ");
    ccd::for_each_kind([&]<ccd::kind K>() {
        expect(found.touching_at_start.of<K>() == numbered<K>(expected.touching_at_start.of<K>()),
               name + "pairs that touch at the start differ");
        expect(found.near_at_start.of<K>() == numbered<K>(expected.near_at_start.of<K>()),
               name + "pairs near at the start differ");
    });
}

void compare_scene(const scene& s) {
    for (const advance_case& test : advance_cases(s)) compare(s, test);
}

/// Contacts a few last places apart: rounding matters, and vertices are moved back.
scene of_last_places(std::mt19937& random, std::size_t vertices, double unit) {
    scene s = soup(random, vertices, 1);
    s.name += ", a few last places apart";
    for (auto* frame : {&s.before, &s.after})
        for (auto& p : frame->vertices) p = {1 + unit * p.x, 1 + unit * p.y, 1 + unit * p.z};
    return s;
}

}  // namespace

int main(int argc, char** argv) {
    return distributed::run(argc, argv, [] {
        std::mt19937 random(7);
        compare_scene(sheets(3, 12));
        compare_scene(soup(random, 300, 0.05));
        compare_scene(soup(random, 60, 0.3));
        for (const double unit : {0x1p-51, 0x1p-48, 0x1p-40})
            if (size <= 3 || unit == 0x1p-48) compare_scene(of_last_places(random, 60, unit));
        compare_scene(huge_face_and_heap());
        compare_scene({"nothing", {}, {}});
    });
}
