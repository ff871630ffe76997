// Advances: a step is tested and shortened until it is free. One template serves a mesh in one
// process and one on many ranks, which exchange their contacts (`Others`).
#pragma once

#include <algorithm>
#include <ccd/advance.hpp>
#include <ccd/nearness.hpp>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "ccd/batch/threads.hpp"
#include "ccd/step/elements.hpp"
#include "ccd/step/short_steps.hpp"
#include "ccd/step/swept_boxes.hpp"
#include "ccd/step/vertex_groups.hpp"

namespace ccd::detail {

/// The largest double such that there is certainly no contact up to and at it.
inline double last_before(const first_time& time) {
    return time.low < time.high ? time.low : std::nextafter(time.low, 0.0);
}

/// The position at a fraction of the way, moved back by a number of last places. Fractions 0 and 1
/// give the ends bit for bit: std::lerp can turn -0.0 into +0.0.
inline point<double> between(const moving_point<double>& way, double fraction,
                             int last_places_back) {
    const auto on_axis = [=](double before, double after) {
        double x = fraction == 1   ? after
                   : fraction == 0 ? before
                                   : std::lerp(before, after, fraction);
        for (int i = 0; i < last_places_back; ++i) x = std::nextafter(x, before);
        return x;
    };
    return {on_axis(way.t0.x, way.t1.x), on_axis(way.t0.y, way.t1.y), on_axis(way.t0.z, way.t1.z)};
}

template <class Pair>
struct timed_pair {
    Pair pair;
    first_time time;
};

/// For a mesh that is in this process only.
struct no_others {
    template <class Pair>
    std::vector<timed_pair<Pair>> found_by_all(std::vector<timed_pair<Pair>> pairs) {
        return pairs;
    }
    void call(const std::function<void()>& what) { what(); }
    first_time earliest(const first_time& time) { return time; }
    bool all(bool holds) { return holds; }
};

/// A time until which three in four vertices of a sample move by no more than the vertices'
/// spacing. Few pairs of elements come near until then. Infinite if these vertices do not move.
inline double time_of_short_way(const vertex_rows& way) {
    rounded_axes::extent box = rounded_axes::extent::nothing();
    std::vector<double> lengths;
    for (std::size_t v = 0; v < way.vertices; v += sampling_stride(way.vertices)) {
        const double *x = way.before + 3 * v, *y = way.after + 3 * v;
        for (std::size_t k = 0; k < 3; ++k) box.widen(k, x[k]);
        const double length = std::hypot(y[0] - x[0], y[1] - x[1], y[2] - x[2]);
        lengths.push_back(std::isnan(length) ? 0 : length);
    }
    const auto most = lengths.begin() + static_cast<std::ptrdiff_t>(3 * lengths.size() / 4);
    std::ranges::nth_element(lengths, most);
    const double size =
        std::hypot(box.high[0] - box.low[0], box.high[1] - box.low[1], box.high[2] - box.low[2]);
    const double time = size / std::sqrt(static_cast<double>(way.vertices)) / *most;
    return time > 0 ? time : std::numeric_limits<double>::infinity();
}

/// Calls step(options) with growing t_max until there is a contact, at last with t_max = 1 or the
/// time of the sample's first contact. Short searches are cheap, and the first contact is usually
/// early if vertices move by many times their spacing, as when a solver diverges. If they do not,
/// the contacts of a sample of pairs show whether the first one is early. sample(options) returns
/// the first of these.
template <class Others, class Sample, class Step>
step_result step_to_first_contact(const vertex_rows& way, step_options options, Others& others,
                                  const Sample& sample, const Step& step) {
    options.first_contact = true;
    double growth = 4;
    constexpr int slow_rounds = 6;  // then faster: a way may be 1e300 times too long
    const bool is_given = way.vertices > 0 && way.before != nullptr && way.after != nullptr;
    const double start = is_given ? time_of_short_way(way) : 1;  // the step checks positions
    options.t_max = others.earliest({outcome::collides, start, start}).low;
    for (int round = 0; options.t_max < 1 / growth; ++round, options.t_max *= growth) {
        if (round > slow_rounds) growth *= growth;
        step_result found = step(options);
        if (others.earliest(found.first_contact).outcome == outcome::collides) return found;
        options.check_start = false;
    }
    options.t_max = 1;
    const first_time early = others.earliest(sample(options));
    if (early.outcome == outcome::collides && early.high < 1) options.t_max = early.high;
    return step(options);
}

/// A pair near at the start, and the distance that it keeps; 0: it may not touch.
template <class Pair>
struct near_pair {
    Pair pair;
    separation keeps;
};
template <kind K>
using near_list = std::vector<near_pair<pair_of_kind<K>>>;

/// Pairs that are near at the start (advance_options::keep), with their times on the way.
template <class Pair>
struct near_times {
    std::vector<near_pair<Pair>> pairs;
    std::vector<first_time> times;  ///< at_start() if they touch at the start

