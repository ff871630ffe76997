#include "ccd/step/candidate_search.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <type_traits>
#include <utility>
#include <vector>

#include "ccd/batch/batch_worker.hpp"
#include "ccd/batch/threads.hpp"
#include "ccd/step/active_parts.hpp"
#include "ccd/step/candidate_blocks.hpp"
#include "ccd/step/elements.hpp"
#include "ccd/step/vertex_order.hpp"

namespace ccd::detail {
namespace {

std::vector<std::array<vertex_index, 1>> all_vertices(std::size_t count) {
    std::vector<std::array<vertex_index, 1>> vertices(count);
    for (std::size_t v = 0; v < count; ++v) vertices[v] = {static_cast<vertex_index>(v)};
    return vertices;
}

std::vector<std::array<vertex_index, 1>> vertices_on_no_edge(const std::vector<edge>& edges,
                                                             std::size_t count) {
    std::vector<std::uint8_t> on_an_edge(count);
    for (const edge& e : edges) on_an_edge[e[0]] = on_an_edge[e[1]] = 1;
    std::vector<std::array<vertex_index, 1>> points;
    for (std::size_t v = 0; v < count; ++v)
        if (on_an_edge[v] == 0) points.push_back({static_cast<vertex_index>(v)});
    return points;
}

/// The unique ones of `edges` that are not among `face_edges`.
std::vector<edge> edges_of_no_face(std::span<const edge> edges,
                                   const std::vector<edge>& face_edges) {
    return without(unique_edges({}, edges), face_edges);
}

}  // namespace

candidate_search::~candidate_search() = default;
candidate_search::candidate_search(candidate_search&&) noexcept = default;

template <std::size_t N>
template <class Real, class Tree, class Sort, class Build>
void ordered_elements<N>::build_tree(const Tree& tree, bool whole_way, const Sort& sort,
                                     const Build& build) {
    constexpr bool by_doubles = std::is_same_v<Real, double>;
    constexpr double worth_sorting = 1.25;  // sort if leaves are this much longer than their least
    auto& least = std::is_same_v<Tree, box_tree<Real>> ? least_of_boxes_ : least_of_extents_;
    if (ordered_ && by_doubles_ == by_doubles) {
        build();
        if (!whole_way) return;
        const double length = tree.length_of_leaves();
        if (length <= worth_sorting * least.value_or(length)) {
            least = std::min(length, least.value_or(length));
            return;
        }
    }
    sort(elements_);
    build();
    least_of_boxes_ = least_of_extents_ = std::nullopt;
    if (whole_way) least = tree.length_of_leaves();
    ordered_ = true;
    by_doubles_ = by_doubles;
}

const search_kernels& search_kernels_for(std::optional<instruction_set> set) {
    switch (runnable(set)) {
#ifdef ERRBOUND_HAVE_X86_KERNELS
        case instruction_set::avx512:
            return avx512::searching;
        case instruction_set::avx2:
            return avx2::searching;
#endif
        default:
            return baseline::searching;
    }
}

candidate_search::candidate_search(std::span<const face> faces, std::span<const edge> edges,
                                   std::size_t vertices)
    : vertex_count_(vertices),
      has_edges_(!edges.empty()),
      unused_(unused_vertices(faces, edges, vertices)),
      vertices_(all_vertices(vertices)),
      faces_(unique_faces(faces)) {
    std::vector<edge> all = unique_edges(faces, edges);
    points_ = ordered_elements(vertices_on_no_edge(all, vertices));
    if (!edges.empty()) rods_ = ordered_elements(edges_of_no_face(edges, unique_edges(faces)));
    edges_ = ordered_elements(std::move(all));
    set_resting();
}

candidate_search candidate_search::in_plane(std::span<const edge> edges, std::size_t vertices) {
    candidate_search search({}, edges, vertices);
    search.in_plane_ = true;
    return search;
}

candidate_search candidate_search::at_start(std::span<const face> faces,
                                            std::span<const edge> edges, std::size_t vertices,
                                            bool in_plane) {
    candidate_search search({}, {}, 0);
    search.in_plane_ = in_plane;
    search.vertex_count_ = vertices;
    search.unused_ = unused_vertices(faces, edges, vertices);
    search.has_edges_ = !edges.empty();
    search.faces_ = ordered_elements(unique_faces(faces));
    if (!edges.empty())
        search.rods_ = ordered_elements(edges_of_no_face(edges, unique_edges(faces)));
    search.set_resting();
    return search;
}

void candidate_search::set_resting() {
    const std::span<const face> faces = faces_;
    const std::span<const edge> rods = rods_;
    std::vector<vertex_index> points = unused_;
    if (has_edges_) points = unused_vertices(faces, rods, vertex_count_);
    if (skips_unused_) points = without(points, unused_);
    std::vector<face> all;
    if (!rods.empty() || !points.empty()) all.assign(faces.begin(), faces.end());
    for (face& f : all)
        while (!is_triangle(f) && f[0] != f[1]) std::rotate(f.begin(), f.begin() + 1, f.end());
    for (const edge& e : rods) all.push_back({e[0], e[1], e[1]});
    for (const vertex_index v : points) all.push_back({v, v, v});
    resting_ = ordered_elements(std::move(all));
    resting_points_ = std::move(points);
}

bool candidate_search::is_point(const face& element) const {
    return element[0] == element[2] && element[0] == element[1] &&
           std::ranges::binary_search(resting_points_, element[0]);
}
bool candidate_search::is_rod(const face& element) const {
    return resting_.size() > 0 && element[0] != element[1] && element[1] == element[2];
}

template <std::size_t N>
void candidate_search::skip_in(ordered_elements<N>& set, bool skip) {
    const std::span<const std::array<vertex_index, N>> old = set;
    std::vector<std::array<vertex_index, N>> all(old.begin(), old.end());
    if (skip)
        std::erase_if(all,
                      [&](const auto& e) { return std::ranges::binary_search(unused_, e[0]); });
    else
        for (const vertex_index v : unused_) std::ranges::fill(all.emplace_back(), v);
    set = ordered_elements(std::move(all));
}

void candidate_search::skip_unused(bool skip) {
    if (skip == skips_unused_ || unused_.empty()) return;
    skips_unused_ = skip;
    skip_in(vertices_, skip);
    skip_in(points_, skip);
    set_resting();
}

template <class Real, std::size_t N>
auto candidate_search::sorting(const swept_boxes& boxes, const ordered_elements<N>& sample) {
    return [&](auto& elements) {
        order_.find<Real, N>(boxes, vertices(), sample);
        order_.sort<Real>(elements, boxes);
    };
}

template <kind K, class Real, class First, class Second>
std::size_t candidate_search::find_by(tree_pair<Real>& trees, const search_request& request,
                                      First& first, Second& second) {
    constexpr bool within_one = std::is_same_v<First, Second>;
    const auto build = [&](box_tree<Real>& tree, auto& elements) {
        elements.template build_tree<Real>(
            tree, request.wanted.t_max >= 1, sorting<Real>(request.boxes, second), [&] {
                tree.build(elements.size(), [&](std::size_t i) {
                    return request.boxes.swept_box<Real>(elements[i]);
                });
            });
    };
    build(trees.second, second);
    if constexpr (!within_one) build(trees.first, first);
    candidate_blocks<pair_of_kind<K>> blocks(request.visitor.of<K>(), request.filter, request.stop);
    for_each_touching(
        within_one ? trees.second : trees.first,
        trees.second, [&]() -> auto& { return blocks.local(); },
        [&](auto& block, std::size_t i, std::size_t j, bool certain) {
            const auto& a = first[i];
            const auto& b = second[j];
            const bool apart = !share_vertex(a, b);
            block.add(candidate_of(a, b), certain ? apart : apart && request.boxes.touch(a, b));
        });
    return blocks.finish();
}

template <class Elements, class Sample>
void candidate_search::improve_order(Elements& elements, const Sample& sample,
                                     const search_request& request) {
    const extents_leaves<Elements::vertices> leaves{request.rounded, elements};
    elements.template build_tree<float>(leaves, request.wanted.t_max >= 1,
                                        sorting<float>(request.boxes, sample), [] {});
}

namespace {

/// Adds the candidates pair_of(i, j) of the elements that `find` finds, of leaves first <= p < end
/// of `a` and all of `b`.
template <class Blocks, class PairOf>
void search_leaves(search_kernels::find_pairs find, const extents_tree& a, std::size_t first,
                   std::size_t end, const extents_tree& b, Blocks& blocks, const PairOf& pair_of) {
    struct context {
        const PairOf& pair_of;
        typename Blocks::block& block;
    };
    constexpr auto add = [](void* to, const element_pair* pairs, std::size_t count) {
        auto& [pair_of, block] = *static_cast<context*>(to);
        for (std::size_t i = 0; i < count; ++i)
            block.add(pair_of(pairs[i].first, pairs[i].second), true);
    };
    context to{pair_of, blocks.local()};
    find(a.levels(), b.levels(), first, end, &to, add);
}

/// Searches each leaf of `a`, or one in `stride`.
template <class Blocks, class PairOf>
void search_trees(search_kernels::find_pairs find, const extents_tree& a, const extents_tree& b,
                  Blocks& blocks, const PairOf& pair_of, std::size_t stride = 1) {
    if (stride > 1)
        for_each_range(
            (a.leaves() + stride - 1) / stride, 1, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i)
                    search_leaves(find, a, i * stride, i * stride + 1, b, blocks, pair_of);
            });
    else
        for_each_range(a.leaves(), 8, [&](std::size_t begin, std::size_t end) {
            search_leaves(find, a, begin, end, b, blocks, pair_of);
        });
}

}  // namespace

