// Advances: positions are tried, asked and shortened until a step to them is free.
#include <algorithm>
#include <ccd/advance.hpp>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <utility>

#include "ccd/step/checks.hpp"
#include "ccd/step/vertex_groups.hpp"

namespace ccd {
namespace {

using detail::vertex_groups;

/// The largest double before which, itself included, there certainly is no contact.
double last_before(const first_time& time) {
    return time.low < time.high ? time.low : std::nextafter(time.low, 0.0);
}

/// Where a fraction of the way leads, taken back by so many last places, or to `before`.
double between(double before, double after, double fraction, int last_places_back) {
    double x = std::lerp(before, after, fraction);
    for (int i = 0; i < last_places_back; ++i) x = std::nextafter(x, before);
    return x;
}

vertex_groups groups_of(std::size_t vertices, std::span<const int> groups) {
    if (!groups.empty() && groups.size() != vertices)
        throw std::invalid_argument("ccd::advance: found groups of " +
                                    std::to_string(groups.size()) + " vertices, the mesh has " +
                                    std::to_string(vertices));
    vertex_groups made(vertices);
    if (groups.empty()) made.join_all();
    std::unordered_map<int, vertex_index> first_of;
    for (vertex_index v = 0; v < groups.size(); ++v)
        made.join(first_of.try_emplace(groups[v], v).first->second, v);
    return made;
}

template <class Pair>
std::vector<Pair> without(const std::vector<Pair>& pairs, const std::vector<Pair>& left_out) {
    std::vector<Pair> rest;
    std::ranges::set_difference(pairs, left_out, std::back_inserter(rest));
    return rest;
}

template <class Pair>
std::vector<Pair> in_contact(const vertex_rows& way, const std::vector<Pair>& pairs,
                             const time_options& asked) {
    const std::vector<first_time> times = first_times(way, pairs, asked);
    std::vector<Pair> found;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        if (times[i].outcome == outcome::collides) found.push_back(pairs[i]);
    return found;
}

class advancing {
  public:
    advancing(mesh_steps& steps, const vertex_rows& way, const advance_options& options)
        : steps_(steps),
          way_(way),
          options_(options),
          groups_(groups_of(way.vertices, options.groups)) {}

    advance_result run() {
        ask_whole_way();
        // Each round joins groups, takes vertices back or shortens a way. Where meetings go on, all
        // become one group, whose way is then not shortened more often than vertex_groups says.
        constexpr int rounds_by_group = 60;
        for (int round = 0; set_positions(); ++round) {
            may_retreat_ = round < rounds_by_group;
            if (round == rounds_by_group) groups_.join_all();
            if (!separate_known() && !separate_others()) break;
        }
        for (const double f : result_.fractions) result_.fraction = std::min(result_.fraction, f);
        return std::move(result_);
    }

  private:
    /// What is on the whole way: who is left out, who is known to meet, and how far groups get.
    void ask_whole_way();
    template <class Pair>
    void hold(const Pair& pair, const first_time& time);
    template <kind K>
    void ask_near_ones();

    /// Where the groups' fractions lead. Returns false if that is the whole way of all.
    bool set_positions();
    vertex_rows way_to_result() const {
        return {way_.before, reinterpret_cast<const double*>(result_.positions.data()),
                way_.vertices};
    }

    /// Separates pairs in contact on the way to the result's positions: known ones, or any. Returns
    /// whether there were any.
    bool separate_known();
    bool separate_others();

    step_options step_asked() const {
        return {.threads = options_.threads,
                .set = options_.set,
                .distances = options_.distances,
                .stop = options_.stop,
                .filter = options_.filter};
    }
    time_options times_asked(const pair_distances& distances) const {
        return {1, distances, options_.threads, options_.set, options_.stop};
    }

