// Collision detection on CUDA devices: positions, candidates and answers in device memory.
//
// The same functions as on the host, compiled for the device, so the same answers. Present where
// the library was built with nvcc (target errbound::ccd_cuda); this header needs none of CUDA's.
// Nothing here allocates, waits or changes the current device unless it says so. Pointers are to
// memory of the current device unless said otherwise. Calls are safe from several threads on
// different streams and scratch memory.
#pragma once

#include <array>
#include <ccd/batch.hpp>
#include <ccd/contact.hpp>
#include <ccd/kind.hpp>
#include <ccd/mesh.hpp>
#include <ccd/method.hpp>
#include <ccd/step.hpp>
#include <ccd/verdict.hpp>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

struct CUstream_st;  // CUDA's; cudaStream_t points to one

namespace ccd::cuda {

/// A cudaStream_t; null is the default stream.
using stream = CUstream_st*;

/// What went wrong, in CUDA's words or this library's; empty if nothing did.
struct [[nodiscard]] status {
    std::string error;
    explicit operator bool() const { return error.empty(); }  ///< true: no error
};

/// Whether there is a device to run on; else why not.
status device_status();

/// What a method computes in first. `float32` keeps every promise for any input: coordinates are
/// taken relative to one of the query's points, with the error of that as the input's bound, and
/// what floats cannot decide is decided in doubles, on the device. (Positions in floats are taken
/// as they are. `float` promises nothing, and stays in floats.)
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

/// Candidates: rows or columns of vertex indices, or pairs of elements. Pair must be in range:
/// the device does not look.
template <class Pair>
struct candidates {
    /// The second element of a pair: a face or an edge.
    using element = std::array<vertex_index, kind_traits<kind_of<Pair>>::second_vertices>;

    const Pair* of_rows = nullptr;
    const vertex_index* columns[4] = {};  ///< of vertex indices, or the first two of elements
    const element* elements = nullptr;
    std::size_t count = 0;
    const vertex_index* numbers = nullptr;  ///< of those that are meant; if null, all

    /// Rows of vertex indices; their memory must be aligned to 16 bytes, as CUDA's is.
    static constexpr candidates rows(const Pair* rows, std::size_t count) {
        return {rows, {}, nullptr, count};
    }
    /// Four columns: v f0 f1 f2, or a0 a1 b0 b1.
    static constexpr candidates of_columns(const vertex_index* a, const vertex_index* b,
                                           const vertex_index* c, const vertex_index* d,
                                           std::size_t count) {
        return {nullptr, {a, b, c, d}, nullptr, count};
    }
    /// Pairs of a vertex and a number of `elements` (faces), or of two numbers of them (edges).
    static constexpr candidates pairs(const vertex_index* first, const vertex_index* second,
                                      const element* elements, std::size_t count) {
        return {nullptr, {first, second, nullptr, nullptr}, elements, count};
    }
    /// Those with these numbers alone, which become the first, the second and so on: as
    /// select_colliding() lists them.
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
/// How much of it `decide_batch`, `select_colliding` and `find_times` need: 12.1 bytes a candidate,
/// 32 a vertex and 4 MiB. Its address must be a multiple of 256, as CUDA's are.
std::size_t scratch_bytes(std::size_t vertices, std::size_t candidates);

struct batch_options {
    ccd::method method = method::exact;
    ccd::cuda::precision precision = precision::float64;
    cuda::stream stream = nullptr;
};

/// Decides candidate i into answers[i], as decide() of ccd/method.hpp does in doubles. Only queues
/// work on the stream. At most 2^32 − 2 candidates.
///
/// After `exact`, `uncertain` stands for the few candidates that integers of fixed width cannot
/// decide (ccd/exact.hpp) and those with coordinates that are not finite; finish() decides the
/// former. Until then the scratch memory must stay as it is.
status decide_batch(const positions& positions, const candidates<vertex_face_pair>& candidates,
                    outcome* answers, scratch memory, const batch_options& options = {});
status decide_batch(const positions& positions, const candidates<edge_edge_pair>& candidates,
                    outcome* answers, scratch memory, const batch_options& options = {});

/// What the stages of `exact` were asked, in one call of decide_batch.
struct stage_counts {
    std::uint32_t axes = 0, coplanarity = 0, inside = 0, subdivision = 0;
    std::uint32_t integers_one_word = 0, integers_two_words = 0;
    std::uint32_t left_open = 0;  ///< decided by finish()
};
/// What finish() answers.
struct [[nodiscard]] finished : status {
    stage_counts stages;
};

/// Decides what decide_batch of `exact` left open, on the host by all its threads, and writes the
/// answers. Waits for the stream. Throws only std::bad_alloc.
finished finish(const positions& positions, const candidates<vertex_face_pair>& candidates,
                outcome* answers, scratch memory, const batch_options& options);
finished finish(const positions& positions, const candidates<edge_edge_pair>& candidates,
                outcome* answers, scratch memory, const batch_options& options);

/// Writes the numbers of the answers other than `separate`, ascending, to found[0], ...,
/// found[room − 1] and how many there are to *count, which may exceed `room`: then call again with
/// more. Only queues work. Scratch memory as above: finish() first, since this overwrites what
/// decide_batch left there.
status select_colliding(const outcome* answers, std::size_t answer_count, vertex_index* found,
                        std::size_t room, vertex_index* count, scratch memory,
                        stream stream = nullptr);

struct time_options {
    double t_max = 1;  ///< times in [0, t_max] are asked for
    cuda::stream stream = nullptr;
};

/// The first time of candidate i into times[i], as time_of_impact() of ccd/contact.hpp tells it.
/// Meant for those that collide, candidates.listed(...) as select_colliding() lists them; others
/// cost more than their decision. Only queues work on the stream. Scratch memory as above, for so
/// many candidates.
///
/// What integers of fixed width leave open (roots that nearly coincide, times below 2^-70,
/// coordinates that differ too much) has no time before finish_times() is called. Until then the
/// scratch memory must stay as it is.
status find_times(const positions& positions, const candidates<vertex_face_pair>& candidates,
                  first_time* times, scratch memory, const time_options& options = {});
status find_times(const positions& positions, const candidates<edge_edge_pair>& candidates,
                  first_time* times, scratch memory, const time_options& options = {});

/// What the stages of find_times were asked: to place roots that floating point had found, or to
/// find the time alone.
struct time_stage_counts {
    std::uint32_t roots_one_word = 0, integers_one_word = 0;
    std::uint32_t roots_two_words = 0, integers_two_words = 0;
    std::uint32_t left_open = 0;  ///< answered by finish_times()
};
/// What finish_times() answers.
struct [[nodiscard]] finished_times : status {
    time_stage_counts stages;
};

/// Finds the times that find_times left open, on the host by all its threads, and writes them.
/// Waits for the stream. Throws only std::bad_alloc.
finished_times finish_times(const positions& positions,
                            const candidates<vertex_face_pair>& candidates, first_time* times,
                            scratch memory, const time_options& options = {});
finished_times finish_times(const positions& positions,
                            const candidates<edge_edge_pair>& candidates, first_time* times,
                            scratch memory, const time_options& options = {});

namespace detail {
template <kind K>
using span_of_kind = std::span<const pair_of_kind<K>>;
template <kind K>
using times_span_of_kind = std::span<const first_time>;
}  // namespace detail
/// Lists of pairs in device memory, as ccd::pair_lists on the host, and their times.
using pair_spans = by_kind<detail::span_of_kind>;
using time_spans = by_kind<detail::times_span_of_kind>;

/// What a step is asked, and how: from initial_contact on as ccd::step_options.
struct mesh_step_options {
    ccd::method method = method::exact;
    ccd::cuda::precision precision = precision::float64;
    cuda::stream stream = nullptr;
    bool initial_contact = false;
    bool first_contact = false;
    bool times = false;
    double t_max = 1;
};

/// Steps of one mesh on the device: keeps its faces, edges and memory from step to step.
class mesh_steps {
  public:
    /// Pairs in no particular order but always the same one, or what went wrong. Of points and of
    /// edges that bound no face the device knows nothing.
    struct [[nodiscard]] result : status {
        pair_spans pairs;
        pair_counts candidates;
        std::size_t finished_on_host = 0;  ///< candidates and times that `exact` left open
        pair_spans touching_at_start;      ///< by `exact` whatever the method; if asked for
        time_spans times;                  ///< of `pairs`, if asked for
        /// The earliest of those not touching at the start, if asked for. For that alone threads
        /// share the least time yet found, and do not look for later ones.
        first_time first_contact;
    };

