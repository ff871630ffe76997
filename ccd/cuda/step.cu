// Steps on the device, and batches from and to host memory.
#include <algorithm>
#include <ccd/cuda.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "ccd/cuda/batch.cuh"
#include "ccd/cuda/device_methods.cuh"
#include "ccd/cuda/pairs.hpp"
#include "ccd/cuda/step.hpp"
#include "ccd/step/checks.hpp"
#include "ccd/step/elements.hpp"
#include "ccd/step/stopwatch.hpp"

namespace ccd::cuda {

struct mesh_steps::state {
    std::vector<face> faces;
    std::vector<edge> edges;
    std::size_t vertices = 0;
    bool mesh_copied = false;
    detail::device_launcher launcher{nullptr};  // with memory of its own, which is kept
    detail::step_memory<detail::device_launcher> memory;
    detail::device_launcher::buffer<std::byte> batch;
};

mesh_steps::mesh_steps(std::span<const face> faces, std::size_t vertices)
    : state_(std::make_unique<state>()) {
    ccd::detail::check_elements(faces, {}, vertices, "ccd::cuda::mesh_steps");
    state_->faces = unique_faces(faces);
    state_->edges = unique_edges(faces);
    state_->vertices = vertices;
}
mesh_steps::~mesh_steps() = default;
mesh_steps::mesh_steps(mesh_steps&&) noexcept = default;
mesh_steps& mesh_steps::operator=(mesh_steps&&) noexcept = default;

mesh_steps::result mesh_steps::run(const positions& positions, const batch_options& options) {
    const auto fault = [](std::string why) { return result{{std::move(why)}, {}, {}, 0}; };
    if (positions.vertices != state_->vertices)
        return fault("ccd::cuda: found positions of " + std::to_string(positions.vertices) +
                     " vertices, expected " + std::to_string(state_->vertices));
    if (positions.vertices > 0 && !detail::has_coordinates(positions))
        return fault("ccd::cuda: found a null pointer, expected positions");
    if (std::string why = detail::fault_of_method(options.method); !why.empty())
        return fault(std::move(why));
    if (positions.vertices == 0) return {};
    detail::device_launcher& launcher = state_->launcher;
    launcher.begin(options.stream);
    auto& memory = state_->memory;
    if (!state_->mesh_copied) {
        memory.set_mesh(launcher, state_->vertices, state_->faces, state_->edges);
        state_->mesh_copied = launcher.ok();
    }
    const auto decide = [&](const auto& block, outcome* answers, detail::scene_extent* scene,
                            detail::rounded_position* rows) -> std::size_t {
        detail::arena needed;
        (void)detail::exact_memory(needed, scene, rows, block.count);  // a method_memory needs less
        state_->batch.resize(launcher, needed.used());
        if (!launcher.ok()) return 0;
        detail::arena given(state_->batch.data(), state_->batch.size());
        if (options.method != method::exact) {
            detail::queue_float_method(launcher, positions, block, answers, given, options);
            return 0;
        }
        const detail::exact_memory all(given, scene, rows, block.count);
        detail::queue_exact(launcher, positions, block, answers, all, options.precision);
        return detail::finish_exact(launcher, positions, block, answers, all).left;
    };
    const auto pairs = memory.run(launcher, positions, decide);
    if (!launcher.ok()) return fault(launcher.result().error);
    if (!pairs.finite) return fault("ccd::cuda: a coordinate is not finite");
    result found;
    found.pairs.vertex_face = {memory.vertex_face().data(), pairs.vertex_face};
    found.pairs.edge_edge = {memory.edge_edge().data(), pairs.edge_edge};
    found.candidates.vertex_face = pairs.vertex_face_candidates;
    found.candidates.edge_edge = pairs.edge_edge_candidates;
    found.finished_on_host = pairs.finished_on_host;
    return found;
}

namespace {

/// Rows of vertices in device memory.
struct device_frames {
    detail::device_launcher::buffer<double> before, after;

