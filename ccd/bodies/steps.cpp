#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <ccd/bodies/steps.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "ccd/batch/checks.hpp"
#include "ccd/batch/threads.hpp"
#include "ccd/bodies/swept_points.hpp"
#include "ccd/exact/finite.hpp"
#include "ccd/step/checks.hpp"
#include "ccd/step/elements.hpp"
#include "ccd/step/trees/box_tree.hpp"
#include "ccd/step/vertex_order.hpp"

namespace ccd {
namespace {

using detail::box;
using detail::box_tree;

/// Elements of N vertices of one body, in an order that gathers neighbours, and their tree.
template <std::size_t N>
struct element_set {
    std::vector<std::array<vertex_index, N>> elements;
    box_tree<double> tree;

    void build(const std::vector<box<double>>& of_vertices) {
        tree.build(elements.size(), [&](std::size_t i) {
            box<double> all = of_vertices[elements[i][0]];
            for (const vertex_index v : elements[i])
                for (std::size_t k = 0; k < 3; ++k) {
                    all.low[k] = std::min(all.low[k], of_vertices[v].low[k]);
                    all.high[k] = std::max(all.high[k], of_vertices[v].high[k]);
                }
            return all;
        });
    }
};

/// A body's mesh, and the boxes of its elements in the last step for which it had a partner.
class swept_body {
  public:
    swept_body(mesh rest, vertex_index first_vertex)
        : rest_(std::move(rest)), first_vertex_(first_vertex) {
        if (rest_.vertices.empty()) return;
        extent_ = {{inf, inf, inf}, {-inf, -inf, -inf}};
        for (const auto& p : rest_.vertices)
            for (std::size_t k = 0; k < 3; ++k) {
                const double x = std::array{p.x, p.y, p.z}[k];
                extent_.low[k] = std::min(extent_.low[k], x);
                extent_.high[k] = std::max(extent_.high[k], x);
            }
    }

    const mesh& rest() const { return rest_; }
    vertex_index first_vertex() const { return first_vertex_; }
    const box<double>& extent() const { return extent_; }

    /// Sets the elements' boxes, widened by `distance`. Keeps those of the last motion.
    void sweep(const body_motion& motion, double distance) {
        if (swept_ == std::pair(motion, distance)) return;
        swept_.reset();
        set_elements();
        const detail::swept_points points(motion, extent_);
        boxes_.resize(rest_.vertices.size());
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, boxes_.size(), 1024), [&](const auto& range) {
                for (std::size_t v = range.begin(); v < range.end(); ++v)
                    boxes_[v] = detail::widened(points.box_of(rest_.vertices[v]), distance);
            });
        vertices.build(boxes_);
        points_.build(boxes_);
        edges.build(boxes_);
        rods.build(boxes_);
        faces.build(boxes_);
        swept_ = {motion, distance};
    }

    element_set<1> vertices, points_;  ///< points are vertices of no edge
    element_set<2> edges, rods;        ///< rods are edges of no face
    element_set<3> faces;

  private:
    static constexpr double inf = std::numeric_limits<double>::infinity();

    void set_elements() {
        if (!vertices.elements.empty()) return;
        edges.elements = unique_edges(rest_.faces, rest_.edges);
        rods.elements = detail::without(edges.elements, unique_edges(rest_.faces));
        faces.elements = unique_faces(rest_.faces);
        std::vector<bool> on_an_edge(rest_.vertices.size());
        for (const edge& e : edges.elements) on_an_edge[e[0]] = on_an_edge[e[1]] = true;
        for (vertex_index v = 0; v < rest_.vertices.size(); ++v) {
            vertices.elements.push_back({v});
            if (!on_an_edge[v]) points_.elements.push_back({v});
        }
        const vertex_rows rows(rest_, rest_);
        const pair_distances contact;
        const detail::swept_boxes boxes(detail::batch_positions(rows), contact);
        detail::vertex_order order;
        order.find<double>(boxes, rest_.vertices.size(), std::span<const edge>(edges.elements));
        const auto sort = [&](auto& set) {
            if (!set.elements.empty()) order.sort<double>(set.elements, boxes);
        };
        sort(vertices);
        sort(points_);
        sort(edges);
        sort(rods);
        sort(faces);
    }

