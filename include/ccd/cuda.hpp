// Collision detection on CUDA devices: positions, candidates and answers in device memory.
//
//     const auto found = ccd::cuda::step(before, after);                    // host to host
//     ccd::cuda::decide_batch(positions, candidates, answers, scratch);     // device memory
//
// The device runs the host's functions, with the same answers. Needs a library built with nvcc
// (target errbound::ccd_cuda), but no header of CUDA. Unless stated otherwise, functions neither
// allocate, nor wait, nor change the current device, and pointers point to the current device's
// memory. Several threads may call at once, with different streams and scratch memory.
#pragma once

#include <array>
#include <ccd/batch.hpp>
#include <ccd/contact.hpp>
#include <ccd/kind.hpp>
#include <ccd/mesh.hpp>
#include <ccd/method.hpp>
#include <ccd/step.hpp>
#include <ccd/verdict.hpp>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

struct CUstream_st;  // CUDA's; cudaStream_t points to one

namespace ccd::cuda {

/// A cudaStream_t: a queue of work that a device runs in order. Null is the default stream.
using stream = CUstream_st*;

/// An error message of CUDA or of this library; empty if there is no error.
struct [[nodiscard]] status {
    std::string error;
    explicit operator bool() const { return error.empty(); }  ///< true: no error
};

/// Returns an error if there is no device.
status device_status();

/// The number type that a method tries first. `float32` keeps the method's promise for any input:
/// coordinates are taken relative to one of the query's points, and their bounds include the error
/// of the conversion. Doubles, on the device, decide the queries that floats do not. (Positions in
/// floats are not converted. The method `float` promises nothing, and stays in floats.)
enum class precision : std::uint8_t { float64, float32 };

/// The methods that run on the device: float, safe, tight, safeccd, safeccd-tight and exact.
std::span<const method> device_methods();

/// One frame's coordinates: those of vertex v are x[v·stride], y[v·stride] and z[v·stride].
template <class Real>
struct coordinates {
    const Real *x = nullptr, *y = nullptr, *z = nullptr;
    std::size_t stride = 1;

    /// Rows x y z, contiguous.
    static constexpr coordinates rows(const Real* xyz) { return {xyz, xyz + 1, xyz + 2, 3}; }
};

/// Positions of the same vertices at t = 0 and t = 1, in doubles or in floats.
struct positions {
    struct frame {
        const void* axis[3] = {};
        std::size_t stride = 1;  ///< in numbers
    };
    frame before, after;
    bool in_floats = false;
    std::size_t vertices = 0;

    constexpr positions() = default;
    template <class Real>
    constexpr positions(const coordinates<Real>& at_start, const coordinates<Real>& at_end,
                        std::size_t count)
        : before{{at_start.x, at_start.y, at_start.z}, at_start.stride},
          after{{at_end.x, at_end.y, at_end.z}, at_end.stride},
          in_floats(sizeof(Real) == sizeof(float)),
          vertices(count) {}
};

template <class Pair>
concept device_pair = std::same_as<Pair, vertex_face_pair> || std::same_as<Pair, edge_edge_pair>;

/// Candidates, the pairs to decide: rows or columns of vertex indices, or pairs of elements.
/// Precondition: indices are in range, which the device does not check.
template <class Pair>
struct candidates {
    /// The second element of a pair: a face or an edge.
    using element = std::array<vertex_index, kind_traits<kind_of<Pair>>::second_vertices>;

    const Pair* of_rows = nullptr;
    const vertex_index* columns[4] =
        {};  ///< vertex indices; with `elements` two columns of indices
    const element* elements = nullptr;
    std::size_t count = 0;
    const vertex_index* numbers = nullptr;  ///< the indices of the selected ones; null: all

