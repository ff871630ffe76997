// ./run bench-gpu: tables of every method on the device and on the host, of first times and of
// whole steps.
#include <cuda_runtime_api.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <ccd/batch.hpp>
#include <ccd/contact.hpp>
#include <ccd/cuda.hpp>
#include <ccd/step.hpp>
#include <cstdio>
#include <exception>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "ccd/lab/machine.hpp"
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
                       const std::vector<bench::timing>& times, const bench::device_peaks& peaks,
                       bench::report& out) {
    std::vector<std::vector<bench::cell>> table;
    const auto count = static_cast<double>(batch.size());
    for (std::size_t i = 0; i < contestants.size(); ++i) {
        const contestant& c = contestants[i];
        // The smallest possible transfer reads every row once and writes every answer once.
        const double moved =
            count * (sizeof(ccd::pair_of_query<Query>) + sizeof(ccd::outcome)) / times[i].minimum;
        table.push_back(
            {bench::word(info(c.options.method).name), bench::word(name_of(c.options.precision)),
             bench::number(count / times[i].minimum / 1e9, 3),
             bench::number(count / times[i].median / 1e9, 3),
             bench::number(1e9 * times[i].minimum / count, 3),
             bench::percent(moved / peaks.bytes_per_second), bench::count(c.errors.false_positives),
             bench::count(c.errors.false_negatives)});
    }
    const std::string kind(short_name(ccd::kind_of<Query>));
    out.table("gpu-methods", {{"scene", s.name}, {"kind", kind}, {"queries", batch.size()}},
              "Methods on the device: " + bench::count(batch.size() / batch.copies()).text + ' ' +
                  kind + " candidates, " + std::to_string(batch.copies()) +
                  " times; errors of one of the copies",
              {{"method", "method", true},
               {"precision", "precision", true},
               {"billion_per_second", "1e9/s best"},
               {"median", "median"},
               {"ns_per_query", "ns/query"},
               {"bandwidth", "bandwidth"},
               {"false_positives", "FP"},
               {"false_negatives", "FN"}},
              table);
}

/// The stages of exact: candidates that enter each stage, and its operations compared with the
/// peaks in `seconds`.
template <class Query>
void add_stages_table(const bench::scene& s, const device_batch<Query>& batch, double seconds,
                      const bench::device_peaks& peaks, bench::report& out) {
    const ccd::cuda::stage_counts counts = batch.decide({});
    const auto operations = bench::operations_of_stages<Query>();
    const auto row = [&](const char* stage, std::uint32_t entered, std::uint64_t each,
                         double peak) {
        const double share = static_cast<double>(entered) / static_cast<double>(batch.size());
        return std::vector<bench::cell>{
            bench::word(stage), bench::count(entered), bench::percent(share),
            each == 0 ? bench::none() : bench::count(each),
            each == 0 ? bench::none()
                      : bench::percent(static_cast<double>(each) * entered / seconds / peak)};
    };
    out.table("gpu-stages",
              {{"scene", s.name}, {"kind", std::string(short_name(ccd::kind_of<Query>))}},
              "Stages of exact: candidates that enter, operations of each, and those of all "
              "as a share of the peak rate in the time of the whole",
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

std::vector<bench::cell> row_of_times(const char* where, std::size_t queries, std::size_t contacts,
                                      const bench::timing& decided, const bench::timing& timed) {
    const auto each = [&](double seconds) {
        return bench::number(1e9 * seconds / static_cast<double>(queries), 3);
    };
    return {bench::word(where),
            bench::count(contacts),
            each(decided.minimum),
            each(timed.minimum),
            bench::number(timed.minimum / decided.minimum, 3),
            bench::number(1e9 * (timed.minimum - decided.minimum) /
                              static_cast<double>(std::max<std::size_t>(1, contacts)),
                          1)};
}

/// First times of all colliding candidates, compared with the decision only, on the device and on
/// the host.
template <class Query>
void add_times_table(const bench::scene& s, const device_batch<Query>& batch,
                     const bench::query_set<Query>& once, const bench::options& o,
                     bench::report& out) {
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
                                    o.repeats());
    std::erase_if(on_host, [&](const ccd::first_time& t) { return !colliding(t.outcome); });
    auto first_copy = found.copied();
    first_copy.resize(contacts / batch.copies());
    const std::string kind(short_name(ccd::kind_of<Query>));
    out.table("gpu-times", {{"scene", s.name}, {"kind", kind}, {"agree", first_copy == on_host}},
              "First times of the " + kind +
                  " candidates that collide, and the decision alone, in " + "ns a query; " +
                  (first_copy == on_host ? "the same" : "NOT THE SAME") +
                  " on the host. On the device " + std::to_string(stages.roots_one_word) +
                  " needed a root in one word, " + std::to_string(stages.integers_one_word) +
                  " in one word alone, " + std::to_string(stages.roots_two_words) + " and " +
                  std::to_string(stages.integers_two_words) + " in two, " +
                  std::to_string(stages.left_open) + " left to the host",
              {{"where", "where", true},
               {"contacts", "contacts"},
               {"decided", "decided"},
               {"timed", "with times"},
               {"ratio", "ratio"},
               {"ns_per_contact", "ns/contact"}},
              {row_of_times("device", batch.size(), contacts, passes[0], passes[1]),
               row_of_times("host", once.size(), on_host.size(), passes[2], passes[3])});
}

template <class Query>
void methods(const bench::scene& s, const device_scene& device, const bench::query_set<Query>& once,
             std::size_t least, const bench::device_peaks& peaks, const bench::options& o,
             bench::report& out) {
    if (once.size() == 0) return;
    const device_batch<Query> batch(device, once, least);
    const auto contestants = contestants_of(batch, once);
    const auto times = race(batch, contestants, o.repeats());
    add_methods_table(s, batch, contestants, times, peaks, out);
    const auto exact = std::ranges::find(contestants, ccd::method::exact,
                                         [](const contestant& c) { return c.options.method; });
    add_stages_table(s, batch, times[static_cast<std::size_t>(exact - contestants.begin())].minimum,
                     peaks, out);
    add_times_table(s, batch, once, o, out);
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

void steps(const bench::scene& s, const device_scene& device, const bench::options& o,
           bench::report& out) {
    std::vector<std::vector<bench::cell>> table;
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
                        o.repeats());
        table.push_back(
            {bench::word(request.name),
             bench::count(found.candidates.vertex_face + found.candidates.edge_edge),
             bench::count(found.pairs.vertex_face.size() + found.pairs.edge_edge.size()),
             bench::word(found.pairs.vertex_face.size() == on_host.pairs.vertex_face.size() &&
                                 found.pairs.edge_edge.size() == on_host.pairs.edge_edge.size() &&
                                 found.first_contact == on_host.first_contact
                             ? "yes"
                             : "NO"),
             bench::number(1e3 * times[0].minimum, 3), bench::number(1e3 * times[0].median, 3),
             bench::number(1e3 * times[1].minimum, 3),
             bench::number(times[1].minimum / times[0].minimum, 1)});
    }
    out.table(
        "gpu-steps", {{"scene", s.name}},
        "A step: from vertices on the device to pairs and times there, in ms; by the host with "
        "all its threads, from its memory",
        {{"method", "step", true},
         {"candidates", "candidates"},
         {"pairs", "pairs"},
         {"agree", "agree", true},
         {"device_ms", "device best"},
         {"device_median_ms", "median"},
         {"host_ms", "host best"},
         {"ratio", "host/device"}},
        table);
}

