// Seeded families of random queries, from plain to hostile, the same with every standard library.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ccd/lab/generators.hpp"
#include "tests/support/near_degenerate.hpp"

namespace query_families {

using ccd::kind;
using namespace ccd::lab;  // points, their source, and their conversion to queries

struct family {
    std::string_view name;
    points (*make)(source& random, kind which);
    /// Tests take one query in this many, since exact answers of some cost tens of milliseconds.
    unsigned thinning = 1;
};

namespace detail {

using namespace generators;

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

inline points clustered(source& random) {
    const position centre{random.symmetric(), random.symmetric(), random.symmetric()};
    return fill([&](std::size_t, std::size_t, std::size_t axis) {
        return centre[axis] + std::ldexp(random.symmetric(), -10);
    });
}

// Quarter turns about one axis, either way. The cubics have extrema and an inflection inside.
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

// Multiples of the least positive double.
inline points subnormal(source& random) {
    const int size = random.between(1, 16);
    return fill(
        [&](auto...) { return std::ldexp(random.between(-(1 << size), 1 << size), -1074); });
}

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

inline points rounded_to_float(const points& p) {
    return map(p, [](double x, auto...) { return static_cast<float>(x); });
}

inline points rounded_to_digits(const points& p) {
    return map(p, [](double x, auto...) { return std::round(1000 * x) / 1000; });
}

// Each axis has three values: exact degeneracies of coordinates that fill their 53 bits.
inline points few_values(source& random) {
    std::array<position, 3> values;
    for (auto& axis : values) axis = {random.symmetric(), random.symmetric(), random.symmetric()};
    return fill([&](std::size_t, std::size_t, std::size_t axis) {
        return values[axis][static_cast<std::size_t>(random.between(0, 2))];
    });
}

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

// One point takes the position of another, at the start, the end or both.
inline points merged(source& random, points p) {
    const auto from = static_cast<std::size_t>(random.between(0, 3));
    const auto to = static_cast<std::size_t>(random.between(0, 3));
    const int which = random.between(0, 2);
    if (which != 1) p[to].t0 = p[from].t0;
    if (which != 0) p[to].t1 = p[from].t1;
    return p;
}

inline point<double> along(const point<double>& a, const point<double>& b, const point<double>& c,
                           int k) {
    return {a.x + k * (c.x - b.x), a.y + k * (c.y - b.y), a.z + k * (c.z - b.z)};
}

// Moves the fourth point: edges are parallel, or the triangle is a segment, at the start, the end
// or both.
inline points parallel(source& random, kind which, points p) {
    const int k = random.between(-2, 2);
    const int when = random.between(0, 2);
    const std::size_t from = which == kind::vertex_face ? 1 : 0;
    const std::size_t base = which == kind::vertex_face ? 1 : 2;
    if (when != 1) p[3].t0 = along(p[base].t0, p[from].t0, p[from + 1].t0, k);
    if (when != 0) p[3].t1 = along(p[base].t1, p[from].t1, p[from + 1].t1, k);
    return p;
}

// On one axis all coordinates are at most 2^exponent.
inline points nearly_in_plane(source& random, const points& p, int exponent) {
    const auto flat = static_cast<std::size_t>(random.between(0, 2));
    return map(p, [&](double x, std::size_t, std::size_t, std::size_t axis) {
        return axis == flat ? std::ldexp(random.symmetric(), exponent) : x;
    });
}

inline points translated(source& random, kind which, const points& p) {
    const std::size_t first_feature = first_feature_size(which);
    std::array<position, 2> shift;
    for (auto& s : shift) s = {random.symmetric(), random.symmetric(), random.symmetric()};
    points out = all_frozen(p);
    return map(out, [&](double x, std::size_t i, std::size_t end, std::size_t axis) {
        return end == 0 ? x : x + shift[i < first_feature ? 0 : 1][axis];
    });
}

inline points far_from_origin(source& random, kind which, int exponent) {
    const position offset{random.symmetric(), random.symmetric(), random.symmetric()};
    return map(near_contact(random, which, 0.5),
               [&](double x, std::size_t, std::size_t, std::size_t axis) {
                   return x + std::ldexp(offset[axis], exponent);
               });
}

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
    {"border", [](source& r, kind k) { return border_contact(r, k); }},
    {"missed-by-2^-36..56",
     [](source& r, kind k) {
         const int exponent = -r.between(36, 56);
         return shifted(r, k, near_contact(r, k, 1), exponent);
     }},
    {"resting", [](source& r, kind k) { return resting(r, k); }},
    {"resting-1-ulp", [](source& r, kind k) { return jitter(r, resting(r, k), 1); }},
    {"hovering-2^-36..56",
     [](source& r, kind k) {
         const int exponent = -r.between(36, 56);
         return shifted(r, k, resting(r, k), exponent);
     }},
    {"grazing-2^-20..56",
     [](source& r, kind k) {
         const int exponent = -r.between(20, 56);
         return shifted(r, k, chosen_roots(r, k, root_triple(r, 2)), exponent);
     }},
    {"sliver-2^-20..56", [](source& r, kind k) { return sliver(r, k, -r.between(20, 56)); }},
    {"needle-2^-20..56", [](source& r, kind k) { return needle(r, k, -r.between(20, 56)); }},
    {"nearly-coplanar-2^-20..60",
     [](source& r, kind) {
         const int exponent = -r.between(20, 60);
         return nearly_in_plane(r, uniform(r), exponent);
     }},
    {"nearly-coplanar-contact",
     [](source& r, kind k) {
         const int exponent = -r.between(20, 60);
         return nearly_in_plane(r, near_contact(r, k, 1), exponent);
     }},
    {"float-contact", [](source& r, kind k) { return rounded_to_float(near_contact(r, k, 1)); }},
    {"float-resting", [](source& r, kind k) { return rounded_to_float(resting(r, k)); }},
    {"float-offset-2^4..16",
     [](source& r, kind k) { return rounded_to_float(far_from_origin(r, k, r.between(4, 16))); }},
    {"three-digits", [](source& r, kind k) { return rounded_to_digits(near_contact(r, k, 1)); }},
    {"few-values", [](source& r, kind) { return few_values(r); }},
    {"sheets", [](source& r, kind k) { return sheets(r, k); }},
    {"sheets-float", [](source& r, kind k) { return rounded_to_float(sheets(r, k)); }},
    {"contact-2^+-160..380",
     [](source& r, kind k) {
         const int exponent = r.between(160, 380);
         return scale(r, near_contact(r, k, 1), exponent);
     }},
    {"axis-2^+-0..200",
     [](source& r, kind k) {
         const int exponent = r.between(0, 200);
         return scale_axis(r, near_contact(r, k, 1), exponent);
     }},
    {"point-2^+-0..200",
     [](source& r, kind k) {
         const int exponent = r.between(0, 200);
         return scale_point(r, near_contact(r, k, 1), exponent);
     }},
    {"grid3-nudged", [](source& r, kind) { return nudged(r, grid(r, 1)); }},
    {"grid-0-1",
     [](source& r, kind) { return fill([&](auto...) { return double(r.between(0, 1)); }); }},
    {"grid-far", [](source& r, kind) { return far_grid(r); }},
    {"grid-far-nudged", [](source& r, kind) { return nudged(r, far_grid(r)); }},
    {"grid-subnormal",
     [](source& r, kind) {
         return map(grid(r, 2), [](double x, auto...) { return std::ldexp(x, -1074); });
     }},
    {"grid-largest",
     [](source& r, kind) {
         return map(grid(r, 1), [](double x, auto...) { return std::ldexp(x, 1023); });
     }},
    {"skew-plane", [](source& r, kind) { return in_skew_span(r, 2); }},
    {"skew-plane-nudged", [](source& r, kind) { return nudged(r, in_skew_span(r, 2)); }},
    {"skew-line", [](source& r, kind) { return in_skew_span(r, 1); }},
    {"skew-line-nudged", [](source& r, kind) { return nudged(r, in_skew_span(r, 1)); }},
    {"exact-contact", [](source& r, kind k) { return exact_contact(r, k); }},
    {"exact-contact-nudged", [](source& r, kind k) { return nudged(r, exact_contact(r, k)); }},
    {"crossing", [](source& r, kind) { return crossing(r, grid(r, 2)); }},
    {"crossing-nudged", [](source& r, kind) { return nudged(r, crossing(r, grid(r, 2))); }},
    {"mirrored", [](source& r, kind) { return mirrored(r, uniform(r)); }},
    {"double-root-nudged",
     [](source& r, kind k) { return nudged(r, chosen_roots(r, k, root_triple(r, 2))); }},
    {"triple-root-nudged",
     [](source& r, kind k) { return nudged(r, chosen_roots(r, k, root_triple(r, 3))); }},
    {"grid-parallel-nudged",
     [](source& r, kind k) { return nudged(r, parallel(r, k, grid(r, 1))); }},
    {"few-values-nudged", [](source& r, kind) { return nudged(r, few_values(r)); }},
    {"moving-1-ulp",
     [](source& r, kind k) {
         points p = all_frozen(near_contact(r, k, 0));
         const points moved = jitter(r, p, 1);
         for (std::size_t i = 0; i < p.size(); ++i) p[i].t1 = moved[i].t1;
         return p;
     }},
};

}  // namespace detail

