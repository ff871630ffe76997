// On a device: the same answers as on the host, bit for bit. Skipped where there is none.
#include <cuda_runtime_api.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <ccd/cuda.hpp>
#include <ccd/exact.hpp>
#include <ccd/io/mesh_file.hpp>
#include <ccd/method.hpp>
#include <ccd/step.hpp>
#include <cstddef>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "tests/ccd/cuda/on_host.hpp"
#include "tests/ccd/cuda/sets.hpp"
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
    EXPECT_EQ(differ, 0u) << info(m).name << " of " << set.size() << " queries";
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
    std::cout << set.size() << " queries by every method\n";
}

TEST_F(on_device, decides_difficult_queries_as_the_host_does) {
    expect_all_methods_same(difficult<ccd::vertex_face_pair>());
    expect_all_methods_same(difficult<ccd::edge_edge_pair>());
}

TEST_F(on_device, decides_stored_queries_as_the_host_does) {
    const fs::path data = cuda_sets::data_folder();
    if (!fs::is_directory(data)) GTEST_SKIP() << "No stored queries.";
    expect_all_methods_same(cuda_sets::stored<ccd::vertex_face_pair>(data));
    expect_all_methods_same(cuda_sets::stored<ccd::edge_edge_pair>(data));
}

void expect_same_step(const fs::path& scene, const char* first, const char* second) {
    const ccd::mesh before = ccd::io::read_mesh(scene / first);
    const ccd::mesh after = ccd::io::read_mesh(scene / second);
    for (const ccd::method m : {ccd::method::exact, ccd::method::tight}) {
        const auto expected = ccd::step(before, after, {.method = m});
        const auto found = ccd::cuda::step(before, after, {.method = m});
        ASSERT_TRUE(found) << found.error;
        EXPECT_EQ(found.candidates.vertex_face, expected.candidates.vertex_face);
        EXPECT_EQ(found.candidates.edge_edge, expected.candidates.edge_edge);
        EXPECT_EQ(found.pairs.vertex_face, expected.pairs.vertex_face);
        EXPECT_EQ(found.pairs.edge_edge, expected.pairs.edge_edge);
    }
}

TEST_F(on_device, finds_the_pairs_of_a_step) {
    expect_same_step(fs::path(ERRBOUND_SCENES) / "cloth-over-ball", "frame0.ply", "frame1.ply");
}

// The calls that a simulation makes: memory, stream and lists of its own.
TEST_F(on_device, works_on_device_memory_and_streams) {
    const auto set = cuda_sets::of_families<ccd::vertex_face_pair>(100, 33);
    cudaStream_t stream = nullptr;
    ASSERT_EQ(cudaStreamCreate(&stream), cudaSuccess);
    const auto copied = [](const auto& host) {
        void* p = nullptr;
        const std::size_t bytes = host.size() * sizeof(host[0]);
        EXPECT_EQ(cudaMalloc(&p, bytes), cudaSuccess);
        EXPECT_EQ(cudaMemcpy(p, host.data(), bytes, cudaMemcpyHostToDevice), cudaSuccess);
        return p;
    };
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
    const auto expect_done = [](const ccd::cuda::status& s) { EXPECT_TRUE(s) << s.error; };
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
    EXPECT_EQ(counts.axes, set.size());
    for (void* p : {static_cast<void*>(before), static_cast<void*>(after), static_cast<void*>(rows),
                    static_cast<void*>(answers), static_cast<void*>(found), memory.data})
        EXPECT_EQ(cudaFree(p), cudaSuccess);
    EXPECT_EQ(cudaStreamDestroy(stream), cudaSuccess);
}

// Arguments are looked at before anything runs, so these need no device.
TEST(device_arguments, are_refused_in_words) {
    const ccd::cuda::positions nowhere;
    alignas(16) const ccd::vertex_face_pair row{0, 1, 2, 3};
    using candidates = ccd::cuda::candidates<ccd::vertex_face_pair>;
    outcome answer{};
    alignas(256) std::byte some[256];
    const double xyz[12]{};
    const ccd::cuda::positions at(ccd::cuda::coordinates<double>::rows(xyz),
                                  ccd::cuda::coordinates<double>::rows(xyz), 4);
    const ccd::cuda::scratch little{some, sizeof some};
    const auto error = [&](const auto&... arguments) {
        return ccd::cuda::decide_batch(arguments...).error;
    };
    const auto one = candidates::rows(&row, 1);
    EXPECT_NE(error(nowhere, one, &answer, little).find("no vertices"), std::string::npos);
    EXPECT_NE(error(at, one, nullptr, little).find("null pointer"), std::string::npos);
    EXPECT_NE(error(at, one, &answer, little).find("scratch memory of 256, expected"),
              std::string::npos);
    const auto* const crooked =
        reinterpret_cast<const ccd::vertex_face_pair*>(reinterpret_cast<const char*>(&row) + 4);
    EXPECT_NE(error(at, candidates::rows(crooked, 1), &answer, little).find("multiple of 16"),
              std::string::npos);
    EXPECT_NE(error(at, one, &answer, little, ccd::cuda::batch_options{ccd::method::provot})
                  .find("provot, expected"),
              std::string::npos);
    EXPECT_NE(
        error(at, candidates::rows(&row, std::size_t(1) << 32), &answer, little).find("at most"),
        std::string::npos);
    EXPECT_NE(error(at, candidates::rows(nullptr, 1), &answer, little).find("null pointer"),
              std::string::npos);
    const ccd::vertex_index one_index = 0;
    EXPECT_NE(error(at, candidates::pairs(&one_index, &one_index, nullptr, 1), &answer, little)
                  .find("null pointer"),
              std::string::npos);
    EXPECT_TRUE(ccd::cuda::decide_batch(at, candidates{}, nullptr, {}));
    ccd::vertex_index found_one = 0, count = 0;
    EXPECT_NE(ccd::cuda::select_colliding(&answer, 1, &found_one, 1, &count, {}).error.find("null"),
              std::string::npos);
    EXPECT_NE(ccd::cuda::select_colliding(&answer, 1, &found_one, 1, &count, little)
                  .error.find("scratch memory of 256, expected"),
              std::string::npos);
    EXPECT_THROW(ccd::cuda::mesh_steps(std::vector<ccd::face>{{0, 1, 4}}, 4),
                 std::invalid_argument);
    ccd::cuda::mesh_steps steps(std::vector<ccd::face>{{0, 1, 2}}, 3);
    EXPECT_NE(steps.run(at).error.find("4 vertices, expected 3"), std::string::npos);
}

}  // namespace