template <std::size_t N, class Blocks, class PairOf>
void candidate_search::search_elements(search_kernels::find_pairs find,
                                       const search_request& request,
                                       std::span<const std::array<vertex_index, N>> elements,
                                       extents_of ends, const extents_tree& b, Blocks& blocks,
                                       const PairOf& pair_of) {
    constexpr std::size_t in_chunk = extents_column::size * extents_column::size;
    per_thread<extents_tree> trees;
    for_each_index((elements.size() + in_chunk - 1) / in_chunk, [&](std::size_t chunk) {
        const std::size_t first = in_chunk * chunk;
        extents_tree& a = trees.local();
        a.build<N>(request.kernels, request.rounded, request.margin,
                   elements.subspan(first, std::min(in_chunk, elements.size() - first)), ends);
        const std::size_t end = request.wanted.sample ? 1 : a.leaves();
        search_leaves(find, a, 0, end, b, blocks,
                      [&](std::size_t i, std::size_t j) { return pair_of(first + i, j); });
    });
}

candidate_search::active_parts* candidate_search::choose_active(const kept_positions& kept,
                                                                const swept_boxes& boxes,
                                                                const search_kernels& kernels) {
    // Every so often, all elements are searched, in a new order: those that move change it.
    constexpr std::size_t most_searched = 64;  // times all elements
    if (active_searched_ > most_searched * (vertices_.size() + edges_.size() + faces_.size())) {
        edges_.forget_order();
        faces_.forget_order();
        vertices_.forget_order();
        return nullptr;
    }
    if (!active_ || !active_->hold(kept)) {
        if (boxes.need_doubles<2>(edges_) || boxes.need_doubles<3>(faces_)) return nullptr;
        active_ = std::make_unique<active_parts>(kept, *this);
        if (active_->are_few()) active_->build_trees(kernels);
    }
    return active_->are_few() ? active_.get() : nullptr;
}

