// One step of a mesh: candidates by sweep and prune, then one decision per candidate.
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <ccd/step.hpp>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace ccd {
namespace {

/// A closed axis-aligned box of exact doubles.
struct box {
    std::array<double, 3> low, high;
};

template <std::size_t N>
box swept_box(const mesh& before, const mesh& after, const std::array<index, N>& vertices) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    box b{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    for (const index v : vertices)
        for (const mesh* frame : {&before, &after}) {
            const point<double>& p = frame->vertices[v];
            const std::array<double, 3> x{p.x, p.y, p.z};
            for (std::size_t k = 0; k < 3; ++k) {
                b.low[k] = std::min(b.low[k], x[k]);
                b.high[k] = std::max(b.high[k], x[k]);
            }
        }
    return b;
}

template <std::size_t N>
std::vector<box> swept_boxes(const mesh& before, const mesh& after,
                             const std::vector<std::array<index, N>>& elements) {
    std::vector<box> boxes(elements.size());
    std::ranges::transform(elements, boxes.begin(),
                           [&](const auto& element) { return swept_box(before, after, element); });
    return boxes;
}

/// Boxes in ascending order of their lower end on one axis.
struct sorted_boxes {
    std::vector<index> order;  ///< position in the order -> element
    std::vector<box> boxes;    ///< in that order
    std::size_t axis;

    sorted_boxes(const std::vector<box>& unsorted, std::size_t along)
        : order(unsorted.size()), boxes(unsorted.size()), axis(along) {
        std::iota(order.begin(), order.end(), index(0));
        std::ranges::sort(order, {}, [&](index i) { return unsorted[i].low[along]; });
        std::ranges::transform(order, boxes.begin(), [&](index i) { return unsorted[i]; });
    }
    double low(std::size_t i) const { return boxes[i].low[axis]; }
    double high(std::size_t i) const { return boxes[i].high[axis]; }
    /// The first position whose lower end is not less than x (`after`: greater than x).
    std::size_t first_from(double x, bool after) const {
        const auto key = [this](const box& b) { return b.low[axis]; };
        const auto found = after ? std::ranges::upper_bound(boxes, x, {}, key)
                                 : std::ranges::lower_bound(boxes, x, {}, key);
        return static_cast<std::size_t>(found - boxes.begin());
    }
};

/// Whether the boxes touch on the two axes other than `axis`.
bool touch_beside(const box& a, const box& b, std::size_t axis) {
    for (std::size_t k = 0; k < 3; ++k)
        if (k != axis && (a.low[k] > b.high[k] || b.low[k] > a.high[k])) return false;
    return true;
}

using index_pair = std::pair<index, index>;

/// Pairs collected by all threads, in no particular order.
class pair_collector {
  public:
    std::vector<index_pair>& local() { return parts_.local(); }
    std::vector<index_pair> all() const {
        std::vector<index_pair> pairs;
        for (const auto& part : parts_) pairs.insert(pairs.end(), part.begin(), part.end());
        return pairs;
    }

  private:
    tbb::enumerable_thread_specific<std::vector<index_pair>> parts_;
};

/// For each box of `from`, those of `to` that begin within it (`after`: not at its very start)
/// and touch it. `emit(i, j, pairs)` gets element numbers.
template <class Emit>
void sweep(const sorted_boxes& from, const sorted_boxes& to, bool after, bool same_list,
           pair_collector& collected, const Emit& emit) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, from.boxes.size(), 256),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          auto& pairs = collected.local();
                          for (std::size_t i = range.begin(); i < range.end(); ++i) {
                              std::size_t j = same_list ? i + 1 : to.first_from(from.low(i), after);
                              for (; j < to.boxes.size() && to.low(j) <= from.high(i); ++j)
                                  if (touch_beside(from.boxes[i], to.boxes[j], from.axis))
                                      emit(from.order[i], to.order[j], pairs);
                          }
                      });
}

/// The axis along which the boxes' middles vary most: the sweep then meets fewest others.
std::size_t widest_axis(const std::vector<box>& boxes) {
    std::array<double, 3> spread{};
    for (std::size_t k = 0; k < 3; ++k) {
        // Halved before adding: the sum of two finite coordinates may overflow.
        const auto middle = [k](const box& b) { return b.low[k] / 2 + b.high[k] / 2; };
        double mean = 0;
        for (const box& b : boxes) mean += middle(b) / static_cast<double>(boxes.size());
        for (const box& b : boxes) spread[k] += std::abs(middle(b) - mean);
    }
    return static_cast<std::size_t>(std::ranges::max_element(spread) - spread.begin());
}

template <std::size_t A, std::size_t B>
bool share_vertex(const std::array<index, A>& a, const std::array<index, B>& b) {
    return std::ranges::any_of(a, [&](index v) { return std::ranges::find(b, v) != b.end(); });
}