    positions copy(detail::device_launcher& launcher, const vertex_rows& host) {
        const std::size_t numbers = 3 * host.vertices;
        before.resize(launcher, numbers);
        after.resize(launcher, numbers);
        launcher.write(before.data(), numbers, host.before);
        launcher.write(after.data(), numbers, host.after);
        return positions(coordinates<double>::rows(before.data()),
                         coordinates<double>::rows(after.data()), host.vertices);
    }
};

template <class Query, class Pair>
status decide_stored(std::span<const Query> queries, std::span<outcome> answers,
                     const batch_options& options) {
    if (queries.size() != answers.size())
        throw std::invalid_argument("ccd::cuda::decide: " + std::to_string(queries.size()) +
                                    " queries, but room for " + std::to_string(answers.size()) +
                                    " answers");
    constexpr std::size_t block = std::size_t(1) << 20;
    detail::device_launcher launcher(options.stream);
    device_frames frames;
    detail::device_launcher::buffer<Pair> rows;
    detail::device_launcher::buffer<outcome> found;
    detail::device_launcher::buffer<std::byte> memory;
    std::vector<point<double>> before, after;
    std::vector<Pair> indices;
    for (std::size_t first = 0; first < queries.size() && launcher.ok(); first += block) {
        const auto part = queries.subspan(first, std::min(block, queries.size() - first));
        before.clear(), after.clear(), indices.clear();
        for (const Query& q : part) {
            const auto v = static_cast<vertex_index>(before.size());
            indices.push_back({v, v + 1, v + 2, v + 3});
            for (const auto& p : points_of(q)) before.push_back(p.t0), after.push_back(p.t1);
        }
        const positions at = frames.copy(launcher, vertex_rows(before, after));
        rows.resize(launcher, part.size());
        launcher.write(rows.data(), part.size(), indices.data());
        found.resize(launcher, part.size());
        memory.resize(launcher, scratch_bytes(at.vertices, part.size()));
        if (!launcher.ok()) break;
        const auto all = candidates<Pair>::rows(rows.data(), part.size());
        const scratch given{memory.data(), memory.size()};
        if (status s = decide_batch(at, all, found.data(), given, options); !s) return s;
        if (status s = finish(at, all, found.data(), given, options); !s) return s;
        launcher.read(found.data(), part.size(), &answers[first]);
    }
    return launcher.result();
}

}  // namespace

status decide(std::span<const vertex_face<double>> queries, std::span<outcome> answers,
              const batch_options& options) {
    return decide_stored<vertex_face<double>, vertex_face_pair>(queries, answers, options);
}
status decide(std::span<const edge_edge<double>> queries, std::span<outcome> answers,
              const batch_options& options) {
    return decide_stored<edge_edge<double>, edge_edge_pair>(queries, answers, options);
}

step_result step(const mesh& before, const mesh& after, const step_options& options,
                 precision precision) {
    step_result result;
    const auto failed = [](status s) { return step_result{std::move(s), {}}; };
    ccd::detail::check_frames(before, after);
    ccd::detail::check_positions(vertex_rows(before, after), before.vertices.size());
    ccd::detail::check_elements(before.faces, {}, before.vertices.size(), "ccd::cuda::step");
    if (!ccd::detail::has_faces_alone(before))
        return failed({"ccd::cuda: found edges or points, expected a mesh of faces alone"});
    if (ccd::detail::ask_for_times_or_distances(options))
        return failed({"ccd::cuda: found times or distances asked for, expected contact alone"});
    ccd::detail::stopwatch total, watch;
    detail::device_launcher launcher(nullptr);
    device_frames frames;
    mesh_steps steps(before.faces, before.vertices.size());
    const positions at = frames.copy(launcher, vertex_rows(before, after));
    if (!launcher.ok()) return failed(launcher.result());
    result.prepare_seconds = watch.lap();

    const mesh_steps::result found = steps.run(at, {options.method, precision, nullptr});
    if (!found) return failed(found);
    result.narrow_phase_seconds = watch.lap();

    auto& vertex_face = result.pairs.vertex_face;
    auto& edge_edge = result.pairs.edge_edge;
    vertex_face.resize(found.pairs.vertex_face.size());
    edge_edge.resize(found.pairs.edge_edge.size());
    launcher.read(found.pairs.vertex_face.data(), vertex_face.size(), vertex_face.data());
    launcher.read(found.pairs.edge_edge.data(), edge_edge.size(), edge_edge.data());
    if (!launcher.ok()) return failed(launcher.result());
    for (vertex_face_pair& p : vertex_face) p = ccd::detail::canonical(p);
    std::ranges::sort(vertex_face);
    std::ranges::sort(edge_edge);
    result.candidates = found.candidates;
    result.sort_seconds = watch.lap();
    result.total_seconds = total.lap();
    result.threads = 1;
    return result;
}

}  // namespace ccd::cuda
