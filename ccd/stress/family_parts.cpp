#include "ccd/stress/family_parts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ccd/stress/generators/contacts.hpp"
#include "ccd/stress/generators/roots.hpp"
#include "ccd/stress/generators/sheets.hpp"

namespace ccd::stress {

using namespace generators;

std::vector<double> range(int low, int high, int step) {
    std::vector<double> values;
    for (int v = low; v < high; v += step) values.push_back(v);
    values.push_back(high);
    return values;
}

std::vector<double> with_zero(std::vector<double> values) {
    values.insert(values.begin(), exact_zero);
    return values;
}

std::vector<double> joined(std::vector<double> values, const std::vector<double>& more) {
    values.insert(values.end(), more.begin(), more.end());
    return values;
}

double power_of_two(double knob) {
    return knob == exact_zero ? 0 : std::ldexp(1, static_cast<int>(knob));
}

int exponent_of(double knob) {
    return knob == exact_zero ? -3000 : static_cast<int>(knob);
}

double lattice(source& random) {
    return std::ldexp(static_cast<double>(random.bits() >> 16), -48);
}

double coarse(source& random) {
    return std::ldexp(static_cast<double>(random.bits() >> 20), -44);
}

double length(source& random) {
    return 0.5 + std::ldexp(static_cast<double>(random.bits() >> 17), -48);
}

points placed(source& random, const local_points& local, std::size_t fine) {
    matrix shear{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < i; ++j) shear[i][j] = random.between(-1, 1);
    }
    ends shift{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        shift[0][axis] = 2 * lattice(random) - 1;
        shift[1][axis] = shift[0][axis] + 2 * lattice(random) - 1;
    }
    std::array<std::size_t, 3> from{0, 1, 2};
    std::rotate(from.begin(), from.begin() + random.between(0, 2), from.end());
    if (random.one_in(2)) std::swap(from[0], from[1]);
    return fill([&](std::size_t i, std::size_t end, std::size_t axis) {
        const std::size_t own = from[axis];
        double x = local[i][end][own];
        if (own == fine) return x;
        for (std::size_t j = 0; j < own; ++j) {
            if (j != fine) x += shear[own][j] * local[i][end][j];
        }
        return x + shift[end][own];
    });
}

points relabelled(source& random, kind which, points p) {
    if (which == kind::vertex_face) {
        std::rotate(p.begin() + 1, p.begin() + 1 + random.between(0, 2), p.end());
    } else {
        if (random.one_in(2)) std::swap(p[0], p[1]);
        if (random.one_in(2)) std::swap(p[2], p[3]);
        if (random.one_in(2)) p = {p[2], p[3], p[0], p[1]};
    }
    return p;
}

points reversed_in_time(points p) {
    for (auto& m : p) std::swap(m.t0, m.t1);
    return p;
}

void set_triangle(local_points& p, double l, double c, double h) {
    p[1] = {};
    for (std::size_t end = 0; end < 2; ++end) {
        p[2][end] = {l, 0, 0};
        p[3][end] = {c, h, 0};
    }
}

points near_decision(source& random, kind which) {
    const int exponent = -random.between(36, 56);
    switch (random.between(0, 6)) {
        case 0:
            return near_contact(random, which, 1);
        case 1:
            return border_contact(random, which);
        case 2:
            return shifted(random, which, near_contact(random, which, 1), exponent);
        case 3:
            return resting(random, which);
        case 4:
            return shifted(random, which, resting(random, which), exponent);
        case 5:
            return chosen_roots(random, which, root_triple(random, 2));
        default:
            return sheets(random, which);
    }
}

position any_weights(source& random, std::size_t corners) {
    return random.one_in(2) ? border_weights(random, corners) : weights(random, corners);
}

}  // namespace ccd::stress
