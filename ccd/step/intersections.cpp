#include <algorithm>
#include <ccd/step.hpp>
#include <errbound/simplices/common_segment.hpp>
#include <errbound/simplices/relation.hpp>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "ccd/batch/threads.hpp"
#include "ccd/step/candidate_blocks.hpp"
#include "ccd/step/candidate_search.hpp"
#include "ccd/step/checks.hpp"
#include "ccd/step/elements.hpp"
#include "ccd/step/order/buckets.hpp"
#include "ccd/step/rest/vertex_fans.hpp"
#include "ccd/step/stopwatch.hpp"

namespace ccd {
namespace detail {
namespace {

using errbound::relation;

/// The vertices of an element, each once.
struct simplex_vertices {
    std::array<vertex_index, 3> vertices;
    std::size_t size = 0;

    explicit simplex_vertices(const face& element) {
        for_each_vertex(element, [this](vertex_index v) { vertices[size++] = v; });
    }
    explicit simplex_vertices(const mesh_element& element)
        : simplex_vertices(repeating_last(element)) {}
    const vertex_index* begin() const { return vertices.data(); }
    const vertex_index* end() const { return vertices.data() + size; }

  private:
    static face repeating_last(const mesh_element& element) {
        face f = element.indices;
        std::fill(f.begin() + element.size, f.end(), f[element.size - 1U]);
        return f;
    }
};

/// One search for intersections. Keeps references.
class intersection_finder {
  public:
    /// Reads positions.before only.
    intersection_finder(const candidate_search& search, const vertex_rows& positions,
                        const intersection_options& options);

    /// Decides pairs without a common vertex. Thread-safe. Throws found_first if one pair suffices.
    void decide(std::span<const face> elements, std::span<const element_pair> pairs);
    /// Decides pairs with common vertices. Throws as decide.
    void decide_adjacent(const vertex_fans& fans);

    /// Precondition: no call of others is running.
    intersection_result take();

    /// Ends the search.
    struct found_first {};

  private:
    struct found_pair {
        mesh_element a, b;
        relation how;
        auto operator<=>(const found_pair&) const = default;
    };
    struct found_by_thread {
        std::array<std::vector<found_pair>, intersection_kinds.size()> pairs;  ///< by kind
        intersection_counts counts;
        std::vector<edge_face_pair> edge_faces;
    };

    bool may_meet(const simplex_vertices& a, const simplex_vertices& b) const;
    void decide(found_by_thread& found, const face& a, const face& b);
    void find_edges_in_faces(found_by_thread& found, const face& edges_of, const face& f) const;
    void report(found_by_thread& found, const face& a, const face& b, relation r) const;
    std::size_t size_of(const face& element) const {
        return search_.is_point(element) ? 1 : search_.is_rod(element) ? 2 : 3;
    }
    mesh_element element_of(const face& element) const;

