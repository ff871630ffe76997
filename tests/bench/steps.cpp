#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <ccd/step.hpp>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <new>
#include <stdexcept>

#include "tests/bench/sections.hpp"

// ---- The heap's peak ----
//
// This program counts the memory of operator new and operator delete. It does not count memory from
// malloc (large integers of the reference, the thread library).

namespace {

std::atomic<bool> counting = false;
std::atomic<std::ptrdiff_t> in_use = 0;  // negative if memory allocated earlier is freed
std::atomic<std::ptrdiff_t> peak = 0;

void add(void* p) {
    if (!counting.load(std::memory_order_relaxed)) return;
    const auto size = static_cast<std::ptrdiff_t>(malloc_usable_size(p));
    const std::ptrdiff_t now = in_use.fetch_add(size, std::memory_order_relaxed) + size;
    std::ptrdiff_t highest = peak.load(std::memory_order_relaxed);
    while (now > highest && !peak.compare_exchange_weak(highest, now, std::memory_order_relaxed)) {
    }
}

void* counted(void* p) {
    if (p == nullptr) throw std::bad_alloc();
    add(p);
    return p;
}

void release(void* p) noexcept {
    if (p != nullptr && counting.load(std::memory_order_relaxed)) {
        in_use.fetch_sub(static_cast<std::ptrdiff_t>(malloc_usable_size(p)),
                         std::memory_order_relaxed);
    }
    std::free(p);
}

}  // namespace

// The forms for arrays and those without exceptions call these.
void* operator new(std::size_t size) {
    return counted(std::malloc(std::max<std::size_t>(size, 1)));
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    const auto to = static_cast<std::size_t>(alignment);
    return counted(std::aligned_alloc(to, (std::max<std::size_t>(size, 1) + to - 1) / to * to));
}
void operator delete(void* p) noexcept {
    release(p);
}
void operator delete(void* p, std::size_t) noexcept {
    release(p);
}
void operator delete(void* p, std::align_val_t) noexcept {
    release(p);
}
void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
    release(p);
}

namespace bench {
namespace {

/// The largest number of bytes that `work` has allocated at a time, beyond those allocated before.
template <class Work>
std::size_t peak_heap(const Work& work) {
    in_use = 0;
    peak = 0;
    counting = true;
    work();
    counting = false;
    return static_cast<std::size_t>(peak.load());
}

// ---- Whole steps ----

/// A way to compute a step, and its best run.
struct contestant {
    ccd::method method;
    int threads;  ///< 0: all
    ccd::instruction_set set = ccd::instruction_sets().back();
    ccd::step_result quickest = {};
    double seconds = std::numeric_limits<double>::infinity();
};

ccd::step_result run(const ccd::mesh& before, const ccd::mesh& after, const contestant& c) {
    return ccd::step(before, after, {.method = c.method, .threads = c.threads, .set = c.set});
}
void run_timed(const ccd::mesh& before, const ccd::mesh& after, contestant& c) {
    const clock::time_point start = clock::now();
    ccd::step_result result = run(before, after, c);
    const double seconds = seconds_since(start);
    if (seconds >= c.seconds) return;
    c.seconds = seconds;
    c.quickest = std::move(result);
}

/// Races the contestants; afterwards each holds its fastest run.
std::vector<timing> race_steps(const ccd::mesh& before, const ccd::mesh& after,
                               std::vector<contestant>& contestants, int repeats) {
    std::vector<std::function<void()>> passes;
    for (contestant& c : contestants) {
        passes.push_back([&before, &after, &c] { run_timed(before, after, c); });
    }
    return race(passes, repeats);
}

std::size_t bytes_of(const ccd::mesh& m) {
    return m.vertices.size() * sizeof m.vertices[0] + m.faces.size() * sizeof m.faces[0];
}

double megabytes(std::size_t bytes) {
    return static_cast<double>(bytes) / 1e6;
}

row row_of(const scene& s, const contestant& c, const timing& t) {
    const ccd::step_result& r = c.quickest;
    const std::size_t heap = peak_heap([&] { keep(run(s.before, s.after, c)); });
    const std::size_t frames = bytes_of(s.before) + bytes_of(s.after);
    const std::size_t result = r.pairs.vertex_face.size() * sizeof(ccd::vertex_face_pair) +
                               r.pairs.edge_edge.size() * sizeof(ccd::edge_edge_pair);
    const std::size_t without_result = heap - std::min(heap, result);
    return {
        {"method", ccd::info(c.method).name},
        {"instruction_set", ccd::name(c.set)},
        {"threads", r.threads},
        {"ms_min", t.ms()},
        {"ms_median", 1e3 * t.median},
        {"prepare_ms", 1e3 * r.prepare_seconds},
        {"broad_ms", 1e3 * r.broad_phase_seconds},
        {"narrow_ms", 1e3 * r.narrow_phase_seconds},
        {"sort_ms", 1e3 * r.sort_seconds},
        {"candidates", s.queries.vertex_face.queries.size() + s.queries.edge_edge.queries.size()},
        {"pairs", r.pairs.vertex_face.size() + r.pairs.edge_edge.size()},
        {"frames_MB", megabytes(frames)},
        {"result_MB", megabytes(result)},
        {"peak_MB", megabytes(heap)},
        {"peak/frames", static_cast<double>(without_result) / static_cast<double>(frames)}};
}

}  // namespace

void steps(const scene& s, const options& o, report& out) {
    std::vector<contestant> contestants{{ccd::method::exact, 1}, {ccd::method::exact, 0}};
    if (!o.quick) {
        for (const ccd::instruction_set set : ccd::instruction_sets())
            if (set != contestants.front().set) contestants.push_back({ccd::method::exact, 1, set});
        contestants.push_back({ccd::method::tight, 1});
        contestants.push_back({ccd::method::float_, 1});
    }
    const auto timings = race_steps(s.before, s.after, contestants, o.repeats());
    rows all;
    for (std::size_t i = 0; i < contestants.size(); ++i)
        all.push_back(row_of(s, contestants[i], timings[i]));
    out.table("steps", {{"scene", s.name}},
              s.name +
                  ": whole steps, frames in memory to sorted pairs (peak: heap on top of the "
                  "frames; its ratio to the frames without the result)",
              all);
}

namespace {

// ---- Growth ----

/// Copies of a frame in rows of a square, `apart` from one another.
ccd::mesh copies_of(const ccd::mesh& frame, std::size_t copies, double apart) {
    const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(copies))));
    ccd::mesh all;
    for (std::size_t i = 0; i < copies; ++i) {
        const auto offset = static_cast<ccd::vertex_index>(all.vertices.size());
        const double x = apart * static_cast<double>(i % side);
        const double z = apart * static_cast<double>(i / side);
        for (const auto& p : frame.vertices) all.vertices.push_back({p.x + x, p.y, p.z + z});
        for (const auto& [a, b, c] : frame.faces)
            all.faces.push_back({a + offset, b + offset, c + offset});
    }
    return all;
}

