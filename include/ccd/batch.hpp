// Many queries at once: the answers of `exact`, over SIMD packs and threads.
//
// The same answers as one by one, on every instruction set and with any number of threads. The
// instruction set is chosen at run time; no flag is needed when compiling.
#pragma once

#include <ccd/explain.hpp>
#include <ccd/kind.hpp>
#include <ccd/mesh.hpp>
#include <ccd/query.hpp>
#include <ccd/stop.hpp>
#include <ccd/verdict.hpp>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <ranges>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace ccd {

/// A matrix with the members of Eigen's dense matrices.
template <class M>
concept dense_matrix = requires(const M& m) {
    *m.data();
    { m.rows() } -> std::convertible_to<std::size_t>;
    { m.cols() } -> std::convertible_to<std::size_t>;
    { m.outerStride() } -> std::convertible_to<std::size_t>;
    { m.innerStride() } -> std::convertible_to<std::size_t>;
    { M::IsRowMajor } -> std::convertible_to<bool>;
};

/// Positions of the same vertices at t = 0 and t = 1: `vertices` rows of x y z each, contiguous.
/// Not owned.
struct vertex_rows {
    static_assert(sizeof(point<double>) == 3 * sizeof(double));
    const double* before = nullptr;
    const double* after = nullptr;
    std::size_t vertices = 0;

    constexpr vertex_rows() = default;
    constexpr vertex_rows(const double* at_start, const double* at_end, std::size_t count)
        : before(at_start), after(at_end), vertices(count) {}
    /// Throws std::invalid_argument if the two lengths differ.
    vertex_rows(std::span<const point<double>> at_start, std::span<const point<double>> at_end)
        : before(reinterpret_cast<const double*>(at_start.data())),
          after(reinterpret_cast<const double*>(at_end.data())),
          vertices(of_both(at_start.size(), at_end.size())) {}
    /// Of two frames of one mesh.
    vertex_rows(const mesh& at_start, const mesh& at_end)
        : vertex_rows(std::span<const point<double>>(at_start.vertices),
                      std::span<const point<double>>(at_end.vertices)) {}
    /// Of Eigen matrices of doubles, n by 3 and row-major, which is not Eigen's default: declare
    /// them Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>, or copy others into such.
    /// Throws std::invalid_argument if they have not three columns, gaps between rows, or different
    /// numbers of rows.
    template <dense_matrix M>
    vertex_rows(const M& at_start, const M& at_end)
        : before(data_of(at_start)),
          after(data_of(at_end)),
          vertices(of_both(rows_of(at_start), rows_of(at_end))) {}

    moving_point<double> operator[](vertex_index vertex) const {
        const auto at = [vertex](const double* frame) {
            const double* row = frame + 3 * std::size_t(vertex);
            return point<double>{row[0], row[1], row[2]};
        };
        return {at(before), at(after)};
    }

  private:
    static std::size_t of_both(std::size_t at_start, std::size_t at_end) {
        if (at_start != at_end)
            throw std::invalid_argument("ccd::vertex_rows: " + std::to_string(at_start) +
                                        " vertices at t = 0, " + std::to_string(at_end) +
                                        " at t = 1");
        return at_start;
    }
    template <dense_matrix M>
    static const double* data_of(const M& m) {
        constexpr bool holds_doubles = std::is_convertible_v<decltype(m.data()), const double*>;
        static_assert(
            holds_doubles,
            "ccd::vertex_rows takes matrices of double: copy others, by m.cast<double>(), "
            "into Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>");
        if constexpr (holds_doubles)
            return m.data();
        else
            return nullptr;
    }
    template <dense_matrix M>
    static std::size_t rows_of(const M& m) {
        static_assert(M::IsRowMajor,
                      "ccd::vertex_rows takes row-major matrices: the coordinates of a vertex must "
                      "lie side by side");
        if (m.cols() != 3 || m.outerStride() != 3 || m.innerStride() != 1)
            throw std::invalid_argument(
                "ccd::vertex_rows: expected matrices of three columns without gaps");
        return static_cast<std::size_t>(m.rows());
    }
};

/// The query that the indices stand for.
inline vertex_face<double> query_of(const vertex_rows& rows, const vertex_face_pair& q) {
    return {rows[q.v], rows[q.f0], rows[q.f1], rows[q.f2]};
}
inline edge_edge<double> query_of(const vertex_rows& rows, const edge_edge_pair& q) {
    return {rows[q.a0], rows[q.a1], rows[q.b0], rows[q.b1]};
}
inline vertex_edge<double> query_of(const vertex_rows& rows, const vertex_edge_pair& q) {
    return {rows[q.v], rows[q.e0], rows[q.e1]};
}
inline vertex_vertex<double> query_of(const vertex_rows& rows, const vertex_vertex_pair& q) {
    return {rows[q.v], rows[q.w]};
}

/// What the kernels are compiled for.
enum class instruction_set : std::uint8_t {
    baseline,  ///< what every machine of the architecture has (SSE2 on x86-64)
    avx2,      ///< with FMA
    avx512,
};
/// Those that this build holds and this machine runs, weakest first.
std::span<const instruction_set> instruction_sets();
std::string_view name(instruction_set set);
std::optional<instruction_set> find_instruction_set(std::string_view name);