    const candidate_search& search_;
    vertex_rows positions_;
    const intersection_options& options_;
    const search_kernels& kernels_;
    bool all_pass_;
    per_thread<found_by_thread> found_;
};

template <std::size_t D>
errbound::simplices::simplex<D> simplex_of(const vertex_rows& positions,
                                           const simplex_vertices& vertices) {
    errbound::simplices::simplex<D> simplex;
    for (const vertex_index v : vertices) {
        std::array<double, D> point;
        std::copy_n(positions.before + 3 * std::size_t(v), D, point.begin());
        simplex.add(point);
    }
    return simplex;
}

/// Moves the common vertices of both to the front, in one order. Returns their number.
std::size_t align(simplex_vertices& a, simplex_vertices& b) {
    std::size_t common = 0;
    for (std::size_t i = 0; i < a.size; ++i)
        for (std::size_t j = common; j < b.size; ++j)
            if (a.vertices[i] == b.vertices[j]) {
                std::swap(a.vertices[i], a.vertices[common]);
                std::swap(b.vertices[j], b.vertices[common++]);
                break;
            }
    return common;
}

relation relation_of(const vertex_rows& positions, bool in_plane, simplex_vertices a,
                     simplex_vertices b) {
    const std::size_t common = align(a, b);
    if (common == std::min(a.size, b.size)) return relation::disjoint;
    const auto decide = [&]<std::size_t D>() {
        return errbound::simplices::relation_of(
            simplex_of<D>(positions, a), simplex_of<D>(positions, b), static_cast<int>(common));
    };
    return in_plane ? decide.template operator()<2>() : decide.template operator()<3>();
}

/// Precondition: the pair is crossing.
std::array<errbound::located_point<3>, 2> segment_of(const vertex_rows& positions, bool in_plane,
                                                     const intersection& pair) {
    const simplex_vertices a(pair.a), b(pair.b);
    if (!in_plane)
        return errbound::simplices::common_segment(simplex_of<3>(positions, a),
                                                   simplex_of<3>(positions, b));
    const auto [p, q] = errbound::simplices::common_segment(simplex_of<2>(positions, a),
                                                            simplex_of<2>(positions, b));
    const auto lifted = [](const errbound::located_point<2>& x) {
        return errbound::located_point<3>{{x.position[0], x.position[1], 0}, x.error};
    };
    return {lifted(p), lifted(q)};
}

intersection_finder::intersection_finder(const candidate_search& search,
                                         const vertex_rows& positions,
                                         const intersection_options& options)
    : search_(search),
      positions_(positions),
      options_(options),
      kernels_(search_kernels_for(options.set)),
      all_pass_(lets_all_through(options.filter)) {}

bool intersection_finder::may_meet(const simplex_vertices& a, const simplex_vertices& b) const {
    if (all_pass_) return true;
    const bool may = std::ranges::any_of(a, [&](vertex_index v) {
        return std::ranges::any_of(
            b, [&](vertex_index w) { return v != w && may_collide(options_.filter, v, w); });
    });
    if (!may || !options_.filter.region) return may;
    std::array<double, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto least = [&](const simplex_vertices& s) {
            double low = std::numeric_limits<double>::infinity();
            for (const vertex_index v : s)
                low = std::min(low, positions_.before[3 * std::size_t(v) + k]);
            return low;
        };
        corner[k] = std::max(least(a), least(b));
    }
    return options_.filter.region->has(corner);
}

void intersection_finder::decide(std::span<const face> elements,
                                 std::span<const element_pair> pairs) {
    found_by_thread& found = found_.local();
    constexpr std::size_t block = 512;
    std::array<errbound::sign_type, block> signs;
    signs.fill(errbound::sign_type::uncertain);
    for (; !pairs.empty(); pairs = pairs.subspan(std::min(block, pairs.size()))) {
        const auto some = pairs.first(std::min(block, pairs.size()));
        if (!options_.edge_faces)
            kernels_.triangle_signs(positions_.before, elements.data()->data(), some.data(),
                                    some.size(), signs.data());
        for (std::size_t i = 0; i < some.size(); ++i) {
            if (signs[i] == errbound::sign_type::negative) continue;
            const face &a = elements[some[i].first], &b = elements[some[i].second];
            if (signs[i] == errbound::sign_type::uncertain)
                decide(found, a, b);
            else if (may_meet(simplex_vertices(a), simplex_vertices(b)))
                report(found, a, b, relation::crossing);
        }
    }
}

void intersection_finder::decide(found_by_thread& found, const face& a, const face& b) {
    if (options_.edge_faces) {
        find_edges_in_faces(found, a, b);
        find_edges_in_faces(found, b, a);
    }
    const simplex_vertices x(a), y(b);
    if (!may_meet(x, y)) return;
    const relation r = relation_of(positions_, search_.is_in_plane(), x, y);
    if (r != relation::disjoint) report(found, a, b, r);
}

void intersection_finder::find_edges_in_faces(found_by_thread& found, const face& edges_of,
                                              const face& f) const {
    const simplex_vertices from(edges_of), to(f);
    if (size_of(f) < 3) return;
    for (std::size_t i = 1; i < from.size; ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const edge e{std::min(from.vertices[i], from.vertices[j]),
                         std::max(from.vertices[i], from.vertices[j])};
            const simplex_vertices ends(face{e[0], e[1], e[1]});
            if (share_vertex(e, f) || !may_meet(ends, to) ||
                relation_of(positions_, false, ends, to) == relation::disjoint)
                continue;
            edge_face_pair& pair = found.edge_faces.emplace_back(edge_face_pair{e, f});
            std::ranges::sort(pair.f);
        }
}

mesh_element intersection_finder::element_of(const face& element) const {
    if (const std::size_t size = size_of(element); size < 3)
        return {static_cast<std::uint8_t>(size), {element[0], size == 2 ? element[1] : 0}};
    const auto [x, y, z] = element;
    const vertex_index low = std::min({x, y, z}), high = std::max({x, y, z});
    return {3, {low, x ^ y ^ z ^ low ^ high, high}};
}

void intersection_finder::report(found_by_thread& found, const face& a, const face& b,
                                 relation relation) const {
    using amount = intersection_options::amount;
    const auto [low, high] = std::minmax({element_of(a), element_of(b)});
    const intersection_kind kind = kind_of_sizes(low.size, high.size);
    found.counts.add(kind, relation);
    if (options_.wanted == amount::count) return;
    found.pairs[static_cast<std::size_t>(kind)].push_back({low, high, relation});
    if (options_.wanted == amount::first) throw found_first{};
}

void intersection_finder::decide_adjacent(const vertex_fans& fans) {
    const std::span<const face> elements = search_.resting_elements();
    const std::size_t vertices = positions_.vertices;
    // Vertices with elements that may intersect, and these elements.
    std::vector<std::uint8_t> is_open(vertices);
    for_each_range(vertices, 1024, [&](std::size_t begin, std::size_t end) {
        stop_if_requested(options_.stop);
        for (std::size_t v = begin; v < end; ++v)
            is_open[v] = !fans.certainly_free(static_cast<vertex_index>(v), positions_.before);
    });
    struct use {
        vertex_index vertex, element;
        auto operator<=>(const use&) const = default;
    };
    if (std::ranges::find(is_open, 1) == is_open.end()) return;
    const std::size_t shares = shares_of(elements.size());
    const std::vector<use> uses = sorted_by_vertex<use>(
        shares, static_cast<vertex_index>(vertices),
        [&](std::size_t share, const auto& visit) {
            for (std::size_t i = begin_of_share(share, shares, elements.size());
                 i < begin_of_share(share + 1, shares, elements.size()); ++i)
                for_each_vertex(elements[i], [&](vertex_index v) {
                    if (is_open[v] != 0) visit(use{v, static_cast<vertex_index>(i)});
                });
        },
        [](const use& u) { return u.vertex; });
    const auto is_first_common = [&](vertex_index v, const face& a, const face& b) {
        for (const vertex_index w : simplex_vertices(a))
            if (share_vertex(std::array{w}, b) && (w < v || is_open[w] == 0)) return false;
        return true;
    };
    for_each_range(uses.size(), 64, [&](std::size_t begin, std::size_t end) {
        stop_if_requested(options_.stop);
        found_by_thread& found = found_.local();
        for (std::size_t i = begin; i < end; ++i)
            for (std::size_t j = i + 1; j < uses.size() && uses[j].vertex == uses[i].vertex; ++j) {
                const face &a = elements[uses[i].element], &b = elements[uses[j].element];
                if (is_first_common(uses[i].vertex, a, b)) decide(found, a, b);
            }
    });
}

intersection_result intersection_finder::take() {
    intersection_result all;
    const std::vector<found_by_thread*> parts = found_.all();
    for (const found_by_thread* found : parts) {
        all.edge_faces.insert(all.edge_faces.end(), found->edge_faces.begin(),
                              found->edge_faces.end());
        all.counts += found->counts;
    }
    std::ranges::sort(all.edge_faces);
    all.edge_faces.erase(std::unique(all.edge_faces.begin(), all.edge_faces.end()),
                         all.edge_faces.end());
    if (options_.wanted == intersection_options::amount::count) return all;
    all.pairs.reserve(all.counts.total());
    for (std::size_t kind = 0; kind < intersection_kinds.size(); ++kind) {
        std::vector<std::vector<found_pair>*> lists;
        for (found_by_thread* found : parts) lists.push_back(&found->pairs[kind]);
        if (lists.empty()) break;
        for (const found_pair& pair : sorted_by_vertex<found_pair>(
                 lists.size(), static_cast<vertex_index>(positions_.vertices),
                 [&](std::size_t list, const auto&visit) {
                     for (const found_pair& pair : *lists[list]) visit(pair);
                 },
                 [](const found_pair&pair) { return pair.a.indices[0]; }))
            all.pairs.push_back({pair.a, pair.b, pair.how});
    }
    if (options_.wanted == intersection_options::amount::first && all.pairs.size() > 1) {
        all.pairs.resize(1);
        all.counts = {};
        all.counts.add(all.pairs[0].kind(), all.pairs[0].relation);
    }
    if (options_.segments)
        for_each_range(all.pairs.size(), 64, [&](std::size_t begin, std::size_t end) {
            stop_if_requested(options_.stop);
            for (std::size_t i = begin; i < end; ++i)
                if (all.pairs[i].relation == relation::crossing)
                    all.pairs[i].segment =
                        segment_of(positions_, search_.is_in_plane(), all.pairs[i]);
        });
    return all;
}

/// The search in the mesh in which the first vertex of each position replaces the others.
candidate_search merged(const candidate_search& search, const vertex_rows& positions) {
    const auto position = [&](vertex_index v) {
        const double* x = positions.before + 3 * std::size_t(v);
        return std::tie(x[0], x[1], x[2]);
    };
    std::vector<vertex_index> first(positions.vertices), order(positions.vertices);
    std::iota(order.begin(), order.end(), vertex_index(0));
    std::ranges::sort(order, [&](vertex_index v, vertex_index w) {
        return std::tuple_cat(position(v), std::tie(v)) < std::tuple_cat(position(w), std::tie(w));
    });
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool repeats = i > 0 && position(order[i]) == position(order[i - 1]);
        first[order[i]] = repeats ? first[order[i - 1]] : order[i];
    }
    std::vector<face> faces;
    std::vector<edge> edges;
    for (const face& e : search.resting_elements()) {
        const face f{first[e[0]], first[e[1]], first[e[2]]};
        if (search.is_point(e) || search.is_rod(e))
            edges.push_back({f[0], f[1]});
        else
            faces.push_back(f);
    }
    return candidate_search::at_start(faces, edges, positions.vertices, search.is_in_plane());
}

}  // namespace

