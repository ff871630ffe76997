#include <algorithm>
#include <array>
#include <ccd/bodies/steps.hpp>
#include <ccd/methods/transform.hpp>
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
#include "ccd/contact/turning/two_bodies.hpp"
#include "ccd/exact/finite.hpp"
#include "ccd/step/checks.hpp"
#include "ccd/step/elements.hpp"
#include "ccd/step/trees/box_tree.hpp"
#include "ccd/step/vertex_order.hpp"

namespace ccd {
namespace {

using detail::box;
using detail::box_tree;

bool touch(const box<double>& a, const box<double>& b) {
    bool all = true;
    for (std::size_t k = 0; k < 3; ++k) all &= a.low[k] <= b.high[k] && b.low[k] <= a.high[k];
    return all;
}
/// Extends `all`.
void include(const box<double>& b, box<double>& all) {
    for (std::size_t k = 0; k < 3; ++k) {
        all.low[k] = std::min(all.low[k], b.low[k]);
        all.high[k] = std::max(all.high[k], b.high[k]);
    }
}
constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double largest = std::numeric_limits<double>::max();
constexpr box<double> empty_box{{inf, inf, inf}, {-inf, -inf, -inf}};

/// Elements of N vertices of one body, in an order that gathers neighbours, and a tree of boxes.
template <std::size_t N>
struct element_set {
    std::vector<std::array<vertex_index, N>> elements;
    box_tree<double> tree;

    /// Builds the tree from a box of each vertex.
    template <class BoxOf>
    void build(const BoxOf& box_of) {
        tree.build(elements.size(), [&](std::size_t i) { return box_of_element(i, box_of); });
    }
    template <class BoxOf>
    box<double> box_of_element(std::size_t i, const BoxOf& box_of) const {
        box<double> all = empty_box;
        for (const vertex_index v : elements[i]) include(box_of(v), all);
        return all;
    }
};

struct element_sets {
    element_set<1> vertices, points;  ///< points are vertices of no edge
    element_set<2> edges, rods;       ///< rods are edges of no face
    element_set<3> faces;
};

/// A body during one step.
class swept_body {
  public:
    /// Divides the step until points are within 2^-8 of their chords, in units of their distance
    /// from the centre.
    swept_body(const body_motion& body, double distance) : motion(body), distance_(distance) {
        const double error = motion.chords().error_per_length;
        int parts = 1;
        while (parts < 8 && error > 0x1p-8 * parts * parts) parts *= 2;
        for (int i = 0; i < parts; ++i)
            chords_.emplace_back(body, static_cast<double>(i) / parts,
                                 static_cast<double>(i + 1) / parts);
        if (!(chords_[0].error_per_length < error)) chords_ = {motion.chords()};
    }

    /// Returns a box of the ways of the points of a box at rest, widened by the distance.
    box<double> box_of(const box<double>& b) const {
        box<double> all = empty_box;
        for (const auto& chords : chords_) {
            const std::array centre{chords.centre.x, chords.centre.y, chords.centre.z};
            std::array<double, 6> least = chords.shift, greatest = chords.shift;
            double length = 0;
            for (std::size_t j = 0; j < 3; ++j) {
                const double low = b.low[j] - centre[j], high = b.high[j] - centre[j];
                length += std::max(std::abs(low), std::abs(high));
                for (std::size_t k = 0; k < 6; ++k) {
                    const double p = chords.column[j][k] * low, q = chords.column[j][k] * high;
                    least[k] += std::min(p, q);
                    greatest[k] += std::max(p, q);
                }
            }
            include(least, greatest, chords.error_of(length), all);
        }
        return all;
    }
    box<double> box_of(const point<double>& x) const {
        box<double> all = empty_box;
        for (const auto& chords : chords_) {
            const auto& c = chords.centre;
            const point<double> y{x.x - c.x, x.y - c.y, x.z - c.z};
            const auto [p, q] = chords.ends_of(y);
            const std::array<double, 6> ends{p.x, p.y, p.z, q.x, q.y, q.z};
            include(ends, ends, chords.error_of(std::abs(y.x) + std::abs(y.y) + std::abs(y.z)),
                    all);
        }
        return all;
    }

