// The SIMD pipeline: see ccd/batch/batch_kernels.hpp for the rules of this file.
//
// Each stage compacts its undecided queries into the input of the next, so that every stage works
// on full packs. Buffers take about 200 KB, which stay in the second-level cache.
#include "ccd/batch/batch_kernels.hpp"

#include <cstdint>

#include "ccd/batch/filter_stages.hpp"
#include "ccd/batch/pack_subdivision.hpp"
#include "ccd/batch/query_queue.hpp"
#include "ccd/batch/rounded_axes_stage.hpp"
#include "ccd/batch/stored_coordinates.hpp"
#include "ccd/batch/time_stage.hpp"

namespace ccd::detail::ERRBOUND_INSTRUCTION_SET {
namespace {

/// The stages of ccd/exact/stages.cpp in their order, except that all axes come first.
/// test_rounded_axes (rounded positions) and test_stored_coordinates (stored queries) have tested
/// axes before.
template <kind K>
class pipeline {
  public:
    /// Distance 0 means contact. Precondition: for other distances, axes have been tested.
    explicit pipeline(const decisions& decided, axes_left axes, double distance = 0)
        : decided_(decided), axes_(axes), distance_(distance) {}

    /// `read(id, at)` writes the 24 coordinates of a query to at[0], at[stride], ... of
    /// coordinate_columns, ordered by point, start or end of the step, axis. If `pause` is null,
    /// axes have been tested.
    template <class Read>
    void process(const std::uint32_t* ids, std::size_t count, const Read& read,
                 stage_pause* pause) {
        for (std::size_t first = 0; first < count; first += block) {
            const std::size_t size = lesser(count - first, block);
            for (std::size_t i = 0; i < size; ++i) read(ids[first + i], &coordinates_.at[0][i]);
            coordinates_.pad(size);
            test_axes<K>(axes_, coordinates_, ids + first, size, pause, decided_, to_coplanarity_);
            run_stages(block);
        }
    }

    void finish() { run_stages(1); }

  private:
    /// Runs the last stage for which at least `enough` queries wait, until no stage has as many.
    /// Each stage therefore has room for the output of its predecessor.
    void run_stages(std::size_t enough) {
        for (;;) {
            if (subdivision_.size() >= enough)
                subdivision_.run(decided_);
            else if (to_inside_.size >= enough)
                test_inside<K>(to_inside_, distance_, decided_, subdivision_);
            else if (to_coplanarity_.size >= enough)
                test_coplanarity<K>(to_coplanarity_, distance_, decided_, to_inside_);
            else
                return;
        }
    }

    decisions decided_;
    axes_left axes_;
    double distance_;
    coordinate_columns coordinates_;
    difference_queue<K> to_coplanarity_, to_inside_;
    pack_subdivision<K> subdivision_;
};

template <kind K>
auto reader_of(const batch_positions& positions, const typename kind_traits<K>::pair* queries) {
    return [&positions, queries](std::size_t id, double* at) {
        for (const vertex_index v : vertices_of(queries[id]))
            for (const double* frame : {positions.exact.before, positions.exact.after})
                for (std::size_t k = 0; k < 3; ++k, at += coordinate_columns::stride)
                    *at = frame[3 * std::size_t(v) + k];
    };
}
template <kind K>
auto reader_of(const typename kind_traits<K>::template query<double>* queries) {
    static_assert(sizeof(*queries) == 24 * sizeof(double));
    return [numbers = reinterpret_cast<const double*>(queries)](std::size_t id, double* at) {
        for (std::size_t c = 0; c < 24; ++c)
            at[c * coordinate_columns::stride] = numbers[24 * id + c];
    };
}

template <kind K>
void decide_indexed(const batch_positions& positions, const typename kind_traits<K>::pair* queries,
                    std::size_t count, const distance_request& within, outcome* answers,
                    axes_pauses& pauses, stage_report* report) {
    const decisions decided{answers, report};
    pipeline<K> stages(decided, axes_left::all, within.distance);
    const auto read = reader_of<K>(positions, queries);
    for (std::size_t first = 0; first < count; first += rounded_block) {
        const std::size_t size = lesser(count - first, rounded_block);
        std::uint32_t ids[rounded_block];
        if (positions.rounded != nullptr && is_due(pauses.in_floats)) {
            const std::size_t open = test_rounded_axes(positions.rounded, queries, first, size,
                                                       within.gaps, decided, ids);
            update_pause(pauses.in_floats, size - open, size);
            stages.process(ids, open, read, nullptr);
        } else {
            for (std::size_t i = 0; i < size; ++i) {
                ids[i] = static_cast<std::uint32_t>(first + i);
                answers[first + i] = outcome::uncertain;
            }
            stages.process(ids, size, read, within.distance > 0 ? nullptr : &pauses.in_doubles);
        }
    }
    stages.finish();
}

template <kind K>
void decide_stored(const typename kind_traits<K>::template query<double>* queries,
                   std::size_t count, outcome* answers, axes_pauses& pauses, stage_report* report) {
    const decisions decided{answers, report};
    pipeline<K> stages(decided, axes_left::diagonals);
    const auto read = reader_of<K>(queries);
    std::uint32_t ids[stored_block];
    for (std::size_t first = 0; first < count; first += stored_block) {
        const std::size_t size = lesser(count - first, stored_block);
        const std::size_t open = test_stored_coordinates<K>(queries, first, size, decided, ids);
        stages.process(ids, open, read, &pauses.in_doubles);
    }
    stages.finish();
}

template <kind K, class Read>
void find_times(std::size_t count, const Read& read, double* low, double* high) {
    coordinate_columns coordinates;
    for (std::size_t first = 0; first < count; first += block) {
        const std::size_t size = lesser(count - first, block);
        for (std::size_t i = 0; i < size; ++i) read(first + i, &coordinates.at[0][i]);
        coordinates.pad(size);
        time_stage<K>::run(coordinates, size, low + first, high + first);
    }
}
template <kind K>
void find_indexed_times(const batch_positions& positions,
                        const typename kind_traits<K>::pair* queries, std::size_t count,
                        double* low, double* high) {
    find_times<K>(count, reader_of<K>(positions, queries), low, high);
}
template <kind K>
void find_stored_times(const typename kind_traits<K>::template query<double>* queries,
                       std::size_t count, double* low, double* high) {
    find_times<K>(count, reader_of<K>(queries), low, high);
}

template <kind K>
constexpr kernels_of_kind<K> kernels_for_kind{decide_indexed<K>, decide_stored<K>,
                                              find_indexed_times<K>, find_stored_times<K>};

}  // namespace

constinit const batch_kernels kernels = {kernels_for_kind<kind::vertex_face>,
                                         kernels_for_kind<kind::edge_edge>};

}  // namespace ccd::detail::ERRBOUND_INSTRUCTION_SET
