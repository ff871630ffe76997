// Steps on the device, and batches from and to host memory.
#include <algorithm>
#include <ccd/cuda.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "ccd/cuda/batch.cuh"
#include "ccd/cuda/cub.cuh"
#include "ccd/cuda/device_methods.cuh"
#include "ccd/cuda/pairs.hpp"
#include "ccd/cuda/step_times.hpp"
#include "ccd/step/checks.hpp"
#include "ccd/step/stopwatch.hpp"

namespace ccd::cuda {

struct mesh_steps::state {
    std::vector<face> faces;
    std::vector<edge> edges;
    std::size_t vertices = 0;
    bool mesh_copied = false;
    detail::device_launcher launcher{nullptr};
    detail::timed_steps<detail::device_launcher> steps;
    detail::device_launcher::buffer<std::byte> batch;

    std::string fault_of(const positions& at, const mesh_step_options& options) const;

    /// Do not use the memory after an error.
    template <class Memory, class... Sizes>
    Memory memory_of(Sizes... sizes) {
        detail::arena needed;
        (void)Memory(needed, sizes...);
        batch.resize(launcher, needed.used());
        detail::arena given(batch.data(), batch.size());
        return Memory(given, sizes...);
    }

    /// Callbacks: decide() of step_memory::run, find() of timed_pairs::find_times.
    template <class Pair>
    std::size_t decide(const positions& at, const mesh_step_options& options,
                       const candidates<Pair>& block, outcome* answers, detail::scene_extent* scene,
                       detail::rounded_position* rows) {
        const auto all = memory_of<detail::exact_memory>(scene, rows, block.count);
        if (!launcher.ok()) return 0;
        if (options.method != method::exact) {
            const detail::arena given(batch.data(), batch.size());
            detail::queue_float_method(launcher, at, block, answers, given,
                                       {options.method, options.precision, options.stream});
            return 0;
        }
        detail::queue_exact(launcher, at, block, answers, all, options.precision);
        return detail::finish_exact(launcher, at, block, answers, all).left;
    }
    template <class Pair>
    std::size_t find(const positions& at, const candidates<Pair>& pairs, first_time* times,
                     const detail::times_request& request) {
        const auto all = memory_of<detail::time_memory>(pairs.count);
        if (!launcher.ok()) return 0;
        detail::queue_times(launcher, at, pairs, times, all, request);
        return detail::finish_times(launcher, at, pairs, times, all).left;
    }
};

std::string mesh_steps::state::fault_of(const positions& at,
                                        const mesh_step_options& options) const {
    if (at.vertices != vertices)
        return "ccd::cuda: number of vertices in positions is " + std::to_string(at.vertices) +
               "; expected " + std::to_string(vertices);
    if (at.vertices > 0 && !detail::has_coordinates(at))
        return "ccd::cuda: positions are a null pointer; expected device memory";
    if (std::string why = detail::fault_of_method(options.method); !why.empty()) return why;
    if (std::string why = detail::fault_of_t_max(options.t_max); !why.empty()) return why;
    if (options.method != method::exact && detail::needs_first_contact(options))
        return "ccd::cuda: method is " + std::string(info(options.method).name) +
               "; expected exact with options for times";
    return {};
}

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

mesh_steps::result mesh_steps::run(const positions& positions, const mesh_step_options& options) {
    const auto fault = [](std::string why) {
        result failed;
        failed.error = std::move(why);
        return failed;
    };
    if (std::string why = state_->fault_of(positions, options); !why.empty())
        return fault(std::move(why));
    result found;
    found.first_contact = detail::no_contact(options);
    if (positions.vertices == 0) return found;
    detail::device_launcher& launcher = state_->launcher;
    auto& steps = state_->steps;
    launcher.begin(options.stream);
    if (!state_->mesh_copied) {
        steps.set_mesh(launcher, state_->vertices, state_->faces, state_->edges);
        state_->mesh_copied = launcher.ok();
    }
    const auto pairs = steps.run(
        launcher, positions, options,
        [&](const auto& block, outcome* answers, detail::scene_extent* scene,
            detail::rounded_position* rows) {
            return state_->decide(positions, options, block, answers, scene, rows);
        },
        [&](const auto& some, first_time* times, const detail::times_request& of) {
            return state_->find(positions, some, times, of);
        });
    if (!launcher.ok()) return fault(launcher.result().error);
    if (!pairs.finite) return fault("ccd::cuda: a coordinate is not finite");
    const auto take = [&]<kind K>(const detail::pairs_and_times<pair_of_kind<K>>& lists) {
        found.pairs.of<K>() = lists.pairs;
        found.times.of<K>() = lists.times;
        found.touching_at_start.of<K>() = lists.touching_at_start;
    };
    take.operator()<kind::vertex_face>(steps.vertex_face());
    take.operator()<kind::edge_edge>(steps.edge_edge());
    found.candidates.vertex_face = pairs.vertex_face_candidates;
    found.candidates.edge_edge = pairs.edge_edge_candidates;
    found.finished_on_host = pairs.finished_on_host;
    found.first_contact = steps.first_contact();
    return found;
}

namespace {

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

template <class Query>
class stored_queries {
  public:
    using pair = pair_of_query<Query>;

