// The vectors b, c and p of queries in integers of up to 250 bits, and a subinterval of the step.
// Y has a rational root, or one close to a rational, at which
// weights, the normal or all vectors vanish or nearly do.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/methods/forms.hpp>
#include <cstddef>
#include <cstdint>
#include <errbound/bernstein.hpp>
#include <errbound/integers/fixed_integer.hpp>

#include "tests/proofs/drawn_query.hpp"
#include "tests/proofs/table.hpp"

namespace tie {

using whole_number = errbound::integers::fixed_integer<4>;
using whole_vector = ccd::vector_form<whole_number, 1>;

/// The product modulo its width.
inline whole_number product(const whole_number& a, const whole_number& b) {
    return (a * b).from_bit<4>(0);
}
inline whole_number drawn_below(sequence& s, int bits) {
    if (bits <= 30) return draw(s, 1 << bits);
    const whole_number high = drawn_below(s, bits - 30);
    return (high << 30) + whole_number(draw(s, 1 << 30));
}
inline whole_number drawn_within(sequence& s, int bits) {
    const whole_number size = drawn_below(s, bits);
    return draw(s, 2) == 0 ? size : -size;
}
inline int pick(sequence& s, int size) {
    return draw(s, 2 * size + 1) - size;
}

struct drawn_forms {
    bool edges;
    std::array<whole_vector, 3> vectors;  ///< b, c and p
    int level;                            ///< of the subinterval
    std::uint64_t path;            ///< to the subinterval, where no sign change determines it
    std::int64_t off;              ///< distance from the root's expected position there
    whole_number root, root_unit;  ///< the root of all is their quotient
    int words, cut;                ///< of a position there: `cut` determines the number of words

    /// The most bits of an axis' coordinates.
    int bits(std::size_t axis) const {
        int most = 0;
        for (const auto& v : vectors) {
            const auto& x = axis == 0 ? v.x : axis == 1 ? v.y : v.z;
            most = std::max({most, x[0].bit_length(), x[1].bit_length()});
        }
        return most;
    }
    int bits() const { return std::max({bits(0), bits(1), bits(2)}); }

    /// The root's position times 2^bits, rounded down.
    whole_number place(int bits) const {
        whole_number quotient, rest = root;
        for (int i = 0; i < bits; ++i) {
            rest = rest << 1;
            const bool one = rest >= root_unit;
            quotient = (quotient << 1) + whole_number(one);
            if (one) rest = rest - root_unit;
        }
        return quotient;
    }

    /// Calls visit.operator()<Forms>().
    template <class Visit>
    void with_kind(const Visit& visit) const {
        if (edges)
            visit.template operator()<ccd::edge_edge_forms>();
        else
            visit.template operator()<ccd::vertex_face_forms>();
    }

    /// The forms in integers that `convert` makes of coordinates.
    template <template <class, int> class Forms, class Convert>
    auto as(const Convert& convert) const {
        using integer = decltype(convert(whole_number()));
        const auto converted = [&](const whole_vector& v) {
            const auto component = [&](const errbound::bernstein<whole_number, 1>& x) {
                return errbound::bernstein<integer, 1>{{convert(x[0]), convert(x[1])}};
            };
            return ccd::vector_form<integer, 1>{component(v.x), component(v.y), component(v.z)};
        };
        return Forms<integer, 1>{converted(vectors[0]), converted(vectors[1]),
                                 converted(vectors[2])};
    }
};

class whole_forms_maker {
  public:
    explicit whole_forms_maker(sequence& s) : s_(s) {}

