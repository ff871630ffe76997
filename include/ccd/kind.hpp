// The four kinds of query, with the types and names of each. Generic code uses kind_traits, kind_of
// and the concepts below. Do not map kinds to types or to names anywhere else.
#pragma once

#include <array>
#include <ccd/query.hpp>
#include <compare>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

namespace ccd {

/// The index of a vertex in a mesh.
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

enum class kind : std::uint8_t { vertex_face, edge_edge, vertex_edge, vertex_vertex };

/// The types `query<T>` and `pair` of a kind, its features' numbers of vertices, and its names.
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

/// Holds one `Of<K>` for each kind, accessed by the kind's name or as `of<K>()`.
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

template <class T>
concept has_kind = requires {
    kind_constant<T>::value;
};

/// Calls f with the members of a query or pair, in order, and returns its result.
template <has_kind T, class F>
constexpr auto with_members(const T& all, const F& f) {
    using traits = kind_traits<kind_constant<T>::value>;
    constexpr std::size_t count = traits::first_vertices + traits::second_vertices;
    if constexpr (count == 4) {
        const auto& [a, b, c, d] = all;
        return f(a, b, c, d);
    } else if constexpr (count == 3) {
        const auto& [a, b, c] = all;
        return f(a, b, c);
    } else {
        const auto& [a, b] = all;
        return f(a, b);
    }
}

template <class R>
using item_of = typename decltype(std::span(std::declval<const R&>()))::value_type;

}  // namespace detail

/// The kind of a query, of any number type, or of a pair.
template <class QueryOrPair>
inline constexpr kind kind_of = detail::kind_constant<QueryOrPair>::value;

/// The pair type of a query, the query type of a pair.
template <class Query>
using pair_of_query = typename kind_traits<kind_of<Query>>::pair;
template <class Pair, class T = double>
using query_of_pair = typename kind_traits<kind_of<Pair>>::template query<T>;

/// True for vertex_face and edge_edge. Their contacts are at roots of the cubic Y
/// (ccd/methods/forms.hpp); every method decides them, and files of queries hold them.
constexpr bool is_cubic(kind k) {
    return k == kind::vertex_face || k == kind::edge_edge;
}

/// A query in doubles.
template <class T>
concept any_query = detail::has_kind<T> && std::same_as<T, query_of_pair<T>>;
/// The same for vertex_face and edge_edge only.
template <class T>
concept cubic_query = any_query<T> && is_cubic(kind_of<T>);

template <class T>
concept any_pair = detail::has_kind<T> && std::same_as<T, pair_of_query<T>>;
template <class T>
concept cubic_pair = any_pair<T> && is_cubic(kind_of<T>);

/// A span, vector or other contiguous range of queries in doubles, or of pairs, all of one kind.
template <class R>
concept query_range = any_query<detail::item_of<R>>;
template <class R>
concept pair_range = any_pair<detail::item_of<R>>;

/// The vertex indices of a pair, in the order of its members.
template <any_pair Pair>
constexpr auto vertices_of(const Pair& pair) {
    return detail::with_members(pair, [](auto... v) { return std::array{v...}; });
}

/// Calls `visit.operator()<K>()` with the kind as a constant, and returns its result.
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

/// The kind's names: "vf" in files, options and tables; "vertex-face" in paths of query files;
/// "vertex_face" in JSON.
constexpr std::string_view short_name(kind k) {
    return visit_kind(k, [&]<kind K>() { return kind_traits<K>::short_name; });
}
constexpr std::string_view path_name(kind k) {
    return visit_kind(k, [&]<kind K>() { return kind_traits<K>::path_name; });
}
constexpr std::string_view name(kind k) {
    return visit_kind(k, [&]<kind K>() { return kind_traits<K>::name; });
}

/// The kinds for which is_cubic() is true.
inline constexpr std::array stored_kinds{kind::vertex_face, kind::edge_edge};

/// The cubic kind with that short name or path name; nothing for any other name.
constexpr std::optional<kind> find_kind(std::string_view wanted) {
    for (const kind k : stored_kinds)
        if (wanted == short_name(k) || wanted == path_name(k)) return k;
    return std::nullopt;
}

}  // namespace ccd
