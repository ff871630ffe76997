// ./run bench-gpu: tables of every method on the device, and of whole steps there and on the host.
#include <cuda_runtime_api.h>

#include <algorithm>
#include <ccd/batch.hpp>
#include <ccd/contact.hpp>
#include <ccd/cuda.hpp>
#include <ccd/step.hpp>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/bench/harness.hpp"
#include "tests/bench/scenes.hpp"

namespace {

using ccd::cuda::precision;

void check(cudaError_t e) {
    if (e != cudaSuccess) throw std::runtime_error(std::string("CUDA: ") + cudaGetErrorString(e));
}
void check(const ccd::cuda::status& s) {
    if (!s) throw std::runtime_error(s.error);
}

/// An array in device memory, optionally with a copy of host memory.
template <class T>
std::shared_ptr<T> on_device(std::size_t count, const T* host = nullptr) {
    void* memory = nullptr;
    check(cudaMalloc(&memory, std::max<std::size_t>(1, count) * sizeof(T)));
    std::shared_ptr<T> array(static_cast<T*>(memory), [](T* p) { (void)cudaFree(p); });
    if (host != nullptr) check(cudaMemcpy(memory, host, count * sizeof(T), cudaMemcpyHostToDevice));
    return array;
}

struct device_scene {
    std::shared_ptr<double> before, after;
    ccd::cuda::positions at;

    explicit device_scene(const ccd::vertex_rows& rows)
        : before(on_device(3 * rows.vertices, rows.before)),
          after(on_device(3 * rows.vertices, rows.after)),
          at(ccd::cuda::coordinates<double>::rows(before.get()),
             ccd::cuda::coordinates<double>::rows(after.get()), rows.vertices) {}
};

/// A scene's candidates of one kind on the device, repeated until there are at least `least`, with
/// the memory for their decision.
template <class Query>
class device_batch {
  public:
    using pair = ccd::pair_of_query<Query>;

    device_batch(const device_scene& scene, const bench::query_set<Query>& once, std::size_t least)
        : scene_(scene) {
        std::vector<pair> all;
        while (all.size() < std::max<std::size_t>(1, least))
            all.insert(all.end(), once.by_index.begin(), once.by_index.end());
        size_ = all.size();
        rows_ = on_device(size_, all.data());
        answers_ = on_device<ccd::outcome>(size_);
        bytes_ = ccd::cuda::scratch_bytes(scene.at.vertices, size_);
        memory_ = on_device<std::byte>(bytes_);
    }

    std::size_t size() const { return size_; }
    void decide(const ccd::cuda::batch_options& options) const {
        const auto all = ccd::cuda::candidates<pair>::rows(rows_.get(), size_);
        const ccd::cuda::scratch scratch{memory_.get(), bytes_};
        check(decide_batch(scene_.at, all, answers_.get(), scratch, options));
        check(finish(scene_.at, all, answers_.get(), scratch, options));
    }
    std::vector<ccd::outcome> answers() const {
        std::vector<ccd::outcome> host(size_);
        check(cudaMemcpy(host.data(), answers_.get(), size_ * sizeof(ccd::outcome),
                         cudaMemcpyDeviceToHost));
        return host;
    }

  private:
    const device_scene& scene_;
    std::size_t size_ = 0, bytes_ = 0;
    std::shared_ptr<pair> rows_;
    std::shared_ptr<ccd::outcome> answers_;
    std::shared_ptr<std::byte> memory_;
};

/// Times all methods in both precisions, and counts their errors.
template <class Query>
void methods(const bench::scene& s, const device_scene& device, const bench::query_set<Query>& once,
             std::size_t least, int repeats, bench::report& out) {
    if (once.size() == 0) return;
    const device_batch<Query> batch(device, once, least);
    std::vector<ccd::outcome> truth(once.size());
    once.decide_batch(0, truth, {.threads = 0});
    bench::rows all;
    std::vector<ccd::lab::tally> errors;  // of one of the copies
    std::vector<std::function<void()>> passes;
    for (const ccd::method m : ccd::cuda::device_methods())
        for (const precision p : {precision::float64, precision::float32}) {
            all.push_back({{"method", info(m).name},
                           {"precision", p == precision::float32 ? "float32" : "float64"}});
            passes.emplace_back([&batch, m, p] {
                batch.decide({m, p, nullptr});
                check(cudaDeviceSynchronize());
            });
            passes.back()();
            const auto found = batch.answers();
            auto& counts = errors.emplace_back();
            for (std::size_t i = 0; i < truth.size(); ++i)
                counts.add(found[i], truth[i] != ccd::outcome::separate);
        }
    const auto times = bench::race(passes, repeats);
    const auto count = static_cast<double>(batch.size());
    for (std::size_t i = 0; i < all.size(); ++i)
        all[i].update({{"1e9/s_best", count / times[i].minimum / 1e9},
                       {"1e9/s_median", count / times[i].median / 1e9},
                       {"ns_per_query", times[i].ns(batch.size())},
                       {"FP", errors[i].false_positives},
                       {"FN", errors[i].false_negatives}});
    const std::string kind(short_name(ccd::kind_of<Query>));
    out.table("gpu-methods", {{"scene", s.name}, {"kind", kind}, {"queries", batch.size()}},
              "Methods on the device: " + std::to_string(once.size()) + ' ' + kind +
                  " candidates, " + std::to_string(batch.size() / once.size()) +
                  " times; errors of one of the copies",
              all);
}

struct step_request {
    const char* name;
    ccd::cuda::mesh_step_options options;