    drawn_forms forms() {
        const int kind = draw(s_, 8);
        drawn_forms f{};
        f.edges = draw(s_, 2) == 1;
        draw_place();
        for (auto& row : slopes_)
            for (whole_number& slope : row) slope = drawn_within(s_, slope_bits_);
        for (auto& row : values_)
            for (whole_number& value : row) value = draw(s_, 2) == 0 ? 0 : pick(s_, 2);
        if (kind == 0) in_a_plane();
        if (kind == 1) keep_diagonal();
        if (kind == 2) of_rank_one();
        if (kind == 3)
            for (std::size_t x = 0; x < 3; ++x) values_[1][x] = values_[0][x] + values_[0][x];
        if (kind == 4) move_in_a_plane();
        if (kind == 5) cross_inside();
        if (kind >= 6) meet_inside();
        constexpr std::array<std::array<std::size_t, 3>, 6> orders{
            {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {1, 0, 2}, {2, 1, 0}}};
        const auto& order = orders[static_cast<std::size_t>(kind < 5 ? draw(s_, 6) : 0)];
        const bool back = draw(s_, 2) == 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto motion = [&](std::size_t x) { return moved(order[i], x, back); };
            f.vectors[i] = {motion(0), motion(1), motion(2)};
        }
        f.root_unit = product(q_ + whole_number(1), u_) + whole_number(1);
        f.root = back ? f.root_unit - u_ : u_;
        f.level = draw(s_, 2) == 0 ? 40 : draw(s_, 40);
        f.path = s_.draw(std::uint64_t{1} << 40);
        constexpr std::array<int, 3> reaches{4, 14, 24};
        const int reach = draw(s_, 6);
        f.off = reach < 3 ? std::int64_t{pick(s_, 1)} << reaches[static_cast<std::size_t>(reach)]
                          : pick(s_, 1 << draw(s_, 27));
        f.words = 1 + draw(s_, 4);
        f.cut = draw(s_, 2) == 0 ? draw(s_, 3) : draw(s_, 64);
        return f;
    }

  private:
    /// Draws the root u/d, d = (q + 1)·u + 1, and sizes.
    void draw_place() {
        const int size = draw(s_, 4);
        const int bits = size == 0   ? 2 + draw(s_, 12)
                         : size == 1 ? 12 + draw(s_, 60)
                         : size == 2 ? 72 + draw(s_, 130)
                                     : 202 + draw(s_, 46);
        const bool dyadic = draw(s_, 6) == 0;
        const int of_u =
            dyadic ? 1 + draw(s_, std::min(2 * bits / 3, 50)) : draw(s_, 2 * bits / 3 + 1);
        const int of_q = dyadic ? 0 : draw(s_, 4) == 0 ? draw(s_, bits / 6 + 1) : draw(s_, 3);
        u_ = dyadic ? whole_number((std::int64_t{1} << of_u) - 1)
                    : drawn_below(s_, of_u) + whole_number(1);
        q_ = drawn_below(s_, of_q);
        value_bits_ = std::max(0, bits - of_q);
        slope_bits_ = std::max(1, bits - of_q - of_u);
    }

