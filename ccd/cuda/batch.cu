// Batches on the device: checks arguments, partitions memory, queues the method's stages.
#include <algorithm>
#include <array>
#include <ccd/cuda.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>

#include "ccd/cuda/batch.cuh"
#include "ccd/cuda/cub.cuh"
#include "ccd/cuda/device_methods.cuh"
#include "ccd/cuda/method_stages.hpp"
#include "ccd/cuda/pairs.hpp"
#include "ccd/cuda/time_stages.hpp"

namespace ccd::cuda {
namespace detail {
namespace {

struct entry {
    ccd::method method;
    const device_method* functions;  ///< null: exact
};
constexpr entry table[] = {
    {method::float_, &device_float},
    {method::safe, &device_safe},
    {method::tight, &device_tight},
    {method::safeccd, &device_safeccd},
    {method::safeccd_tight, &device_safeccd_tight},
    {method::exact, nullptr},
};

/// The memory that CUB needs: a few bytes per thousand items, and a constant per block.
std::size_t temporary_bytes(std::size_t candidates) {
    return (std::size_t(4) << 20) + candidates / 16;
}

/// Checked scratch memory (fault_of_scratch), partitioned into that of CUB and the rest.
struct shares {
    arena rest, temporary;

    shares(const scratch& memory, std::size_t candidates)
        : rest(memory.data, memory.bytes),
          temporary(rest.take<std::byte>(temporary_bytes(candidates)),
                    temporary_bytes(candidates)) {}
};

std::string wrong_size(const std::string& name, std::size_t size, const char* condition,
                       std::size_t expected) {
    return "ccd::cuda: " + name + " is " + std::to_string(size) + "; expected " + condition + " " +
           std::to_string(expected);
}

std::string fault_of_scratch(const scratch& memory, std::size_t vertices, std::size_t candidates) {
    if (memory.data == nullptr)
        return "ccd::cuda: scratch memory is a null pointer; expected device memory";
    if (reinterpret_cast<std::uintptr_t>(memory.data) % arena::alignment != 0)
        return "ccd::cuda: scratch memory is misaligned; expected an address that is a multiple of "
               "256";
    const std::size_t bytes = scratch_bytes(vertices, candidates);
    if (memory.bytes < bytes)
        return wrong_size("number of bytes of scratch memory", memory.bytes, ">=", bytes);
    return {};
}

/// The largest number of candidates in one call. It and the next number fit in 32 bits.
constexpr std::size_t max_candidates = std::numeric_limits<std::uint32_t>::max() - 1;

template <class Pair>
std::string fault_of(const positions& at, const candidates<Pair>& candidates, const void* answers,
                     const scratch& memory) {
    if (candidates.count > max_candidates)
        return wrong_size("number of candidates", candidates.count, "<=", max_candidates);
    if (candidates.count == 0) return {};
    if (at.vertices == 0) return "ccd::cuda: number of vertices is 0; expected positions";
    if (at.vertices > max_candidates)
        return wrong_size("number of vertices", at.vertices, "<=", max_candidates);
    const bool named = candidates.of_rows != nullptr ||
                       (candidates.columns[0] != nullptr && candidates.columns[1] != nullptr &&
                        (candidates.elements != nullptr ||
                         (candidates.columns[2] != nullptr && candidates.columns[3] != nullptr)));
    if (!named || !has_coordinates(at) || answers == nullptr)
        return "ccd::cuda: argument is a null pointer; expected device memory";
    if (reinterpret_cast<std::uintptr_t>(candidates.of_rows) % 16 != 0)
        return "ccd::cuda: rows of indices are misaligned; expected an address that is a multiple "
               "of 16";
    return fault_of_scratch(memory, at.vertices, candidates.count);
}

template <class Pair>
std::string fault_of(const positions& at, const candidates<Pair>& candidates,
                     const outcome* answers, const scratch& memory, method m) {
    std::string fault = fault_of_method(m);
    return fault.empty() ? fault_of(at, candidates, answers, memory) : fault;
}

void check_left(device_launcher& launcher, std::size_t left, std::size_t candidates,
                const std::string& left_by) {
    if (launcher.ok() && left > candidates)
        launcher.fail("ccd::cuda: scratch memory is not that of " + left_by +
                      "; expected the same memory and candidates in both calls");
}

template <class Pair>
std::string fault_of(const positions& at, const candidates<Pair>& candidates,
                     const first_time* times, const scratch& memory, const time_options& options) {
    std::string fault = fault_of_t_max(options.t_max);
    return fault.empty() ? fault_of(at, candidates, times, memory) : fault;
}

}  // namespace

std::string fault_of_t_max(double t_max) {
    if (std::isfinite(t_max)) return {};
    return "ccd::cuda: t_max is " + std::to_string(t_max) + "; expected a finite number";
}

std::string fault_of_method(method m) {
    if (std::ranges::find(table, m, &entry::method) != std::end(table)) return {};
    return "ccd::cuda: method is " + std::string(info(m).name) +
           "; expected one of device_methods()";
}

bool has_coordinates(const positions& at) {
    const auto all = [](const positions::frame& frame) {
        return std::ranges::none_of(frame.axis, [](const void* p) { return p == nullptr; });
    };
    return all(at.before) && all(at.after);
}

template <class Pair>
void queue_float_method(device_launcher& launcher, const positions& at,
                        const candidates<Pair>& candidates, outcome* answers, arena memory,
                        const batch_options& options) {
    const device_method& m = *std::ranges::find(table, options.method, &entry::method)->functions;
    const auto& functions = options.precision == precision::float32 ? m.float32 : m.float64;
    static_cast<const queue_function<Pair>&>(functions).queue(launcher, at, candidates, answers,
                                                              memory);
}
template void queue_float_method(device_launcher&, const positions&,
                                 const candidates<vertex_face_pair>&, outcome*, arena,
                                 const batch_options&);
template void queue_float_method(device_launcher&, const positions&,
                                 const candidates<edge_edge_pair>&, outcome*, arena,
                                 const batch_options&);

}  // namespace detail

std::span<const method> device_methods() {
    static constexpr auto all = [] {
        std::array<method, std::size(detail::table)> methods{};
        std::ranges::transform(detail::table, methods.begin(), &detail::entry::method);
        return methods;
    }();
    return all;
}

status device_status() {
    int count = 0;
    detail::device_launcher launcher(nullptr);
    if (launcher.check(cudaGetDeviceCount(&count)) && count == 0) launcher.fail("CUDA: no device");
    return launcher.result();
}

std::size_t scratch_bytes(std::size_t vertices, std::size_t candidates) {
    detail::arena temporary, exact, other, times, place;
    temporary.take<std::byte>(detail::temporary_bytes(candidates));
    (void)detail::exact_memory(exact, vertices, candidates);
    (void)detail::method_memory(other, candidates);
    (void)detail::time_memory(times, candidates);
    place.take<std::uint32_t>(candidates + 1);
    return temporary.used() + std::max({exact.used(), other.used(), times.used(), place.used()});
}

template <device_pair Pair>
status decide_batch(const positions& at, const candidates<Pair>& candidates, outcome* answers,
                    scratch memory, const batch_options& options) {
    if (std::string fault = detail::fault_of(at, candidates, answers, memory, options.method);
        !fault.empty())
        return {std::move(fault)};
    if (candidates.count == 0) return {};
    detail::shares parts(memory, candidates.count);
    detail::device_launcher launcher(options.stream, parts.temporary);
    if (options.method == method::exact) {
        const detail::exact_memory all(parts.rest, at.vertices, candidates.count);
        detail::run_rounding(launcher, at, all.scene, all.rows);
        detail::queue_exact(launcher, at, candidates, answers, all, options.precision);
    } else {
        detail::queue_float_method(launcher, at, candidates, answers, parts.rest, options);
    }
    return launcher.result();
}
template status decide_batch(const positions&, const candidates<vertex_face_pair>&, outcome*,
                             scratch, const batch_options&);
template status decide_batch(const positions&, const candidates<edge_edge_pair>&, outcome*, scratch,
                             const batch_options&);

template <device_pair Pair>
finished finish(const positions& at, const candidates<Pair>& candidates, outcome* answers,
                scratch memory, const batch_options& options) {
    if (std::string fault = detail::fault_of(at, candidates, answers, memory, options.method);
        !fault.empty())
        return {{std::move(fault)}, {}};
    if (candidates.count == 0 || options.method != method::exact) return {};
    detail::shares parts(memory, candidates.count);
    detail::device_launcher launcher(options.stream, parts.temporary);
    const detail::exact_memory all(parts.rest, at.vertices, candidates.count);
    const detail::exact_counters c = detail::finish_exact(launcher, at, candidates, answers, all);
    detail::check_left(launcher, c.left, candidates.count, "decide_batch");
    return {launcher.result(),
            {static_cast<std::uint32_t>(candidates.count), c.coplanarity, c.inside, c.subdivision,
             c.one_word, c.two_words, c.left}};
}
template finished finish(const positions&, const candidates<vertex_face_pair>&, outcome*, scratch,
                         const batch_options&);
template finished finish(const positions&, const candidates<edge_edge_pair>&, outcome*, scratch,
                         const batch_options&);

template <device_pair Pair>
status find_times(const positions& at, const candidates<Pair>& candidates, first_time* times,
                  scratch memory, const time_options& options) {
    if (std::string fault = detail::fault_of(at, candidates, times, memory, options);
        !fault.empty())
        return {std::move(fault)};
    if (candidates.count == 0) return {};
    detail::shares parts(memory, candidates.count);
    detail::device_launcher launcher(options.stream, parts.temporary);
    detail::queue_times(launcher, at, candidates, times,
                        detail::time_memory(parts.rest, candidates.count), {options.t_max, false});
    return launcher.result();
}
template status find_times(const positions&, const candidates<vertex_face_pair>&, first_time*,
                           scratch, const time_options&);
template status find_times(const positions&, const candidates<edge_edge_pair>&, first_time*,
                           scratch, const time_options&);

template <device_pair Pair>
finished_times finish_times(const positions& at, const candidates<Pair>& candidates,
                            first_time* times, scratch memory, const time_options& options) {
    if (std::string fault = detail::fault_of(at, candidates, times, memory, options);
        !fault.empty())
        return {{std::move(fault)}, {}};
    if (candidates.count == 0) return {};
    detail::shares parts(memory, candidates.count);
    detail::device_launcher launcher(options.stream, parts.temporary);
    const detail::time_memory all(parts.rest, candidates.count);
    const detail::time_counters c = detail::finish_times(launcher, at, candidates, times, all);
    detail::check_left(launcher, c.left, candidates.count, "find_times");
    return {launcher.result(),
            {static_cast<std::uint32_t>(candidates.count), c.one_word, c.roots_in_two_words,
             c.two_words, c.left}};
}
template finished_times finish_times(const positions&, const candidates<vertex_face_pair>&,
                                     first_time*, scratch, const time_options&);
template finished_times finish_times(const positions&, const candidates<edge_edge_pair>&,
                                     first_time*, scratch, const time_options&);

status select_colliding(const outcome* answers, std::size_t answer_count, vertex_index* found,
                        std::size_t room, vertex_index* count, scratch memory, stream stream) {
    if (answer_count > detail::max_candidates)
        return {
            detail::wrong_size("number of answers", answer_count, "<=", detail::max_candidates)};
    if ((answer_count > 0 && answers == nullptr) || (room > 0 && found == nullptr) ||
        count == nullptr)
        return {"ccd::cuda: argument is a null pointer; expected device memory"};
    if (std::string fault = detail::fault_of_scratch(memory, 0, answer_count); !fault.empty())
        return {std::move(fault)};
    detail::shares parts(memory, answer_count);
    detail::device_launcher launcher(stream, parts.temporary);
    detail::run_select(launcher, detail::may_collide_at{answers}, answer_count, found, room, count,
                       parts.rest.take<std::uint32_t>(answer_count + 1));
    return launcher.result();
}

}  // namespace ccd::cuda