inline constexpr auto& families = detail::list;

/// Query `index` of a family. New families do not change the existing ones.
inline points make(const family& f, kind which, std::uint64_t seed, std::uint64_t index) {
    source random = source_of(f.name, {static_cast<std::uint64_t>(which), seed, index});
    return f.make(random, which);
}

/// The first queries of all families, of one kind.
template <class Query>
std::vector<Query> of_all_families(std::uint64_t per_family, std::uint64_t seed) {
    std::vector<Query> all;
    for (const auto& f : families)
        for (std::uint64_t i = 0; i * f.thinning < per_family; ++i)
            all.push_back(as_query<Query>(make(f, ccd::kind_of<Query>, seed, i)));
    return all;
}

/// Calls check(query, text) for queries of all families and kinds: `per_family` of each, divided by
/// its thinning.
template <class Check>
void for_some_queries(std::uint64_t per_family, std::uint64_t seed, const Check& check) {
    for (const kind which :
         {kind::vertex_face, kind::edge_edge, kind::vertex_edge, kind::vertex_vertex}) {
        for (const auto& f : families) {
            for (std::uint64_t i = 0; i * f.thinning < per_family; ++i) {
                const points p = make(f, which, seed, i);
                const std::string text = std::string(f.name) + " " + std::to_string(i) + " " +
                                         std::string(path_name(which)) + "\n" + csv(p);
                visit_query(which, p, [&](const auto& q) { check(q, text); });
            }
        }
    }
}

}  // namespace query_families