    mesh_steps& steps_;
    const vertex_rows& way_;
    const advance_options& options_;
    vertex_groups groups_;
    pair_lists at_start_, known_;
    bool may_retreat_ = true;
    advance_result result_;
};

/// Joins a pair's vertices, which then get to just before that time.
template <class Pair>
void advancing::hold(const Pair& pair, const first_time& time) {
    const auto vertices = vertices_of(pair);
    for (const vertex_index v : vertices) groups_.join(vertices[0], v);
    if (time.outcome != outcome::collides || time.at_start()) return;
    groups_.limit(vertices[0], last_before(time));
    first_time& first = result_.first_contact;
    if (first.outcome != outcome::collides ||
        std::pair(time.low, time.high) < std::pair(first.low, first.high))
        first = time;
}

/// Of pairs within their distance at the start: which touch, and when the others do.
template <kind K>
void advancing::ask_near_ones() {
    const auto& pairs = at_start_.of<K>();
    const std::vector<first_time> contacts = first_times(way_, pairs, times_asked({}));
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        (contacts[i].at_start() ? result_.touching_at_start : result_.near_at_start)
            .of<K>()
            .push_back(pairs[i]);
        hold(pairs[i], contacts[i]);
    }
}

void advancing::ask_whole_way() {
    step_options asked = step_asked();
    const bool all_are_one = options_.groups.empty();
    asked.first_contact = true;
    asked.times = !all_are_one;
    const step_result whole = steps_.run(way_, asked);
    result_.first_contact = whole.first_contact;
    if (whole.first_contact.outcome == outcome::collides && all_are_one)
        groups_.limit(0, last_before(whole.first_contact));
    at_start_ = whole.touching_at_start;
    for_each_kind([&]<kind K>() {
        known_.of<K>() = without(whole.pairs.of<K>(), at_start_.of<K>());
        for (std::size_t i = 0; i < whole.times.of<K>().size(); ++i)
            hold(whole.pairs.of<K>()[i], whole.times.of<K>()[i]);
        if (!options_.distances.ask_for_contact()) ask_near_ones<K>();
    });
    if (options_.distances.ask_for_contact()) result_.touching_at_start = at_start_;
}

bool advancing::set_positions() {
    result_.positions.resize(way_.vertices);
    result_.fractions.resize(way_.vertices);
    bool all_the_way = true;
    for (vertex_index v = 0; v < way_.vertices; ++v) {
        const double f = result_.fractions[v] = groups_.fraction(v);
        const auto [before, after] = way_[v];
        const int back = groups_.last_places_back(v);
        result_.positions[v] = {between(before.x, after.x, f, back),
                                between(before.y, after.y, f, back),
                                between(before.z, after.z, f, back)};
        all_the_way &= f == 1;
    }
    return !all_the_way;
}

bool advancing::separate_known() {
    bool any = false;
    for_each_kind([&]<kind K>() {
        const auto separate = [&](const auto& pairs, const pair_distances& distances) {
            const auto found = in_contact(way_to_result(), pairs, times_asked(distances));
            groups_.separate(found, may_retreat_);
            any |= !found.empty();
        };
        separate(known_.of<K>(), options_.distances);
        separate(result_.near_at_start.of<K>(), {});
    });
    return any;
}

bool advancing::separate_others() {
    const step_result found = steps_.run(way_to_result(), step_asked());
    bool any = false;
    for_each_kind([&]<kind K>() {
        const auto others = without(found.pairs.of<K>(), at_start_.of<K>());
        groups_.separate(others, may_retreat_);
        known_.of<K>().insert(known_.of<K>().end(), others.begin(), others.end());
        any |= !others.empty();
    });
    return any;
}

}  // namespace

advance_result advance(mesh_steps& steps, const vertex_rows& positions,
                       const advance_options& options) {
    return advancing(steps, positions, options).run();
}

advance_result advance(const mesh& before, const mesh& after, const advance_options& options) {
    detail::check_frames(before, after);
    mesh_steps steps(before);
    return advance(steps, vertex_rows(before, after), options);
}

}  // namespace ccd