    near_times(const vertex_rows& way, const std::vector<Pair>& all,
               const advance_options& options) {
        pairs.resize(all.size());
        times.resize(all.size());
        on_threads(options.threads, [&] {
            for_each_index(all.size(), [&](std::size_t i) {
                stop_if_requested(options.stop);
                const auto query = query_of(way, all[i]);
                pairs[i] = {all[i], {}};
                if (options.keep > 0) {
                    const nearness at_start = nearness_of(query);
                    if (at_start.distance_error < at_start.distance)
                        pairs[i].keeps.first =
                            options.keep * (at_start.distance - at_start.distance_error);
                    else if (!at_start.touches())  // the distance overflows
                        pairs[i].keeps.first = options.keep * std::numeric_limits<double>::max();
                }
                times[i] = time_within(query, pairs[i].keeps);
                if (times[i].at_start() && pairs[i].keeps.first > 0)
                    times[i] = time_within(query, pairs[i].keeps = {});
            });
        });
    }
};

/// Distances within which pairs are near at the start; `scaled` holds thicknesses.
inline pair_distances near_distances(const advance_options& options, std::vector<double>& scaled) {
    pair_distances near = options.distances;
    if (options.keep == 0) return near;
    constexpr double wider = 1 + 0x1p-10;
    const auto widen = [](double& d) {
        d = std::min(wider * d, std::numeric_limits<double>::max());
    };
    widen(near.all);
    scaled.assign(near.thickness.begin(), near.thickness.end());
    std::ranges::for_each(scaled, widen);
    near.thickness = scaled;
    return near;
}

/// Others must have the members of no_others: found_by_all returns the same pairs in the same order
/// on all processes. If `what` throws on one, call throws on all. In `groups`, vertices of other
/// processes follow those of `way`.
template <class Others>
class advancing {
  public:
    /// Precondition: `groups` has joined two vertices exactly if they have the same index in
    /// advance_options::groups; without `islands`, it has joined all vertices.
    /// With `islands`, groups have their own fractions.
    advancing(mesh_steps& steps, const vertex_rows& way, const advance_options& options,
              bool islands, vertex_groups& groups, Others& others)
        : steps_(steps),
          short_(steps),
          way_(way),
          options_(options),
          islands_(islands),
          groups_(groups),
          others_(others) {}

    /// Returns the first contact and all lists of the result, those of all processes.
    advance_result first_contact() {
        evaluate_whole_way();
        return std::move(result_);
    }
    /// Returns all except result.fraction, which stays 1. The lists are those of all processes.
    advance_result run() {
        evaluate_whole_way();
        // Each round joins groups, takes vertices back or shortens a way. After rounds_by_group all
        // become one group, whose way vertex_groups shortens a bounded number of times.
        constexpr int rounds_by_group = 60;
        for (int round = 0; set_positions(); ++round) {
            may_retreat_ = round < rounds_by_group;
            if (round == rounds_by_group) groups_.join_all();
            if (!separate_known() && !separate_others()) break;
        }
        return std::move(result_);
    }

  private:
    /// Finds the pairs to skip, pairs with a contact, and fractions.
    void evaluate_whole_way();
    template <class Pair>
    void hold(const timed_pair<Pair>& contact);
    template <kind K>
    void find_near_contacts(const std::vector<pair_of_kind<K>>& near);

