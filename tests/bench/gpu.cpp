// ./run bench-gpu: tables of every method on the device and on the host, of first times and of
// whole steps.
#include <cuda_runtime_api.h>

#include <algorithm>
#include <ccd/batch.hpp>
#include <ccd/contact.hpp>
#include <ccd/cuda.hpp>
#include <ccd/step.hpp>
#include <functional>
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
class device_array {
  public:
    explicit device_array(std::size_t count) : count_(count) {
        void* memory = nullptr;
        check(cudaMalloc(&memory, std::max<std::size_t>(1, count) * sizeof(T)));
        data_ = static_cast<T*>(memory);
    }
    device_array(const T* host, std::size_t count) : device_array(count) {
        check(cudaMemcpy(data_, host, count_ * sizeof(T), cudaMemcpyHostToDevice));
    }
    ~device_array() { (void)cudaFree(data_); }
    device_array(const device_array&) = delete;
    device_array& operator=(const device_array&) = delete;

    T* data() const { return data_; }
    std::size_t size() const { return count_; }
    std::vector<T> copied() const {
        std::vector<T> host(count_);
        check(cudaMemcpy(host.data(), data_, count_ * sizeof(T), cudaMemcpyDeviceToHost));
        return host;
    }

  private:
    T* data_ = nullptr;
    std::size_t count_;
};

struct device_scene {
    device_array<double> before, after;
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

/// A scene's candidates of one kind on the device, repeated until there are at least `least`, with
/// the memory for their decision.
template <class Query>
class device_batch {
  public:
    using pair = ccd::pair_of_query<Query>;

    device_batch(const device_scene& scene, const bench::query_set<Query>& once, std::size_t least)
        : scene_(scene),
          copies_((least + once.size() - 1) / once.size()),
          rows_(repeated(once.by_index, copies_)),
          answers_(rows_.size()),
          memory_(ccd::cuda::scratch_bytes(scene.at.vertices, rows_.size())) {}

    std::size_t size() const { return rows_.size(); }
    std::size_t copies() const { return copies_; }
    ccd::cuda::stage_counts decide(const ccd::cuda::batch_options& options) const {
        const auto all = ccd::cuda::candidates<pair>::rows(rows_.data(), rows_.size());
        const ccd::cuda::scratch scratch{memory_.data(), memory_.size()};
        check(decide_batch(scene_.at, all, answers_.data(), scratch, options));
        const auto finished = finish(scene_.at, all, answers_.data(), scratch, options);
        check(finished);
        return finished.stages;
    }
    std::vector<ccd::outcome> answers() const { return answers_.copied(); }

    /// Lists the colliding candidates and finds their times. Preconditions: `exact` has decided
    /// them; `times` is as large as their number.
    ccd::cuda::time_stage_counts find_times(const device_array<ccd::vertex_index>& numbers,
                                            const device_array<ccd::first_time>& times) const {
        const ccd::cuda::scratch scratch{memory_.data(), memory_.size()};
        check(select_colliding(answers_.data(), size(), numbers.data(), size(),
                               numbers.data() + size(), scratch));
        ccd::vertex_index count = 0;
        check(cudaMemcpy(&count, numbers.data() + size(), sizeof count, cudaMemcpyDeviceToHost));
        const auto all = ccd::cuda::candidates<pair>::rows(rows_.data(), rows_.size())
                             .listed(numbers.data(), count);
        check(ccd::cuda::find_times(scene_.at, all, times.data(), scratch));
        const auto finished = finish_times(scene_.at, all, times.data(), scratch);
        check(finished);
        return finished.stages;
    }

  private:
    static device_array<pair> repeated(const std::vector<pair>& once, std::size_t copies) {
        std::vector<pair> all;
        for (std::size_t i = 0; i < copies; ++i) all.insert(all.end(), once.begin(), once.end());
        return {all.data(), all.size()};
    }

