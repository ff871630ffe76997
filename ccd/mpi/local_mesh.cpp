#include "ccd/mpi/local_mesh.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "ccd/step/swept_boxes.hpp"

namespace ccd::mpi::detail {
namespace {

template <class Item>
std::vector<std::vector<Item>> picked(std::span<const Item> items,
                                      const std::vector<std::vector<vertex_index>>& places) {
    std::vector<std::vector<Item>> lists(places.size());
    if (items.empty()) return lists;
    for (std::size_t r = 0; r < places.size(); ++r)
        for (const vertex_index i : places[r]) lists[r].push_back(items[i]);
    return lists;
}

template <class Item>
std::vector<std::size_t> sources(const received<Item>& sent) {
    std::vector<std::size_t> ranks(sent.items.size());
    for (std::size_t r = 0; r + 1 < sent.starts.size(); ++r)
        std::fill(ranks.begin() + static_cast<std::ptrdiff_t>(sent.starts[r]),
                  ranks.begin() + static_cast<std::ptrdiff_t>(sent.starts[r + 1]), r);
    return ranks;
}

std::array<double, 3> array_of(const point<double>& p) {
    return {p.x, p.y, p.z};
}
point<double> point_of(const std::array<double, 3>& x) {
    return {x[0], x[1], x[2]};
}

}  // namespace

given_elements::given_elements(const mesh_part& mesh, const pair_distances& distances,
                               bool skip_unused) {
    if (!skip_unused)
        single_vertices_ = unused_vertices(mesh.faces, mesh.edges, mesh.numbers.size());
    const ccd::detail::swept_boxes boxes(ccd::detail::batch_positions(mesh.positions), distances);
    boxes_.reserve(mesh.faces.size() + mesh.edges.size() + single_vertices_.size());
    for (const face& f : mesh.faces) boxes_.push_back(boxes.swept_box<double>(f));
    for (const edge& e : mesh.edges) boxes_.push_back(boxes.swept_box<double>(e));
    for (const vertex_index v : single_vertices_)
        boxes_.push_back(boxes.swept_box<double>(std::array{v}));
}

local_mesh::routes local_mesh::routes_of(std::size_t ranks, const mesh_part& mesh,
                                         const given_elements& given, const decomposition& parts) {
    routes to;
    for (auto* lists : {&to.vertices, &to.faces, &to.edges}) lists->resize(ranks);
    const std::size_t faces = mesh.faces.size(), elements = faces + mesh.edges.size();
    for (std::size_t i = 0; i < given.boxes().size(); ++i)
        parts.for_each_met(given.boxes()[i], [&](std::size_t r) {
            auto& vertices = to.vertices[r];
            if (i < faces) {
                to.faces[r].push_back(static_cast<vertex_index>(i));
                vertices.insert(vertices.end(), mesh.faces[i].begin(), mesh.faces[i].end());
            } else if (i < elements) {
                const edge& e = mesh.edges[i - faces];
                to.edges[r].push_back(static_cast<vertex_index>(i - faces));
                vertices.insert(vertices.end(), e.begin(), e.end());
            } else {
                vertices.push_back(given.single_vertices()[i - elements]);
            }
        });
    for (auto& vertices : to.vertices) {
        std::ranges::sort(vertices);
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    }
    return to;
}

local_mesh::local_mesh(exchanger& ranks, const mesh_part& mesh, const given_elements& given,
                       const decomposition& parts, const vertex_lists& of_vertices) {
    const routes to = routes_of(ranks.size(), mesh, given, parts);
    std::vector<std::vector<sent_vertex>> vertices(ranks.size());
    std::vector<std::vector<sent_face>> faces(ranks.size());
    std::vector<std::vector<sent_edge>> edges(ranks.size());
    const auto number = [&](vertex_index v) { return mesh.numbers[v]; };
    for (std::size_t r = 0; r < ranks.size(); ++r) {
        for (const vertex_index v : to.vertices[r])
            vertices[r].push_back(
                {number(v), array_of(mesh.positions[v].t0), array_of(mesh.positions[v].t1)});
        for (const vertex_index i : to.faces[r]) {
            const face& f = mesh.faces[i];
            faces[r].push_back({number(f[0]), number(f[1]), number(f[2])});
        }
        for (const vertex_index i : to.edges[r])
            edges[r].push_back({number(mesh.edges[i][0]), number(mesh.edges[i][1])});
    }
    const auto sent_vertices = ranks.all_to_all(vertices);
    const auto send = [&](auto list) { return ranks.all_to_all(picked(list, to.vertices)); };
    const received_lists lists{send(of_vertices.groups), send(of_vertices.pinned),
                               send(of_vertices.thickness), send(of_vertices.islands)};
    const auto sent_faces = ranks.all_to_all(faces);
    const auto sent_edges = ranks.all_to_all(edges);
    ranks.agree([&] { keep_vertices(sent_vertices, lists); });
    faces_ = by_index<3>(sent_faces);
    edges_ = by_index<2>(sent_edges);
    owner_of_face_ = sources(sent_faces);
    owner_of_edge_ = sources(sent_edges);
    elements_ =
        faces_.size() + edges_.size() + unused_vertices(faces_, edges_, numbers_.size()).size();
}

/// Keeps one copy of each vertex, in the order of their numbers.
void local_mesh::keep_vertices(const received<sent_vertex>& sent,
                               const received_lists& of_vertices) {
    const auto& [groups, pinned, thickness, islands] = of_vertices;
    if (sent.items.size() > std::numeric_limits<vertex_index>::max())
        throw std::length_error("ccd::mpi: number of vertices in one region is " +
                                std::to_string(sent.items.size()) +
                                "; expected fewer than 2^32 - 1");
    std::vector<vertex_index> order(sent.items.size());
    for (vertex_index i = 0; i < order.size(); ++i) order[i] = i;
    // Stable, so that the lowest rank's copy is first.
    std::ranges::stable_sort(order, {}, [&](vertex_index i) { return sent.items[i].number; });
    const std::vector<std::size_t> ranks = sources(sent);
    const auto differ = [](vertex_index i, vertex_index j, const auto&... lists) {
        return ((!lists.items.empty() && lists.items[i] != lists.items[j]) || ...);
    };
    const auto keep = [](auto& kept, const auto& list, vertex_index i) {
        if (!list.items.empty()) kept.push_back(list.items[i]);
    };
    for (std::size_t k = 0, first = 0; k < order.size(); ++k) {
        const vertex_index i = order[k], kept = order[first];
        const sent_vertex& v = sent.items[i];
        if (k > 0 && v.number == sent.items[kept].number) {
            const sent_vertex& w = sent.items[kept];
            if (v.before != w.before || v.after != w.after ||
                differ(i, kept, groups, pinned, thickness, islands))
                throw std::invalid_argument(
                    "ccd::mpi: vertex " + std::to_string(v.number) + " on rank " +
                    std::to_string(ranks[i]) + " differs from its copy on rank " +
                    std::to_string(ranks[kept]) +
                    "; expected the same positions, group, flag, thickness and island");
            continue;
        }
        first = k;
        numbers_.push_back(v.number);
        owner_of_vertex_.push_back(ranks[i]);
        before_.push_back(point_of(v.before));
        after_.push_back(point_of(v.after));
        keep(groups_, groups, i);
        keep(pinned_, pinned, i);
        keep(thickness_, thickness, i);
        keep(islands_, islands, i);
    }
}

std::optional<vertex_index> local_mesh::find(vertex_number number) const {
    const auto found = std::ranges::lower_bound(numbers_, number);
    if (found == numbers_.end() || *found != number) return {};
    return static_cast<vertex_index>(found - numbers_.begin());
}

template <std::size_t N>
std::vector<std::array<vertex_index, N>> local_mesh::by_index(
    const received<std::array<vertex_number, N>>& sent) const {
    std::vector<std::array<vertex_index, N>> elements(sent.items.size());
    for (std::size_t i = 0; i < elements.size(); ++i)
        std::ranges::transform(sent.items[i], elements[i].begin(),
                               [this](vertex_number n) { return find(n).value(); });
    return elements;
}

pair_filter local_mesh::filter(const space_region& part, const pair_filter& given) const {
    pair_filter own = given;
    own.groups = groups_;
    own.pinned = pinned_;
    own.region = part;
    return own;
}

template <class Pair>
std::vector<std::size_t> local_mesh::owners(const std::vector<Pair>& pairs) const {
    std::vector<std::size_t> owners(pairs.size());
    if constexpr (kind_of<Pair> != kind::edge_edge) {
        for (std::size_t i = 0; i < pairs.size(); ++i)
            owners[i] = owner_of_vertex_[vertices_of(pairs[i])[0]];
    } else {
        // The first edge of each pair, and the lowest rank that has it as an edge or a side of a
        // face.
        std::vector<std::pair<edge, std::size_t>> first;
        for (const Pair& p : pairs) first.push_back({{p.a0, p.a1}, ~std::size_t(0)});
        std::ranges::sort(first);
        const auto seen = [&](vertex_index v, vertex_index w, std::size_t rank) {
            const edge e{std::min(v, w), std::max(v, w)};
            const auto found =
                std::ranges::lower_bound(first, e, {}, &std::pair<edge, std::size_t>::first);
            if (found != first.end() && found->first == e)
                found->second = std::min(found->second, rank);
        };
        for (std::size_t i = 0; i < edges_.size(); ++i)
            seen(edges_[i][0], edges_[i][1], owner_of_edge_[i]);
        for (std::size_t i = 0; i < faces_.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k)
                seen(faces_[i][k], faces_[i][(k + 1) % 3], owner_of_face_[i]);
        for (std::size_t i = 0; i < pairs.size(); ++i)
            owners[i] = std::ranges::lower_bound(first, edge{pairs[i].a0, pairs[i].a1}, {},
                                                 &std::pair<edge, std::size_t>::first)
                            ->second;
    }
    return owners;
}

template std::vector<std::size_t> local_mesh::owners(const std::vector<vertex_face_pair>&) const;
template std::vector<std::size_t> local_mesh::owners(const std::vector<edge_edge_pair>&) const;
template std::vector<std::size_t> local_mesh::owners(const std::vector<vertex_edge_pair>&) const;
template std::vector<std::size_t> local_mesh::owners(const std::vector<vertex_vertex_pair>&) const;

}  // namespace ccd::mpi::detail