struct run_options : bench::options {
    std::string json, commit = "unknown";
    std::size_t queries = 20'000'000;
};

void add_options(CLI::App& app, run_options& o) {
    app.add_flag("--quick", o.quick, "Fewer queries and repeats: tests that everything runs");
    app.add_option("--json", o.json, "The tables as JSON, to this file");
    app.add_option("--scene", o.scene, "Only scenes whose name contains this");
    app.add_option("--queries", o.queries, "Candidates are replicated to at least this number")
        ->check(CLI::Range(std::size_t(1), std::size_t(2'000'000'000)));
    app.add_option("--commit", o.commit, "Commit to print with the results");
}

/// Prints the device and the host, and returns them as JSON.
nlohmann::json say_machine(const bench::device_peaks& peaks, const std::string& commit) {
    cudaDeviceProp device{};
    check(cudaGetDeviceProperties(&device, 0));
    nlohmann::json here = ccd::lab::this_machine();
    here.update({{"device", device.name},
                 {"bytes_per_second", peaks.bytes_per_second},
                 {"float_operations", peaks.float_operations},
                 {"double_operations", peaks.double_operations},
                 {"commit", commit}});
    std::printf(
        "%s, %d multiprocessors; host: %s, %s cores; commit %s\n"
        "measured: %.0f GB/s copied, %.1f and %.1f Tflop/s in floats and doubles, not "
        "fused\n",
        device.name, device.multiProcessorCount, here["processor"].get<std::string>().c_str(),
        here["cores"].dump().c_str(), commit.c_str(), 1e-9 * peaks.bytes_per_second,
        1e-12 * peaks.float_operations, 1e-12 * peaks.double_operations);
    return here;
}

void measure_scene(const std::string& name, const run_options& o, const bench::device_peaks& peaks,
                   bench::report& out) {
    bench::scene s;
    if (!bench::load(name, s)) {
        bench::report::say("\n== " + name + ": skipped, its data is missing");
        return;
    }
    if (!s.is_step()) return;
    const std::size_t queries = o.quick ? std::min<std::size_t>(o.queries, 1'000'000) : o.queries;
    const device_scene device({s.before, s.after});
    methods(s, device, s.queries.vertex_face, queries, peaks, o, out);
    methods(s, device, s.queries.edge_edge, queries, peaks, o, out);
    steps(s, device, o, out);
}

}  // namespace

int main(int argc, char** argv) try {
    CLI::App app{"Times collision detection on a CUDA device; prints tables."};
    app.name("./run bench-gpu");
    run_options o;
    add_options(app, o);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    if (const auto s = ccd::cuda::device_status(); !s) {
        std::printf("No CUDA device, so nothing is measured: %s\n", s.error.c_str());
        return 77;
    }
    const bench::device_peaks peaks = bench::measured_peaks();
    const nlohmann::json machine = say_machine(peaks, o.commit);
    bench::report out;
    for (const std::string& name : bench::scene_names())
        if (name.find(o.scene) != std::string::npos) measure_scene(name, o, peaks, out);
    if (!o.json.empty())
        errbound::support::write_whole(
            o.json, nlohmann::json{{"machine", machine}, {"tables", out.tables()}}.dump(1) + "\n");
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "bench-gpu: %s\n", error.what());
    return 1;
}