    stored_queries(std::span<const Query> queries, cuda::stream stream)
        : launcher_(stream), queries_(queries) {}

    /// Calls use(first, positions, candidates, answers, scratch) for every decided block, until it
    /// returns an error.
    template <class Use>
    status decide(const batch_options& options, const Use& use) {
        constexpr std::size_t block = std::size_t(1) << 20;
        for (std::size_t first = 0; first < queries_.size(); first += block) {
            const auto part = queries_.subspan(first, std::min(block, queries_.size() - first));
            const positions at = copy(part);
            if (!launcher_.ok()) break;
            const auto all = candidates<pair>::rows(rows_.data(), part.size());
            const scratch memory{memory_.data(), memory_.size()};
            outcome* const answers = answers_.data();
            if (status s = decide_batch(at, all, answers, memory, options); !s) return s;
            if (status s = finish(at, all, answers, memory, options); !s) return s;
            if (status s = use(first, at, all, answers, memory); !s) return s;
        }
        return launcher_.result();
    }
    detail::device_launcher& launcher() { return launcher_; }

  private:
    positions copy(std::span<const Query> part) {
        before_.clear(), after_.clear(), indices_.clear();
        for (const Query& q : part) {
            const auto v = static_cast<vertex_index>(before_.size());
            indices_.push_back({v, v + 1, v + 2, v + 3});
            for (const auto& p : points_of(q)) before_.push_back(p.t0), after_.push_back(p.t1);
        }
        rows_.resize(launcher_, part.size());
        launcher_.write(rows_.data(), part.size(), indices_.data());
        answers_.resize(launcher_, part.size());
        memory_.resize(launcher_, scratch_bytes(before_.size(), part.size()));
        return frames_.copy(launcher_, vertex_rows(before_, after_));
    }

