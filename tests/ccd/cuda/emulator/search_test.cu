// Compares the search of a step on the device with the host's: candidates, and the order of pairs.
#include <algorithm>
#include <ccd/io/mesh_file.hpp>
#include <cstdio>
#include <random>
#include <vector>

#include "ccd/cuda/cub.cuh"
#include "ccd/cuda/step.hpp"

namespace {

using namespace ccd::cuda::detail;

/// Decides candidates by a hash of their vertices.
template <class Pair>
struct decide_by_hash {
    ccd::cuda::candidates<Pair> all;
    ccd::outcome* answers;
    constexpr void operator()(std::uint32_t i) const {
        std::uint32_t hash = 0;
        for (const auto v : vertices_of(pair_at(all, i))) hash = (hash ^ v) * 2654435761u;
        answers[i] = hash >> 28 == 0 ? ccd::outcome::collides : ccd::outcome::separate;
    }
};

struct found {
    std::size_t vertex_faces, edge_edges;  ///< numbers of candidates
    std::vector<ccd::vertex_face_pair> vertex_face;
    std::vector<ccd::edge_edge_pair> edge_edge;
};

template <class T, class Launcher>
const T* copied(Launcher& launcher, typename Launcher::template buffer<T>& to,
                const std::vector<T>& from) {
    to.resize(launcher, from.size());
    launcher.write(to.data(), from.size(), from.data());
    return to.data();
}

template <class Launcher>
found search(Launcher& launcher, const ccd::mesh& before, const ccd::mesh& after,
             std::size_t block) {
    using points = typename Launcher::template buffer<ccd::point<double>>;
    using coordinates = ccd::cuda::coordinates<double>;
    points from, to;
    const auto rows = [&](points& memory, const ccd::mesh& m) {
        return coordinates::rows(
            reinterpret_cast<const double*>(copied(launcher, memory, m.vertices)));
    };
    const ccd::cuda::positions at(rows(from, before), rows(to, after), before.vertices.size());
    step_memory<Launcher> memory(block);
    memory.set_mesh(launcher, at.vertices, ccd::unique_faces(before.faces),
                    ccd::unique_edges(before.faces));
    const auto decide = [&]<class Pair>(const ccd::cuda::candidates<Pair>& all,
                                        ccd::outcome* answers, scene_extent*, rounded_position*) {
        launcher.for_each(all.count, decide_by_hash<Pair>{all, answers});
        return std::size_t(0);
    };
    const found_pairs pairs = memory.run(launcher, at, decide);
    found f{pairs.vertex_face_candidates, pairs.edge_edge_candidates, {}, {}};
    f.vertex_face.resize(pairs.vertex_face);
    f.edge_edge.resize(pairs.edge_edge);
    launcher.read(memory.vertex_face().data(), pairs.vertex_face, f.vertex_face.data());
    launcher.read(memory.edge_edge().data(), pairs.edge_edge, f.edge_edge.data());
    return f;
}

template <class Pair>
bool same(const std::vector<Pair>& a, const std::vector<Pair>& b) {
    return std::ranges::equal(
        a, b, {}, [](const Pair& p) { return vertices_of(p); },
        [](const Pair& p) { return vertices_of(p); });
}

bool all_right = true;

void compare(const ccd::mesh& before, const ccd::mesh& after, std::size_t block) {
    device_launcher device(nullptr);
    host_launcher host;
    const found x = search(device, before, after, block), y = search(host, before, after, block);
    if (!device.ok()) std::printf("%s\n", device.result().error.c_str());
    const bool pairs = same(x.vertex_face, y.vertex_face) && same(x.edge_edge, y.edge_edge);
    if (device.ok() && pairs && x.vertex_faces == y.vertex_faces && x.edge_edges == y.edge_edges)
        return;
    all_right = false;
    std::printf("%zu faces, block %zu: candidates %zu %zu, expected %zu %zu; equal pairs: %d\n",
                before.faces.size(), block, x.vertex_faces, x.edge_edges, y.vertex_faces,
                y.edge_edges, pairs);
}

ccd::mesh soup(std::size_t faces, unsigned extent) {
    std::mt19937_64 random(faces + extent);
    const auto coordinate = [&] { return double(random() % extent); };
    ccd::mesh m;
    for (std::size_t i = 0; i < faces + 3; ++i)
        m.vertices.push_back({coordinate(), coordinate(), coordinate()});
    for (std::size_t i = 0; i < faces; ++i) {
        const auto v = static_cast<ccd::vertex_index>(random() % (faces + 1));
        m.faces.push_back({v + 2, v, v + 1});
    }
    return m;
}

}  // namespace

int main(int count, char** arguments) {
    if (count == 3)
        compare(ccd::io::read_mesh(arguments[1]), ccd::io::read_mesh(arguments[2]),
                step_memory<device_launcher>::default_block);
    else
        for (const std::size_t faces : {1, 11, 33, 100})
            for (const unsigned extent : {1, 12}) {
                const ccd::mesh before = soup(faces, extent);
                ccd::mesh after = before;
                for (auto& p : after.vertices) p = {p.x + p.y / 4, p.y - 0.25, p.z};
                if (faces < 33) compare(before, after, 7);
                compare(before, after, 2000);
                compare(before, after, 1 << 20);
            }
    std::printf("%s\n", all_right ? "the search agrees with the host" : "FAILED");
    return all_right ? 0 : 1;
}
