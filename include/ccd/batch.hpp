// Many queries at once: the answers of `exact`, over SIMD packs and threads.
//
// The same answers as one by one, on every instruction set and with any number of threads. The
// instruction set is chosen at run time; no flag is needed when compiling.
#pragma once

#include <ccd/explain.hpp>
#include <ccd/kind.hpp>
#include <ccd/mesh.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>
#include <cstddef>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace ccd {

/// Positions of the same vertices at t = 0 and t = 1: `vertices` rows of x y z each, contiguous.
/// Not owned.
///
/// Of Eigen matrices, pass data() of a row-major one, which is not Eigen's default: declare it
/// Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>. (errbound/eigen.hpp is about
/// scalars.)
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
          vertices(at_start.size()) {
        if (at_start.size() != at_end.size())
            throw std::invalid_argument("ccd::vertex_rows: " + std::to_string(at_start.size()) +
                                        " vertices at t = 0, " + std::to_string(at_end.size()) +
                                        " at t = 1");
    }
    /// Of two frames of one mesh.
    vertex_rows(const mesh& at_start, const mesh& at_end)
        : vertex_rows(std::span<const point<double>>(at_start.vertices),
                      std::span<const point<double>>(at_end.vertices)) {}

    moving_point<double> operator[](index vertex) const {
        const auto at = [vertex](const double* frame) {
            const double* row = frame + 3 * std::size_t(vertex);
            return point<double>{row[0], row[1], row[2]};
        };
        return {at(before), at(after)};
    }
};

/// The query that the indices stand for.
inline vertex_face<double> query_of(const vertex_rows& rows, const vertex_face_pair& q) {
    return {rows[q.v], rows[q.f0], rows[q.f1], rows[q.f2]};
}
inline edge_edge<double> query_of(const vertex_rows& rows, const edge_edge_pair& q) {
    return {rows[q.a0], rows[q.a1], rows[q.b0], rows[q.b1]};
}

/// What the kernels are compiled for.
enum class instruction_set : std::uint8_t {
    baseline,  ///< what every machine of the architecture has (SSE2 on x86-64)
    avx2,
    avx512,
};
/// Those that this build holds and this machine runs, weakest first.
std::span<const instruction_set> instruction_sets();
std::string_view name(instruction_set set);
std::optional<instruction_set> find_instruction_set(std::string_view name);

struct batch_options {
    int threads = 1;                          ///< at most; 0: one per core
    std::optional<instruction_set> set = {};  ///< by default the strongest
    stage_report* report = nullptr;           ///< added to, if given: costs a few per cent
};

/// Decides queries[i] by `exact` into answers[i], contiguous. Coordinates that are not finite give
/// `uncertain`. Throws std::invalid_argument if the two lengths differ, an index is out of range or
/// the instruction set is not of instruction_sets(). Cost: see `./run bench`; memory: some
/// 300 KB of stack a thread, and 32 bytes a vertex if there are queries for half the vertices.
void decide_batch(const vertex_rows& positions, std::span<const vertex_face_pair> queries,
                  std::span<outcome> answers, const batch_options& options = {});
void decide_batch(const vertex_rows& positions, std::span<const edge_edge_pair> queries,
                  std::span<outcome> answers, const batch_options& options = {});
void decide_batch(std::span<const vertex_face<double>> queries, std::span<outcome> answers,
                  const batch_options& options = {});
void decide_batch(std::span<const edge_edge<double>> queries, std::span<outcome> answers,
                  const batch_options& options = {});

}  // namespace ccd