    /// Faces in host memory, with indices below `vertices` (else std::invalid_argument). Allocates
    /// and copies on first use, on the stream given then.
    mesh_steps(std::span<const face> faces, std::size_t vertices);
    ~mesh_steps();
    mesh_steps(mesh_steps&&) noexcept;
    mesh_steps& operator=(mesh_steps&&) noexcept;

    /// The pairs that options.method cannot certify as separate, as ccd::step() finds them, with a
    /// contact in [0, t_max]. The result is this object's, complete on return, and lasts until the
    /// next call. A coordinate that is not finite is an error, and so is asking a method other than
    /// `exact` for times. Waits for the stream some times; allocates where its memory does not
    /// suffice. All calls must be on one device.
    result run(const positions& positions, const mesh_step_options& options = {});

  private:
    struct state;
    std::unique_ptr<state> state_;
};

/// A step's result, or what went wrong.
struct [[nodiscard]] step_result : status, ccd::step_result {};

/// ccd::step() on the device, which throws what that throws: copies both frames there and the pairs
/// back. The mesh must have no edges of its own and at most one vertex on no face, whose kinds of
/// pairs the device does not look for: anything else is an error, and so are distances, and a
/// filter. Of the options, those of mesh_step_options count; of the seconds, those of both phases
/// and of the times are taken together as the narrow's.
step_result step(const mesh& before, const mesh& after, const step_options& options = {},
                 precision precision = precision::float64);

/// ccd::decide_batch, from and to host memory, by any of device_methods(). Throws
/// std::invalid_argument if the two lengths differ.
status decide(std::span<const vertex_face<double>> queries, std::span<outcome> answers,
              const batch_options& options);
status decide(std::span<const edge_edge<double>> queries, std::span<outcome> answers,
              const batch_options& options);

/// ccd::first_times, from and to host memory: decided by `exact`, and those that collide asked for
/// their times. Throws std::invalid_argument if the two lengths differ.
status first_times(std::span<const vertex_face<double>> queries, std::span<first_time> times,
                   const time_options& options = {});
status first_times(std::span<const edge_edge<double>> queries, std::span<first_time> times,
                   const time_options& options = {});

}  // namespace ccd::cuda