    mesh rest_;
    vertex_index first_vertex_;
    box<double> extent_{};
    std::vector<box<double>> boxes_;
    std::optional<std::pair<body_motion, double>> swept_;  ///< of the boxes
};

template <kind K>
struct timed_pair {
    pair_of_kind<K> pair;
    first_time time;
};
template <kind K>
using timed_pairs = std::vector<timed_pair<K>>;
struct findings {
    by_kind<timed_pairs> pairs;
    pair_counts candidates;
};

/// Calls visit(i, j), i < j, for all boxes that touch. Cost: O(n log n + n m) for m boxes that
/// overlap along x at a time.
template <class Visit>
void for_each_two_touching(const std::vector<box<double>>& boxes, const Visit& visit) {
    std::vector<std::size_t> by_low(boxes.size()), active;
    std::iota(by_low.begin(), by_low.end(), std::size_t{0});
    std::ranges::sort(by_low, {}, [&](std::size_t i) { return std::pair(boxes[i].low[0], i); });
    for (const std::size_t i : by_low) {
        std::erase_if(active, [&](std::size_t j) { return boxes[j].high[0] < boxes[i].low[0]; });
        for (const std::size_t j : active) {
            bool touch = true;
            for (std::size_t k = 1; k < 3; ++k)
                touch &= boxes[i].low[k] <= boxes[j].high[k] && boxes[j].low[k] <= boxes[i].high[k];
            if (touch) visit(std::min(i, j), std::max(i, j));
        }
        active.push_back(i);
    }
}

template <std::size_t N>
std::array<vertex_index, N> numbered(std::array<vertex_index, N> element, const swept_body& body) {
    for (vertex_index& v : element) v += body.first_vertex();
    return element;
}

bool is_after_start(const first_time& time) {
    return time.outcome == outcome::collides && !time.at_start();
}

/// Sorts the pairs of all threads into the result.
void collect(tbb::enumerable_thread_specific<findings>& found, body_step_result& result) {
    result.first_contact = {outcome::separate, 0, 0};
    for_each_kind([&]<kind K>() {
        timed_pairs<K> all;
        for (findings& f : found) {
            const auto& own = f.pairs.of<K>();
            all.insert(all.end(), own.begin(), own.end());
            result.candidates.of<K>() += f.candidates.of<K>();
        }
        std::ranges::sort(all, {}, &timed_pair<K>::pair);
        for (const auto& [pair, time] : all) {
            result.pairs.of<K>().push_back(pair);
            result.times.of<K>().push_back(time);
            if (is_after_start(time))
                detail::add_first(time, pair, result);
            else
                result.touching_at_start.of<K>().push_back(pair);
        }
    });
}

}  // namespace

struct body_steps::state {
    std::vector<swept_body> bodies;
    std::vector<vertex_index> first_vertices;

    void check(std::span<const body_motion> motions, const body_step_options& options) const {
        if (motions.size() != bodies.size())
            throw std::invalid_argument("ccd::body_steps: number of motions is " +
                                        std::to_string(motions.size()) + "; expected " +
                                        std::to_string(bodies.size()) + ", one for each body");
        for (std::size_t b = 0; b < motions.size(); ++b)
            if (const std::string fault = fault_of(motions[b]); !fault.empty())
                throw std::invalid_argument("ccd::body_steps: motion of body " + std::to_string(b) +
                                            ": " + fault);
        detail::check_t_max("ccd::body_steps", options.t_max);
        for (const double d : {options.distance.first, options.distance.second})
            detail::check_distances("ccd::body_steps", {.all = d}, first_vertices.back());
    }

