// The first filter of triangles that intersect, for packs of doubles. Internal; see
// ccd/batch/batch_kernels.hpp for the rules of headers that kernels include.
#pragma once

#include <ccd/kind.hpp>
#include <ccd/methods/forms.hpp>
#include <cstddef>
#include <errbound/sign.hpp>
#include <limits>

#include "ccd/exact/simd.hpp"
#include "ccd/exact/static_filter/constants.hpp"

namespace ccd::detail::ERRBOUND_INSTRUCTION_SET {
namespace {

using vector_pack_form = vector_form<pack, 0>;
struct triangle_pack {
    vector_pack_form vertices[3];
};

inline vector_pack_form difference(const vector_pack_form& q, const vector_pack_form& p) {
    return {{{q.x[0] - p.x[0]}}, {{q.y[0] - p.y[0]}}, {{q.z[0] - p.z[0]}}};
}
inline vector_pack_form select(const pack_mask& m, const vector_pack_form& p,
                               const vector_pack_form& q) {
    return {{{select(m, p.x[0], q.x[0])}},
            {{select(m, p.y[0], q.y[0])}},
            {{select(m, p.z[0], q.z[0])}}};
}

constexpr auto volume_constants() {
    constexpr auto d = errbound::filters::error_count::difference();
    constexpr vector_form<errbound::filters::error_count, 0> any{{{d}}, {{d}}, {{d}}};
    return static_filter::detail::constants_of<double, 3>(
        coplanarity_forms<errbound::filters::error_count, 0>(any, any, any).y()[0], 3);
}

/// Bounds the errors of det(b, c, p) for any three of these differences. Infinite if one of them is
/// too large (errbound/filters/error_count.hpp).
template <class... Differences>
pack error_of_volumes(const Differences&... d) {
    pack x(0.0), y(0.0), z(0.0);
    ((x = max(x, abs(d.x[0])), y = max(y, abs(d.y[0])), z = max(z, abs(d.z[0]))), ...);
    constexpr auto c = volume_constants();
    return select(max(max(x, y), z) <= pack(static_filter::largest_difference<double>),
                  x * y * z * pack(c.relative) + pack(c.absolute),
                  pack(std::numeric_limits<double>::infinity()));
}

/// The lanes where a number is certainly positive or negative.
struct sign_pack {
    pack_mask positive, negative;

    sign_pack(const pack& x, const pack& error) : positive(x > error), negative(x < -error) {}
    sign_pack(const pack_mask& p, const pack_mask& n) : positive(p), negative(n) {}
    pack_mask certain() const { return positive | negative; }
    friend sign_pack operator*(const sign_pack& a, const sign_pack& b) {
        return {(a.positive & b.positive) | (a.negative & b.negative),
                (a.positive & b.negative) | (a.negative & b.positive)};
    }
};

/// The signs of det(b, c, p) for each vertex of a triangle: opposite to the sides of
/// errbound/simplices/relation.hpp.
struct side_pack {
    sign_pack of[3];

    side_pack(const triangle_pack& plane, const triangle_pack& t)
        : side_pack(difference(plane.vertices[1], plane.vertices[0]),
                    difference(plane.vertices[2], plane.vertices[0]),
                    difference(t.vertices[0], plane.vertices[0]),
                    difference(t.vertices[1], plane.vertices[0]),
                    difference(t.vertices[2], plane.vertices[0])) {}

    pack_mask on_one_side() const {
        return (of[0].positive & of[1].positive & of[2].positive) |
               (of[0].negative & of[1].negative & of[2].negative);
    }
    pack_mask certain() const { return of[0].certain() & of[1].certain() & of[2].certain(); }

  private:
    side_pack(const vector_pack_form& b, const vector_pack_form& c, const vector_pack_form& p,
              const vector_pack_form& q, const vector_pack_form& r)
        : side_pack(cross(b, c), p, q, r, error_of_volumes(b, c, p, q, r)) {}
    side_pack(const vector_pack_form& n, const vector_pack_form& p, const vector_pack_form& q,
              const vector_pack_form& r, const pack& error)
        : of{{dot(n, p)[0], error}, {dot(n, q)[0], error}, {dot(n, r)[0], error}} {}
};

/// `one` is the vertex on a side of a plane on which the two others are not. Its edges to `low` and
/// `high` meet the plane, at the ends of errbound::simplices::section. Precondition: sides are
/// certain and not all the same.
struct section_pack {
    sign_pack side;  ///< opposite to the side of `one`
    vector_pack_form one, low, high;

