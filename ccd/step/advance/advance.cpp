#include <algorithm>
#include <ccd/advance.hpp>
#include <ccd/contact.hpp>
#include <ccd/nearness.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "ccd/batch/checks.hpp"
#include "ccd/step/advance/advancing.hpp"
#include "ccd/step/checks.hpp"
#include "ccd/step/vertex_groups.hpp"

namespace ccd {
namespace {

void check(mesh_steps& steps, const vertex_rows& positions, const advance_options& options,
           const std::string& caller) {
    detail::check_shares(options.conservative, options.keep, caller);
    detail::short_steps(steps).check(
        positions, {.set = options.set, .distances = options.distances, .filter = options.filter},
        caller);
}

detail::vertex_groups groups_of(std::size_t vertices, std::span<const int> groups) {
    if (!groups.empty() && groups.size() != vertices)
        throw std::invalid_argument("ccd::advance: number of groups is " +
                                    std::to_string(groups.size()) + "; expected " +
                                    std::to_string(vertices) + ", one for each vertex");
    detail::vertex_groups made(vertices);
    if (groups.empty()) made.join_all();
    for (vertex_index v = 0; v < groups.size(); ++v) made.join_named(groups[v], v);
    return made;
}

/// Fractions of single vertices, from a result by groups up to the whole way. A pair in contact
/// limits its vertices first by a plane between its elements at the start, then to the fractions by
/// groups. With these, the pair is free, so this ends.
class vertex_limits {
  public:
    vertex_limits(mesh_steps& steps, const vertex_rows& way, const advance_options& options,
                  advance_result by_groups)
        : steps_(steps),
          way_(way),
          options_(options),
          base_(std::move(by_groups)),
          result_(base_),
          at_base_(way.vertices) {
        for (vertex_index v = 0; v < way.vertices; ++v) {
            result_.fractions[v] = 1;
            result_.positions[v] = way[v].t1;
        }
    }

    advance_result run() {
        constexpr int rounds = 40;
        for (int round = 0; limit_pairs_in_contact(round < rounds / 2); ++round)
            if (round == rounds) return base_;
        return std::move(result_);
    }

  private:
    /// Returns false if there are none.
    bool limit_pairs_in_contact(bool by_planes) {
        const vertex_rows way(
            way_.before, reinterpret_cast<const double*>(result_.positions.data()), way_.vertices);
        const step_result found = steps_.run(way, {.threads = options_.threads,
                                                   .set = options_.set,
                                                   .adjacent_rods = options_.distances.is_contact(),
                                                   .distances = options_.distances,
                                                   .stop = options_.stop,
                                                   .filter = options_.filter});
        bool any = false;
        for_each_kind([&]<kind K>() {
            using pair = pair_of_kind<K>;
            const auto& touching = base_.touching_at_start.of<K>();
            const auto& near = base_.near_at_start.of<K>();
            const auto limit = [&](const pair& p, const separation& keeps) {
                any = true;
                const bool is_new = planes_.of<K>().insert(p).second;
                if (!by_planes || !is_new || !limit_by_plane(p, keeps))
                    for (const vertex_index v : vertices_of(p)) move_as_group(v);
            };
            for (const pair& p : found.pairs.of<K>())
                if (!std::ranges::binary_search(touching, p) &&
                    !std::ranges::binary_search(near, p))
                    limit(p, options_.distances.of(p));
            const detail::near_times<pair> kept(way, near, options_);
            for (std::size_t i = 0; i < near.size(); ++i)
                if (kept.times[i].outcome == outcome::collides) limit(near[i], kept.pairs[i].keeps);
        });
        return any;
    }

    /// The plane is across the shortest way between both elements at the start, and divides the
    /// gap as they approach it. All of an element is on one side of it at the start. Returns false
    /// if rounding hides the gap.
    template <class Pair>
    bool limit_by_plane(const Pair& pair, const separation& keeps) {
        constexpr std::size_t first = kind_traits<kind_of<Pair>>::first_vertices;
        constexpr double share_of_way = 0.9;
        const auto vertices = vertices_of(pair);
        const nearness at_start = nearness_of(query_of(way_, pair));
        const auto along_normal = [&](const point<double>& p) {
            return p.x * at_start.normal.x + p.y * at_start.normal.y + p.z * at_start.normal.z;
        };
        const double gap = at_start.distance - (keeps.first + keeps.second);
        double start[4], approach[4], nearest[2] = {}, fastest[2] = {};
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const auto [x, y] = way_[vertices[i]];
            const std::size_t side = i < first ? 0 : 1;
            start[i] = along_normal(x);
            approach[i] = along_normal({y.x - x.x, y.y - x.y, y.z - x.z}) * (side == 0 ? -1 : 1);
            nearest[side] += at_start.weights[i] * start[i];
            fastest[side] = std::max(fastest[side], approach[i]);
        }
        if (!(gap > 0 && fastest[0] + fastest[1] > 0 &&
              fastest[0] + fastest[1] <= std::numeric_limits<double>::max()))
            return false;
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const std::size_t side = i < first ? 0 : 1;
            const double behind = (start[i] - nearest[side]) * (side == 0 ? 1 : -1);
            const double room =  // rounding can make it negative
                std::max(0.0, share_of_way *
                                  (behind + gap * (fastest[side] / (fastest[0] + fastest[1]))));
            if (approach[i] > room) move(vertices[i], room / approach[i]);
        }
        return true;
    }