    /// Returns each two bodies, of which one moves, whose swept boxes touch.
    std::vector<std::pair<std::size_t, std::size_t>> partners(
        std::span<const body_motion> motions, double distance,
        const body_step_options& options) const {
        std::vector<std::size_t> used;  // bodies with vertices
        std::vector<box<double>> boxes;
        for (std::size_t b = 0; b < motions.size(); ++b) {
            const swept_body& body = bodies[b];
            if (body.rest().vertices.empty()) continue;
            used.push_back(b);
            const auto all = detail::swept_points(motions[b], body.extent()).box_of_all();
            boxes.push_back(detail::widened(all, moves(motions[b]) ? distance : 0));
        }
        std::vector<std::pair<std::size_t, std::size_t>> all;
        for_each_two_touching(boxes, [&](std::size_t i, std::size_t j) {
            const std::size_t a = used[i], b = used[j];
            if (!moves(motions[a]) && !moves(motions[b])) return;
            if (options.may_touch && !options.may_touch(a, b)) return;
            all.emplace_back(a, b);
        });
        return all;
    }

    /// Decides all pairs of element sets whose boxes touch.
    template <kind K, std::size_t A, std::size_t B>
    void decide(const body_steps& steps, const std::array<std::size_t, 2>& of,
                const element_set<A>& a, const element_set<B>& b,
                std::span<const body_motion> motions, const body_step_options& options,
                tbb::enumerable_thread_specific<findings>& found) const {
        if (a.elements.empty() || b.elements.empty()) return;
        const swept_body &first = bodies[of[0]], &second = bodies[of[1]];
        detail::for_each_touching(
            a.tree, b.tree,
            [&]() -> findings& {
                detail::stop_if_requested(options.stop);
                return found.local();
            },
            [&](findings& local, std::size_t i, std::size_t j, bool) {
                const auto pair = detail::candidate_of(numbered(a.elements[i], first),
                                                       numbered(b.elements[j], second));
                ++local.candidates.template of<K>();
                const auto query = steps.query_of(pair, motions);
                const first_time time = time_within(query, options.distance, options.t_max);
                if (time.outcome != outcome::separate)
                    local.pairs.template of<K>().push_back({detail::canonical(pair), time});
            });
    }

    void decide_bodies(const body_steps& steps, std::size_t i, std::size_t j,
                       std::span<const body_motion> motions, const body_step_options& options,
                       tbb::enumerable_thread_specific<findings>& found) const {
        const auto decide_kind = [&]<kind K>(std::size_t first, std::size_t second, const auto& a,
                                             const auto& b) {
            decide<K>(steps, {first, second}, a, b, motions, options, found);
        };
        const swept_body &a = bodies[i], &b = bodies[j];
        decide_kind.operator()<kind::vertex_face>(i, j, a.vertices, b.faces);
        decide_kind.operator()<kind::vertex_face>(j, i, b.vertices, a.faces);
        decide_kind.operator()<kind::edge_edge>(i, j, a.edges, b.edges);
        decide_kind.operator()<kind::vertex_edge>(i, j, a.points_, b.rods);
        decide_kind.operator()<kind::vertex_edge>(j, i, b.points_, a.rods);
        decide_kind.operator()<kind::vertex_vertex>(i, j, a.points_, b.points_);
    }
};

body_steps::body_steps(std::vector<mesh> meshes) : state_(std::make_unique<state>()) {
    std::size_t vertices = 0;
    for (std::size_t b = 0; b < meshes.size(); ++b) {
        const std::string caller = "ccd::body_steps: body " + std::to_string(b);
        mesh& m = meshes[b];
        detail::check_elements(m.faces, m.edges, m.vertices.size(), caller);
        for (std::size_t v = 0; v < m.vertices.size(); ++v)
            if (!std::isfinite(m.vertices[v].x) || !std::isfinite(m.vertices[v].y) ||
                !std::isfinite(m.vertices[v].z))
                throw std::invalid_argument(caller + ": vertex " + std::to_string(v) +
                                            " is not finite; expected finite coordinates");
        if (vertices + m.vertices.size() > std::numeric_limits<vertex_index>::max())
            throw std::invalid_argument(
                "ccd::body_steps: number of all vertices is too large; expected fewer than 2^32");
        state_->first_vertices.push_back(static_cast<vertex_index>(vertices));
        vertices += m.vertices.size();
        state_->bodies.emplace_back(std::move(m), state_->first_vertices.back());
    }
    state_->first_vertices.push_back(static_cast<vertex_index>(vertices));
}
body_steps::~body_steps() = default;
body_steps::body_steps(body_steps&&) noexcept = default;
body_steps& body_steps::operator=(body_steps&&) noexcept = default;

