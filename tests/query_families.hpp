// Seeded families of random queries, from plain to hostile, the same on every standard library.
#pragma once

#include <array>
#include <bit>
#include <ccd/query.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <string_view>
#include <utility>

namespace query_families {

enum class kind { vertex_face, edge_edge, vertex_edge, vertex_vertex };

/// Four points in the order of the query's members; shorter kinds use the first three or two.
using points = std::array<ccd::moving_point<double>, 4>;

/// Random numbers by integer arithmetic alone: std distributions differ between libraries.
class source {
  public:
    explicit source(std::uint64_t seed) : bits_(seed) {}

    std::uint64_t bits() { return bits_(); }
    /// low..high; the modulo's bias is far below what a test could see.
    int between(int low, int high) {
        return low + static_cast<int>(bits_() % static_cast<std::uint64_t>(high - low + 1));
    }
    bool one_in(int n) { return between(1, n) == 1; }
    /// [0, 1), a multiple of 2^-53.
    double unit() { return std::ldexp(static_cast<double>(bits_() >> 11), -53); }
    /// [-1, 1), a multiple of 2^-52.
    double symmetric() { return 2 * unit() - 1; }

  private:
    std::mt19937_64 bits_;
};

namespace detail {

using position = std::array<double, 3>;  // also a displacement

// A position at the start and one at the end of the step.
using ends = std::array<position, 2>;

inline ccd::moving_point<double> moving(const ends& e) {
    return {{e[0][0], e[0][1], e[0][2]}, {e[1][0], e[1][1], e[1][2]}};
}

// make(point, end, axis) for all 24 numbers, in one fixed order.
template <class Make>
points fill(Make make) {
    points out;
    for (std::size_t i = 0; i < 4; ++i) {
        ends e;
        for (std::size_t end = 0; end < 2; ++end) {
            for (std::size_t axis = 0; axis < 3; ++axis) e[end][axis] = make(i, end, axis);
        }
        out[i] = moving(e);
    }
    return out;
}

// change(value, point, end, axis) of all 24 numbers.
template <class Change>
points map(const points& p, Change change) {
    return fill([&](std::size_t i, std::size_t end, std::size_t axis) {
        const ccd::point<double>& at = end == 0 ? p[i].t0 : p[i].t1;
        return change(std::array{at.x, at.y, at.z}[axis], i, end, axis);
    });
}

// The sign of every exponent below is drawn: 2^exponent or 2^-exponent.
inline int either_sign(source& random, int exponent) {
    return random.one_in(2) ? exponent : -exponent;
}

inline points scale(source& random, const points& p, int exponent) {
    const int drawn = either_sign(random, exponent);
    return map(p, [&](double x, auto...) { return std::ldexp(x, drawn); });
}

inline points scale_axis(source& random, const points& p, int exponent) {
    const int drawn = either_sign(random, exponent);
    const auto scaled = static_cast<std::size_t>(random.between(0, 2));
    return map(p, [&](double x, std::size_t, std::size_t, std::size_t axis) {
        return axis == scaled ? std::ldexp(x, drawn) : x;
    });
}

inline points scale_point(source& random, const points& p, int exponent) {
    const int drawn = either_sign(random, exponent);
    const auto scaled = static_cast<std::size_t>(random.between(0, 3));
    return map(p, [&](double x, std::size_t point, auto...) {
        return point == scaled ? std::ldexp(x, drawn) : x;
    });
}

// x moved by at most `most` units in its last place; a zero by units of 2^-53, since its neighbours
// would bring in a second scale (the families of mixed scales do that).
inline double jitter(source& random, double x, int most) {
    const int units = random.between(-most, most);
    if (x == 0) return std::ldexp(units, -53);
    for (int n = std::abs(units); n > 0; --n) {
        x = std::nextafter(x, units * std::numeric_limits<double>::infinity());
    }
    return x;
}

inline points jitter(source& random, const points& p, int most) {
    return map(p, [&](double x, auto...) { return jitter(random, x, most); });
}

inline points uniform(source& random) {
    return fill([&](auto...) { return random.symmetric(); });
}

// All within 2^-10 of one another, and moving no further.
inline points clustered(source& random) {
    const position centre{random.symmetric(), random.symmetric(), random.symmetric()};
    return fill([&](std::size_t, std::size_t, std::size_t axis) {
        return centre[axis] + std::ldexp(random.symmetric(), -10);
    });
}

inline points grid(source& random, int half) {
    return fill([&](auto...) { return random.between(-half, half); });
}

// Half of the points, at random, do not move.
inline points part_frozen(source& random, points p) {
    for (auto& m : p) {
        if (random.one_in(2)) m.t1 = m.t0;
    }
    return p;
}

inline points all_frozen(points p) {
    for (auto& m : p) m.t1 = m.t0;
    return p;
}

inline points in_plane(source& random, const points& p) {
    const auto flat = static_cast<std::size_t>(random.between(0, 2));
    return map(p, [&](double x, std::size_t, std::size_t, std::size_t axis) {
        return axis == flat ? 0 : x;
    });
}

inline points on_line(source& random, const points& p) {
    const auto line = static_cast<std::size_t>(random.between(0, 2));
    return map(p, [&](double x, std::size_t, std::size_t, std::size_t axis) {
        return axis == line ? x : 0;
    });
}

// Identical points: at one end or at both, one point takes another's place.
inline points merged(source& random, points p) {
    const auto from = static_cast<std::size_t>(random.between(0, 3));
    const auto to = static_cast<std::size_t>(random.between(0, 3));
    const int which = random.between(0, 2);
    if (which != 1) p[to].t0 = p[from].t0;
    if (which != 0) p[to].t1 = p[from].t1;
    return p;
}

inline ccd::point<double> along(const ccd::point<double>& a, const ccd::point<double>& b,
                                const ccd::point<double>& c, int k) {
    return {a.x + k * (c.x - b.x), a.y + k * (c.y - b.y), a.z + k * (c.z - b.z)};
}

// The fourth point parallel to the others: parallel edges, or a triangle collapsed to a segment;
// throughout the step, or only at its start or its end.
inline points parallel(source& random, kind which, points p) {
    const int k = random.between(-2, 2);
    const int when = random.between(0, 2);
    const std::size_t from = which == kind::vertex_face ? 1 : 0;
    const std::size_t base = which == kind::vertex_face ? 1 : 2;
    if (when != 1) p[3].t0 = along(p[base].t0, p[from].t0, p[from + 1].t0, k);
    if (when != 0) p[3].t1 = along(p[base].t1, p[from].t1, p[from + 1].t1, k);
    return p;
}

// Each feature moves as a whole.
inline points translated(source& random, kind which, const points& p) {
    const std::size_t first_feature = which == kind::edge_edge ? std::size_t{2} : std::size_t{1};
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

// A contact at one instant, as near as rounding allows: the points are placed there, then each
// gets a velocity of its own, times `speed`.
inline points near_contact(source& random, kind which, double speed) {
    std::array<position, 4> at;
    for (auto& p : at) p = {random.symmetric(), random.symmetric(), random.symmetric()};
    if (which == kind::edge_edge) {
        const position a = weights(random, 2);
        const position b = weights(random, 2);
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
        const position w = weights(random, corners);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            at[0][axis] = w[0] * at[1][axis] + w[1] * at[2][axis] + w[2] * at[3][axis];
        }
    }
    const int when = random.between(0, 3);
    const double t = when == 0 ? 0 : when == 1 ? 1 : when == 2 ? 0.5 : random.unit();
    std::array<position, 4> velocity;
    for (auto& v : velocity) v = {random.symmetric(), random.symmetric(), random.symmetric()};
    return fill([&](std::size_t i, std::size_t end, std::size_t axis) {
        return at[i][axis] + speed * velocity[i][axis] * (end == 0 ? -t : 1 - t);
    });
}

using matrix = std::array<position, 3>;  // rows

inline matrix product(const matrix& a, const matrix& b) {
    matrix c{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            for (std::size_t k = 0; k < 3; ++k) c[i][j] += a[i][k] * b[k][j];
        }
    }
    return c;
}

struct fraction {
    int numerator = 0, denominator = 1;
};

// Contacts at roots of the coplanarity function that are chosen, multiplicities included, exactly.
//
// The columns of M(t) = U T(t) V are the query's three differences. T is upper triangular, its
// diagonal vanishes at the chosen roots r0, r1 and r2, so det M has just those. At r0 the first
// unit vector is in T's kernel, and V = n A^-1 for A with first column (x, y, n) puts (x, y, n)
// into M's: that makes x and y, over n, the weights of the contact. All numbers are small and
// whole, so nothing rounds.
inline points chosen_roots(source& random, kind which, const std::array<fraction, 3>& roots) {
    const bool face = which == kind::vertex_face;
    const int n = random.between(1, 4);
    const int i = random.between(0, n);
    const int j = random.between(0, face ? n - i : n);
    // VF: p - f0 = (i (f1 - f0) + j (f2 - f0)) / n. EE: a0 + (i/n) a = b0 + (j/n) b.
    const double x = face ? -i : i;
    const double y = -j;
    const double w = face ? n : -n;
    const matrix v{{{0, 0, 1}, {w, 0, -x}, {0, w, -y}}};
    const matrix u{{{1, static_cast<double>(random.between(-1, 1)), 0},
                    {0, 1, static_cast<double>(random.between(-1, 1))},
                    {static_cast<double>(random.between(-1, 1)), 0, 1}}};
    std::array<matrix, 2> m;
    const std::array<double, 3> above{static_cast<double>(random.between(-2, 2)),
                                      static_cast<double>(random.between(-2, 2)),
                                      static_cast<double>(random.between(-2, 2))};
    const std::array<double, 3> slope{static_cast<double>(random.between(-2, 2)),
                                      static_cast<double>(random.between(-2, 2)),
                                      static_cast<double>(random.between(-2, 2))};
    for (std::size_t end = 0; end < 2; ++end) {
        const auto t = static_cast<double>(end);
        const auto vanishing = [t](const fraction& root) {
            return root.denominator * t - root.numerator;
        };
        const matrix upper{{{vanishing(roots[0]), above[0] + t * slope[0], above[1] + t * slope[1]},
                            {0, vanishing(roots[1]), above[2] + t * slope[2]},
                            {0, 0, vanishing(roots[2])}}};
        m[end] = product(product(u, upper), v);
    }
    ends base;
    for (auto& e : base) {
        for (double& c : e) c = random.between(-2, 2);
    }
    const auto offset = [&](std::size_t column, std::size_t end, std::size_t axis) {
        return base[end][axis] + m[end][axis][column];
    };
    return fill([&](std::size_t point, std::size_t end, std::size_t axis) {
        if (face) {
            if (point == 1) return base[end][axis];
            return offset(point == 0 ? 2 : point - 2, end, axis);
        }
        if (point == 0) return base[end][axis];
        if (point == 1) return offset(0, end, axis);
        const double b0 = offset(2, end, axis);
        return point == 2 ? b0 : b0 + m[end][axis][1];
    });
}

inline std::array<fraction, 3> root_triple(source& random, int multiplicity) {
    std::array<fraction, 3> r;
    for (fraction& root : r) {
        root.denominator = random.between(1, 8);
        root.numerator = random.between(0, root.denominator);
    }
    if (multiplicity > 1) r[1] = r[0];
    if (multiplicity > 2) r[2] = r[0];
    return r;
}

// Every point is turned a quarter round one axis, one way or the other, as spinning parts are:
// cubics with extrema and an inflection inside.
inline points rotating(source& random) {
    points p = uniform(random);
    for (auto& m : p) {
        const double lift = 0.25 * random.symmetric();
        const double grow = 1 + 0.25 * random.symmetric();
        m.t1 = {-grow * m.t0.y, grow * m.t0.x, m.t0.z + lift};
        if (random.one_in(2)) std::swap(m.t0, m.t1);
    }
    return p;
}

inline points far_from_origin(source& random, kind which, int exponent) {
    const position offset{random.symmetric(), random.symmetric(), random.symmetric()};
    return map(near_contact(random, which, 0.5),
               [&](double x, std::size_t, std::size_t, std::size_t axis) {
                   return x + std::ldexp(offset[axis], exponent);
               });
}

// Multiples of the least positive double.
inline points subnormal(source& random) {
    const int size = random.between(1, 16);
    return fill(
        [&](auto...) { return std::ldexp(random.between(-(1 << size), 1 << size), -1074); });
}

// Any finite doubles.
inline points any_bits(source& random) {
    return fill([&](auto...) {
        for (;;) {
            const auto x = std::bit_cast<double>(random.bits());
            if (std::isfinite(x)) return x;
        }
    });
}

// Powers of two of every size, so that one query holds many scales.
inline points mixed_scales(source& random, int range) {
    return fill([&](auto...) {
        const int factor = random.between(-2, 2);
        return std::ldexp(factor, random.between(-range, range));
    });
}

}  // namespace detail

