#include <ccd/nearness.hpp>
#include <cmath>
#include <cstddef>
#include <random>

#include "ccd/lab/tables.hpp"
#include "tests/bench/sections.hpp"

namespace bench {
namespace {

using ccd::kind;

/// Pairs of vertices in a unit cube: of `grid`, if not 0, positions in that many steps.
template <kind K>
void add_random_rows(const std::string& positions_are, double grid, const options& o, rows& table) {
    const std::size_t count = o.quick ? 10'000 : 200'000;
    std::mt19937_64 random(1);
    const auto coordinate = [&] {
        const double x = std::ldexp(static_cast<double>(random() >> 11), -53);
        return grid == 0 ? x : std::floor(x * grid);
    };
    std::vector<ccd::point<double>> positions;
    for (std::size_t i = 0; i < 4 * count; ++i)
        positions.push_back({coordinate(), coordinate(), coordinate()});
    const ccd::vertex_rows at(positions, positions);
    std::vector<ccd::pair_of_kind<K>> pairs;
    for (std::size_t i = 0; i < count; ++i) {
        const auto v = static_cast<ccd::vertex_index>(4 * i);
        if constexpr (ccd::is_cubic(K))
            pairs.push_back({v, v + 1, v + 2, v + 3});
        else if constexpr (K == kind::vertex_edge)
            pairs.push_back({v, v + 1, v + 2});
        else
            pairs.push_back({v, v + 1});
    }
    for (const ccd::instruction_set set : ccd::instruction_sets()) {
        const auto timings =
            race({[&] {
                      for (const auto& pair : pairs) keep(nearness_of(query_of(at, pair)));
                  },
                  [&] { keep(ccd::nearnesses(at, pairs, {.threads = 1, .set = set})); }},
                 o.repeats());
        const auto ns = [&](std::size_t i) {
            return 1e9 * timings[i].minimum / static_cast<double>(count);
        };
        table.push_back({{"kind", short_name(K)},
                         {"positions", positions_are},
                         {"on", name(set)},
                         {"pairs", count},
                         {"ns_one_by_one", ns(0)},
                         {"ns_in_batches", ns(1)}});
    }
}

/// Two layers of cloth, each of squares with two triangles, as waves with some noise.
ccd::mesh layers(std::size_t squares, double shift) {
    std::mt19937_64 random(1);
    const auto noise = [&] { return std::ldexp(static_cast<double>(random() >> 11), -53) * 1e-4; };
    const double edge = 1 / static_cast<double>(squares);
    ccd::mesh m;
    for (std::size_t layer = 0; layer < 2; ++layer) {
        const auto first = static_cast<ccd::vertex_index>(m.vertices.size());
        const auto n = static_cast<ccd::vertex_index>(squares + 1);
        for (ccd::vertex_index i = 0; i < n; ++i)
            for (ccd::vertex_index j = 0; j < n; ++j) {
                const double x = i * edge, y = j * edge, up = static_cast<double>(layer);
                m.vertices.push_back(
                    {x + up * shift + noise(), y + up * shift + noise(),
                     0.1 * std::sin(6 * x) * std::cos(5 * y) + up * 5e-4 + noise()});
                const ccd::vertex_index v = first + i * n + j;
                if (i + 1 == n || j + 1 == n) continue;
                m.faces.push_back({v, v + n, v + n + 1});
                m.faces.push_back({v, v + n + 1, v + 1});
            }
    }
    return m;
}

void add_layers_row(const std::string& placed, double shift, const options& o, rows& table) {
    const ccd::mesh mesh = layers(o.quick ? 40 : 159, shift);
    const ccd::vertex_rows at(mesh, mesh);
    ccd::mesh_steps steps(mesh);
    constexpr double distance = 1e-3;
    const auto timings =
        race({[&] { keep(ccd::near_pairs(steps, at, {.all = distance}, {.threads = 1})); },
              [&] { keep(ccd::least_distance(steps, at, {.threads = 1})); },
              [&] { keep(ccd::near_pairs(steps, at, {.all = distance})); }},
             o.repeats());
    const auto near = ccd::near_pairs(steps, at, {.all = distance});
    table.push_back({{"layers", placed},
                     {"triangles", mesh.faces.size()},
                     {"pairs", number_of(near.pairs)},
                     {"ms_near_pairs", 1e3 * timings[0].minimum},
                     {"ms_all_threads", 1e3 * timings[2].minimum},
                     {"ms_least_distance", 1e3 * timings[1].minimum},
                     {"least_distance", ccd::least_distance(steps, at).low}});
}

}  // namespace

void nearness(const options& o, report& out) {
    rows pairs, meshes;
    ccd::for_each_kind([&]<kind K>() { add_random_rows<K>("random", 0, o, pairs); });
    ccd::for_each_kind([&]<kind K>() { add_random_rows<K>("grid of 5", 5, o, pairs); });
    add_layers_row("one above the other", 0, o, meshes);
    add_layers_row("shifted", 2e-3, o, meshes);
    out.table("nearness", {}, "Nearest features with all data, ns of a pair, on one thread", pairs);
    out.table("near pairs", {},
              "Two layers of cloth: pairs within 1e-3 with all data, and the least distance",
              meshes);
}

}  // namespace bench