    void move(vertex_index v, double fraction) {
        if (at_base_[v] || result_.fractions[v] <= fraction) return;
        if (fraction <= base_.fractions[v]) return move_as_group(v);
        result_.fractions[v] = fraction;
        result_.positions[v] = detail::between(way_[v], fraction, 0);
    }
    void move_as_group(vertex_index v) {
        at_base_[v] = true;
        result_.fractions[v] = base_.fractions[v];
        result_.positions[v] = base_.positions[v];
    }

    template <kind K>
    using pair_set = std::set<pair_of_kind<K>>;

    mesh_steps& steps_;
    const vertex_rows& way_;
    const advance_options& options_;
    const advance_result base_;
    advance_result result_;
    std::vector<bool> at_base_;  ///< of each vertex: its fraction is that by groups
    by_kind<pair_set> planes_;   ///< the pairs limited by planes
};

}  // namespace

advance_result advance(mesh_steps& steps, const vertex_rows& positions,
                       const advance_options& options) {
    check(steps, positions, options, "ccd::advance");
    detail::vertex_groups groups = groups_of(positions.vertices, options.groups);
    const bool islands = !options.groups.empty() || options.each_vertex;
    if (options.groups.empty() && options.each_vertex)
        groups = detail::vertex_groups(positions.vertices);
    detail::no_others nobody;
    advance_result result =
        detail::advancing(steps, positions, options, islands, groups, nobody).run();
    if (options.each_vertex)
        result = vertex_limits(steps, positions, options, std::move(result)).run();
    for (const double f : result.fractions) result.fraction = std::min(result.fraction, f);
    return result;
}

advance_result advance(const mesh& before, const mesh& after, const advance_options& options) {
    detail::check_frames(before, after, "ccd::advance");
    mesh_steps steps(before);
    return advance(steps, vertex_rows(before, after), options);
}

namespace {

double rounded_twice(double x, double alpha, double p) {
    volatile double product = alpha * p;  // so that no compiler fuses the two operations
    return x + product;
}

/// The two forms of x + alpha * p. Returns false if a position is not finite.
bool move(const vertex_rows& x_and_p, double alpha, std::vector<point<double>>& rounded,
          std::vector<point<double>>& fused) {
    bool finite = true;
    for (std::size_t v = 0; v < x_and_p.vertices; ++v) {
        const auto [x, p] = x_and_p[static_cast<vertex_index>(v)];
        rounded[v] = {rounded_twice(x.x, alpha, p.x), rounded_twice(x.y, alpha, p.y),
                      rounded_twice(x.z, alpha, p.z)};
        fused[v] = {std::fma(alpha, p.x, x.x), std::fma(alpha, p.y, x.y),
                    std::fma(alpha, p.z, x.z)};
        for (const point<double>& q : {rounded[v], fused[v]})
            finite &= std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z);
    }
    return finite;
}

}  // namespace

advance_result free_step(mesh_steps& steps, const vertex_rows& x_and_p,
                         const advance_options& options) {
    if (!options.groups.empty() || options.each_vertex)
        throw std::invalid_argument(
            "ccd::free_step: groups or each_vertex are given; expected none, "
            "since all vertices have one alpha");
    const std::size_t numbers = x_and_p.after == nullptr ? 0 : 3 * x_and_p.vertices;
    for (std::size_t i = 0; i < numbers; ++i)
        if (!std::isfinite(x_and_p.after[i]))
            throw std::invalid_argument("ccd::free_step: " + std::string(1, "xyz"[i % 3]) +
                                        " of the displacement of vertex " + std::to_string(i / 3) +
                                        " is " + detail::text_of(x_and_p.after[i]) +
                                        "; expected a finite number");
    check(steps, x_and_p, options, "ccd::free_step");  // so that shorter ways become finite
    advance_options unchecked = options;
    unchecked.check_start = false;
    const auto first_contact = [&](const std::vector<point<double>>& end,
                                   const advance_options& with) {
        const vertex_rows way(x_and_p.before, reinterpret_cast<const double*>(end.data()),
                              x_and_p.vertices);
        detail::vertex_groups all = groups_of(x_and_p.vertices, {});
        detail::no_others nobody;
        return detail::advancing(steps, way, with, false, all, nobody).first_contact();
    };
    std::vector<point<double>> rounded(x_and_p.vertices), fused(x_and_p.vertices);
    double alpha = 1;
    while (!move(x_and_p, alpha, rounded, fused)) alpha /= 2;
    advance_result result = first_contact(rounded, options);
    first_time found = result.first_contact;
    // A later contact is due to rounding: alpha decreases by a few ulps, then by more and more.
    for (double less = 0; alpha > 0; less = std::max(0x1p-52, 4 * less)) {
        if (found.outcome != outcome::collides && fused != rounded)
            found = first_contact(fused, unchecked).first_contact;
        if (found.outcome != outcome::collides) break;
        const double before = detail::last_before(found);
        alpha *=
            less == 0 ? options.conservative * before : std::max(0.0, std::min(before, 1 - less));
        move(x_and_p, alpha, rounded, fused);
        found = first_contact(rounded, unchecked).first_contact;
    }
    result.fraction = alpha;
    result.fractions.assign(x_and_p.vertices, alpha);
    result.positions = std::move(rounded);
    return result;
}

}  // namespace ccd