/// A distance larger than the scene's width.
double width_of(const scene& s) {
    double least = 0, greatest = 0;
    for (const ccd::mesh* frame : {&s.before, &s.after})
        for (const auto& p : frame->vertices) {
            least = std::min({least, p.x, p.z});
            greatest = std::max({greatest, p.x, p.z});
        }
    return 1.1 * (greatest - least);
}

}  // namespace

void growth(const scene& s, const options& o, report& out) {
    rows all;
    const std::size_t most = o.quick ? 10 * s.before.faces.size() : 10'000'000;
    for (std::size_t faces = s.before.faces.size(), n = 1; n * faces < 10 * most; n *= 10) {
        const std::size_t copies = std::min(n, most / faces);
        const ccd::mesh before = copies_of(s.before, copies, width_of(s));
        const ccd::mesh after = copies_of(s.after, copies, width_of(s));
        std::vector<contestant> fresh{{ccd::method::exact, 1}, {ccd::method::exact, 0}};
        ccd::mesh_steps steps(before);
        const ccd::vertex_rows frames(before.vertices, after.vertices);
        std::size_t pairs = 0;
        const auto again = [&] { pairs = number_of(steps.run(frames, {.threads = 1}).pairs); };
        again();
        const auto timings = race({[&] { run_timed(before, after, fresh[0]); },
                                   [&] { run_timed(before, after, fresh[1]); }, again},
                                  copies > 10 ? 3 : o.repeats());
        if (pairs != number_of(fresh[0].quickest.pairs))
            throw std::runtime_error(s.name + ": a repeated step returned different pairs");
        const std::size_t heap = peak_heap([&] { keep(ccd::step(before, after, {.threads = 1})); });
        const auto ms = [&](std::size_t i) { return timings[i].ms(); };
        const auto per_face = static_cast<double>(before.faces.size());
        all.push_back({{"copies", copies},
                       {"faces", before.faces.size()},
                       {"pairs", pairs},
                       {"ms_one_thread", ms(0)},
                       {"ms_all_threads", ms(1)},
                       {"speed-up", ms(0) / ms(1)},
                       {"ms_again", ms(2)},
                       {"again/fresh", ms(2) / ms(0)},
                       {"ns_per_face", 1e6 * ms(0) / per_face},
                       {"frames_MB", megabytes(bytes_of(before) + bytes_of(after))},
                       {"peak_MB", megabytes(heap)},
                       {"bytes_per_face", static_cast<double>(heap) / per_face}});
        if (copies < n) break;
    }
    out.table("growth", {{"scene", s.name}, {"with", "copies"}},
              s.name +
                  ": whole steps of copies of the scene side by side, by exact, one thread "
                  "where no other number is given",
              all);
}

}  // namespace bench