    const prepared_motion motion;

  private:
    /// Extends `all` by the chords' ends. Their error also covers the rounding here.
    void include(const std::array<double, 6>& least, const std::array<double, 6>& greatest,
                 double error, box<double>& all) const {
        const double by = distance_ * (1 + 0x1p-40) + error;
        const bool bounded = by < 0x1p900;  // otherwise numbers may have overflowed
        for (std::size_t i = 0; i < 3; ++i) {
            const double low = std::min(least[i], least[3 + i]) - by,
                         high = std::max(greatest[i], greatest[3 + i]) + by;
            all.low[i] = bounded ? std::min(all.low[i], low) : -largest;
            all.high[i] = bounded ? std::max(all.high[i], high) : largest;
        }
    }

    std::vector<detail::motion_chords> chords_;
    double distance_;
};

/// A body's mesh, and trees of its elements at rest.
class body_at_rest {
  public:
    body_at_rest(mesh rest, vertex_index first_vertex)
        : rest_(std::move(rest)), first_vertex_(first_vertex) {
        for (const auto& p : rest_.vertices) include({{p.x, p.y, p.z}, {p.x, p.y, p.z}}, extent_);
    }

    const mesh& rest() const { return rest_; }
    vertex_index first_vertex() const { return first_vertex_; }
    const box<double>& extent() const { return extent_; }

    /// Sets the trees, at the first call. An exception leaves them unset.
    void prepare() {
        if (!sets_.vertices.elements.empty()) return;
        element_sets all;
        all.edges.elements = unique_edges(rest_.faces, rest_.edges);
        all.rods.elements = detail::without(all.edges.elements, unique_edges(rest_.faces));
        all.faces.elements = unique_faces(rest_.faces);
        std::vector<bool> on_an_edge(rest_.vertices.size());
        for (const edge& e : all.edges.elements) on_an_edge[e[0]] = on_an_edge[e[1]] = true;
        for (vertex_index v = 0; v < rest_.vertices.size(); ++v) {
            all.vertices.elements.push_back({v});
            if (!on_an_edge[v]) all.points.elements.push_back({v});
        }
        const vertex_rows rows(rest_, rest_);
        const pair_distances contact;
        const detail::swept_boxes boxes(detail::batch_positions(rows), contact);
        detail::vertex_order order;
        order.find<double>(boxes, rest_.vertices.size(), std::span<const edge>(all.edges.elements));
        const auto box_of = [&](vertex_index v) -> box<double> {
            const auto& p = rest_.vertices[v];
            return {{p.x, p.y, p.z}, {p.x, p.y, p.z}};
        };
        for_each_set(all, all, [&](auto& set, auto&) {
            if (set.elements.empty()) return;
            order.sort<double>(set.elements, boxes);
            set.build(box_of);
        });
        sets_ = std::move(all);
    }

    /// Returns the elements whose swept boxes touch the region, with trees of these boxes, and
    /// sets it to a box around them.
    element_sets near(const swept_body& swept, box<double>& region) const {
        element_sets found;
        box<double> all = empty_box;
        for_each_set(sets_, found, [&](const auto& set, auto& some) {
            std::vector<box<double>> boxes;
            set.tree.find_where(
                [&](const box<double>& b) { return touch(swept.box_of(b), region); },
                [&](std::size_t i) {
                    const box<double> b = set.box_of_element(
                        i, [&](vertex_index v) { return swept.box_of(rest_.vertices[v]); });
                    if (!touch(b, region)) return;
                    some.elements.push_back(set.elements[i]);
                    boxes.push_back(b);
                    include(b, all);
                });
            if (!boxes.empty())
                some.tree.build(boxes.size(), [&](std::size_t i) { return boxes[i]; });
        });
        region = all;
        return found;
    }

  private:
    /// Calls visit(set, other) for the sets of each kind.
    template <class Sets, class Visit>
    static void for_each_set(Sets& sets, element_sets& others, const Visit& visit) {
        visit(sets.vertices, others.vertices);
        visit(sets.points, others.points);
        visit(sets.edges, others.edges);
        visit(sets.rods, others.rods);
        visit(sets.faces, others.faces);
    }