std::vector<index_pair> vertex_face_candidates(const std::vector<box>& vertex_boxes,
                                               const std::vector<box>& face_boxes,
                                               const std::vector<face>& faces) {
    const std::size_t axis = widest_axis(face_boxes);
    const sorted_boxes vertices(vertex_boxes, axis), triangles(face_boxes, axis);
    pair_collector collected;
    const auto keep = [&faces](index v, index f, std::vector<index_pair>& pairs) {
        if (std::ranges::find(faces[f], v) == faces[f].end()) pairs.emplace_back(v, f);
    };
    // Of two touching boxes one begins within the other; equal starts belong to the first sweep.
    sweep(vertices, triangles, false, false, collected, keep);
    sweep(triangles, vertices, true, false, collected,
          [&keep](index f, index v, std::vector<index_pair>& pairs) { keep(v, f, pairs); });
    return collected.all();
}

std::vector<index_pair> edge_edge_candidates(const std::vector<box>& edge_boxes,
                                             const std::vector<edge>& edges) {
    const sorted_boxes sorted(edge_boxes, widest_axis(edge_boxes));
    pair_collector collected;
    sweep(sorted, sorted, false, true, collected,
          [&edges](index i, index j, std::vector<index_pair>& pairs) {
              if (!share_vertex(edges[i], edges[j]))
                  pairs.emplace_back(std::min(i, j), std::max(i, j));
          });
    return collected.all();
}

/// The candidates that `decides` does not certify as separate.
template <class Decides>
std::vector<index_pair> reported(const std::vector<index_pair>& candidates,
                                 const Decides& decides) {
    pair_collector collected;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, candidates.size(), 1024),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          auto& pairs = collected.local();
                          for (std::size_t i = range.begin(); i < range.end(); ++i)
                              if (decides(candidates[i].first, candidates[i].second))
                                  pairs.push_back(candidates[i]);
                      });
    return collected.all();
}

void check(const mesh& before, const mesh& after) {
    if (before.faces != after.faces || before.vertices.size() != after.vertices.size())
        throw std::invalid_argument("ccd::step: the two frames differ in topology");
    if (before.vertices.size() > std::numeric_limits<index>::max())
        throw std::invalid_argument("ccd::step: more vertices than an index can name");
    for (const face& f : before.faces)
        for (const index v : f)
            if (v >= before.vertices.size())
                throw std::invalid_argument("ccd::step: a face names vertex " + std::to_string(v) +
                                            " of " + std::to_string(before.vertices.size()));
    for (const mesh* frame : {&before, &after})
        for (const point<double>& p : frame->vertices)
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
                throw std::invalid_argument("ccd::step: a coordinate is not finite");
}

face ascending(face f) {
    std::ranges::sort(f);
    return f;
}

step_result run_step(const mesh& before, const mesh& after, method m) {
    using clock = std::chrono::steady_clock;
    const auto seconds_since = [](clock::time_point start) {
        return std::chrono::duration<double>(clock::now() - start).count();
    };
    step_result result;
    const auto broad_start = clock::now();
    const std::vector<edge> edges = unique_edges(before.faces);
    std::vector<std::array<index, 1>> vertices(before.vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) vertices[i] = {static_cast<index>(i)};
    const auto vf = vertex_face_candidates(swept_boxes(before, after, vertices),
                                           swept_boxes(before, after, before.faces), before.faces);
    const auto ee = edge_edge_candidates(swept_boxes(before, after, edges), edges);
    result.vertex_face_candidates = vf.size();
    result.edge_edge_candidates = ee.size();
    result.broad_phase_seconds = seconds_since(broad_start);

    const auto narrow_start = clock::now();
    const auto moving = [&](index v) {
        return moving_point<double>{before.vertices[v], after.vertices[v]};
    };
    for (const auto& [v, f] : reported(vf, [&](index i, index j) {
             const face& t = before.faces[j];
             return may_collide(decide(
                 m,
                 vertex_face<double>{
                     .v = moving(i), .f0 = moving(t[0]), .f1 = moving(t[1]), .f2 = moving(t[2])}));
         }))
        result.vertex_face.push_back({v, ascending(before.faces[f])});
    for (const auto& [a, b] : reported(ee, [&](index i, index j) {
             return may_collide(decide(m, edge_edge<double>{.a0 = moving(edges[i][0]),
                                                            .a1 = moving(edges[i][1]),
                                                            .b0 = moving(edges[j][0]),
                                                            .b1 = moving(edges[j][1])}));
         }))
        result.edge_edge.push_back({edges[a], edges[b]});  // edges are sorted, and a < b
    std::ranges::sort(result.vertex_face);
    std::ranges::sort(result.edge_edge);
    result.narrow_phase_seconds = seconds_since(narrow_start);
    return result;
}

}  // namespace

std::vector<edge> unique_edges(const std::vector<face>& faces) {
    std::vector<edge> edges;
    edges.reserve(3 * faces.size());
    for (const face& f : faces)
        for (std::size_t k = 0; k < 3; ++k) {
            const index v = f[k], w = f[(k + 1) % 3];
            if (v != w) edges.push_back({std::min(v, w), std::max(v, w)});
        }
    std::ranges::sort(edges);
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

step_result step(const mesh& before, const mesh& after, const step_options& options) {
    check(before, after);
    const int cores = tbb::info::default_concurrency();
    tbb::task_arena arena(options.threads > 0 ? std::min(options.threads, cores) : cores);
    step_result result;
    arena.execute([&] { result = run_step(before, after, options.method); });
    result.threads = arena.max_concurrency();
    return result;
}

}  // namespace ccd
