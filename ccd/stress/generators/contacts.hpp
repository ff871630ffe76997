// Queries in contact, or near one.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "ccd/stress/generators/coordinates.hpp"
#include "ccd/stress/generators/degenerate.hpp"

namespace ccd::stress::generators {

// How many of a query's points make up its first feature.
inline std::size_t first_feature_size(kind which) {
    return which == kind::edge_edge ? 2 : 1;
}

// Each feature moves as a whole.
inline points translated(source& random, kind which, const points& p) {
    const std::size_t first_feature = first_feature_size(which);
    std::array<position, 2> shift;
    for (auto& s : shift) s = {random.symmetric(), random.symmetric(), random.symmetric()};
    points out = all_frozen(p);
    return map(out, [&](double x, std::size_t i, std::size_t end, std::size_t axis) {
        return end == 0 ? x : x + shift[i < first_feature ? 0 : 1][axis];
    });
}

// Weights of a point of a segment or triangle; `corners` of them, often on its border.
inline position weights(source& random, std::size_t corners) {
    position w{};
    double rest = 1;
    for (std::size_t i = 0; i + 1 < corners; ++i) {
        const int pick = random.between(0, 5);
        const double part = pick == 0 ? 0 : pick == 1 ? 1 : pick == 2 ? 0.5 : random.unit();
        w[i] = rest * part;
        rest -= w[i];
    }
    w[corners - 1] = rest;
    return w;
}

// Four positions, drawn before those that a contact moves.
inline std::array<position, 4> positions(source& random) {
    std::array<position, 4> at;
    for (auto& p : at) p = {random.symmetric(), random.symmetric(), random.symmetric()};
    return at;
}

// A contact at one instant, as near as rounding allows: the first feature of `at` (EE: the second)
// is moved there, then each point gets a velocity of its own, times `speed`.
// pick(random, corners) gives the weights of the point of contact.
template <class Pick>
points contact_at(source& random, kind which, double speed, std::array<position, 4> at, Pick pick) {
    if (which == kind::edge_edge) {
        const position a = pick(random, 2);
        const position b = pick(random, 2);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double gap =
                a[0] * at[0][axis] + a[1] * at[1][axis] - b[0] * at[2][axis] - b[1] * at[3][axis];
            at[2][axis] += gap;
            at[3][axis] += gap;
        }
    } else {
        const std::size_t corners = which == kind::vertex_face   ? 3
                                    : which == kind::vertex_edge ? 2
                                                                 : 1;
        const position w = pick(random, corners);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            at[0][axis] = w[0] * at[1][axis] + w[1] * at[2][axis] + w[2] * at[3][axis];
        }
    }
    const int when = random.between(0, 3);
    const double t = when == 0 ? 0 : when == 1 ? 1 : when == 2 ? 0.5 : random.unit();
    const std::array<position, 4> velocity = positions(random);
    return fill([&](std::size_t i, std::size_t end, std::size_t axis) {
        return at[i][axis] + speed * velocity[i][axis] * (end == 0 ? -t : 1 - t);
    });
}

inline points near_contact(source& random, kind which, double speed) {
    return contact_at(random, which, speed, positions(random), weights);
}

inline points far_from_origin(source& random, kind which, int exponent) {
    const position offset{random.symmetric(), random.symmetric(), random.symmetric()};
    return map(near_contact(random, which, 0.5),
               [&](double x, std::size_t, std::size_t, std::size_t axis) {
                   return x + std::ldexp(offset[axis], exponent);
               });
}

// Weights of a point of contact within 2^-30 to 2^-58 of a border, inside or outside.
inline position border_weights(source& random, std::size_t corners) {
    const int exponent = -random.between(30, 58);
    const double beyond = std::ldexp(random.one_in(2) ? 1 : -1, exponent);
    if (corners == 1) return {1, 0, 0};
    if (corners == 2) {
        return random.one_in(2) ? position{beyond, 1 - beyond, 0} : position{1 - beyond, beyond, 0};
    }
    const double second = (1 - beyond) * random.unit();
    const std::array<double, 3> w{beyond, second, 1 - beyond - second};
    const auto turn = static_cast<std::size_t>(random.between(0, 2));
    return {w[turn], w[(turn + 1) % 3], w[(turn + 2) % 3]};
}

inline points border_contact(source& random, kind which) {
    return contact_at(random, which, 1, positions(random), border_weights);
}

// The first feature moved by at most 2^exponent on each axis.
inline points shifted(source& random, kind which, const points& p, int exponent) {
    const position shift{random.symmetric(), random.symmetric(), random.symmetric()};
    return map(p, [&](double x, std::size_t i, std::size_t, std::size_t axis) {
        return i < first_feature_size(which) ? x + std::ldexp(shift[axis], exponent) : x;
    });
}

// Everything moves by one vector: features in contact stay so, but for rounding.
inline points drifting(source& random, const points& p) {
    const position drift{random.symmetric(), random.symmetric(), random.symmetric()};
    return map(p, [&](double x, std::size_t, std::size_t end, std::size_t axis) {
        return end == 0 ? x : x + drift[axis];
    });
}

inline points resting(source& random, kind which) {
    return drifting(random, near_contact(random, which, 0));
}

// In contact, EE with edges parallel but for 2^exponent, VF with as flat a triangle; at the contact
// alone, or, where motion is as small, throughout.
inline points sliver(source& random, kind which, int exponent) {
    std::array<position, 4> at = positions(random);
    const bool face = which == kind::vertex_face;
    const std::size_t base = face ? 1 : 2, from = face ? 1 : 0;
    const double along = 2 * random.symmetric();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        at[3][axis] = at[base][axis] + along * (at[from + 1][axis] - at[from][axis]) +
                      std::ldexp(random.symmetric(), exponent);
    }
    const double speed = random.one_in(2) ? 1 : std::ldexp(1, exponent);
    return contact_at(random, which, speed, at, weights);
}

// In contact, with one edge of length 2^exponent.
inline points needle(source& random, kind which, int exponent) {
    std::array<position, 4> at = positions(random);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        at[3][axis] = at[2][axis] + std::ldexp(random.symmetric(), exponent);
    }
    const double speed = random.one_in(2) ? 1 : std::ldexp(1, exponent);
    return contact_at(random, which, speed, at, weights);
}

}  // namespace ccd::stress::generators
