// Checks of an advance, by the oracle on every pair.
#include <algorithm>
#include <ccd/batch.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <variant>
#include <vector>

#include "tests/soak/advance_scenes.hpp"
#include "tests/support/first_time_faults.hpp"
#include "tests/support/oracle.hpp"

namespace soak {
namespace {

using ccd::vertex_index;
using oracle::interval;

/// The condition that a pair must not meet, by its state at the start.
enum class condition : std::uint8_t { nothing, contact, distance };

struct checked_pair {
    std::variant<ccd::vertex_face_pair, ccd::edge_edge_pair, ccd::vertex_edge_pair,
                 ccd::vertex_vertex_pair>
        pair;
    condition unwanted;
    ccd::separation d;
};

bool within(const auto& query, ccd::separation d, const interval& when) {
    return oracle::within(query, d.first, d.second, oracle::shortcuts::on, when);
}
bool in_contact(const auto& query, const interval& when) {
    return oracle::collides(query, oracle::shortcuts::on, when);
}

bool holds(const ccd::vertex_rows& way, const checked_pair& of, const interval& when) {
    return std::visit(
        [&](const auto& pair) {
            const auto query = query_of(way, pair);
            if (of.unwanted == condition::distance) return within(query, of.d, when);
            return of.unwanted == condition::contact && in_contact(query, when);
        },
        of.pair);
}

/// A double that is at least the distance of a pair.
double at_least(ccd::separation d) {
    return std::nextafter(d.first + d.second, std::numeric_limits<double>::infinity());
}

std::vector<checked_pair> pairs_of(const advance_scene& scene) {
    std::vector<checked_pair> all;
    const ccd::vertex_rows at_rest(scene.at.first, scene.at.first);
    const ccd::pair_distances distances = scene.distances();
    scene.for_each_pair([&](const auto& pair) {
        const auto query = query_of(at_rest, pair);
        const ccd::separation d = distances.of(pair);
        condition unwanted = condition::distance;
        if (in_contact(query, interval::instant(0)))
            unwanted = condition::nothing;
        else if (distances.is_contact() || within(query, d, interval::instant(0)))
            unwanted = condition::contact;
        all.push_back({pair, unwanted, d});
    });
    return all;
}

/// True if a pair meets its condition on the way from the start to these positions.
bool meet(const advance_scene& scene, const std::vector<checked_pair>& pairs,
          const std::vector<ccd::point<double>>& positions) {
    const ccd::vertex_rows way(scene.at.first.vertices, positions);
    return std::ranges::any_of(pairs, [&](const checked_pair& p) { return holds(way, p, {}); });
}

class checking {
  public:
    checking(const advance_scene& scene, const ccd::advance_result& result)
        : scene_(scene),
          result_(result),
          whole_(scene.at.first, scene.at.second),
          pairs_(pairs_of(scene)) {
        check_pairs_at_start();
        check_first_contact();
        check_positions();
        check_fractions();
        check_way();
        check_progress();
        check_.pairs = pairs_.size();
    }
    advance_check check_;

  private:
    void fault(const std::string& what) { check_.faults += what + "; "; }

    void check_pairs_at_start() {
        ccd::pair_lists touching, near;
        for (const checked_pair& checked : pairs_)
            std::visit(
                [&]<class Pair>(const Pair& pair) {
                    constexpr ccd::kind K = ccd::kind_of<Pair>;
                    if (checked.unwanted == condition::nothing)
                        touching.of<K>().push_back(brute_force::as_reported(pair));
                    else if (checked.unwanted == condition::contact &&
                             !scene_.distances().is_contact())
                        near.of<K>().push_back(brute_force::as_reported(pair));
                },
                checked.pair);
        ccd::for_each_kind([&]<ccd::kind K>() {
            std::ranges::sort(touching.of<K>());
            std::ranges::sort(near.of<K>());
        });
        if (touching != result_.touching_at_start) fault("other pairs touch at the start");
        if (near != result_.near_at_start) fault("other pairs are near at the start");
    }

    void check_first_contact() {
        const std::string wrong =
            support::fault_of(result_.first_contact, 1, [&](const interval& when) {
                return std::ranges::any_of(
                    pairs_, [&](const checked_pair& p) { return holds(whole_, p, when); });
            });
        if (!wrong.empty()) fault("first contact: " + wrong);
    }

    void check_positions() {
        if (result_.positions.size() != whole_.vertices ||
            result_.fractions.size() != whole_.vertices)
            return fault("positions of other vertices");
        for (vertex_index v = 0; v < whole_.vertices; ++v) {
            const auto [before, after] = whole_[v];
            const auto& at = result_.positions[v];
            const double f = result_.fractions[v];
            if (!is_taken_back(before.x, std::lerp(before.x, after.x, f), at.x) ||
                !is_taken_back(before.y, std::lerp(before.y, after.y, f), at.y) ||
                !is_taken_back(before.z, std::lerp(before.z, after.z, f), at.z))
                fault("vertex " + std::to_string(v) + " is not where its fraction leads");
        }
    }
    static bool is_taken_back(double before, double there, double at) {
        for (int places = 0; places < 1024 && at != there; ++places)
            there = std::nextafter(there, before);
        return at == there;
    }

