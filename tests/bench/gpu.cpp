// ./run bench-gpu: every method on the device, beside the host; whole steps; as tables.
#include <cuda_runtime_api.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <ccd/batch.hpp>
#include <ccd/cuda.hpp>
#include <ccd/step.hpp>
#include <cstdio>
#include <exception>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "ccd/report/machine.hpp"
#include "errbound/support/output_file.hpp"
#include "tests/bench/gpu_peaks.hpp"
#include "tests/bench/harness.hpp"
#include "tests/bench/operations.hpp"
#include "tests/bench/scenes.hpp"

namespace {

using ccd::cuda::precision;

using bench::check;
void check(const ccd::cuda::status& s) {
    if (!s) throw std::runtime_error(s.error);
}

/// Device memory, with a copy of host memory if given.
template <class T>
class on_device {
  public:
    explicit on_device(std::size_t count) : count_(count) {
        void* memory = nullptr;
        check(cudaMalloc(&memory, std::max<std::size_t>(1, count) * sizeof(T)));
        data_ = static_cast<T*>(memory);
    }
    on_device(const T* host, std::size_t count) : on_device(count) {
        check(cudaMemcpy(data_, host, count_ * sizeof(T), cudaMemcpyHostToDevice));
    }
    ~on_device() { (void)cudaFree(data_); }
    on_device(const on_device&) = delete;
    on_device& operator=(const on_device&) = delete;

    T* data() const { return data_; }
    std::vector<T> copied() const {
        std::vector<T> host(count_);
        check(cudaMemcpy(host.data(), data_, count_ * sizeof(T), cudaMemcpyDeviceToHost));
        return host;
    }

  private:
    T* data_ = nullptr;
    std::size_t count_;
};

/// A scene's positions on the device.
struct device_scene {
    on_device<double> before, after;
    ccd::cuda::positions at;

