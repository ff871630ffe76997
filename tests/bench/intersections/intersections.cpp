// Intersections of meshes at rest, next to CGAL's if it is installed: ./run bench --intersections.
#include <algorithm>
#include <ccd/batch.hpp>
#include <ccd/intersections.hpp>
#include <ccd/io/mesh_file.hpp>
#include <ccd/step.hpp>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "tests/bench/harness.hpp"
#include "tests/bench/intersections/peers.hpp"

namespace {

using amount = ccd::intersection_options::amount;

struct named_mesh {
    std::string name;
    ccd::mesh at_rest;
    ccd::mesh after = {};  ///< the next frame
};

/// A wavy grid of 2 side² faces. If `pierced` is true, one vertex is pushed through it.
ccd::mesh wavy_grid(std::size_t side, bool pierced) {
    const auto height = [](double x, double y) { return std::sin(40 * x) * std::cos(33 * y) / 20; };
    const std::size_t row = side + 1;
    const double cell = 1 / static_cast<double>(side);
    const auto index = [row](std::size_t i, std::size_t j) {
        return static_cast<ccd::vertex_index>(i * row + j);
    };
    ccd::mesh m;
    for (std::size_t i = 0; i < row; ++i)
        for (std::size_t j = 0; j < row; ++j) {
            const double x = cell * static_cast<double>(i), y = cell * static_cast<double>(j);
            m.vertices.push_back({x, y, height(x, y)});
        }
    for (std::size_t i = 0; i < side; ++i)
        for (std::size_t j = 0; j < side; ++j) {
            m.faces.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
            m.faces.push_back({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
        }
    if (pierced) {
        // From half the height of a hill through its other side.
        constexpr double half_wave = std::numbers::pi / 40;
        const double x = 2 * half_wave, y = 2 * std::numbers::pi / 33;
        const auto nearest = [side](double at) {
            return static_cast<std::size_t>(std::lround(at * static_cast<double>(side)));
        };
        m.vertices[index(nearest(x), nearest(y))] = {x + half_wave + 3 * cell, y, 0};
    }
    return m;
}

/// Calls visit with one mesh after the other.
template <class Visit>
void for_each_mesh(bool quick, std::size_t most_faces, const Visit& visit) {
    for (const char* folder : {ERRBOUND_SCENES, ERRBOUND_SHARED_DATA "/scenes/cloth-funnel/frames",
                               ERRBOUND_SHARED_DATA "/scenes/cloth-ball/frames"}) {
        std::vector<std::filesystem::path> frames;
        if (std::filesystem::is_directory(folder))
            for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
                if (entry.path().extension() == ".ply") frames.push_back(entry.path());
        std::ranges::sort(frames);
        if (frames.size() >= 2)
            visit(named_mesh{frames[0].stem().string(), ccd::io::read_mesh(frames[0]),
                             ccd::io::read_mesh(frames[1])});
    }
    for (const std::size_t side :
         quick ? std::vector<std::size_t>{70} : std::vector<std::size_t>{70, 707, 2236})
        for (const bool pierced : {false, true}) {
            if (2 * side * side > most_faces) continue;
            named_mesh m{pierced ? "pierced" : "free", wavy_grid(side, pierced)};
            m.after = m.at_rest;
            for (auto& p : m.after.vertices) p.z += std::sin(50 * p.x) / 1000;
            visit(m);
        }
}

/// The pairs of two faces, by the indices of the faces in the mesh.
bench::face_pairs face_pairs_of(const ccd::mesh& mesh, const ccd::intersection_result& found) {
    std::map<ccd::face, std::size_t> indices;
    for (const auto& pair : found.pairs)
        for (const auto* element : {&pair.a, &pair.b})
            if (element->size == 3) indices[element->indices] = 0;
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
        ccd::face sorted = mesh.faces[i];
        std::ranges::sort(sorted);
        if (const auto at = indices.find(sorted); at != indices.end()) at->second = i;
    }
    bench::face_pairs pairs;
    for (const auto& pair : found.pairs)
        if (pair.kind() == ccd::intersection_kind::face_face)
            pairs.push_back(
                std::minmax<std::size_t>(indices[pair.a.indices], indices[pair.b.indices]));
    std::ranges::sort(pairs);
    return pairs;
}

/// The first call to `stop` comes after the trees are built.
void build_trees(const ccd::mesh& mesh) {
    try {
        ccd::intersections(mesh, {.threads = 1, .stop = [] { return true; }});
    } catch (const ccd::stopped&) {
    }
}

bench::row row_of(const named_mesh& named, int repeats) {
    const ccd::mesh& mesh = named.at_rest;
    ccd::intersection_result found;
    const ccd::intersection_options pairs_only{.segments = false, .threads = 1};
    const ccd::intersection_options first{.wanted = amount::first, .segments = false, .threads = 1};
    const auto timings = bench::race(
        {[&] { found = ccd::intersections(mesh, pairs_only); },
         [&] { bench::keep(ccd::intersections(mesh, {.threads = 1})); },
         [&] { bench::keep(ccd::intersections(mesh, first)); }, [&] { build_trees(mesh); }},
        repeats);
    const std::vector<bench::timing> of_steps = [&] {
        ccd::mesh_steps steps(mesh);
        const ccd::vertex_rows frames(mesh.vertices, named.after.vertices);
        return bench::race(
            {[&] { bench::keep(steps.run(frames, {.threads = 1})); },
             [&] { bench::keep(steps.run(frames, {.threads = 1, .check_start = true})); }},
            repeats);
    }();
    const auto ms = [&](std::size_t i) { return timings[i].ms(); };
    bench::row r = {{"mesh", named.name},
                    {"faces", mesh.faces.size()},
                    {"pairs", found.pairs.size()},
                    {"pairs_ms", ms(0)},
                    {"with_segments_ms", ms(1)},
                    {"first_ms", ms(2)},
                    {"trees_ms", ms(3)},
                    {"first/trees", ms(2) / ms(3)},
                    {"step_ms", of_steps[0].ms()},
                    {"start/step", of_steps[1].minimum / of_steps[0].minimum - 1}};
#ifdef ERRBOUND_HAVE_CGAL
    bench::face_pairs theirs, other;
    const auto cgal =
        bench::race(bench::cgal_passes(mesh, theirs), mesh.faces.size() > 5'000'000 ? 1 : 3);
    std::ranges::set_symmetric_difference(face_pairs_of(mesh, found), theirs,
                                          std::back_inserter(other));
    r["CGAL:_pairs_ms"] = cgal[0].ms();
    r["any_ms"] = cgal[1].ms();
    r["pairs_that_differ"] = other.size();
    r["CGAL/pairs_ms"] = cgal[0].ms() / ms(0);
#endif
    return r;
}

}  // namespace

int main(int argc, char** argv) {
    bench::program bench("./run bench --intersections",
                         "ccd::intersections next to CGAL's self_intersections, on one thread.");
    std::size_t most_faces = 10'000'000;
    bench.line.add_option("--most-faces", most_faces,
                          "The size of the largest generated mesh; 10,000,000 faces need 12 GB");
    return bench.run(argc, argv, [&](bench::report& out) {
        bench::rows all;
        for_each_mesh(bench.quick, most_faces, [&](const named_mesh& m) {
            all.push_back(row_of(m, m.at_rest.faces.size() > 500'000 ? 3 : bench.repeats()));
        });
        out.table("intersections", {},
                  "intersections of meshes at rest, one thread, ms (least of some passes): pairs "
                  "without and with their segments, the first pair, the trees alone; the cost of "
                  "check_start as a share of a repeated step; CGAL's pairs and does_self_intersect",
                  all);
    });
}