    detail::device_launcher launcher_;
    std::span<const Query> queries_;
    std::vector<point<double>> before_, after_;
    std::vector<pair> indices_;
    device_frames frames_;
    detail::device_launcher::buffer<pair> rows_;
    detail::device_launcher::buffer<outcome> answers_;
    detail::device_launcher::buffer<std::byte> memory_;
};

void check_room(const char* caller, std::size_t queries, std::size_t room) {
    if (queries != room)
        throw std::invalid_argument(std::string(caller) + ": number of answers is " +
                                    std::to_string(room) + "; expected that of queries, " +
                                    std::to_string(queries));
}

template <class Query>
status decide_stored(std::span<const Query> queries, std::span<outcome> answers,
                     const batch_options& options) {
    check_room("ccd::cuda::decide", queries.size(), answers.size());
    stored_queries<Query> stored(queries, options.stream);
    return stored.decide(options, [&](std::size_t first, const positions&, const auto& all,
                                      const outcome* found, const scratch&) {
        stored.launcher().read(found, all.count, &answers[first]);
        return stored.launcher().result();
    });
}

template <class Query>
status times_of_stored(std::span<const Query> queries, std::span<first_time> times,
                       const time_options& options) {
    check_room("ccd::cuda::first_times", queries.size(), times.size());
    stored_queries<Query> stored(queries, options.stream);
    detail::device_launcher& launcher = stored.launcher();
    detail::selection<detail::device_launcher> colliding;
    detail::device_launcher::buffer<first_time> found;
    std::vector<vertex_index> numbers;
    std::vector<first_time> found_on_host;
    const auto times_of_block = [&](std::size_t first, const positions& at, const auto& all,
                                    const outcome* answers, const scratch& memory) -> status {
        colliding.select(launcher, detail::may_collide_at{answers}, all.count);
        found.resize(launcher, colliding.size());
        if (!launcher.ok()) return launcher.result();
        const auto some = all.listed(colliding.numbers(), colliding.size());
        if (status s = find_times(at, some, found.data(), memory, options); !s) return s;
        if (status s = finish_times(at, some, found.data(), memory, options); !s) return s;
        numbers.resize(colliding.size());
        launcher.read(colliding.numbers(), numbers.size(), numbers.data());
        found_on_host.resize(colliding.size());
        launcher.read(found.data(), found_on_host.size(), found_on_host.data());
        std::ranges::fill(times.subspan(first, all.count), first_time{outcome::separate});
        for (std::size_t k = 0; k < numbers.size(); ++k)
            times[first + numbers[k]] = found_on_host[k];
        return launcher.result();
    };
    return stored.decide({.stream = options.stream}, times_of_block);
}

}  // namespace

status decide(std::span<const vertex_face<double>> queries, std::span<outcome> answers,
              const batch_options& options) {
    return decide_stored(queries, answers, options);
}
status decide(std::span<const edge_edge<double>> queries, std::span<outcome> answers,
              const batch_options& options) {
    return decide_stored(queries, answers, options);
}
status first_times(std::span<const vertex_face<double>> queries, std::span<first_time> times,
                   const time_options& options) {
    return times_of_stored(queries, times, options);
}
status first_times(std::span<const edge_edge<double>> queries, std::span<first_time> times,
                   const time_options& options) {
    return times_of_stored(queries, times, options);
}

step_result step(const mesh& before, const mesh& after, const step_options& options,
                 precision precision) {
    step_result result;
    const auto failed = [](status s) { return step_result{std::move(s), {}}; };
    ccd::detail::check_frames(before, after, "ccd::cuda::step");
    ccd::detail::check_positions(vertex_rows(before, after), before.vertices.size(),
                                 "ccd::cuda::step");
    ccd::detail::check_elements(before.faces, {}, before.vertices.size(), "ccd::cuda::step");
    if (!ccd::detail::has_faces_only(before))
        return failed({"ccd::cuda: mesh has edges or points; expected only faces"});
    ccd::detail::check_options(options, before.vertices.size(), "ccd::cuda::step");
    if (!options.distances.is_contact())
        return failed({"ccd::cuda: distances are not 0; expected 0"});
    const pair_filter& filter = options.filter;
    if (filter.can_collide || !filter.groups.empty() || !filter.pinned.empty() || filter.region ||
        filter.skip_unused)
        return failed({"ccd::cuda: filter of pairs is not empty; expected an empty one"});
    ccd::detail::stopwatch total, watch;
    detail::device_launcher launcher(nullptr);
    device_frames frames;
    mesh_steps steps(before.faces, before.vertices.size());
    const positions at = frames.copy(launcher, vertex_rows(before, after));
    if (!launcher.ok()) return failed(launcher.result());
    result.prepare_seconds = watch.lap();

    const mesh_steps::result found =
        steps.run(at, {options.method, precision, nullptr, options.initial_contact,
                       options.first_contact, options.times, options.t_max});
    if (!found) return failed(found);
    result.narrow_phase_seconds = watch.lap();

    const auto read = [&]<kind K>() {
        const detail::pairs_and_times<pair_of_kind<K>> lists{
            found.pairs.of<K>(), found.times.of<K>(), found.touching_at_start.of<K>()};
        detail::read_lists<K>(launcher, lists, result);
    };
    read.operator()<kind::vertex_face>();
    read.operator()<kind::edge_edge>();
    if (!launcher.ok()) return failed(launcher.result());
    result.first_contact = found.first_contact;
    result.candidates = found.candidates;
    result.sort_seconds = watch.lap();
    result.total_seconds = total.lap();
    result.threads = 1;
    return result;
}

}  // namespace ccd::cuda