    explicit device_scene(const ccd::vertex_rows& rows)
        : before(rows.before, 3 * rows.vertices),
          after(rows.after, 3 * rows.vertices),
          at(ccd::cuda::coordinates<double>::rows(before.data()),
             ccd::cuda::coordinates<double>::rows(after.data()), rows.vertices) {}
};

std::string name_of(precision p) {
    return p == precision::float32 ? "float32" : "float64";
}

template <class Query>
void methods(const bench::scene& s, const device_scene& device,
             const bench::query_set<Query>& candidates, std::size_t least,
             const bench::device_peaks& peaks, const bench::options& o, bench::report& out) {
    using indices = typename bench::query_set<Query>::indices;
    if (candidates.size() == 0) return;
    const std::size_t copies = (least + candidates.size() - 1) / candidates.size();
    std::vector<indices> rows;
    for (std::size_t i = 0; i < copies; ++i)
        rows.insert(rows.end(), candidates.by_index.begin(), candidates.by_index.end());
    std::vector<ccd::outcome> truth(candidates.size());
    candidates.decide_batch(0, truth, {.threads = 0});

    const on_device<indices> device_rows(rows.data(), rows.size());
    const on_device<ccd::outcome> answers(rows.size());
    const std::size_t bytes = ccd::cuda::scratch_bytes(device.at.vertices, rows.size());
    const on_device<std::byte> memory(bytes);
    const ccd::cuda::scratch scratch{memory.data(), bytes};
    const auto all = ccd::cuda::candidates<indices>::rows(device_rows.data(), rows.size());

    struct contestant {
        ccd::cuda::batch_options options;
        std::size_t false_positives = 0, false_negatives = 0;
    };
    std::vector<contestant> contestants;
    std::vector<std::function<void()>> passes;
    for (const ccd::method m : ccd::cuda::device_methods())
        for (const precision p : {precision::float64, precision::float32})
            contestants.push_back({{m, p, nullptr}});
    for (contestant& c : contestants) {
        check(decide_batch(device.at, all, answers.data(), scratch, c.options));
        check(finish(device.at, all, answers.data(), scratch, c.options));
        const auto found = answers.copied();
        for (std::size_t i = 0; i < truth.size(); ++i) {
            const bool said = found[i] != ccd::outcome::separate;
            const bool is = truth[i] != ccd::outcome::separate;
            c.false_positives += said && !is;
            c.false_negatives += !said && is;
        }
        passes.emplace_back([&] {
            check(decide_batch(device.at, all, answers.data(), scratch, c.options));
            check(finish(device.at, all, answers.data(), scratch, c.options));
            check(cudaDeviceSynchronize());
        });
    }
    const auto times = bench::race(passes, o.repeats());

    std::vector<std::vector<bench::cell>> table;
    const auto count = static_cast<double>(rows.size());
    for (std::size_t i = 0; i < contestants.size(); ++i) {
        const contestant& c = contestants[i];
        // What has to come from memory at least: the rows, once, and an answer each.
        const double moved = count * (sizeof(indices) + sizeof(ccd::outcome)) / times[i].minimum;
        table.push_back({bench::word(info(c.options.method).name),
                         bench::word(name_of(c.options.precision)),
                         bench::number(count / times[i].minimum / 1e9, 3),
                         bench::number(count / times[i].median / 1e9, 3),
                         bench::number(1e9 * times[i].minimum / count, 3),
                         bench::percent(moved / peaks.bytes_per_second),
                         bench::count(c.false_positives), bench::count(c.false_negatives)});
    }
    const std::string kind(short_name(ccd::kind_of<Query>));
    out.table("gpu-methods", {{"scene", s.name}, {"kind", kind}, {"queries", rows.size()}},
              "Methods on the device: " + bench::count(candidates.size()).text + ' ' + kind +
                  " candidates, " + std::to_string(copies) + " times; errors of one of the copies",
              {{"method", "method", true},
               {"precision", "precision", true},
               {"billion_per_second", "1e9/s best"},
               {"median", "median"},
               {"ns_per_query", "ns/query"},
               {"bandwidth", "bandwidth"},
               {"false_positives", "FP"},
               {"false_negatives", "FN"}},
              table);

    // The stages of exact: what they were asked, and what that is beside the peaks.
    const ccd::cuda::batch_options exact{};
    ccd::cuda::stage_counts counts;
    check(decide_batch(device.at, all, answers.data(), scratch, exact));
    check(finish(device.at, all, answers.data(), scratch, exact, &counts));
    const bench::stage_operations operations = bench::operations_of_stages<indices>();
    const double seconds =
        times[static_cast<std::size_t>(
                  std::ranges::find(contestants, ccd::method::exact,
                                    [](const contestant& c) { return c.options.method; }) -
                  contestants.begin())]
            .minimum;
    const auto row = [&](const char* stage, std::uint32_t entered, std::uint64_t each,
                         double peak) {
        return std::vector<bench::cell>{
            bench::word(stage), bench::count(entered), bench::percent(entered / count),
            each == 0 ? bench::none() : bench::count(each),
            each == 0 ? bench::none()
                      : bench::percent(static_cast<double>(each) * entered / seconds / peak)};
    };
    out.table("gpu-stages", {{"scene", s.name}, {"kind", kind}},
              "Stages of exact: candidates that enter, operations of each, and those of all "
              "beside the peak rate in the time of the whole",
              {{"stage", "stage", true},
               {"entered", "entered"},
               {"share", "share"},
               {"operations", "operations"},
               {"peak", "of peak"}},
              {row("axes, floats", counts.axes, operations.axes_in_floats, peaks.float_operations),
               row("coplanarity, doubles", counts.coplanarity, operations.coplanarity,
                   peaks.double_operations),
               row("inside, doubles", counts.inside, operations.inside, peaks.double_operations),
               row("subdivision", counts.subdivision, 0, 1),
               row("integers, one word", counts.integers_one_word, 0, 1),
               row("integers, two words", counts.integers_two_words, 0, 1),
               row("host", counts.left_open, 0, 1)});
}

void steps(const bench::scene& s, const device_scene& device, const bench::options& o,
           bench::report& out) {
    std::vector<std::vector<bench::cell>> table;
    for (const ccd::method m : {ccd::method::exact, ccd::method::tight}) {
        ccd::cuda::mesh_steps steps(s.before.faces, s.before.vertices.size());
        ccd::cuda::mesh_steps::result found;
        ccd::step_result on_host;
        const auto times =
            bench::race({[&] {
                             check(steps.run(device.at, {m, precision::float64, nullptr}, found));
                         },
                         [&] { on_host = ccd::step(s.before, s.after, {.method = m}); }},
                        o.repeats());
        table.push_back({bench::word(info(m).name),
                         bench::count(found.vertex_face_candidates + found.edge_edge_candidates),
                         bench::count(found.vertex_face_count + found.edge_edge_count),
                         bench::word(found.vertex_face_count == on_host.vertex_face.size() &&
                                             found.edge_edge_count == on_host.edge_edge.size()
                                         ? "yes"
                                         : "NO"),
                         bench::number(1e3 * times[0].minimum, 3),
                         bench::number(1e3 * times[0].median, 3),
                         bench::number(1e3 * times[1].minimum, 3),
                         bench::number(times[1].minimum / times[0].minimum, 1)});
    }
    out.table("gpu-steps", {{"scene", s.name}},
              "A step: from vertices on the device to pairs there, in ms; by the host with all "
              "its threads, from its memory",
              {{"method", "method", true},
               {"candidates", "candidates"},
               {"pairs", "pairs"},
               {"agree", "agree", true},
               {"device_ms", "device best"},
               {"device_median_ms", "median"},
               {"host_ms", "host best"},
               {"ratio", "host/device"}},
              table);
}

}  // namespace

