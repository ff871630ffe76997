// The four kinds of query, and what belongs to each: its query, its pairs of a mesh, its names.
//
// Whoever is generic in the kind asks kind_traits; nobody else maps kinds to types or to names.
#pragma once

#include <array>
#include <ccd/query.hpp>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

namespace ccd {

/// Names a vertex of a mesh.
using vertex_index = std::uint32_t;

/// Vertex v and face f0 f1 f2.
struct vertex_face_pair {
    vertex_index v, f0, f1, f2;
    friend auto operator<=>(const vertex_face_pair&, const vertex_face_pair&) = default;
};
/// Edge a0 a1 and edge b0 b1.
struct edge_edge_pair {
    vertex_index a0, a1, b0, b1;
    friend auto operator<=>(const edge_edge_pair&, const edge_edge_pair&) = default;
};
/// Vertex v and edge e0 e1.
struct vertex_edge_pair {
    vertex_index v, e0, e1;
    friend auto operator<=>(const vertex_edge_pair&, const vertex_edge_pair&) = default;
};
/// Vertices v and w.
struct vertex_vertex_pair {
    vertex_index v, w;
    friend auto operator<=>(const vertex_vertex_pair&, const vertex_vertex_pair&) = default;
};

constexpr std::array<vertex_index, 4> vertices_of(const vertex_face_pair& p) {
    return {p.v, p.f0, p.f1, p.f2};
}
constexpr std::array<vertex_index, 4> vertices_of(const edge_edge_pair& p) {
    return {p.a0, p.a1, p.b0, p.b1};
}
constexpr std::array<vertex_index, 3> vertices_of(const vertex_edge_pair& p) {
    return {p.v, p.e0, p.e1};
}
constexpr std::array<vertex_index, 2> vertices_of(const vertex_vertex_pair& p) {
    return {p.v, p.w};
}

enum class kind : std::uint8_t { vertex_face, edge_edge, vertex_edge, vertex_vertex };

/// What belongs to a kind: `query<T>`, `pair`, the numbers of vertices of its two elements, and its
/// names in files, options and tables. (ccd/methods/forms.hpp has the forms of those that have
/// any.)
template <kind K>
struct kind_traits;
template <>
struct kind_traits<kind::vertex_face> {
    template <class T>
    using query = vertex_face<T>;
    using pair = vertex_face_pair;
    static constexpr std::size_t first_vertices = 1, second_vertices = 3;
    static constexpr std::string_view short_name = "vf", name = "vertex_face",
                                      path_name = "vertex-face";
};
template <>
struct kind_traits<kind::edge_edge> {
    template <class T>
    using query = edge_edge<T>;
    using pair = edge_edge_pair;
    static constexpr std::size_t first_vertices = 2, second_vertices = 2;
    static constexpr std::string_view short_name = "ee", name = "edge_edge",
                                      path_name = "edge-edge";
};
template <>
struct kind_traits<kind::vertex_edge> {
    template <class T>
    using query = vertex_edge<T>;
    using pair = vertex_edge_pair;
    static constexpr std::size_t first_vertices = 1, second_vertices = 2;
    static constexpr std::string_view short_name = "ve", name = "vertex_edge",
                                      path_name = "vertex-edge";
};
template <>
struct kind_traits<kind::vertex_vertex> {
    template <class T>
    using query = vertex_vertex<T>;
    using pair = vertex_vertex_pair;
    static constexpr std::size_t first_vertices = 1, second_vertices = 1;
    static constexpr std::string_view short_name = "vv", name = "vertex_vertex",
                                      path_name = "vertex-vertex";
};

/// The pair type of a kind.
template <kind K>
using pair_of_kind = typename kind_traits<K>::pair;

/// Something for each kind: an `Of<K>` by the kind's name, or `of<K>()`.
template <template <kind> class Of>
struct by_kind {
    Of<kind::vertex_face> vertex_face{};
    Of<kind::edge_edge> edge_edge{};
    Of<kind::vertex_edge> vertex_edge{};
    Of<kind::vertex_vertex> vertex_vertex{};