    section_pack(const triangle_pack& t, const side_pack& s)
        : section_pack(t, s, (s.of[1] * s.of[0]).negative & (s.of[1] * s.of[2]).negative,
                       (s.of[2] * s.of[0]).negative & (s.of[2] * s.of[1]).negative) {}

  private:
    section_pack(const triangle_pack& t, const side_pack& s, const pack_mask& is_1,
                 const pack_mask& is_2)
        : side((is_1 & s.of[1].positive) | (is_2 & s.of[2].positive) |
                   (~(is_1 | is_2) & s.of[0].positive),
               (is_1 & s.of[1].negative) | (is_2 & s.of[2].negative) |
                   (~(is_1 | is_2) & s.of[0].negative)) {
        const auto& [v0, v1, v2] = t.vertices;
        const auto chosen = [&](const auto& p, const auto& q, const auto& r) {
            return select(is_1, q, select(is_2, r, p));
        };
        const vector_pack_form next = chosen(v1, v2, v0), previous = chosen(v2, v0, v1);
        one = chosen(v0, v1, v2);
        low = select(side.negative, previous, next);
        high = select(side.negative, next, previous);
    }
};

/// Sets the sign of triangle_intersects_triangle, or uncertain. `elements` are three vertices each.
/// Elements that repeat a vertex are uncertain, since all their volumes are zero. For certain signs
/// that are not zero, the cases are those of relation_of_faces
/// (errbound/simplices/relation.hpp).
template <class Pair>
[[gnu::flatten]] void triangle_signs(const double* positions, const vertex_index* elements,
                                     const Pair* pairs, std::size_t count,
                                     errbound::sign_type* signs) {
    constexpr std::size_t block = 64;
    alignas(64) double columns[18][block] = {};
    for (std::size_t first = 0; first < count; first += block) {
        const std::size_t size = count - first < block ? count - first : block;
        for (std::size_t i = 0; i < size; ++i) {
            const Pair& pair = pairs[first + i];
            for (std::size_t c = 0; c < 6; ++c) {
                const std::size_t element = c < 3 ? pair.first : pair.second;
                const double* x = positions + 3 * std::size_t(elements[3 * element + c % 3]);
                for (std::size_t k = 0; k < 3; ++k) columns[3 * c + k][i] = x[k];
            }
        }
        for (std::size_t at = 0; at < size; at += width) {
            const auto vertex = [&](std::size_t c) {
                const auto coordinate = [&](std::size_t k) {
                    return pack::load_aligned(&columns[3 * c + k][at]);
                };
                return vector_pack_form{{{coordinate(0)}}, {{coordinate(1)}}, {{coordinate(2)}}};
            };
            const triangle_pack a{vertex(0), vertex(1), vertex(2)},
                b{vertex(3), vertex(4), vertex(5)};
            const side_pack of_b(a, b), of_a(b, a);
            lanes disjoint = lanes_of<double>(of_b.on_one_side() | of_a.on_one_side());
            const lanes certain = lanes_of<double>(of_a.certain() & of_b.certain()) & ~disjoint;
            lanes crossing = 0;
            if (certain != 0) {
                const section_pack x(a, of_a), y(b, of_b);
                const auto from_one = [&](const auto& p) { return difference(p, x.one); };
                const vector_pack_form high = from_one(x.high), low = from_one(x.low),
                                       one = from_one(y.one), high_of_b = from_one(y.high),
                                       low_of_b = from_one(y.low);
                const pack error = error_of_volumes(high, low, one, high_of_b, low_of_b);
                const sign_pack same = x.side * y.side;
                const sign_pack after =
                    same * sign_pack(dot(cross(high, one), high_of_b)[0], error);
                const sign_pack before = same * sign_pack(dot(cross(low, one), low_of_b)[0], error);
                disjoint |= certain & lanes_of<double>(after.negative | before.positive);
                crossing = certain & lanes_of<double>(after.positive & before.negative);
            }
            for (std::size_t i = 0; i < width && at + i < size; ++i)
                signs[first + at + i] = (disjoint >> i & 1) != 0   ? errbound::sign_type::negative
                                        : (crossing >> i & 1) != 0 ? errbound::sign_type::positive
                                                                   : errbound::sign_type::uncertain;
        }
    }
}

}  // namespace
}  // namespace ccd::detail::ERRBOUND_INSTRUCTION_SET
