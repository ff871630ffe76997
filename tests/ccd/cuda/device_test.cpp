// Answers on a device equal those on the host, bit for bit. Skipped without a device.
#include <cuda_runtime_api.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <ccd/contact.hpp>
#include <ccd/cuda.hpp>
#include <ccd/exact.hpp>
#include <ccd/io/mesh_file.hpp>
#include <ccd/method.hpp>
#include <ccd/step.hpp>
#include <cstddef>
#include <filesystem>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/ccd/cuda/on_host.hpp"
#include "tests/ccd/cuda/sets.hpp"
#include "tests/ccd/step/expect_steps.hpp"
#include "tests/support/scaled.hpp"

namespace {

namespace fs = std::filesystem;
using ccd::outcome;
using ccd::cuda::precision;
using cuda_sets::batch;

class on_device : public testing::Test {
  protected:
    void SetUp() override {
        if (const auto s = ccd::cuda::device_status(); !s)
            GTEST_SKIP() << "No CUDA device: " << s.error;
    }
};

template <class Pair>
constexpr auto name_of = ccd::kind_traits<ccd::kind_of<Pair>>::short_name;

template <class Pair>
batch<Pair> difficult() {
    return cuda_sets::of_families<Pair>(support::scaled(2000u), 21);
}

template <class Pair>
void expect_same(const batch<Pair>& set, ccd::method m, precision p,
                 const std::vector<outcome>& expected) {
    std::vector<outcome> found(set.size(), outcome::uncertain);
    const auto s = ccd::cuda::decide(set.queries, found, {m, p, nullptr});
    ASSERT_TRUE(s) << s.error;
    std::size_t differ = 0;
    for (std::size_t i = 0; i < set.size(); ++i) differ += found[i] != expected[i];
    std::cout << name_of<Pair> << ' ' << info(m).name << (p == precision::float32 ? " float32" : "")
              << ": " << differ << " of " << set.size() << " differ\n";
    EXPECT_EQ(differ, 0u);
}

template <class Pair>
void expect_all_methods_same(const batch<Pair>& set) {
    std::vector<outcome> truth;
    for (const auto& q : set.queries) truth.push_back(ccd::decide_exact(q).outcome);
    for (const precision p : {precision::float64, precision::float32})
        expect_same(set, ccd::method::exact, p, truth);
    const auto at = set.positions();
    const auto all = set.candidates();
    cuda_on_host::for_each_float_method([&]<class Method>(ccd::method m) {
        expect_same(set, m, precision::float64, cuda_on_host::decide_by<Method, double>(at, all));
        expect_same(set, m, precision::float32, cuda_on_host::decide_by<Method, float>(at, all));
    });
}

TEST_F(on_device, decides_difficult_queries_as_the_host_does) {
    expect_all_methods_same(difficult<ccd::vertex_face_pair>());
    expect_all_methods_same(difficult<ccd::edge_edge_pair>());
}

TEST_F(on_device, decides_stored_queries_as_the_host_does) {
    const fs::path data = stored_data::folder();
    if (!fs::is_directory(data)) GTEST_SKIP() << stored_data::missing;
    expect_all_methods_same(cuda_sets::stored<ccd::vertex_face_pair>(data));
    expect_all_methods_same(cuda_sets::stored<ccd::edge_edge_pair>(data));
}

template <class Pair>
void expect_same_times(const batch<Pair>& set) {
    for (const double t_max : {1.0, 0.5, 0.0}) {
        std::vector<ccd::first_time> found(set.size());
        const auto s = ccd::cuda::first_times(set.queries, found, {t_max, nullptr});
        ASSERT_TRUE(s) << s.error;
        const auto expected = ccd::first_times(set.queries, {.t_max = t_max});
        std::size_t differ = 0;
        for (std::size_t i = 0; i < set.size(); ++i) differ += found[i] != expected[i];
        std::cout << name_of<Pair> << " times until " << t_max << ": " << differ << " of "
                  << set.size() << " differ\n";
        EXPECT_EQ(differ, 0u);
    }
}

TEST_F(on_device, finds_first_times_as_the_host_does) {
    expect_same_times(difficult<ccd::vertex_face_pair>());
    expect_same_times(difficult<ccd::edge_edge_pair>());
}

TEST_F(on_device, finds_first_times_of_stored_queries_as_the_host_does) {
    const fs::path data = stored_data::folder();
    if (!fs::is_directory(data)) GTEST_SKIP() << stored_data::missing;
    expect_same_times(cuda_sets::stored<ccd::vertex_face_pair>(data));
    expect_same_times(cuda_sets::stored<ccd::edge_edge_pair>(data));
}

void expect_same_step(const ccd::mesh& before, const ccd::mesh& after,
                      const ccd::step_options& options) {
    ccd::step_options counted = options;
    counted.count_candidates = true;
    const auto expected = ccd::step(before, after, counted);
    const auto found = ccd::cuda::step(before, after, options);
    ASSERT_TRUE(found) << found.error;
    EXPECT_EQ(found.candidates, expected.candidates);
    brute_force::expect_same_results(found, expected);
    std::cout << before.faces.size() << " faces, " << info(options.method).name << ": "
              << expected.candidates->vertex_face + expected.candidates->edge_edge
              << " candidates, "
              << expected.pairs.vertex_face.size() + expected.pairs.edge_edge.size() << " pairs\n";
}

TEST_F(on_device, finds_the_pairs_and_times_of_a_step) {
    const fs::path scene = fs::path(ERRBOUND_SCENES) / "cloth-over-ball";
    const ccd::mesh before = ccd::io::read_mesh(scene / "frame0.ply");
    const ccd::mesh after = ccd::io::read_mesh(scene / "frame1.ply");
    for (const ccd::method m : {ccd::method::exact, ccd::method::tight})
        for (const bool initial_contact : {false, true})
            expect_same_step(before, after, {.method = m, .initial_contact = initial_contact});
    for (const double t_max : {1.0, 0.5})
        for (const bool times : {false, true})
            expect_same_step(before, after,
                             {.first_contact = true, .times = times, .t_max = t_max});
    for (const unsigned faces : {1U, 11U, 33U, 100U}) {
        auto [strip, moved] = brute_force::random_soup(faces, faces + 2, 1);
        strip.faces.clear();
        for (ccd::vertex_index v = 0; v < faces; ++v) strip.faces.push_back({v + 2, v, v + 1});
        moved.faces = strip.faces;
        expect_same_step(strip, moved, {.times = true});
    }
}

TEST_F(on_device, finds_the_pairs_and_times_of_stored_scenes) {
    if (!stored_data::has_scenes()) GTEST_SKIP() << stored_data::missing;
    stored_data::for_each_scene([](const fs::path& first, const fs::path& second) {
        const ccd::mesh before = ccd::io::read_mesh(first), after = ccd::io::read_mesh(second);
        expect_same_step(before, after, {.times = true});
        expect_same_step(before, after, {.initial_contact = true, .first_contact = true});
        expect_same_step(before, after, {.method = ccd::method::tight});
    });
}

template <class T>
void* copied(const std::vector<T>& host) {
    void* p = nullptr;
    EXPECT_EQ(cudaMalloc(&p, host.size() * sizeof(T)), cudaSuccess);
    EXPECT_EQ(cudaMemcpy(p, host.data(), host.size() * sizeof(T), cudaMemcpyHostToDevice),
              cudaSuccess);
    return p;
}
void expect_done(const ccd::cuda::status& s) {
    EXPECT_TRUE(s) << s.error;
}

template <class Pair>
void expect_times_of(const batch<Pair>& set, const std::vector<ccd::vertex_index>& numbers,
                     const ccd::cuda::positions& at, const ccd::cuda::candidates<Pair>& candidates,
                     const ccd::cuda::scratch& memory, cudaStream_t stream) {
    constexpr double t_max = 0.75;
    std::vector<ccd::first_time> found(numbers.size());
    auto* const times = static_cast<ccd::first_time*>(copied(found));
    expect_done(ccd::cuda::find_times(at, candidates, times, memory, {t_max, stream}));
    expect_done(ccd::cuda::finish_times(at, candidates, times, memory, {t_max, stream}));
    ASSERT_EQ(cudaStreamSynchronize(stream), cudaSuccess);
    ASSERT_EQ(cudaMemcpy(found.data(), times, found.size() * sizeof *times, cudaMemcpyDeviceToHost),
              cudaSuccess);
    for (std::size_t k = 0; k < found.size(); ++k)
        EXPECT_EQ(found[k], ccd::time_of_impact(set.queries[numbers[k]], t_max));
    EXPECT_EQ(cudaFree(times), cudaSuccess);
}

// The calls of a simulation with its own memory, stream and lists.
TEST_F(on_device, works_on_device_memory_and_streams) {
    const auto set = cuda_sets::of_families<ccd::vertex_face_pair>(100, 33);
    cudaStream_t stream = nullptr;
    ASSERT_EQ(cudaStreamCreate(&stream), cudaSuccess);
    auto* const before = static_cast<double*>(copied(set.before));
    auto* const after = static_cast<double*>(copied(set.after));
    auto* const rows = static_cast<ccd::vertex_face_pair*>(copied(set.rows));
    auto* const answers = static_cast<outcome*>(copied(std::vector<outcome>(set.size())));
    auto* const found =
        static_cast<ccd::vertex_index*>(copied(std::vector<ccd::vertex_index>(set.size() + 1)));
    const std::size_t bytes = ccd::cuda::scratch_bytes(set.before.size(), set.size());
    const ccd::cuda::scratch memory{copied(std::vector<std::byte>(bytes)), bytes};

    const auto at = cuda_sets::positions_of({before, after, set.before.size()});
    const auto all = ccd::cuda::candidates<ccd::vertex_face_pair>::rows(rows, set.size());
    const ccd::cuda::batch_options options{ccd::method::exact, precision::float64, stream};
    expect_done(ccd::cuda::decide_batch(at, all, answers, memory, options));
    const auto finished = ccd::cuda::finish(at, all, answers, memory, options);
    expect_done(finished);
    const ccd::cuda::stage_counts& counts = finished.stages;
    expect_done(ccd::cuda::select_colliding(answers, set.size(), found, set.size(),
                                            found + set.size(), memory, stream));
    std::vector<ccd::vertex_index> list(set.size() + 1);
    ASSERT_EQ(cudaStreamSynchronize(stream), cudaSuccess);
    ASSERT_EQ(cudaMemcpy(list.data(), found, list.size() * sizeof list[0], cudaMemcpyDeviceToHost),
              cudaSuccess);
    std::vector<ccd::vertex_index> expected;
    for (ccd::vertex_index i = 0; i < set.size(); ++i)
        if (ccd::decide_exact(set.queries[i]).outcome != outcome::separate) expected.push_back(i);
    ASSERT_EQ(list.back(), expected.size());
    list.resize(expected.size());
    EXPECT_EQ(list, expected);

    expect_times_of(set, list, at, all.listed(found, list.size()), memory, stream);
    EXPECT_EQ(counts.axes, set.size());
    for (void* p : {static_cast<void*>(before), static_cast<void*>(after), static_cast<void*>(rows),
                    static_cast<void*>(answers), static_cast<void*>(found), memory.data})
        EXPECT_EQ(cudaFree(p), cudaSuccess);
    EXPECT_EQ(cudaStreamDestroy(stream), cudaSuccess);
}

// Arguments are checked before anything runs, so no device is needed.
class device_arguments : public testing::Test {
  protected:
    using candidates = ccd::cuda::candidates<ccd::vertex_face_pair>;
    static constexpr double nan = std::numeric_limits<double>::quiet_NaN();