struct batch_options {
    int threads = 0;                          ///< at most; 0: one per core
    std::optional<instruction_set> set = {};  ///< by default the strongest
    bool explain = false;                     ///< fill the stages' report: costs a few per cent
    stop_query stop = {};                     ///< ends the call by throwing ccd::stopped
};

struct batch_result {
    std::vector<outcome> answers;
    stage_report stages;  ///< of vertex/face and edge/edge queries, if asked for
};

struct pair_distances;  // in first_times.hpp

namespace detail {

template <class T>
concept has_kind = requires {
    kind_constant<T>::value;
};
template <class T>
concept is_pair =
    has_kind<T> && std::same_as<T, typename kind_traits<kind_constant<T>::value>::pair>;
template <class T>
concept is_query = has_kind<T> &&
    std::same_as<T, typename kind_traits<kind_constant<T>::value>::template query<double>>;
template <class R>
concept contiguous_items = std::ranges::contiguous_range<R> && std::ranges::sized_range<R>;
template <class R>
using items_of = std::span<const std::ranges::range_value_t<R>>;

/// What is asked of each query, and by whom, for messages.
struct question {
    const char* caller = "ccd::decide_batch";
    bool at_start = false;                   ///< contact at t = 0
    const pair_distances* within = nullptr;  ///< that a pair comes within these
};
constexpr question touches_at_start_asked{"ccd::touches_at_start_batch", true, nullptr};

template <class Pair>
stage_report decide_pairs(const vertex_rows& positions, std::span<const Pair> pairs,
                          std::span<outcome> answers, const batch_options& options,
                          const question& asked);
template <class Query>
stage_report decide_queries(std::span<const Query> queries, std::span<outcome> answers,
                            const batch_options& options, const question& asked);

}  // namespace detail

/// A span, vector or other contiguous range of pairs of one kind.
template <class R>
concept pair_range = detail::contiguous_items<R> && detail::is_pair<std::ranges::range_value_t<R>>;
/// The same of queries in doubles.
template <class R>
concept query_range =
    detail::contiguous_items<R> && detail::is_query<std::ranges::range_value_t<R>>;

/// Decides queries by `exact`, of any kind: by index, or stored. Coordinates that are not finite
/// give `uncertain`. Throws std::invalid_argument if an index is out of range, positions are null
/// or the instruction set is not one of instruction_sets().
///
/// Cost: see `./run bench`; the worst known of a query is decide_exact's. Vertex/edge and
/// vertex/vertex queries are decided one by one. Memory:
/// some 300 KB of stack a thread, and 32 bytes a vertex if there are queries for half the vertices.
template <pair_range Pairs>
batch_result decide_batch(const vertex_rows& positions, const Pairs& pairs,
                          const batch_options& options = {});
template <query_range Queries>
batch_result decide_batch(const Queries& queries, const batch_options& options = {});

/// The same into memory of one's own: answers[i] is that of query i. Returns the stages' report.
/// Throws std::invalid_argument also if the two lengths differ. After a throw, answers may be
/// anything.
template <pair_range Pairs>
stage_report decide_batch(const vertex_rows& positions, const Pairs& pairs,
                          std::span<outcome> answers, const batch_options& options = {}) {
    return detail::decide_pairs(positions, detail::items_of<Pairs>(pairs), answers, options,
                                detail::question{});
}
template <query_range Queries>
stage_report decide_batch(const Queries& queries, std::span<outcome> answers,
                          const batch_options& options = {}) {
    return detail::decide_queries(detail::items_of<Queries>(queries), answers, options,
                                  detail::question{});
}

/// Whether the features of each query touch already at t = 0: as decide_batch, but as
/// touches_at_start of ccd/exact.hpp answers. Only positions at t = 0 are looked at; those at t = 1
/// may be null.
template <pair_range Pairs>
batch_result touches_at_start_batch(const vertex_rows& positions, const Pairs& pairs,
                                    const batch_options& options = {}) {
    batch_result result{std::vector<outcome>(std::ranges::size(pairs)), {}};
    result.stages =
        detail::decide_pairs(positions, detail::items_of<Pairs>(pairs), std::span(result.answers),
                             options, detail::touches_at_start_asked);
    return result;
}
template <query_range Queries>
batch_result touches_at_start_batch(const Queries& queries, const batch_options& options = {}) {
    batch_result result{std::vector<outcome>(std::ranges::size(queries)), {}};
    result.stages =
        detail::decide_queries(detail::items_of<Queries>(queries), std::span(result.answers),
                               options, detail::touches_at_start_asked);
    return result;
}

template <pair_range Pairs>
batch_result decide_batch(const vertex_rows& positions, const Pairs& pairs,
                          const batch_options& options) {
    batch_result result{std::vector<outcome>(std::ranges::size(pairs)), {}};
    result.stages = decide_batch(positions, pairs, std::span(result.answers), options);
    return result;
}
template <query_range Queries>
batch_result decide_batch(const Queries& queries, const batch_options& options) {
    batch_result result{std::vector<outcome>(std::ranges::size(queries)), {}};
    result.stages = decide_batch(queries, std::span(result.answers), options);
    return result;
}

}  // namespace ccd
