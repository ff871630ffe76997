// ns per query of every method, one query at a time, on the candidates of whole steps: the bundled
// scene, and real scenes where they are. A share of the candidates is drawn evenly from all of
// them.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <ccd/method.hpp>
#include <ccd/step.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "ccd/io/mesh_file.hpp"

namespace {

namespace fs = std::filesystem;

struct scene_queries {
    std::vector<ccd::vertex_face<double>> vf;
    std::vector<ccd::edge_edge<double>> ee;
};

/// Pairs whose swept boxes touch, by brute force over an even sample of the elements: slow to make,
/// but independent of the step whose parts are measured.
scene_queries sampled_candidates(const ccd::mesh& before, const ccd::mesh& after) {
    const auto moving = [&](ccd::index v) {
        return ccd::moving_point<double>{before.vertices[v], after.vertices[v]};
    };
    const auto boxes_touch = [](const auto& a, const auto& b) {
        for (const auto axis :
             {&ccd::point<double>::x, &ccd::point<double>::y, &ccd::point<double>::z}) {
            const auto range = [axis](const auto& points) {
                double low = points[0].t0.*axis, high = low;
                for (const auto& p : points) {
                    low = std::min({low, p.t0.*axis, p.t1.*axis});
                    high = std::max({high, p.t0.*axis, p.t1.*axis});
                }
                return std::pair(low, high);
            };
            const auto [a_low, a_high] = range(a);
            const auto [b_low, b_high] = range(b);
            if (a_low > b_high || b_low > a_high) return false;
        }
        return true;
    };
    constexpr std::size_t most = 20000;
    scene_queries queries;
    const auto edges = ccd::unique_edges(before.faces);
    const std::size_t v_stride = 1 + before.vertices.size() / 500;
    for (std::size_t v = 0; v < before.vertices.size() && queries.vf.size() < most; v += v_stride)
        for (const ccd::face& f : before.faces) {
            const auto i = static_cast<ccd::index>(v);
            if (std::ranges::find(f, i) != f.end()) continue;
            const ccd::vertex_face<double> q{moving(i), moving(f[0]), moving(f[1]), moving(f[2])};
            if (boxes_touch(std::vector{q.v}, std::vector{q.f0, q.f1, q.f2}))
                queries.vf.push_back(q);
        }
    const std::size_t e_stride = 1 + edges.size() / 500;
    for (std::size_t i = 0; i < edges.size() && queries.ee.size() < most; i += e_stride)
        for (std::size_t j = 0; j < edges.size(); ++j) {
            const auto &a = edges[i], &b = edges[j];
            if (i == j || a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1]) continue;
            const ccd::edge_edge<double> q{moving(a[0]), moving(a[1]), moving(b[0]), moving(b[1])};
            if (boxes_touch(std::vector{q.a0, q.a1}, std::vector{q.b0, q.b1}))
                queries.ee.push_back(q);
        }
    return queries;
}

template <class Query>
void add(const std::string& name, ccd::method method, const std::vector<Query>& queries) {
    if (queries.empty()) return;
    benchmark::RegisterBenchmark(name.c_str(), [method, &queries](benchmark::State& state) {
        for (auto _ : state)
            for (const Query& q : queries) {
                ccd::verdict v = ccd::decide(method, q);
                benchmark::DoNotOptimize(v);
            }
        const auto decided =
            static_cast<double>(state.iterations()) * static_cast<double>(queries.size());
        state.counters["queries"] = static_cast<double>(queries.size());
        state.counters["s_per_query"] =
            benchmark::Counter(decided, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
    });
}

}  // namespace

int main(int argc, char** argv) {
    const fs::path bundled = ERRBOUND_SCENES, real = ERRBOUND_SHARED_DATA;
    const fs::path funnel = real / "scenes/cloth-funnel/frames";
    const fs::path ball = real / "scenes/cloth-ball/frames";
    struct {
        const char* name;
        fs::path before, after;
    } const scenes[] = {{"cloth-over-ball", bundled / "cloth-over-ball/frame0.ply",
                         bundled / "cloth-over-ball/frame1.ply"},
                        {"cloth-funnel", funnel / "227.ply", funnel / "228.ply"},
                        {"cloth-ball", ball / "cloth_ball92.ply", ball / "cloth_ball93.ply"}};
    std::vector<std::unique_ptr<scene_queries>> kept;
    for (const auto& [name, before, after] : scenes) {
        if (!fs::exists(before)) {
            std::printf("left out, no frames here: %s\n", name);
            continue;
        }
        kept.push_back(std::make_unique<scene_queries>(
            sampled_candidates(ccd::io::read_mesh(before), ccd::io::read_mesh(after))));
        for (const ccd::method_info& m : ccd::methods()) {
            add(std::string(name) + "/vf/" + std::string(m.name), m.method, kept.back()->vf);
            add(std::string(name) + "/ee/" + std::string(m.name), m.method, kept.back()->ee);
        }
    }
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
}