    static void expect_refused(const ccd::cuda::status& s, const char* message) {
        EXPECT_NE(s.error.find(message), std::string::npos) << s.error;
    }

    alignas(16) const ccd::vertex_face_pair row{0, 1, 2, 3};
    alignas(256) std::byte some[256];
    const ccd::cuda::scratch little{some, sizeof some};
    const double xyz[12]{};
    const ccd::cuda::positions at{ccd::cuda::coordinates<double>::rows(xyz),
                                  ccd::cuda::coordinates<double>::rows(xyz), 4};
    const candidates one = candidates::rows(&row, 1);
};

TEST_F(device_arguments, of_decisions_are_refused_in_words) {
    using ccd::cuda::decide_batch;
    const auto* const crooked =
        reinterpret_cast<const ccd::vertex_face_pair*>(reinterpret_cast<const char*>(&row) + 4);
    outcome answer{};
    const ccd::vertex_index index = 0;
    expect_refused(decide_batch({}, one, &answer, little), "number of vertices is 0");
    expect_refused(decide_batch(at, one, nullptr, little), "null pointer");
    expect_refused(decide_batch(at, one, &answer, little), "scratch memory is 256; expected");
    expect_refused(decide_batch(at, one, &answer, little, {ccd::method::provot}),
                   "provot; expected");
    for (const auto& [wrong, message] :
         {std::pair(candidates::rows(crooked, 1), "multiple of 16"),
          {candidates::rows(&row, std::size_t(1) << 32), "expected <="},
          {candidates::rows(nullptr, 1), "null pointer"},
          {candidates::pairs(&index, &index, nullptr, 1), "null pointer"}})
        expect_refused(decide_batch(at, wrong, &answer, little), message);
    EXPECT_TRUE(decide_batch(at, candidates{}, nullptr, {}));
    ccd::vertex_index found_one = 0, count = 0;
    expect_refused(ccd::cuda::select_colliding(&answer, 1, &found_one, 1, &count, {}), "null");
    expect_refused(ccd::cuda::select_colliding(&answer, 1, &found_one, 1, &count, little),
                   "scratch memory is 256; expected");
}

TEST_F(device_arguments, of_times_and_steps_are_refused_in_words) {
    ccd::first_time time;
    expect_refused(ccd::cuda::find_times(at, one, &time, little, {nan, nullptr}), "t_max is nan");
    expect_refused(ccd::cuda::find_times(at, one, nullptr, little), "null pointer");
    expect_refused(ccd::cuda::finish_times(at, one, &time, little), "scratch memory is 256");
    std::vector<ccd::first_time> none;
    EXPECT_THROW((void)ccd::cuda::first_times(std::vector<ccd::vertex_face<double>>(1), none),
                 std::invalid_argument);
    EXPECT_THROW(ccd::cuda::mesh_steps(std::vector<ccd::face>{{0, 1, 4}}, 4),
                 std::invalid_argument);
    ccd::cuda::mesh_steps steps(std::vector<ccd::face>{{0, 1, 2}}, 4),
        others(std::vector<ccd::face>{{0, 1, 2}}, 3);
    expect_refused(others.run(at), "is 4; expected 3");
    expect_refused(steps.run(at, {.method = ccd::method::tight, .times = true}),
                   "method is tight; expected exact");
    expect_refused(steps.run(at, {.t_max = nan}), "t_max is nan");
    const ccd::mesh mesh{std::vector<ccd::point<double>>(4), {{0, 1, 2}}};
    expect_refused(ccd::cuda::step(mesh, mesh, {.distances = {0.5}}), "distances");
    const std::vector<int> groups(4);
    expect_refused(ccd::cuda::step(mesh, mesh, {.filter = {.groups = groups}}), "filter");
    EXPECT_THROW(
        (void)ccd::cuda::step(mesh, mesh, {.method = ccd::method::tight, .first_contact = true}),
        std::invalid_argument);
}

}  // namespace