template <kind K, class First, class Second>
std::size_t candidate_search::find_close_active(const search_request& request, const First&,
                                                const Second&) {
    constexpr std::size_t n = First::vertices, m = Second::vertices;
    constexpr bool within_one = std::is_same_v<First, Second>;
    const auto& first = request.active->template of<n>();
    const auto& second = request.active->template of<m>();
    extents_tree& b = of_extents_.second;
    extents_tree& a = within_one ? b : of_extents_.first;
    candidate_blocks<pair_of_kind<K>> blocks(request.visitor.of<K>(), request.filter, request.stop);
    const auto build = [&]<std::size_t N>(extents_tree& tree, const auto& elements) {
        if (!elements.empty())
            tree.build<N>(request.kernels, request.active->rounded(), 0, elements);
    };
    const auto search = [&](search_kernels::find_pairs find, const extents_tree& x,
                            const auto& of_x, const extents_tree& y, const auto& of_y) {
        if (of_x.empty() || of_y.empty()) return;
        search_trees(find, x, y, blocks,
                     [&](std::size_t i, std::size_t j) { return candidate_of(of_x[i], of_y[j]); });
    };
    build.template operator()<m>(b, second.active);
    if constexpr (!within_one) build.template operator()<n>(a, first.active);
    constexpr auto of_both_ends =
        within_one ? &search_kernels::of_two_edges : &search_kernels::of_vertices_and_faces;
    constexpr auto of_swept = within_one ? &search_kernels::of_two_swept_edges
                                         : &search_kernels::of_swept_vertices_and_faces;
    search(request.kernels.*of_both_ends, a, first.active, b, second.active);
    // An axis separates swept elements from those at rest if it does at both ends.
    if (!second.active.empty()) b.sweep();
    if (!within_one && !first.active.empty()) a.sweep();
    search(request.kernels.*of_swept, a, first.active, second.of_near, second.near);
    if constexpr (!within_one)
        search(request.kernels.*of_swept, first.of_near, first.near, b, second.active);
    return blocks.finish();
}

