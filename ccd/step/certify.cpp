#include <algorithm>
#include <ccd/certify.hpp>
#include <ccd/methods/transform.hpp>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "ccd/contact/data/moment.hpp"
#include "ccd/contact/data/normal.hpp"
#include "ccd/step/checks.hpp"

namespace ccd {
namespace {

using detail::enclosure;

template <class Pair>
passage passage_of(const Pair& pair, const vertex_rows& positions, const first_contact& contact) {
    passage found{contact, motion_after(query_of(positions, pair), contact)};
    if (!contact.sided || contact.normal_from == normal_source::relative_velocity ||
        !std::isfinite(contact.normal_velocity_error))
        return found;
    const enclosure velocity =
        enclosure::within(contact.normal_velocity, contact.normal_velocity_error);
    const auto [depth, error] =
        detail::nearest(-velocity * (enclosure(1.0) - detail::enclosed_time(contact.time)));
    if (!std::isfinite(depth) || !(error >= 0)) return found;
    found.depth = std::max(depth, 0.0);
    found.depth_error = error;
    return found;
}

/// The velocity of the nearest points along their normal.
template <class Pair>
detail::estimate approach_of(const Pair& pair, const vertex_rows& positions,
                             const nearness& nearest) {
    constexpr std::size_t first = kind_traits<kind_of<Pair>>::first_vertices;
    const auto points = points_of(query_of(positions, pair));
    const auto [x, y, z] = nearest.normal;
    const auto known = [](double value, double error) { return enclosure::within(value, error); };
    enclosure sum;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto& [p, q] = points[i];
        const auto along = [&](double n, double start, double end) {
            return known(n, nearest.normal_error) * (enclosure(end) - enclosure(start));
        };
        const enclosure share = known(nearest.weights[i], nearest.weight_error) *
                                (along(x, p.x, q.x) + along(y, p.y, q.y) + along(z, p.z, q.z));
        sum = i < first ? sum + share : sum - share;
    }
    return detail::nearest(sum);
}

template <class Pair>
reason reason_of(const Pair& pair, const vertex_rows& positions, const first_time& time,
                 bool of_contact) {
    reason found;
    found.kind = kind_of<Pair>;
    found.time = time;
    const auto query = query_of(positions, pair);
    std::ranges::copy(vertices_of(pair), found.vertices.begin());
    found.at_start = nearness_of(query);
    if (of_contact) {
        const first_contact contact = contact_at(query, time);
        found.motion = motion_after(query, contact);
        found.normal_velocity = contact.normal_velocity;
        found.normal_velocity_error = contact.normal_velocity_error;
        return found;
    }
    const auto [velocity, error] = approach_of(pair, positions, nearness_of(query, time.low));
    if (!std::isfinite(velocity) || !std::isfinite(error)) return found;
    found.normal_velocity = velocity;
    found.normal_velocity_error = error;
    if (velocity < -error) found.motion = contact_motion::approaches;
    if (std::abs(velocity) <= error) found.motion = contact_motion::slides;
    return found;
}

mesh_steps steps_of(const mesh& before, const mesh& after) {
    detail::check_frames(before, after, "ccd::certify");
    return mesh_steps(before);
}

}  // namespace

const passage& certificate::deepest() const {
    static const passage none;
    const passage* found = &none;
    for_each_kind([&]<kind K>() {
        for (const passage& p : passages.of<K>())
            if (std::isfinite(p.depth_error) &&
                (!std::isfinite(found->depth_error) || p.depth > found->depth))
                found = &p;
    });
    return *found;
}

certificate certify(mesh_steps& steps, const vertex_rows& positions, step_options options) {
    if (!options.distances.is_contact())
        throw std::invalid_argument("ccd::certify: options have distances; expected contact");
    options.times = options.check_start = options.adjacent_rods = true;
    certificate found{steps.run(positions, options), {}};
    for_each_kind([&]<kind K>() {
        const auto& pairs = found.step.pairs.of<K>();
        const auto contacts =
            first_contacts(positions, pairs, found.step.times.of<K>(), options.threads);
        for (std::size_t i = 0; i < pairs.size(); ++i)
            found.passages.of<K>().push_back(passage_of(pairs[i], positions, contacts[i]));
    });
    return found;
}

certificate certify(const mesh& before, const mesh& after, const step_options& options) {
    mesh_steps steps = steps_of(before, after);
    return certify(steps, vertex_rows(before, after), options);
}

certificate certify(mesh_steps& steps, std::span<const point<float>> before,
                    std::span<const point<float>> after, const step_options& options) {
    const auto widened = [](std::span<const point<float>> frame) {
        std::vector<point<double>> wide;
        for (const auto& [x, y, z] : frame) wide.push_back({x, y, z});
        return wide;
    };
    const std::vector<point<double>> from = widened(before), to = widened(after);
    return certify(steps, vertex_rows(from, to), options);
}

std::vector<reason> reasons(const vertex_rows& positions, const pair_lists& first_pairs,
                            const first_time& first_contact, const pair_distances& distances) {
    std::vector<reason> all;
    for_each_kind([&]<kind K>() {
        for (const auto& pair : first_pairs.of<K>()) {
            for (const vertex_index v : vertices_of(pair))
                if (positions.before == nullptr || positions.after == nullptr ||
                    v >= positions.vertices)
                    throw std::invalid_argument("ccd::reasons: vertex of a pair is " +
                                                std::to_string(v) + "; expected less than " +
                                                std::to_string(positions.vertices) +
                                                ", and positions at both times");
            all.push_back(reason_of(pair, positions, first_contact, distances.is_contact()));
        }
    });
    return all;
}

}  // namespace ccd
