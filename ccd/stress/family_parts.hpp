// What families are made with: knobs, and queries that are built without any rounding, so that
// their contacts are where they are said to be: local coordinates are multiples of `unit` (or tiny
// numbers on an axis of their own), and what puts them into space is exact: see placed().
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "ccd/stress/families.hpp"
#include "ccd/stress/generators/coordinates.hpp"

namespace ccd::stress {

// ---- Knobs ----

/// low, low + step, ... up to high, which is always the last.
std::vector<double> range(int low, int high, int step);

std::vector<double> with_zero(std::vector<double> values);

std::vector<double> joined(std::vector<double> values, const std::vector<double>& more);

/// 2^exponent for a logarithmic knob.
double power_of_two(double knob);

/// The knob as an exponent; for exact zero one that takes every double to zero.
int exponent_of(double knob);

// ---- Exact building ----

/// A position at each end of the step of each point, on axes of its own.
using local_points = std::array<generators::ends, 4>;

/// One unit in the last place of numbers from 4 to 8.
constexpr double unit = 0x1p-50;

/// [0, 1), a multiple of 4 units.
double lattice(source& random);

/// [0, 1), a multiple of 64 units.
double coarse(source& random);

/// [1/2, 1), a multiple of 4 units.
double length(source& random);

/// The local points in space, exactly where they are in contact and where not: axes are sheared by
/// whole numbers, all points moved by one translation per end, axes permuted. Nothing rounds if
/// local coordinates are multiples of `unit` and a point's three add up to at most 6: with a
/// translation of at most 2 they stay within 8. Axis `fine` (3: none) may hold other numbers: it is
/// neither sheared nor moved, nor added to another.
points placed(source& random, const local_points& local, std::size_t fine = 3);

/// Corners rotated, or edges and their ends exchanged: the same contact.
points relabelled(source& random, kind which, points p);

points reversed_in_time(points p);

/// Triangle (0, 0), (l, 0), (c, h) in the plane z = 0, both ends alike.
void set_triangle(local_points& p, double l, double c, double h);

// ---- Near the decision, whatever is done to it next ----

points near_decision(source& random, kind which);

/// Weights of a contact: anywhere, or close to a border.
generators::position any_weights(source& random, std::size_t corners);

}  // namespace ccd::stress