template <kind K, class First, class Second>
std::size_t candidate_search::find_close(const search_request& request, First& first,
                                         Second& second) {
    constexpr bool within_one = std::is_same_v<First, Second>;
    constexpr std::size_t n = First::vertices, m = Second::vertices;
    const bool swept = request.rests || request.boxes.nearly_rest<m>(second);
    const extents_of ends = request.rests ? extents_of::start
                            : swept       ? extents_of::whole_way
                                          : extents_of::both_ends;
    constexpr auto of_both_ends =
        within_one ? &search_kernels::of_two_edges : &search_kernels::of_vertices_and_faces;
    constexpr auto of_swept = within_one ? &search_kernels::of_two_swept_edges
                                         : &search_kernels::of_swept_vertices_and_faces;
    const search_kernels::find_pairs find = request.kernels.*(swept ? of_swept : of_both_ends);
    candidate_blocks<pair_of_kind<K>> blocks(request.visitor.of<K>(), request.filter, request.stop);
    const std::span<const std::array<vertex_index, n>> all_first = first;
    const std::span<const std::array<vertex_index, m>> all_second = second;
    extents_tree& tree = of_extents_.second;
    improve_order(second, second, request);
    in_second_ = &second;
    if constexpr (within_one) {
        // Two trees, one after the other, so that edges take no more memory than faces.
        constexpr std::size_t few = 4096, sample_stride = 64;
        const std::size_t half = (second.size() + 1) / 2;
        const std::size_t at_once =
            second.size() <= few ? second.size() : std::max(faces_.size(), half);
        for (std::size_t end = second.size(), begin = 0; end > 0; end = begin) {
            begin = end - std::min(end, at_once);
            tree.build<m>(request.kernels, request.rounded, request.margin,
                          all_second.subspan(begin, end - begin), ends);
            const auto pair_of = [&, begin](std::size_t i, std::size_t j) {
                return candidate_of(all_first[i], all_second[begin + j]);
            };
            search_trees(
                find, tree, tree, blocks,
                [&](std::size_t i, std::size_t j) { return pair_of(begin + i, j); },
                request.wanted.sample ? sample_stride : 1);
            search_elements(find, request, all_first.first(begin), ends, tree, blocks, pair_of);
        }
    } else {
        tree.build<m>(request.kernels, request.rounded, request.margin, all_second, ends);
        improve_order(first, second, request);
        search_elements(find, request, all_first, ends, tree, blocks,
                        [&](std::size_t i, std::size_t j) {
                            return candidate_of(all_first[i], all_second[j]);
                        });
    }
    return blocks.finish();
}