struct family {
    std::string_view name;
    points (*make)(source& random, kind which);
    /// Tests take one in this many: where exact answers cost tens of milliseconds.
    unsigned thinning = 1;
};

namespace detail {

inline constexpr family list[] = {
    {"uniform", [](source& r, kind) { return uniform(r); }},
    {"clustered", [](source& r, kind) { return clustered(r); }},
    {"grid3", [](source& r, kind) { return grid(r, 1); }},
    {"grid5", [](source& r, kind) { return grid(r, 2); }},
    {"grid-part-frozen", [](source& r, kind) { return part_frozen(r, grid(r, 1)); }},
    {"grid-coplanar", [](source& r, kind) { return in_plane(r, grid(r, 2)); }},
    {"grid-collinear", [](source& r, kind) { return on_line(r, grid(r, 3)); }},
    {"grid-merged", [](source& r, kind) { return merged(r, grid(r, 1)); }},
    {"grid-parallel", [](source& r, kind k) { return parallel(r, k, grid(r, 1)); }},
    {"frozen-grid", [](source& r, kind) { return all_frozen(grid(r, 1)); }},
    {"frozen-uniform", [](source& r, kind) { return all_frozen(uniform(r)); }},
    {"coplanar-uniform", [](source& r, kind) { return in_plane(r, uniform(r)); }},
    {"translated-grid", [](source& r, kind k) { return translated(r, k, grid(r, 1)); }},
    {"translated-uniform", [](source& r, kind k) { return translated(r, k, uniform(r)); }},
    {"grid-2^+-300", [](source& r, kind) { return scale(r, grid(r, 1), 300); }},
    {"grid-2^+-1000", [](source& r, kind) { return scale(r, grid(r, 1), 1000); }},
    {"contact-2^+-300", [](source& r, kind k) { return scale(r, near_contact(r, k, 1), 300); }},
    {"contact-2^+-1000", [](source& r, kind k) { return scale(r, near_contact(r, k, 1), 1000); }},
    {"axis-2^+-40", [](source& r, kind k) { return scale_axis(r, near_contact(r, k, 1), 40); }},
    {"axis-2^+-300", [](source& r, kind k) { return scale_axis(r, near_contact(r, k, 1), 300); }},
    {"point-2^+-40", [](source& r, kind) { return scale_point(r, uniform(r), 40); }},
    {"point-2^+-300", [](source& r, kind) { return scale_point(r, grid(r, 2), 300); }},
    {"contact", [](source& r, kind k) { return near_contact(r, k, 1); }},
    {"contact-3-ulp", [](source& r, kind k) { return jitter(r, near_contact(r, k, 1), 3); }},
    {"contact-slow",
     [](source& r, kind k) { return jitter(r, near_contact(r, k, std::ldexp(1, -20)), 3); }},
    {"contact-coplanar",
     [](source& r, kind k) { return jitter(r, in_plane(r, near_contact(r, k, 1)), 1); }},
    {"offset-2^20..50", [](source& r, kind k) { return far_from_origin(r, k, r.between(20, 50)); }},
    {"subnormal", [](source& r, kind) { return subnormal(r); }},
    {"double-root", [](source& r, kind k) { return chosen_roots(r, k, root_triple(r, 2)); }},
    {"double-root-2^+-300",
     [](source& r, kind k) { return scale(r, chosen_roots(r, k, root_triple(r, 2)), 300); }},
    {"double-root-3-ulp",
     [](source& r, kind k) { return jitter(r, chosen_roots(r, k, root_triple(r, 2)), 3); }},
    {"triple-root", [](source& r, kind k) { return chosen_roots(r, k, root_triple(r, 3)); }},
    {"triple-root-3-ulp",
     [](source& r, kind k) { return jitter(r, chosen_roots(r, k, root_triple(r, 3)), 3); }},
    {"three-roots", [](source& r, kind k) { return chosen_roots(r, k, root_triple(r, 1)); }},
    {"three-roots-3-ulp",
     [](source& r, kind k) { return jitter(r, chosen_roots(r, k, root_triple(r, 1)), 3); }},
    {"rotating", [](source& r, kind) { return rotating(r); }},
    {"mixed-2^+-30", [](source& r, kind) { return mixed_scales(r, 30); }},
    {"mixed-2^+-1000", [](source& r, kind) { return mixed_scales(r, 1000); }, 20},
    {"any-bits", [](source& r, kind) { return any_bits(r); }, 20},
};

}  // namespace detail

inline constexpr auto& families = detail::list;

/// Query `index` of a family: its own generator, so one can be made again without the others, and
/// new families leave the old ones as they were.
inline points make(const family& f, kind which, std::uint64_t seed, std::uint64_t index) {
    std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a
    const auto stir = [&hash](std::uint64_t word) { hash = (hash ^ word) * 0x100000001b3; };
    for (const char c : f.name) stir(static_cast<unsigned char>(c));
    stir(static_cast<std::uint64_t>(which));
    stir(seed);
    stir(index);
    source random(hash);
    return f.make(random, which);
}

inline ccd::vertex_face<double> as_vertex_face(const points& p) {
    return {p[0], p[1], p[2], p[3]};
}
inline ccd::edge_edge<double> as_edge_edge(const points& p) {
    return {p[0], p[1], p[2], p[3]};
}
inline ccd::vertex_edge<double> as_vertex_edge(const points& p) {
    return {p[0], p[1], p[2]};
}
inline ccd::vertex_vertex<double> as_vertex_vertex(const points& p) {
    return {p[0], p[1]};
}

}  // namespace query_families