    template <kind K>
    constexpr const Of<K>& of() const {
        if constexpr (K == kind::vertex_face) return vertex_face;
        if constexpr (K == kind::edge_edge) return edge_edge;
        if constexpr (K == kind::vertex_edge) return vertex_edge;
        if constexpr (K == kind::vertex_vertex) return vertex_vertex;
    }
    template <kind K>
    constexpr Of<K>& of() {
        return const_cast<Of<K>&>(std::as_const(*this).template of<K>());
    }
    friend bool operator==(const by_kind&, const by_kind&) = default;
};

/// Calls `visit.operator()<K>()` for every kind.
template <class Visit>
constexpr void for_each_kind(Visit&& visit) {
    visit.template operator()<kind::vertex_face>();
    visit.template operator()<kind::edge_edge>();
    visit.template operator()<kind::vertex_edge>();
    visit.template operator()<kind::vertex_vertex>();
}

namespace detail {

template <class QueryOrPair>
struct kind_constant;
template <class T>
struct kind_constant<vertex_face<T>> {
    static constexpr kind value = kind::vertex_face;
};
template <class T>
struct kind_constant<edge_edge<T>> {
    static constexpr kind value = kind::edge_edge;
};
template <class T>
struct kind_constant<vertex_edge<T>> {
    static constexpr kind value = kind::vertex_edge;
};
template <class T>
struct kind_constant<vertex_vertex<T>> {
    static constexpr kind value = kind::vertex_vertex;
};
template <>
struct kind_constant<vertex_face_pair> : kind_constant<vertex_face<double>> {};
template <>
struct kind_constant<edge_edge_pair> : kind_constant<edge_edge<double>> {};
template <>
struct kind_constant<vertex_edge_pair> : kind_constant<vertex_edge<double>> {};
template <>
struct kind_constant<vertex_vertex_pair> : kind_constant<vertex_vertex<double>> {};

}  // namespace detail

/// The kind of a query, of any number type, or of a pair.
template <class QueryOrPair>
inline constexpr kind kind_of = detail::kind_constant<QueryOrPair>::value;

/// The pair type of a query, the query type of a pair.
template <class Query>
using pair_of_query = typename kind_traits<kind_of<Query>>::pair;
template <class Pair, class T = double>
using query_of_pair = typename kind_traits<kind_of<Pair>>::template query<T>;

/// Calls `visit.operator()<K>()` with the kind as a constant, and returns what that returns.
template <class Visit>
constexpr decltype(auto) visit_kind(kind k, Visit&& visit) {
    switch (k) {
        case kind::edge_edge:
            return visit.template operator()<kind::edge_edge>();
        case kind::vertex_edge:
            return visit.template operator()<kind::vertex_edge>();
        case kind::vertex_vertex:
            return visit.template operator()<kind::vertex_vertex>();
        default:
            return visit.template operator()<kind::vertex_face>();
    }
}

/// As files, options and tables write it: "vf", "ee", "ve", "vv".
constexpr std::string_view short_name(kind k) {
    return visit_kind(k, [&]<kind K>() { return kind_traits<K>::short_name; });
}
/// As directories are named that hold stored queries: "vertex-face".
constexpr std::string_view path_name(kind k) {
    return visit_kind(k, [&]<kind K>() { return kind_traits<K>::path_name; });
}
/// As JSON writes it: "vertex_face".
constexpr std::string_view name(kind k) {
    return visit_kind(k, [&]<kind K>() { return kind_traits<K>::name; });
}

/// The kinds that files of queries hold and that every method decides.
inline constexpr std::array stored_kinds{kind::vertex_face, kind::edge_edge};

/// The stored kind of that short or path name, if there is one.
constexpr std::optional<kind> find_kind(std::string_view wanted) {
    for (const kind k : stored_kinds)
        if (wanted == short_name(k) || wanted == path_name(k)) return k;
    return std::nullopt;
}

}  // namespace ccd