template <kind K, class First, class Second>
std::size_t candidate_search::find_kind(const search_request& request, First& first,
                                        Second& second) {
    if (!request.visitor.of<K>() || first.size() == 0 || second.size() == 0) return 0;
    if constexpr (is_cubic(K))
        if (request.active != nullptr) return find_close_active<K>(request, first, second);
    if (!request.boxes.need_doubles<Second::vertices>(second)) {
        if constexpr (is_cubic(K))
            if (request.wanted.close) return find_close<K>(request, first, second);
        if (request.wanted.sample) return 0;
        if (!request.boxes.need_widening()) return find_by<K>(in_floats_, request, first, second);
    }
    if (request.wanted.sample) return 0;
    return find_by<K>(in_doubles_, request, first, second);
}

std::size_t candidate_search::find_adjacent_rods(const search_request& request) {
    if (!request.visitor.vertex_edge) return 0;
    const std::span<const edge> given = rods_;
    std::vector<edge> rods(given.begin(), given.end());
    for (const face& f : std::span<const face>(faces_))
        if (!is_triangle(f)) rods.insert(rods.end(), {{f[0], f[1]}, {f[0], f[2]}});
    std::vector<edge> from_vertex;  // both directions of each rod
    for (const edge& e : unique_edges({}, rods))
        from_vertex.insert(from_vertex.end(), {{e[0], e[1]}, {e[1], e[0]}});
    std::ranges::sort(from_vertex);
    candidate_blocks<vertex_edge_pair> blocks(request.visitor.vertex_edge, request.filter,
                                              request.stop);
    for (auto first = from_vertex.begin(); first != from_vertex.end();) {
        const auto last = std::find_if(first, from_vertex.end(),
                                       [&](const edge& e) { return e[0] != (*first)[0]; });
        for (auto a = first; a != last; ++a)
            for (auto b = first; b != last; ++b) {
                const auto [at, other] = *b;
                const std::array<vertex_index, 1> end{(*a)[1]};
                const bool is_twice =  // in a triangle of rods
                    std::ranges::binary_search(from_vertex, edge{other, end[0]});
                if (a == b || (is_twice && at > other)) continue;
                const edge rod{std::min(at, other), std::max(at, other)};
                blocks.local().add(candidate_of(end, rod), request.boxes.touch(end, rod));
            }
        first = last;
    }
    return blocks.finish();
}

void candidate_search::find_at_start(const batch_positions& positions, const step_options& options,
                                     const resting_visitor& visit, trees from, bool one_suffices) {
    skip_unused(options.filter.skip_unused);
    if (from == trees::new_ones) {
        order_.forget();
        in_second_ = nullptr;
    }
    ordered_elements<3>& elements = resting_.size() > 0 ? resting_ : faces_;
    if (elements.size() == 0) return;
    batch_positions at = positions;
    at.exact.after = at.exact.before;
    const pair_distances contact;
    const swept_boxes boxes(at, contact);
    if (boxes.need_doubles<3>(elements))
        return find_resting_by_boxes(boxes, elements, options, visit);
    extents_tree& tree = of_extents_.second;
    const search_kernels& kernels = search_kernels_for(options.set);
    if (in_second_ != &elements) {
        elements.build_tree<float>(extents_leaves<3>{at.rounded, elements, 1}, true,
                                   sorting<float>(boxes, elements), [] {});
        tree.build<3>(kernels, at.rounded, 0, elements, extents_of::start);
    }
    in_second_ = &elements;
    struct context {
        const resting_visitor& visit;
        std::span<const face> elements;
    };
    constexpr auto pass = [](void* to, const element_pair* pairs, std::size_t count) {
        const auto& [visit, elements] = *static_cast<context*>(to);
        visit(elements, {pairs, count});
    };
    const auto find = [&](const extents_levels& leaves, std::size_t first, std::size_t end) {
        stop_if_requested(options.stop);
        context to{visit, elements};
        kernels.of_two_faces_at_start(leaves, tree.levels(), first, end, &to, pass);
    };
    if (one_suffices) {
        // Elements that reach far often intersect others. A copy of the levels counts as another
        // tree, so each of their leaves is compared with all.
        const extents_levels others = tree.levels();
        for (const std::size_t leaf : tree.longest_leaves(tree.leaves() / 64))
            find(others, leaf, leaf + 1);
    }
    for_each_range(tree.leaves(), 8,
                   [&](std::size_t begin, std::size_t end) { find(tree.levels(), begin, end); });
}