    /// Sets positions from the groups' fractions. Returns false if all move the whole way.
    bool set_positions();
    vertex_rows way_to_result() const {
        return {way_.before, reinterpret_cast<const double*>(result_.positions.data()),
                way_.vertices};
    }

    /// Separates the known pairs that are in contact on the way to the result's positions. Returns
    /// true if there were any.
    bool separate_known();
    /// The same for all pairs of the mesh. Pairs in contact become known.
    bool separate_others();
    /// Separates `found` and the pairs that other processes found.
    template <class Pair>
    bool separate(const std::vector<Pair>& found);

    step_result step(const vertex_rows& way, const step_options& options) {
        step_result found;
        const bool is_short = options.first_contact && options.t_max < 1;
        others_.call(
            [&] { found = is_short ? short_.run(way, options) : steps_.run(way, options); });
        has_candidates_ = is_short && others_.all(short_.has_candidates());
        if (options.check_start)
            result_.intersections_at_start = std::move(found.intersections_at_start);
        return found;
    }
    template <class Pair>
    std::vector<timed_pair<Pair>> timed(const vertex_rows& way, const std::vector<Pair>& pairs,
                                        const pair_distances& distances) {
        std::vector<timed_pair<Pair>> found;
        others_.call([&] {
            const std::vector<first_time> times = first_times(
                way, pairs, {1, distances, options_.threads, options_.set, options_.stop});
            for (std::size_t i = 0; i < pairs.size(); ++i) found.push_back({pairs[i], times[i]});
        });
        return found;
    }
    template <class Pair>
    std::vector<Pair> found_by_all(const std::vector<Pair>& pairs) {
        std::vector<timed_pair<Pair>> own;
        for (const Pair& pair : pairs) own.push_back({pair, {}});
        std::vector<Pair> all;
        for (const auto& found : others_.found_by_all(std::move(own))) all.push_back(found.pair);
        return all;
    }

    step_options base_options() const {
        return {.threads = options_.threads,
                .set = options_.set,
                .adjacent_rods = options_.distances.is_contact(),
                .distances = options_.distances,
                .stop = options_.stop,
                .filter = options_.filter};
    }