    /// At the root the vectors are in a plane, or almost, with p·b and c·b nearly parallel.
    void in_a_plane() {
        const int of_h = draw(s_, value_bits_ + 1), more = value_bits_ - of_h;
        const auto h = drawn_below(s_, of_h);
        const auto factor = [&] {
            return draw(s_, 3) == 0 ? drawn_within(s_, draw(s_, more + 1))
                                    : whole_number(pick(s_, 1));
        };
        const auto g = factor();
        const auto j = factor();
        const auto k = drawn_within(s_, draw(s_, value_bits_ + 1));
        const whole_number d = pick(s_, 3);
        values_[0] = {h, 1, 0};
        values_[1] = {product(h, j) - k, j, 0};
        values_[2] = {product(h, g) + d, g, 0};
        for (auto& row : values_) row[2] = draw(s_, 4) == 0 ? pick(s_, 1) : 0;
    }
    /// Y is nearly a product of three linear forms with the root.
    void keep_diagonal() {
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t x = 0; x < 3; ++x)
                if (i != x) slopes_[i][x] = 0;
    }
    /// A double or triple root.
    void of_rank_one() {
        if (draw(s_, 3) == 0) values_[0] = {0, 0, 0};
        for (std::size_t i = 1; i < 3; ++i) {
            const whole_number times = pick(s_, 2);
            for (std::size_t x = 0; x < 3; ++x) values_[i][x] = product(times, values_[0][x]);
        }
    }
    /// b and c are in one plane throughout, whose normal vanishes together with their cross
    /// product.
    void move_in_a_plane() {
        for (std::size_t i = 0; i < 2; ++i) {
            values_[i] = {drawn_within(s_, value_bits_), drawn_within(s_, value_bits_), 0};
            slopes_[i][2] = 0;
        }
    }

    /// A contact in the middle of both features, at a simple root.
    void cross_inside() {
        const std::int64_t side = draw(s_, 2) == 0 ? 1 : -1;
        values_ = {{{4, 0, 0}, {0, 4 * side, 0}, {1, 1, 0}}};
    }
    /// A contact in the middle of both features, at a double or triple root, or at three close
    /// ones.
    void meet_inside() {
        const bool triple = draw(s_, 2) == 0, coincide = draw(s_, 2) == 0;
        const whole_number side = draw(s_, 2) == 0 ? 1 : -1;
        const auto arrange = [&](auto& rows, const whole_number& along, const whole_number& other,
                                 const whole_number& edge) {
            rows[0] = {along << 2, edge << 2, 0};
            rows[1] = {0, product(side, along << 2), product(side, edge << 2)};
            rows[2] = {along, edge + along, edge + other};
        };
        const auto along = slopes_[0][0], other = triple ? along : slopes_[1][1];
        arrange(slopes_, along, other, slopes_[2][2]);
        const auto at = [&] { return whole_number(coincide ? 0 : pick(s_, 1)); };
        const auto first = at();
        const auto second = at();
        arrange(values_, first, second, drawn_within(s_, value_bits_));
        if (!coincide)
            for (auto& row : values_)
                for (whole_number& value : row)
                    if (draw(s_, 6) == 0) value = value + whole_number(pick(s_, 1));
    }

    /// The form with this value, over d, at the root: from value + slope·u to −q·value − slope·(d −
    /// u).
    errbound::bernstein<whole_number, 1> moved(std::size_t row, std::size_t x, bool back) const {
        const whole_number &value = values_[row][x], &slope = slopes_[row][x];
        const whole_number start = value + product(slope, u_);
        const whole_number end =
            -(product(q_, value) + product(slope, product(q_, u_) + whole_number(1)));
        if (back) return {{end, start}};
        return {{start, end}};
    }

    sequence& s_;
    whole_number u_, q_;
    int value_bits_ = 0, slope_bits_ = 0;
    std::array<std::array<whole_number, 3>, 3> values_, slopes_;
};

/// Small vectors, p zero at the start, and a subinterval of width 2^-unit_bits from there, in which
/// a cubic has a root near 2^-root_bits. Numbers at the limit of can_be_narrowed, and a cubic with
/// two close roots.
struct drawn_deep {
    drawn_forms forms;
    int unit_bits, root_bits, test_from;
    int limit_unit_bits, limit_bits;
    int limit_index;
    bool limit_negative;
    std::array<whole_number, 4> pair;
};
inline drawn_deep draw_deep(sequence& s) {
    drawn_deep d{};
    d.forms.edges = draw(s, 2) == 1;
    for (std::size_t i = 0; i < 3; ++i) {
        auto& v = d.forms.vectors[i];
        for (auto* x : {&v.x, &v.y, &v.z}) {
            const int start = pick(s, 3), end = pick(s, 3);
            *x = {{i == 2 ? 0 : start, end}};
        }
    }
    d.unit_bits = draw(s, 1535);
    d.root_bits = draw(s, 700);
    d.test_from = d.unit_bits + (draw(s, 2) == 0 ? 0 : draw(s, 200));
    d.limit_unit_bits = 1472 + draw(s, 4);
    d.limit_bits = 5442 + draw(s, 4);
    d.limit_index = static_cast<int>(draw(s, 4));
    d.limit_negative = draw(s, 2) == 0;
    // (at − bs)²·(cs + et), slightly changed.
    const int a = 1 + draw(s, 16), b = 1 + draw(s, 16), c = 1 + draw(s, 4), e = 1 + draw(s, 4);
    const int bits = draw(s, 63);
    const std::array<int, 4> with_double_root{b * b * c, b * b * e - 2 * a * b * c,
                                              a * a * c - 2 * a * b * e, a * a * e};
    constexpr std::array<int, 4> little{1, 3, 3, 1};
    for (std::size_t i = 0; i < 4; ++i)
        d.pair[i] = (whole_number(with_double_root[i]) << bits) - whole_number(little[i]);
    return d;
}