    /// Rows of vertex indices. Precondition: aligned to 16 bytes, as memory from cudaMalloc is.
    static constexpr candidates rows(const Pair* rows, std::size_t count) {
        return {rows, {}, nullptr, count};
    }
    /// Four columns: v f0 f1 f2, or a0 a1 b0 b1.
    static constexpr candidates of_columns(const vertex_index* a, const vertex_index* b,
                                           const vertex_index* c, const vertex_index* d,
                                           std::size_t count) {
        return {nullptr, {a, b, c, d}, nullptr, count};
    }
    /// Pairs of a vertex and an index into `elements` (faces), or of two such indices (edges).
    static constexpr candidates pairs(const vertex_index* first, const vertex_index* second,
                                      const element* elements, std::size_t count) {
        return {nullptr, {first, second, nullptr, nullptr}, elements, count};
    }
    /// Only the candidates with these indices, in this order, as listed by select_colliding().
    constexpr candidates listed(const vertex_index* those, std::size_t how_many) const {
        candidates some = *this;
        some.numbers = those;
        some.count = how_many;
        return some;
    }
};

/// Device memory that a call may write to.
struct scratch {
    void* data = nullptr;
    std::size_t bytes = 0;
};
/// Returns the bytes that `decide_batch`, `select_colliding` and `find_times` need: 12.1 for each
/// candidate, 32 for each vertex, and 4 MiB. Their address must be a multiple of 256, as those of
/// cudaMalloc are.
std::size_t scratch_bytes(std::size_t vertices, std::size_t candidates);

struct batch_options {
    ccd::method method = method::exact;
    ccd::cuda::precision precision = precision::float64;
    cuda::stream stream = nullptr;
};

/// Decides candidate i into answers[i], as decide() of ccd/method.hpp. Only queues work on the
/// stream. At most 2^32 − 2 candidates.
///
/// After `exact`, `uncertain` marks candidates with coordinates that are not finite, and the few
/// that integers of one and two words (of 64 bits) do not decide; finish() decides the latter. Do
/// not change the scratch memory before finish().
template <device_pair Pair>
status decide_batch(const positions& positions, const candidates<Pair>& candidates,
                    outcome* answers, scratch memory, const batch_options& options = {});

/// The number of candidates that entered each stage of `exact`, in one call of decide_batch.
struct stage_counts {
    std::uint32_t axes = 0, coplanarity = 0, inside = 0, subdivision = 0;
    std::uint32_t integers_one_word = 0, integers_two_words = 0;
    std::uint32_t left_open = 0;  ///< undecided until finish()
};
/// The result of finish().
struct [[nodiscard]] finished : status {
    stage_counts stages;
};

/// Decides the undecided candidates of decide_batch on all threads of the host, and writes their
/// answers. Waits for the stream. Throws only std::bad_alloc.
template <device_pair Pair>
finished finish(const positions& positions, const candidates<Pair>& candidates, outcome* answers,
                scratch memory, const batch_options& options);

/// Writes the indices of the answers other than `separate`, ascending, to the `room` places of
/// `found`, and their number to *count; if it exceeds `room`, call again with more room. Only
/// queues work. Overwrites the scratch memory of decide_batch, so call finish() first.
status select_colliding(const outcome* answers, std::size_t answer_count, vertex_index* found,
                        std::size_t room, vertex_index* count, scratch memory,
                        stream stream = nullptr);

struct time_options {
    double t_max = 1;  ///< the last time
    cuda::stream stream = nullptr;
};

/// Writes the first time of candidate i to times[i], as time_of_impact() of ccd/contact.hpp. Only
/// queues work on the stream. Pass only colliding candidates: candidates.listed(...) after
/// select_colliding(). For others, a time costs more than a decision. Scratch memory: as for
/// decide_batch.
///
/// finish_times() finds the times for which integers of two words do not suffice: roots that nearly
/// coincide or are below 2^-70, or coordinates that differ too much. Do not change the scratch
/// memory before finish_times().
template <device_pair Pair>
status find_times(const positions& positions, const candidates<Pair>& candidates, first_time* times,
                  scratch memory, const time_options& options = {});

/// The number of candidates that entered each stage of find_times. In `roots`, floating point finds
/// the interval of the contact and integers its root. In `integers`, integers find both.
struct time_stage_counts {
    std::uint32_t roots_one_word = 0, integers_one_word = 0;
    std::uint32_t roots_two_words = 0, integers_two_words = 0;
    std::uint32_t left_open = 0;  ///< undecided until finish_times()
};
/// The result of finish_times().
struct [[nodiscard]] finished_times : status {
    time_stage_counts stages;
};

/// Finds the undecided times of find_times, and otherwise works as finish().
template <device_pair Pair>
finished_times finish_times(const positions& positions, const candidates<Pair>& candidates,
                            first_time* times, scratch memory, const time_options& options = {});

namespace detail {
template <kind K>
using span_of_kind = std::span<const pair_of_kind<K>>;
template <kind K>
using times_span_of_kind = std::span<const first_time>;
}  // namespace detail
/// Lists of pairs in device memory, and their times.
using pair_spans = by_kind<detail::span_of_kind>;
using time_spans = by_kind<detail::times_span_of_kind>;

/// The members from initial_contact on are as in ccd::step_options.
struct mesh_step_options {
    ccd::method method = method::exact;
    ccd::cuda::precision precision = precision::float64;
    cuda::stream stream = nullptr;
    bool initial_contact = false;
    bool first_contact = false;
    bool times = false;
    double t_max = 1;
};

/// Steps of one mesh on the device. Keeps its faces, edges and memory from step to step.
class mesh_steps {
  public:
    /// Vertex/face and edge/edge pairs, sorted by their vertices, or an error. Unlike in
    /// ccd::pair_lists, vertices of faces keep the mesh's order.
    struct [[nodiscard]] result : status {
        pair_spans pairs;
        pair_counts candidates;
        std::size_t finished_on_host = 0;  ///< candidates and times that the device left undecided
        pair_spans touching_at_start;      ///< decided by `exact` for every method
        time_spans times;                  ///< of `pairs`
        /// The earliest time of pairs that do not touch at the start. Unless `times` is set,
        /// threads skip pairs whose times are later than the least time found so far.
        first_time first_contact;
    };