    mesh_steps& steps_;
    short_steps short_;
    bool has_candidates_ = false;  ///< of short_, on all processes, until the next step
    const vertex_rows& way_;
    const advance_options& options_;
    bool islands_;
    vertex_groups& groups_;
    Others& others_;
    pair_lists at_start_;            ///< of all processes
    pair_lists known_;               ///< of this process
    by_kind<near_list> known_near_;  ///< of this process
    bool may_retreat_ = true;
    advance_result result_;
};

template <class Others>
template <class Pair>
void advancing<Others>::hold(const timed_pair<Pair>& contact) {
    const auto vertices = vertices_of(contact.pair);
    for (const vertex_index v : vertices) groups_.join(vertices[0], v);
    const first_time& time = contact.time;
    if (time.outcome != outcome::collides || time.at_start()) return;
    groups_.limit(vertices[0], options_.conservative * last_before(time));
    add_first(time, contact.pair, result_);
}

/// Finds times of pairs that are near at the start.
template <class Others>
template <kind K>
void advancing<Others>::find_near_contacts(const std::vector<pair_of_kind<K>>& near) {
    using pair = pair_of_kind<K>;
    std::vector<timed_pair<pair>> contacts;
    others_.call([&] {
        const near_times<pair> found(way_, near, options_);
        for (std::size_t i = 0; i < near.size(); ++i) {
            contacts.push_back({near[i], found.times[i]});
            if (!found.times[i].at_start()) known_near_.of<K>().push_back(found.pairs[i]);
        }
    });
    for (const auto& contact : others_.found_by_all(contacts)) {
        (contact.time.at_start() ? result_.touching_at_start : result_.near_at_start)
            .template of<K>()
            .push_back(contact.pair);
        hold(contact);
    }
}

template <class Others>
void advancing<Others>::evaluate_whole_way() {
    result_.first_contact = {outcome::separate};
    step_options options = base_options();
    const bool contact = options_.distances.is_contact();
    const bool keeps = !contact && options_.keep > 0;
    std::vector<double> scaled;
    pair_lists near;
    if (keeps) {
        step_options resting = options;
        resting.distances = near_distances(options_, scaled);
        resting.t_max = 0;
        near = step(way_, resting).touching_at_start;
    }
    options.first_contact = true;
    options.times = islands_ || keeps;
    options.check_start = options_.check_start;
    const auto sample = [&](const step_options& o) {
        first_time found;
        others_.call([&] { found = short_.first_of_sample(way_, o); });
        return found;
    };
    const auto step_way = [&](const step_options& o) { return step(way_, o); };
    const step_result whole = options.times
                                  ? step_way(options)
                                  : step_to_first_contact(way_, options, others_, sample, step_way);
    const first_time first = others_.earliest(whole.first_contact);
    for_each_kind([&]<kind K>() {
        const auto& pairs = whole.pairs.of<K>();
        const auto& times = whole.times.of<K>();
        if (!keeps) near.of<K>() = whole.touching_at_start.of<K>();
        at_start_.of<K>() = found_by_all(near.of<K>());
        if (contact) result_.touching_at_start.of<K>() = at_start_.of<K>();
        std::ranges::sort(at_start_.of<K>());
        std::vector<timed_pair<pair_of_kind<K>>> timed;
        if (options.times) {
            known_.of<K>() = without(pairs, at_start_.of<K>());
            for (std::size_t i = 0; i < pairs.size(); ++i)
                if (!keeps || std::ranges::binary_search(known_.of<K>(), pairs[i]))
                    timed.push_back({pairs[i], times[i]});
        } else if (whole.first_contact == first) {
            known_.of<K>() = whole.first_pairs.of<K>();
            for (const auto& pair : known_.of<K>()) timed.push_back({pair, first});
        }
        for (const auto& pair : others_.found_by_all(std::move(timed))) hold(pair);
        if (!contact) find_near_contacts<K>(near.of<K>());
        std::ranges::sort(result_.first_pairs.template of<K>());
    });
}

template <class Others>
bool advancing<Others>::set_positions() {
    result_.positions.resize(way_.vertices);
    result_.fractions.resize(way_.vertices);
    bool all_the_way = true;
    for (vertex_index v = 0; v < way_.vertices; ++v) {
        const double f = result_.fractions[v] = groups_.fraction(v);
        result_.positions[v] = between(way_[v], f, groups_.last_places_back(v));
        all_the_way &= f == 1;
    }
    return !others_.all(all_the_way);
}

template <class Others>
template <class Pair>
bool advancing<Others>::separate(const std::vector<Pair>& found) {
    const std::vector<Pair> all = found_by_all(found);
    groups_.separate(all, may_retreat_);
    return !all.empty();
}

template <class Others>
bool advancing<Others>::separate_known() {
    bool any = false;
    for_each_kind([&]<kind K>() {
        std::vector<pair_of_kind<K>> found;
        for (const auto& [pair, time] : timed(way_to_result(), known_.of<K>(), options_.distances))
            if (time.outcome == outcome::collides) found.push_back(pair);
        any |= separate(found);
        found.clear();
        for (const auto& [pair, keeps] : known_near_.of<K>())
            if (decide_within(query_of(way_to_result(), pair), keeps).outcome == outcome::collides)
                found.push_back(pair);
        any |= separate(found);
    });
    return any;
}

template <class Others>
bool advancing<Others>::separate_others() {
    pair_lists found;
    if (has_candidates_)
        others_.call([&] { found = short_.pairs_on(way_to_result(), base_options()); });
    else
        found = step(way_to_result(), base_options()).pairs;
    bool any = false;
    for_each_kind([&]<kind K>() {
        const auto others = without(found.of<K>(), at_start_.of<K>());
        any |= separate(others);
        known_.of<K>().insert(known_.of<K>().end(), others.begin(), others.end());
    });
    return any;
}

}  // namespace ccd::detail