void candidate_search::find_resting_by_boxes(const swept_boxes& boxes,
                                             ordered_elements<3>& elements,
                                             const step_options& options,
                                             const resting_visitor& visit) {
    struct block {
        std::size_t count = 0;
        std::array<element_pair, 512> pairs;
    };
    per_thread<block> blocks;
    const auto flush = [&](block& b) {
        stop_if_requested(options.stop);
        visit(elements, {b.pairs.data(), b.count});
        b.count = 0;
    };
    box_tree<double>& tree = in_doubles_.second;
    elements.build_tree<double>(tree, true, sorting<double>(boxes, elements), [&] {
        tree.build(elements.size(),
                   [&](std::size_t i) { return boxes.swept_box<double>(elements[i]); });
    });
    for_each_touching(
        tree, tree, [&]() -> auto& { return blocks.local(); },
        [&](block& b, std::size_t i, std::size_t j, bool) {
            if (share_vertex(elements[i], elements[j])) return;
            b.pairs[b.count++] = {static_cast<unsigned>(i), static_cast<unsigned>(j)};
            if (b.count == b.pairs.size()) flush(b);
        });
    const std::vector<block*> all = blocks.all();
    for_each_task(all.size(), [&](std::size_t i) { flush(*all[i]); });
}

pair_counts candidate_search::find(const batch_positions& positions, const step_options& options,
                                   const candidate_visitor& visitor,
                                   const wanted_candidates& wanted) {
    std::optional<short_way> until;
    if (wanted.t_max < 1) until.emplace(positions.exact, std::max(wanted.t_max, 0.0), wanted.spare);
    const swept_boxes whole(positions, options.distances),
        boxes = until ? swept_boxes(until->positions(), options.distances, until->error()) : whole;
    const pair_test test(options.filter, whole);
    skip_unused(options.filter.skip_unused);
    const float* rounded = until ? until->positions().rounded : positions.rounded;
    const float margin = until ? until->margin() : 0;
    const search_kernels& kernels = search_kernels_for(options.set);
    active_parts* const active = wanted.close && wanted.kept != nullptr
                                     ? choose_active(*wanted.kept, whole, kernels)
                                     : nullptr;
    if (active == nullptr) {
        active_ = nullptr;
        active_searched_ = 0;
    } else {
        active_searched_ += active->size();
    }
    const std::size_t bytes = 3 * sizeof(double) * positions.exact.vertices;
    const bool rests = active == nullptr && bytes > 0 &&
                       std::memcmp(positions.exact.before, positions.exact.after, bytes) == 0;
    const search_request request{boxes,   lets_all_through(options.filter) ? nullptr : &test,
                                 visitor, options.stop,
                                 rounded, margin,
                                 kernels, wanted,
                                 active,  rests};
    order_.forget();
    in_second_ = nullptr;
    skipped_rest_ = active != nullptr;
    pair_counts counts;
    if (in_plane_) {
        counts.vertex_edge = find_kind<kind::vertex_edge>(request, vertices_, edges_);
    } else {
        counts.edge_edge = find_kind<kind::edge_edge>(request, edges_, edges_);
        counts.vertex_face = find_kind<kind::vertex_face>(request, vertices_, faces_);
        counts.vertex_edge = find_kind<kind::vertex_edge>(request, points_, rods_);
        if (options.adjacent_rods) counts.vertex_edge += find_adjacent_rods(request);
    }
    counts.vertex_vertex = find_kind<kind::vertex_vertex>(request, points_, points_);
    return counts;
}

}  // namespace ccd::detail