    /// Takes faces in host memory. Throws std::invalid_argument if an index is not below
    /// `vertices`. The first run() copies them to the device, on its stream. Vertices on no edge
    /// form no vertex/vertex pairs here.
    mesh_steps(std::span<const face> faces, std::size_t vertices);
    ~mesh_steps();
    mesh_steps(mesh_steps&&) noexcept;
    mesh_steps& operator=(mesh_steps&&) noexcept;

    /// Returns the pairs that options.method does not certify as separate in [0, t_max], as
    /// ccd::step(). The result belongs to this object and is valid until the next call. Waits for
    /// the stream, and allocates if its memory does not suffice. All calls must be on one device.
    /// Errors: a coordinate that is not finite; a method that is not in device_methods();
    /// first_contact, times or t_max < 1 with a method other than `exact`.
    result run(const positions& positions, const mesh_step_options& options = {});

  private:
    struct state;
    std::unique_ptr<state> state_;
};

/// A step's result, or an error.
struct [[nodiscard]] step_result : status, ccd::step_result {};

/// ccd::step() on the device: copies both frames there and the pairs back. Throws as ccd::step().
/// Devices have only vertex/face and edge/edge pairs, without distances and filters. It is
/// therefore an error if mesh.edges is not empty, or if more than one vertex is on no face's edge.
/// Uses the options that mesh_step_options has; narrow_phase_seconds includes the search and the
/// times.
step_result step(const mesh& before, const mesh& after, const step_options& options = {},
                 precision precision = precision::float64);

/// Decides queries in host memory on the device, by any of device_methods(), as ccd::decide_batch.
/// Throws std::invalid_argument if the two lengths differ.
status decide(std::span<const vertex_face<double>> queries, std::span<outcome> answers,
              const batch_options& options);
status decide(std::span<const edge_edge<double>> queries, std::span<outcome> answers,
              const batch_options& options);

/// Finds their first times, as ccd::first_times. Throws as decide.
status first_times(std::span<const vertex_face<double>> queries, std::span<first_time> times,
                   const time_options& options = {});
status first_times(std::span<const edge_edge<double>> queries, std::span<first_time> times,
                   const time_options& options = {});

}  // namespace ccd::cuda