intersection_result find_intersections(candidate_search& search, std::optional<vertex_fans>& fans,
                                       const vertex_rows& positions,
                                       const intersection_options& options,
                                       const batch_positions* of_step) {
    search.skip_unused(options.filter.skip_unused);
    if (options.merge_equal_positions) {
        intersection_options without = options;
        without.merge_equal_positions = false;
        without.filter.skip_unused = true;
        candidate_search of_merged = merged(search, positions);
        std::optional<vertex_fans> of_its_elements;
        return find_intersections(of_merged, of_its_elements, positions, without);
    }
    intersection_finder finder(search, positions, options);
    const step_options searching{
        .set = options.set, .stop = options.stop, .filter = options.filter};
    const resting_visitor decide = [&](auto elements, auto pairs) {
        finder.decide(elements, pairs);
    };
    const bool one_suffices = options.wanted == intersection_options::amount::first;
    try {
        if (of_step != nullptr) {
            search.find_at_start(*of_step, searching, decide, candidate_search::trees::of_last_find,
                                 one_suffices);
        } else {
            const vertex_rows at_rest(positions.before, positions.before, positions.vertices);
            const rounded_positions rounded(at_rest);
            search.find_at_start({at_rest, rounded}, searching, decide,
                                 candidate_search::trees::new_ones, one_suffices);
        }
        if (!fans) fans.emplace(search.resting_elements(), positions.vertices);
        finder.decide_adjacent(*fans);
    } catch (const intersection_finder::found_first&) {
        return finder.take();
    }
    return finder.take();
}

}  // namespace detail

intersection_result intersections(std::span<const face> faces, std::span<const edge> edges,
                                  std::span<const point<double>> positions,
                                  const intersection_options& options) {
    detail::stopwatch watch;
    detail::check_elements(faces, edges, positions.size(), "ccd::intersections");
    const vertex_rows rows(positions, positions);
    detail::check_at_rest(rows, positions.size(), options.filter);
    intersection_result result;
    detail::on_threads(options.threads, [&] {
        auto search = detail::candidate_search::at_start(faces, edges, positions.size());
        std::optional<detail::vertex_fans> fans;
        result = detail::find_intersections(search, fans, rows, options);
    });
    result.seconds = watch.lap();
    return result;
}
intersection_result intersections(const mesh& mesh, const intersection_options& options) {
    return intersections(mesh.faces, mesh.edges, mesh.vertices, options);
}

bool is_free_of_intersections(const mesh& mesh, intersection_options options) {
    options.wanted = intersection_options::amount::first;
    options.segments = options.edge_faces = false;
    return intersections(mesh, options).is_free();
}

}  // namespace ccd