/// Three quadratics, of which the first often has common roots with the others, and one more.
struct drawn_quadratics {
    using form = errbound::bernstein<errbound::integers::fixed_integer<2>, 2>;
    std::array<form, 3> forms;
    form other;
};
inline drawn_quadratics draw_quadratics(sequence& s) {
    using number = errbound::integers::fixed_integer<2>;
    constexpr std::array<int, 5> sizes{1, 2, 5, 30, 1 << 20};
    const int size = sizes[static_cast<std::size_t>(draw(s, 5))], kind = draw(s, 4);
    const auto small = [&] { return static_cast<std::int64_t>(pick(s, size)); };
    const auto any = [&] {
        const auto f0 = small(), f1 = small(), f2 = small();
        return drawn_quadratics::form{{number(f0), number(f1), number(f2)}};
    };
    const auto c0 = small(), c1 = small();
    const auto with_root = [&] {
        const auto d0 = small(), d1 = small();
        return drawn_quadratics::form{
            {number(c0 * d0), number(c0 * d1 + c1 * d0), number(c1 * d1)}};
    };
    const auto first = kind == 0 ? any() : with_root();
    const auto next = [&] {
        if (draw(s, 6) == 0) return any();
        if (kind > 1) return with_root();
        const number times(pick(s, 2));
        return drawn_quadratics::form{{(first[0] * times).from_bit<2>(0),
                                       (first[1] * times).from_bit<2>(0),
                                       (first[2] * times).from_bit<2>(0)}};
    };
    const auto second = next();
    const auto third = next();
    return {{first, second, third}, draw(s, 3) == 0 ? any() : with_root()};
}

/// The roots of a product of linear forms, over 2^bits, an interval a few doubles wide with one
/// sign change, and an estimate. The ends may be roots, and there may be a double root.
struct drawn_search {
    int degree, bits;
    std::int64_t low, high, estimate;
    std::array<std::int64_t, 3> roots;
    bool negative;
};
inline drawn_search draw_search(sequence& s) {
    drawn_search d{};
    d.degree = 1 + draw(s, 3);
    d.bits = 54 + (draw(s, 2) == 0 ? 0 : draw(s, 80));
    d.low = (std::int64_t{1} << 53) + 2 * static_cast<std::int64_t>(s.draw(std::uint64_t{1} << 40));
    const int doubles = 2 + draw(s, 39);
    d.high = d.low + 2 * doubles;
    d.roots[0] = d.low + 1 + draw(s, 2 * doubles - 1);
    const bool twice = draw(s, 3) == 0;
    const auto at_end = [&] { return draw(s, 2) == 0 ? d.low : d.high; };
    d.roots[1] = twice && d.degree == 3 ? d.low + 2 * (1 + draw(s, doubles - 1)) : at_end();
    d.roots[2] = twice ? d.roots[1] : at_end();
    d.negative = draw(s, 2) == 0;
    d.estimate = d.low + 2 * (draw(s, doubles + 3) - 1);
    return d;
}

struct drawn_bounded {
    errbound::integers::fixed_integer<2> a, b;
    int a_bits, b_bits;  ///< of the errors
};
inline drawn_bounded draw_bounded(sequence& s) {
    constexpr int exact = -(1 << 20);
    const auto bits = [&] { return draw(s, 4) == 0 ? exact + draw(s, 2) : draw(s, 20) - 5; };
    const auto number = [&] { return drawn_within(s, draw(s, 20)).from_bit<2>(0); };
    const auto a = number();
    const auto b = number();
    const int a_bits = bits();
    return {a, b, a_bits, bits()};
}

}  // namespace tie