    ccd::step_options on_host() const {
        return {.method = options.method,
                .first_contact = options.first_contact,
                .times = options.times};
    }
};
constexpr step_request step_requests[] = {
    {"exact", {}},
    {"exact, first contact", {.first_contact = true}},
    {"exact, times", {.times = true}},
    {"tight", {.method = ccd::method::tight}},
};

void steps(const bench::scene& s, const device_scene& device, int repeats, bench::report& out) {
    bench::rows all;
    for (const step_request& request : step_requests) {
        ccd::cuda::mesh_steps steps(s.before.faces, s.before.vertices.size());
        ccd::cuda::mesh_steps::result found;
        ccd::step_result on_host;
        const auto times =
            bench::race({[&] {
                             found = steps.run(device.at, request.options);
                             check(found);
                         },
                         [&] { on_host = ccd::step(s.before, s.after, request.on_host()); }},
                        repeats);
        const bool agree = found.pairs.vertex_face.size() == on_host.pairs.vertex_face.size() &&
                           found.pairs.edge_edge.size() == on_host.pairs.edge_edge.size() &&
                           found.first_contact == on_host.first_contact;
        all.push_back({{"step", request.name},
                       {"candidates", found.candidates.vertex_face + found.candidates.edge_edge},
                       {"pairs", found.pairs.vertex_face.size() + found.pairs.edge_edge.size()},
                       {"agree", agree},
                       {"device_best", times[0].ms()},
                       {"median", 1e3 * times[0].median},
                       {"host_best", times[1].ms()},
                       {"host/device", times[1].minimum / times[0].minimum}});
    }
    out.table("gpu-steps", {{"scene", s.name}},
              "A step: from vertices on the device to pairs and times there, in ms; by the host "
              "with all its threads, from its memory",
              all);
}

/// The device, for the head of the tables.
bench::row device_row() {
    cudaDeviceProp device{};
    if (cudaGetDeviceProperties(&device, 0) != cudaSuccess) return bench::row::object();
    return {{"device", device.name}, {"multiprocessors", device.multiProcessorCount}};
}

void measure_scene(const std::string& name, std::size_t queries, int repeats, bench::report& out) {
    const auto loaded = bench::load(name);
    if (!loaded) return bench::say("\n== " + name + ": skipped, its data is missing");
    const bench::scene& s = *loaded;
    if (!bench::is_step(s)) return;
    const device_scene device({s.before, s.after});
    s.queries.for_each(
        [&](const auto& known) { methods(s, device, known.queries, queries, repeats, out); });
    steps(s, device, repeats, out);
}

}  // namespace

int main(int argc, char** argv) {
    bench::program bench("./run bench-gpu", "Times collision detection on a CUDA device.");
    std::string only;
    std::size_t queries = 20'000'000;
    bench.line.add_option("--scene", only, "Only scenes whose name holds this");
    bench.line
        .add_option("--queries", queries, "Candidates are replicated to at least this number")
        ->check(CLI::Range(std::size_t(1), std::size_t(2'000'000'000)));
    return bench.run(
        argc, argv,
        [&](bench::report& out) {
            if (const auto s = ccd::cuda::device_status(); !s) {
                bench::say("No CUDA device, so nothing is measured: " + s.error);
                bench.status = 77;
                return;
            }
            const std::size_t least =
                bench.quick ? std::min<std::size_t>(queries, 1'000'000) : queries;
            for (const std::string& name : bench::scene_names())
                if (name.find(only) != std::string::npos)
                    measure_scene(name, least, bench.repeats(), out);
        },
        device_row);
}