    const device_scene& scene_;
    std::size_t copies_;
    device_array<pair> rows_;
    device_array<ccd::outcome> answers_;
    device_array<std::byte> memory_;
};

struct contestant {
    ccd::cuda::batch_options options;
    ccd::lab::tally errors = {};  ///< of one of the copies
};

/// Times all methods in both precisions and counts their errors.
template <class Query>
std::vector<contestant> contestants_of(const device_batch<Query>& batch,
                                       const bench::query_set<Query>& once) {
    std::vector<ccd::outcome> truth(once.size());
    once.decide_batch(0, truth, {.threads = 0});
    std::vector<contestant> all;
    for (const ccd::method m : ccd::cuda::device_methods())
        for (const precision p : {precision::float64, precision::float32}) {
            contestant& c = all.emplace_back(contestant{{m, p, nullptr}});
            batch.decide(c.options);
            const auto found = batch.answers();
            for (std::size_t i = 0; i < truth.size(); ++i)
                c.errors.add(found[i], truth[i] != ccd::outcome::separate);
        }
    return all;
}

template <class Query>
std::vector<bench::timing> race(const device_batch<Query>& batch,
                                const std::vector<contestant>& contestants, int repeats) {
    std::vector<std::function<void()>> passes;
    for (const contestant& c : contestants)
        passes.emplace_back([&] {
            batch.decide(c.options);
            check(cudaDeviceSynchronize());
        });
    return bench::race(passes, repeats);
}

template <class Query>
void add_methods_table(const bench::scene& s, const device_batch<Query>& batch,
                       const std::vector<contestant>& contestants,
                       const std::vector<bench::timing>& times, bench::report& out) {
    bench::rows all;
    const auto count = static_cast<double>(batch.size());
    for (std::size_t i = 0; i < contestants.size(); ++i) {
        const contestant& c = contestants[i];
        all.push_back({{"method", info(c.options.method).name},
                       {"precision", name_of(c.options.precision)},
                       {"1e9/s_best", count / times[i].minimum / 1e9},
                       {"1e9/s_median", count / times[i].median / 1e9},
                       {"ns_per_query", 1e9 * times[i].minimum / count},
                       {"FP", c.errors.false_positives},
                       {"FN", c.errors.false_negatives}});
    }
    const std::string kind(short_name(ccd::kind_of<Query>));
    out.table("gpu-methods", {{"scene", s.name}, {"kind", kind}, {"queries", batch.size()}},
              "Methods on the device: " + std::to_string(batch.size() / batch.copies()) + ' ' +
                  kind + " candidates, " + std::to_string(batch.copies()) +
                  " times; errors of one of the copies",
              all);
}

/// The candidates that enter each stage of exact.
template <class Query>
void add_stages_table(const bench::scene& s, const device_batch<Query>& batch, bench::report& out) {
    const ccd::cuda::stage_counts counts = batch.decide({});
    bench::rows all;
    const auto add = [&](const char* stage, std::uint32_t entered) {
        const auto share = static_cast<double>(entered) / static_cast<double>(batch.size());
        all.push_back({{"stage", stage}, {"entered", entered}, {"%", 100 * share}});
    };
    add("axes, floats", counts.axes);
    add("coplanarity, doubles", counts.coplanarity);
    add("inside, doubles", counts.inside);
    add("subdivision", counts.subdivision);
    add("integers, one word", counts.integers_one_word);
    add("integers, two words", counts.integers_two_words);
    add("host", counts.left_open);
    out.table("gpu-stages",
              {{"scene", s.name}, {"kind", std::string(short_name(ccd::kind_of<Query>))}},
              "Stages of exact: the candidates that enter", all);
}

bench::row row_of_times(const char* where, std::size_t queries, std::size_t contacts,
                        const bench::timing& decided, const bench::timing& timed) {
    const auto each = [&](double seconds) { return 1e9 * seconds / static_cast<double>(queries); };
    return {{"where", where},
            {"contacts", contacts},
            {"decided", each(decided.minimum)},
            {"with_times", each(timed.minimum)},
            {"ratio", timed.minimum / decided.minimum},
            {"ns/contact", 1e9 * (timed.minimum - decided.minimum) /
                               static_cast<double>(std::max<std::size_t>(1, contacts))}};
}

/// First times of all colliding candidates, compared with the decision only, on the device and on
/// the host.
template <class Query>
void add_times_table(const bench::scene& s, const device_batch<Query>& batch,
                     const bench::query_set<Query>& once, int repeats, bench::report& out) {
    batch.decide({});
    const auto colliding = [](ccd::outcome a) { return a != ccd::outcome::separate; };
    const auto contacts =
        static_cast<std::size_t>(std::ranges::count_if(batch.answers(), colliding));
    const device_array<ccd::vertex_index> numbers(batch.size() + 1);
    const device_array<ccd::first_time> found(contacts);
    ccd::cuda::time_stage_counts stages;
    std::vector<ccd::first_time> on_host;
    const ccd::vertex_rows rows(s.before, s.after);
    const auto passes = bench::race({[&] {
                                         batch.decide({});
                                         check(cudaDeviceSynchronize());
                                     },
                                     [&] {
                                         batch.decide({});
                                         stages = batch.find_times(numbers, found);
                                         check(cudaDeviceSynchronize());
                                     },
                                     [&] { ccd::decide_batch(rows, once.by_index); },
                                     [&] { on_host = ccd::first_times(rows, once.by_index); }},
                                    repeats);
    std::erase_if(on_host, [&](const ccd::first_time& t) { return !colliding(t.outcome); });
    auto first_copy = found.copied();
    first_copy.resize(contacts / batch.copies());
    const std::string kind(short_name(ccd::kind_of<Query>));
    out.table("gpu-times", {{"scene", s.name}, {"kind", kind}, {"agree", first_copy == on_host}},
              "First times of the " + kind +
                  " candidates that collide, and the decision alone, in ns a query; " +
                  (first_copy == on_host ? "the same" : "NOT THE SAME") +
                  " on the host. On the device " + std::to_string(stages.roots_one_word) +
                  " needed a root in one word, " + std::to_string(stages.integers_one_word) +
                  " only in one word, " + std::to_string(stages.roots_two_words) + " and " +
                  std::to_string(stages.integers_two_words) + " in two, " +
                  std::to_string(stages.left_open) + " left to the host",
              {row_of_times("device", batch.size(), contacts, passes[0], passes[1]),
               row_of_times("host", once.size(), on_host.size(), passes[2], passes[3])});
}

template <class Query>
void methods(const bench::scene& s, const device_scene& device, const bench::query_set<Query>& once,
             std::size_t least, int repeats, bench::report& out) {
    if (once.size() == 0) return;
    const device_batch<Query> batch(device, once, least);
    const auto contestants = contestants_of(batch, once);
    add_methods_table(s, batch, contestants, race(batch, contestants, repeats), out);
    add_stages_table(s, batch, out);
    add_times_table(s, batch, once, repeats, out);
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
                       {"device_best", 1e3 * times[0].minimum},
                       {"median", 1e3 * times[0].median},
                       {"host_best", 1e3 * times[1].minimum},
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
