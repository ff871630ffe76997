#include "ccd/batch/batch_worker.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "ccd/exact/finite.hpp"
#include "ccd/exact/stages.hpp"

namespace ccd {
namespace detail {
namespace {

struct instruction_set_entry {
    instruction_set set;
    std::string_view name;
    const batch_kernels* kernels;
    bool (*runs_here)();
};

constexpr instruction_set_entry entries[] = {
    {instruction_set::baseline, "baseline", &baseline::kernels, [] { return true; }},
#ifdef ERRBOUND_HAVE_X86_KERNELS
    {instruction_set::avx2, "avx2", &avx2::kernels,
     [] { return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0; }},
    {instruction_set::avx512, "avx512", &avx512::kernels,
     [] {
         return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
                __builtin_cpu_supports("avx512vl") != 0 &&
                __builtin_cpu_supports("avx512bw") != 0 && __builtin_cpu_supports("avx512cd") != 0;
     }},
#endif
};

struct available_sets {
    std::array<instruction_set, std::size(entries)> sets{};
    std::size_t size = 0;

    available_sets() {
        for (const auto& entry : entries)
            if (entry.runs_here()) sets[size++] = entry.set;
    }
};

}  // namespace
}  // namespace detail

std::span<const instruction_set> instruction_sets() {
    static const detail::available_sets available;
    return {available.sets.data(), available.size};
}

std::string_view name(instruction_set set) {
    constexpr std::string_view names[] = {"baseline", "avx2", "avx512"};
    const auto i = static_cast<std::size_t>(set);
    return i < std::size(names) ? names[i] : "unknown";
}

std::optional<instruction_set> find_instruction_set(std::string_view wanted) {
    for (const auto set :
         {instruction_set::baseline, instruction_set::avx2, instruction_set::avx512})
        if (name(set) == wanted) return set;
    return std::nullopt;
}

namespace detail {

instruction_set runnable(std::optional<instruction_set> set) {
    const auto available = instruction_sets();
    const instruction_set wanted = set.value_or(available.back());
    if (std::ranges::find(available, wanted) == available.end())
        throw std::invalid_argument("ccd: this build or machine does not run the instruction set " +
                                    std::string(name(wanted)));
    return wanted;
}

const batch_kernels& kernels_for(std::optional<instruction_set> set) {
    return *std::ranges::find(entries, runnable(set), &instruction_set_entry::set)->kernels;
}

namespace {

/// What the kernels left uncertain, by the exact stages; what is not finite stays so.
template <class At>
void decide_uncertain(std::size_t count, outcome* answers, stage_report* report,
                      const At& query_at) {
    for (std::size_t i = 0; i < count; ++i) {
        if (answers[i] != outcome::uncertain) continue;
        const auto query = query_at(i);
        if (is_finite(query)) answers[i] = decide_exactly(query, report).outcome;
    }
}

template <kind K, class Pair>
void decide_indexed(const kernels_of_kind<K>& kernels, const batch_positions& positions,
                    std::span<const Pair> queries, outcome* answers, axes_pauses& pauses,
                    stage_report* report) {
    kernels.indexed(positions, queries.data(), queries.size(), {}, answers, pauses, report);
    decide_uncertain(queries.size(), answers, report,
                     [&](std::size_t i) { return query_of(positions.exact, queries[i]); });
}

template <kind K, class Query>
void decide_stored(const kernels_of_kind<K>& kernels, std::span<const Query> queries,
                   outcome* answers, axes_pauses& pauses, stage_report* report) {
    kernels.stored(queries.data(), queries.size(), answers, pauses, report);
    decide_uncertain(queries.size(), answers, report, [&](std::size_t i) { return queries[i]; });
}

template <kind K, class Pair>
void decide_by_floats(const kernels_of_kind<K>& kernels, const batch_positions& positions,
                      std::span<const Pair> queries, double distance, outcome* answers,
                      axes_pauses& pauses) {
    const distance_asked within{distance, rounded_axes::gaps_beyond(distance * positions.scale)};
    kernels.indexed(positions, queries.data(), queries.size(), within, answers, pauses, nullptr);
}

/// By blocks: find(first, count, low, high) asks a kernel; where it cannot tell, query_at(i) is
/// asked alone.
template <class Find, class QueryAt>
void find_times_of(std::size_t count, const Find& find, const QueryAt& query_at,
                   first_time* times) {
    constexpr std::size_t block = 256;
    double low[block], high[block];
    for (std::size_t first = 0; first < count; first += block) {
        const std::size_t size = std::min(count - first, block);
        find(first, size, low, high);
        for (std::size_t i = 0; i < size; ++i)
            times[first + i] = low[i] < high[i] ? first_time{outcome::collides, low[i], high[i]}
                                                : time_of_impact(query_at(first + i));
    }
}

template <kind K, class Pair>
void find_indexed_times(const kernels_of_kind<K>& kernels, const batch_positions& positions,
                        std::span<const Pair> queries, first_time* times) {
    find_times_of(
        queries.size(),
        [&](std::size_t first, std::size_t count, double* low, double* high) {
            kernels.indexed_times(positions, queries.data() + first, count, low, high);
        },
        [&](std::size_t i) { return query_of(positions.exact, queries[i]); }, times);
}
template <kind K, class Query>
void find_stored_times(const kernels_of_kind<K>& kernels, std::span<const Query> queries,
                       first_time* times) {
    find_times_of(
        queries.size(),
        [&](std::size_t first, std::size_t count, double* low, double* high) {
            kernels.stored_times(queries.data() + first, count, low, high);
        },
        [&](std::size_t i) { return queries[i]; }, times);
}

}  // namespace

void batch_worker::decide(const batch_positions& positions,
                          std::span<const vertex_face_pair> queries, outcome* answers) {
    decide_indexed(kernels_->vertex_face, positions, queries, answers, vertex_face_pauses_,
                   counts());
}
void batch_worker::decide(const batch_positions& positions, std::span<const edge_edge_pair> queries,
                          outcome* answers) {
    decide_indexed(kernels_->edge_edge, positions, queries, answers, edge_edge_pauses_, counts());
}
void batch_worker::decide(std::span<const vertex_face<double>> queries, outcome* answers) {
    decide_stored(kernels_->vertex_face, queries, answers, vertex_face_pauses_, counts());
}
void batch_worker::decide(std::span<const edge_edge<double>> queries, outcome* answers) {
    decide_stored(kernels_->edge_edge, queries, answers, edge_edge_pauses_, counts());
}

void batch_worker::decide_by_floats(const batch_positions& positions,
                                    std::span<const vertex_face_pair> queries, double distance,
                                    outcome* answers) {
    detail::decide_by_floats(kernels_->vertex_face, positions, queries, distance, answers,
                             vertex_face_pauses_);
}
void batch_worker::decide_by_floats(const batch_positions& positions,
                                    std::span<const edge_edge_pair> queries, double distance,
                                    outcome* answers) {
    detail::decide_by_floats(kernels_->edge_edge, positions, queries, distance, answers,
                             edge_edge_pauses_);
}
void batch_worker::find_times(const batch_positions& positions,
                              std::span<const vertex_face_pair> queries, first_time* times) const {
    find_indexed_times(kernels_->vertex_face, positions, queries, times);
}
void batch_worker::find_times(const batch_positions& positions,
                              std::span<const edge_edge_pair> queries, first_time* times) const {
    find_indexed_times(kernels_->edge_edge, positions, queries, times);
}
void batch_worker::find_times(std::span<const vertex_face<double>> queries,
                              first_time* times) const {
    find_stored_times(kernels_->vertex_face, queries, times);
}
void batch_worker::find_times(std::span<const edge_edge<double>> queries, first_time* times) const {
    find_stored_times(kernels_->edge_edge, queries, times);
}

}  // namespace detail
}  // namespace ccd