std::size_t body_steps::bodies() const {
    return state_->bodies.size();
}
vertex_index body_steps::first_vertex(std::size_t body) const {
    return state_->first_vertices[body];
}
std::size_t body_steps::body_of(vertex_index vertex) const {
    const auto& first = state_->first_vertices;
    return static_cast<std::size_t>(std::ranges::upper_bound(first, vertex) - first.begin()) - 1;
}
const mesh& body_steps::rest(std::size_t body) const {
    return state_->bodies[body].rest();
}

body_step_result body_steps::run(std::span<const body_motion> motions,
                                 const body_step_options& options) {
    state_->check(motions, options);
    const double distance = options.distance.first == 0 && options.distance.second == 0
                                ? 0
                                : std::nextafter(options.distance.first + options.distance.second,
                                                 std::numeric_limits<double>::infinity());
    body_step_result result;
    const auto partners = state_->partners(motions, distance, options);
    result.body_pairs = partners.size();
    tbb::enumerable_thread_specific<findings> found;
    detail::on_threads(options.threads, [&] {
        std::vector<bool> is_swept(motions.size());
        for (const auto& [a, b] : partners)
            for (const std::size_t body : {a, b}) {
                if (!is_swept[body])
                    state_->bodies[body].sweep(motions[body], moves(motions[body]) ? distance : 0);
                is_swept[body] = true;
            }
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, partners.size(), 1), [&](const auto& range) {
                for (std::size_t i = range.begin(); i < range.end(); ++i)
                    state_->decide_bodies(*this, partners[i].first, partners[i].second, motions,
                                          options, found);
            });
    });
    collect(found, result);
    return result;
}

body_motion until(const body_motion& motion, double fraction) {
    if (fraction == 1) return motion;
    const auto between = [&](double a, double b) { return a == b ? a : std::lerp(a, b, fraction); };
    const auto position = [&](const point<double>& a, const point<double>& b) {
        return point<double>{between(a.x, b.x), between(a.y, b.y), between(a.z, b.z)};
    };
    body_motion part = motion;
    if (auto* affine = std::get_if<affine_motion>(&part)) {
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j)
                affine->a1[i][j] = between(affine->a0[i][j], affine->a1[i][j]);
        affine->p1 = position(affine->p0, affine->p1);
    } else if (auto* rigid = std::get_if<rigid_motion>(&part)) {
        const quaternion &a = rigid->q0, b = rigid->q1;
        rigid->q1 = {between(a.w, b.w), between(a.x, b.x), between(a.y, b.y), between(a.z, b.z)};
        rigid->p1 = position(rigid->p0, rigid->p1);
    }
    return part;
}

body_advance body_steps::advance(std::span<const body_motion> motions,
                                 const body_advance_options& options) {
    detail::check_shares(options.conservative, 0, "ccd::body_steps");
    body_step_options step = options.step;
    step.t_max = 1;
    body_advance result;
    result.motions.assign(motions.begin(), motions.end());
    body_step_result found = run(motions, step);
    result.first_contact = found.first_contact;
    result.first_pairs = std::move(found.first_pairs);
    result.touching_at_start = std::move(found.touching_at_start);
    // Each round gives up more of the way, at last all of it. Without motion no contact is new.
    double lost = 0x1p-52;
    for (first_time contact = result.first_contact; is_after_start(contact);) {
        const double share = lost > 0x1p-52 ? 1 : options.conservative;
        result.fraction *= share * contact.low * (1 - std::min(lost, 1.0));
        for (std::size_t b = 0; b < motions.size(); ++b)
            result.motions[b] = until(motions[b], result.fraction);
        contact = run(result.motions, step).first_contact;
        lost *= 4;
    }
    return result;
}

}  // namespace ccd