    void check_fractions() {
        std::map<int, double> of_group;
        double least = 1;
        for (std::size_t v = 0; v < result_.fractions.size(); ++v) {
            const double f = result_.fractions[v];
            least = std::min(least, f);
            const int group = scene_.groups.empty() ? 0 : scene_.groups[v];
            if (!(f >= 0 && f <= 1)) fault("a fraction out of [0, 1]");
            if (of_group.try_emplace(group, f).first->second != f)
                fault("two fractions of group " + std::to_string(group));
        }
        if (least != result_.fraction) fault("not the least fraction");
    }

    void check_way() {
        if (meet(scene_, pairs_, result_.positions))
            fault("a pair meets on the way to the positions");
    }

    /// The island of each vertex. Two groups are in one island if a pair of their boxes, swept over
    /// the whole step, is within its distance.
    std::vector<int> islands() const {
        std::vector<ccd::edge> joined;
        std::map<int, vertex_index> first_of;
        for (vertex_index v = 0; v < whole_.vertices; ++v) {
            const int group = scene_.groups.empty() ? 0 : scene_.groups[v];
            joined.push_back({first_of.try_emplace(group, v).first->second, v});
        }
        for (const checked_pair& p : pairs_)
            std::visit(
                [&](const auto& pair) {
                    if (!brute_force::boxes_touch(scene_.at, pair, at_least(p.d))) return;
                    const auto vertices = vertices_of(pair);
                    for (const vertex_index v : vertices) joined.push_back({vertices[0], v});
                },
                p.pair);
        return ccd::connected_parts({}, joined, whole_.vertices);
    }

    void check_progress() {
        const std::vector<int> island = islands();
        std::map<int, double> least;
        for (std::size_t v = 0; v < island.size(); ++v) {
            double& f = least.try_emplace(island[v], 1).first->second;
            f = std::min(f, result_.fractions[v]);
        }
        for (const auto& [number, f] : least) {
            if (f == 1) continue;
            if (!is_held(island, number, 1)) fault("nothing holds the vertices of an island");
            // f / 0.99 is rounded, and a contact time is a bracket.
            const double end = std::nextafter(std::nextafter(f / 0.99, 2), 2);
            check_.is_short |= !is_held(island, number, std::min(end, 1.0));
        }
    }
    /// True if a pair of the island meets in [0, end] when all vertices move all the way.
    bool is_held(const std::vector<int>& island, int number, double end) const {
        return std::ranges::any_of(pairs_, [&](const checked_pair& p) {
            const auto v =
                std::visit([](const auto& pair) { return vertices_of(pair)[0]; }, p.pair);
            return island[v] == number && holds(whole_, p, {0, end});
        });
    }

    const advance_scene& scene_;
    const ccd::advance_result& result_;
    const ccd::vertex_rows whole_;
    const std::vector<checked_pair> pairs_;
};

}  // namespace

std::string line_search_faults(const advance_scene& scene, const ccd::advance_result& found,
                               const ccd::mesh& p) {
    std::vector<ccd::point<double>> rounded, fused;
    const auto& before = scene.at.first.vertices;
    const double alpha = found.fraction;
    for (std::size_t v = 0; v < before.size(); ++v) {
        const auto &x = before[v], &d = p.vertices[v];
        // This file is compiled without contraction of products and sums.
        rounded.push_back({x.x + alpha * d.x, x.y + alpha * d.y, x.z + alpha * d.z});
        fused.push_back(
            {std::fma(alpha, d.x, x.x), std::fma(alpha, d.y, x.y), std::fma(alpha, d.z, x.z)});
    }
    std::string faults;
    if (found.positions != rounded) faults += "positions of free_step are not x + alpha * p; ";
    const std::vector<checked_pair> pairs = pairs_of(scene);
    if (meet(scene, pairs, rounded)) faults += "a pair meets on the way to x + alpha * p; ";
    if (meet(scene, pairs, fused)) faults += "a pair meets on the way to fused x + alpha * p; ";
    return faults;
}

std::string each_vertex_faults(const advance_scene& scene, const ccd::advance_result& by_groups,
                               const ccd::advance_result& found) {
    std::string faults;
    if (meet(scene, pairs_of(scene), found.positions))
        faults += "a pair meets on the way of each vertex; ";
    for (std::size_t v = 0; v < found.fractions.size(); ++v)
        if (!(found.fractions[v] >= by_groups.fractions[v] && found.fractions[v] <= 1))
            faults += "vertex " + std::to_string(v) + " goes less far than its group; ";
    return faults;
}

advance_check check(const advance_scene& scene, const ccd::advance_result& result) {
    return checking(scene, result).check_;
}

}  // namespace soak
