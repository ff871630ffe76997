// Meshes: one frame of a mesh, and the positions of its vertices at both ends of a step.
#pragma once

#include <array>
#include <ccd/kind.hpp>
#include <ccd/query.hpp>
#include <concepts>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace ccd {

using face = std::array<vertex_index, 3>;  ///< vertex indices, in any order
using edge = std::array<vertex_index, 2>;  ///< vertex indices; ascending if the library made it

/// One frame: triangles, edges that bound no triangle (rods, hair, springs), and points.
///
/// `edges` may repeat edges, and contain edges of faces or from a vertex to itself: these add no
/// edge. A vertex that is not an end of an edge between two different vertices is a point. So are
/// unused vertices: see pair_filter::skip_unused.
struct mesh {
    std::vector<point<double>> vertices;
    std::vector<face> faces;
    std::vector<edge> edges = {};
};

/// Returns the unique edges of `faces` and `edges`, each ascending, sorted, without edges from a
/// vertex to itself. Cost: O(faces + edges) unless very many of them share a vertex. Memory: 36
/// bytes a face, 12 an edge and 8 a vertex.
std::vector<edge> unique_edges(std::span<const face> faces, std::span<const edge> edges = {});

/// Returns the faces in their order, without those that have the same three vertices as an earlier
/// face. Cost and memory: as unique_edges.
std::vector<face> unique_faces(std::span<const face> faces);

/// Returns the vertices of no face and no edge, ascending; an edge {v, v} counts as a use of v.
/// Precondition: indices are in range.
std::vector<vertex_index> unused_vertices(std::span<const face> faces, std::span<const edge> edges,
                                          std::size_t vertices);

/// Returns for each vertex the index of its connected part (body). Parts are numbered in the order
/// of their first vertices. Precondition: indices are in range.
std::vector<int> connected_parts(std::span<const face> faces, std::span<const edge> edges,
                                 std::size_t vertices);

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

/// Rows x y z of the same vertices at t = 0 and t = 1, each contiguous. Not owned.
struct vertex_rows {
    static_assert(sizeof(point<double>) == 3 * sizeof(double));
    const double* before = nullptr;
    const double* after = nullptr;
    std::size_t vertices = 0;

    constexpr vertex_rows() = default;
    constexpr vertex_rows(const double* at_start, const double* at_end, std::size_t count)
        : before(at_start), after(at_end), vertices(count) {}
    /// Throws std::invalid_argument if the lengths differ, as the next constructor.
    vertex_rows(std::span<const point<double>> at_start, std::span<const point<double>> at_end)
        : before(reinterpret_cast<const double*>(at_start.data())),
          after(reinterpret_cast<const double*>(at_end.data())),
          vertices(common_size(at_start.size(), at_end.size())) {}
    vertex_rows(const mesh& at_start, const mesh& at_end)
        : vertex_rows(std::span<const point<double>>(at_start.vertices),
                      std::span<const point<double>>(at_end.vertices)) {}
    /// Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>: row-major is not Eigen's default.
    /// Throws std::invalid_argument if there are not three columns, if there are gaps between rows,
    /// or if the numbers of rows differ.
    template <dense_matrix M>
    vertex_rows(const M& at_start, const M& at_end)
        : before(data_of(at_start)),
          after(data_of(at_end)),
          vertices(common_size(rows_of(at_start), rows_of(at_end))) {}

    moving_point<double> operator[](vertex_index vertex) const {
        const auto at = [vertex](const double* frame) {
            const double* row = frame + 3 * std::size_t(vertex);
            return point<double>{row[0], row[1], row[2]};
        };
        return {at(before), at(after)};
    }

  private:
    static std::size_t common_size(std::size_t at_start, std::size_t at_end) {
        if (at_start != at_end)
            throw std::invalid_argument("ccd::vertex_rows: number of vertices at t = 1 is " +
                                        std::to_string(at_end) + "; expected " +
                                        std::to_string(at_start) + " as at t = 0");
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
                "ccd::vertex_rows: layout of a matrix differs; expected three columns without "
                "gaps");
        return static_cast<std::size_t>(m.rows());
    }
};

/// The query of a pair's vertices.
template <any_pair Pair>
query_of_pair<Pair> query_of(const vertex_rows& rows, const Pair& pair) {
    return detail::with_members(pair,
                                [&rows](auto... v) { return query_of_pair<Pair>{rows[v]...}; });
}

namespace detail {

/// Queries by value, or pairs of vertices of `positions`.
template <class Item>
struct batch_input {
    std::span<const Item> items;
    vertex_rows positions = {};
};
template <pair_range Pairs>
batch_input<item_of<Pairs>> input_of(const vertex_rows& positions, const Pairs& pairs) {
    return {std::span<const item_of<Pairs>>(pairs), positions};
}
template <query_range Queries>
batch_input<item_of<Queries>> input_of(const Queries& queries) {
    return {std::span<const item_of<Queries>>(queries)};
}
template <class Item>
query_of_pair<Item> query_at(const batch_input<Item>& queries, std::size_t i) {
    if constexpr (any_pair<Item>)
        return query_of(queries.positions, queries.items[i]);
    else
        return queries.items[i];
}

}  // namespace detail

}  // namespace ccd
