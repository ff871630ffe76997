// Runs kernel bodies on the host in loops (ccd/cuda/launch.hpp).
#pragma once

#include <ccd/cuda.hpp>
#include <ccd/mesh.hpp>
#include <ccd/method.hpp>
#include <ccd/step.hpp>
#include <ccd/verdict.hpp>
#include <cstddef>
#include <memory>
#include <vector>

#include "ccd/cuda/launch.hpp"
#include "ccd/cuda/method_stages.hpp"
#include "ccd/cuda/step_times.hpp"

namespace cuda_on_host {

/// Memory for a layout. Memory(arena, sizes...) is constructed twice: to count, then to take
/// memory.
template <class Memory>
class laid_out {
  public:
    template <class... Sizes>
    explicit laid_out(Sizes... sizes) : bytes_(counted(sizes...)), memory_(taken(sizes...)) {}
    const Memory& operator*() const { return memory_; }
    const Memory* operator->() const { return &memory_; }

  private:
    template <class... Sizes>
    static std::size_t counted(Sizes... sizes) {
        ccd::cuda::detail::arena count;
        (void)Memory(count, sizes...);
        return count.used() + ccd::cuda::detail::arena::alignment;
    }
    template <class... Sizes>
    Memory taken(Sizes... sizes) {
        void* start = bytes_.data();
        std::size_t room = bytes_.size();
        std::align(ccd::cuda::detail::arena::alignment, 1, start, room);
        ccd::cuda::detail::arena from(start, room);
        return Memory(from, sizes...);
    }

    std::vector<std::byte> bytes_;
    Memory memory_;
};

/// Returns answers of a float method's stages. `in_doubles`, if not null, receives the number of
/// candidates that doubles decided.
template <class Method, class T, class Pair>
std::vector<ccd::outcome> decide_by(const ccd::cuda::positions& at,
                                    const ccd::cuda::candidates<Pair>& all,
                                    std::size_t* in_doubles = nullptr) {
    ccd::cuda::detail::host_launcher launcher;
    // Results must not depend on old contents.
    std::vector<ccd::outcome> answers(all.count, ccd::outcome::collides);
    const laid_out<ccd::cuda::detail::method_memory> memory(all.count);
    ccd::cuda::detail::run_method<Method, T>(launcher, at, all, answers.data(), *memory);
    if (in_doubles != nullptr) *in_doubles = memory->counters->in_doubles;
    return answers;
}

template <class Pair>
std::vector<ccd::first_time> first_times(const ccd::cuda::positions& at,
                                         const ccd::cuda::candidates<Pair>& all,
                                         const ccd::cuda::detail::times_request& request = {1,
                                                                                            false},
                                         ccd::cuda::detail::time_counters* counters = nullptr) {
    ccd::cuda::detail::host_launcher launcher;
    // Results must not depend on old contents.
    std::vector<ccd::first_time> times(all.count, {ccd::outcome::collides, -1, 2});
    const laid_out<ccd::cuda::detail::time_memory> memory(all.count);
    run_time_stages(launcher, at, all, times.data(), *memory, request);
    const auto counted = finish_times(launcher, at, all, times.data(), *memory);
    if (counters != nullptr) *counters = counted;
    return times;
}

constexpr std::size_t default_block =
    ccd::cuda::detail::step_memory<ccd::cuda::detail::host_launcher>::default_block;

/// A step by `exact` with the device's code, except the launches.
inline ccd::step_result step(const ccd::mesh& before, const ccd::mesh& after,
                             const ccd::cuda::mesh_step_options& options = {},
                             std::size_t block = default_block) {
    using namespace ccd::cuda::detail;
    host_launcher launcher;
    timed_steps<host_launcher> steps(block);
    using coordinates = ccd::cuda::coordinates<double>;
    const ccd::vertex_rows rows(before, after);
    const ccd::cuda::positions at(coordinates::rows(rows.before), coordinates::rows(rows.after),
                                  rows.vertices);
    steps.set_mesh(launcher, rows.vertices, ccd::unique_faces(before.faces),
                   ccd::unique_edges(before.faces));
    const auto decide = [&](const auto& part, ccd::outcome* answers, scene_extent* scene,
                            rounded_position* rounded) -> std::size_t {
        const laid_out<exact_memory> all(scene, rounded, part.count);
        run_exact_stages(launcher, at, part, answers, *all, ccd::cuda::precision::float32);
        return finish_exact(launcher, at, part, answers, *all).left;
    };
    const auto find = [&](const auto& pairs, ccd::first_time* times,
                          const times_request& times_of) -> std::size_t {
        const laid_out<time_memory> all(pairs.count);
        run_time_stages(launcher, at, pairs, times, *all, times_of);
        return finish_times(launcher, at, pairs, times, *all).left;
    };
    ccd::step_result result;
    // Runs twice: the second step reuses the memory of the first.
    for (int i = 0; i < 2; ++i) {
        const found_pairs found = steps.run(launcher, at, options, decide, find);
        result = {};
        result.candidates = {found.vertex_face_candidates, found.edge_edge_candidates};
        read_lists<ccd::kind::vertex_face>(launcher, steps.vertex_face(), result);
        read_lists<ccd::kind::edge_edge>(launcher, steps.edge_edge(), result);
        result.first_contact = steps.first_contact();
    }
    return result;
}

template <class Visit>
void for_each_float_method(const Visit& visit) {
    using ccd::method, ccd::cuda::detail::bsc_method, ccd::cuda::detail::safeccd_method;
    visit.template operator()<bsc_method<errbound::none>>(method::float_);
    visit.template operator()<bsc_method<errbound::safe>>(method::safe);
    visit.template operator()<bsc_method<errbound::tight>>(method::tight);
    visit.template operator()<safeccd_method<errbound::safe>>(method::safeccd);
    visit.template operator()<safeccd_method<errbound::tight>>(method::safeccd_tight);
}

}  // namespace cuda_on_host