int main(int argc, char** argv) try {
    CLI::App app{"Times collision detection on a CUDA device; prints tables."};
    app.name("./run bench-gpu");
    bench::options o;
    std::string json, commit = "unknown";
    std::size_t queries = 20'000'000;
    app.add_flag("--quick", o.quick, "Fewer queries and repeats: shows that all works");
    app.add_option("--json", json, "The tables as JSON, to this file");
    app.add_option("--scene", o.scene, "Only scenes whose name holds this");
    app.add_option("--queries", queries, "Candidates are replicated to at least so many")
        ->check(CLI::Range(std::size_t(1), std::size_t(2'000'000'000)));
    app.add_option("--commit", commit, "To be printed at the head");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    if (const auto s = ccd::cuda::device_status(); !s) {
        std::printf("No CUDA device, so nothing is measured: %s\n", s.error.c_str());
        return 77;
    }

    cudaDeviceProp device{};
    check(cudaGetDeviceProperties(&device, 0));
    const ccd::report::machine host = ccd::report::this_machine();
    const bench::device_peaks peaks = bench::measured_peaks();
    std::printf(
        "%s, %d multiprocessors; host: %s, %u cores; commit %s\n"
        "measured: %.0f GB/s copied, %.1f and %.1f Tflop/s in floats and doubles, not "
        "fused\n",
        device.name, device.multiProcessorCount, host.processor.c_str(), host.cores, commit.c_str(),
        1e-9 * peaks.bytes_per_second, 1e-12 * peaks.float_operations,
        1e-12 * peaks.double_operations);
    bench::report out;
    if (o.quick) queries = std::min<std::size_t>(queries, 1'000'000);
    for (const std::string& name : bench::scene_names()) {
        if (name.find(o.scene) == std::string::npos) continue;
        bench::scene s;
        if (!bench::load(name, s)) {
            bench::report::say("\n== " + name + ": left out, its data is not here");
            continue;
        }
        if (!s.is_step()) continue;
        const device_scene on_it({s.before, s.after});
        methods(s, on_it, s.queries.vertex_face, queries, peaks, o, out);
        methods(s, on_it, s.queries.edge_edge, queries, peaks, o, out);
        steps(s, on_it, o, out);
    }
    if (!json.empty()) {
        const nlohmann::json machine{{"device", device.name},
                                     {"processor", host.processor},
                                     {"cores", host.cores},
                                     {"bytes_per_second", peaks.bytes_per_second},
                                     {"float_operations", peaks.float_operations},
                                     {"double_operations", peaks.double_operations},
                                     {"commit", commit}};
        errbound::support::write_whole(
            json, nlohmann::json{{"machine", machine}, {"tables", out.tables()}}.dump(1) + "\n");
    }
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "bench-gpu: %s\n", error.what());
    return 1;
}