    mesh rest_;
    vertex_index first_vertex_;
    box<double> extent_ = empty_box;
    element_sets sets_;
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
    std::vector<edge_face_pair> crossings;  ///< at t = 0
    std::size_t visited = 0;                ///< two elements whose boxes touch
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
            if (touch(boxes[i], boxes[j])) visit(std::min(i, j), std::max(i, j));
        }
        active.push_back(i);
    }
}

template <std::size_t N>
std::array<vertex_index, N> numbered(std::array<vertex_index, N> element,
                                     const body_at_rest& body) {
    for (vertex_index& v : element) v += body.first_vertex();
    return element;
}

bool is_after_start(const first_time& time) {
    return time.outcome == outcome::collides && !time.at_start();
}

/// Sorts the pairs of all threads into the result.
void collect(detail::per_thread<findings>& found, body_step_result& result) {
    result.first_contact = {outcome::separate, 0, 0};
    for_each_kind([&]<kind K>() {
        timed_pairs<K> all;
        for (const findings* f : found.all()) {
            const auto& own = f->pairs.of<K>();
            all.insert(all.end(), own.begin(), own.end());
            result.candidates.of<K>() += f->candidates.of<K>();
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
    for (const findings* f : found.all())
        result.crossing_at_start.insert(result.crossing_at_start.end(), f->crossings.begin(),
                                        f->crossings.end());
    std::ranges::sort(result.crossing_at_start);
}

}  // namespace

struct body_steps::state {
    std::vector<body_at_rest> bodies;
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

    /// The bodies that have vertices, during a step.
    struct swept_bodies {
        std::vector<std::size_t> index;  ///< of the body
        std::vector<swept_body> body;
        std::vector<box<double>> box_of_all;
    };
    swept_bodies sweep(std::span<const body_motion> motions, double distance) const {
        swept_bodies all;
        for (std::size_t b = 0; b < motions.size(); ++b) {
            if (bodies[b].rest().vertices.empty()) continue;
            all.index.push_back(b);
            all.body.emplace_back(motions[b], moves(motions[b]) ? distance : 0);
            all.box_of_all.push_back(all.body.back().box_of(bodies[b].extent()));
        }
        return all;
    }

    /// Returns each two of the swept bodies, of which one moves, whose boxes touch.
    std::vector<std::pair<std::size_t, std::size_t>> partners(
        const swept_bodies& swept, std::span<const body_motion> motions,
        const body_step_options& options) const {
        std::vector<std::pair<std::size_t, std::size_t>> all;
        for_each_two_touching(swept.box_of_all, [&](std::size_t i, std::size_t j) {
            const std::size_t a = swept.index[i], b = swept.index[j];
            if (!moves(motions[a]) && !moves(motions[b])) return;
            if (options.may_touch && !options.may_touch(a, b)) return;
            all.emplace_back(i, j);
        });
        return all;
    }

    /// The elements of a body near another.
    struct near_elements {
        const body_at_rest* body;
        const prepared_motion* motion;
        element_sets elements;

        bool has(vertex_index v) const {
            return v - body->first_vertex() < body->rest().vertices.size();
        }
        body_point point_of(vertex_index v) const {
            return motion->at(body->rest().vertices[v - body->first_vertex()]);
        }
    };

    /// Calls visit(local, x, y) for all elements x, y of the sets whose boxes touch.
    template <class First, class Second, class Visit>
    static void for_each_near(const near_elements& a, const First& of_a, const near_elements& b,
                              const Second& of_b, const body_step_options& options,
                              detail::per_thread<findings>& found, const Visit& visit) {
        if (of_a.elements.empty() || of_b.elements.empty()) return;
        detail::for_each_touching(
            of_a.tree, of_b.tree,
            [&]() -> findings& {
                detail::stop_if_requested(options.stop);
                return found.local();
            },
            [&](findings& local, std::size_t i, std::size_t j, bool) {
                if (++local.visited % 1024 == 0) detail::stop_if_requested(options.stop);
                visit(local, numbered(of_a.elements[i], *a.body),
                      numbered(of_b.elements[j], *b.body));
            });
    }

    /// Decides all pairs of element sets whose boxes touch.
    template <kind K, class First, class Second>
    static void decide(const near_elements& a, const First& of_a, const near_elements& b,
                       const Second& of_b, const body_step_options& options,
                       detail::per_thread<findings>& found) {
        for_each_near(
            a, of_a, b, of_b, options, found,
            [&](findings& local, const auto& of_first, const auto& of_second) {
                const auto pair = detail::candidate_of(of_first, of_second);
                ++local.candidates.template of<K>();
                const auto points = detail::with_members(
                    pair, [&](auto... v) { return std::array{(a.has(v) ? a : b).point_of(v)...}; });
                const first_time time = detail::first_within_of_bodies<K>(
                    points, options.distance, options.t_max, detail::answer::time, options.stop);
                if (time.outcome != outcome::separate)
                    local.pairs.template of<K>().push_back({detail::canonical(pair), time});
            });
    }

    /// Finds the edges of a that go through faces of b at t = 0.
    static void find_crossings(const near_elements& a, const near_elements& b,
                               const body_step_options& options,
                               detail::per_thread<findings>& found) {
        for_each_near(a, a.elements.edges, b, b.elements.faces, options, found,
                      [&](findings& local, edge e, face f) {
                          if (!detail::crosses_at_start(
                                  {a.point_of(e[0]), a.point_of(e[1])},
                                  {b.point_of(f[0]), b.point_of(f[1]), b.point_of(f[2])}))
                              return;
                          std::ranges::sort(e);
                          std::ranges::sort(f);
                          local.crossings.push_back({e, f});
                      });
    }

    /// The elements of the swept bodies p and q near each other.
    std::pair<near_elements, near_elements> near_each_other(const swept_bodies& swept,
                                                            std::size_t p, std::size_t q) const {
        box<double> region = swept.box_of_all[q];
        const auto near = [&](std::size_t i) -> near_elements {
            const body_at_rest& body = bodies[swept.index[i]];
            return {&body, &swept.body[i].motion, body.near(swept.body[i], region)};
        };
        near_elements a = near(p);
        return {std::move(a), near(q)};
    }

    /// Decides pairs of the swept bodies p and q.
    void decide_bodies(const swept_bodies& swept, std::size_t p, std::size_t q,
                       const body_step_options& options,
                       detail::per_thread<findings>& found) const {
        const auto [a, b] = near_each_other(swept, p, q);
        decide<kind::vertex_face>(a, a.elements.vertices, b, b.elements.faces, options, found);
        decide<kind::vertex_face>(b, b.elements.vertices, a, a.elements.faces, options, found);
        decide<kind::edge_edge>(a, a.elements.edges, b, b.elements.edges, options, found);
        decide<kind::vertex_edge>(a, a.elements.points, b, b.elements.rods, options, found);
        decide<kind::vertex_edge>(b, b.elements.points, a, a.elements.rods, options, found);
        decide<kind::vertex_vertex>(a, a.elements.points, b, b.elements.points, options, found);
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
    const auto swept = state_->sweep(motions, distance);
    const auto partners = state_->partners(swept, motions, options);
    result.body_pairs = partners.size();
    std::vector<body_motion> starts;
    if (options.check_start)
        for (const body_motion& motion : motions) starts.push_back(until(motion, 0));
    const auto at_start = state_->sweep(starts, 0);
    detail::per_thread<findings> found;
    detail::on_threads(options.threads, [&] {
        for (const auto& [p, q] : partners)
            for (const std::size_t body : {p, q}) state_->bodies[swept.index[body]].prepare();
        detail::for_each_index(partners.size(), [&](std::size_t i) {
            const auto [p, q] = partners[i];
            state_->decide_bodies(swept, p, q, options, found);
            if (!options.check_start || !touch(at_start.box_of_all[p], at_start.box_of_all[q]))
                return;
            const auto [a, b] = state_->near_each_other(at_start, p, q);
            state::find_crossings(a, b, options, found);
            state::find_crossings(b, a, options, found);
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
    result.crossing_at_start = std::move(found.crossing_at_start);
    step.check_start = false;
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
