#include "tests/soak/images.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace soak {
namespace {

using ccd::kind;

constexpr double at(const ccd::point<double>& p, std::size_t axis) {
    return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

/// The exponent of the lowest bit set. Precondition: x is not zero.
int lowest_exponent(double x) {
    int e;
    const auto digits = static_cast<std::uint64_t>(std::ldexp(std::fabs(std::frexp(x, &e)), 53));
    return e - 53 + std::countr_zero(digits);
}

/// True if a + b has neither a rounding error nor an overflow (Knuth's TwoSum).
bool sum_is_exact(double a, double b) {
    const double s = a + b, bb = s - a;
    return std::isfinite(s) && (a - (s - bb)) + (b - bb) == 0;
}

}  // namespace

query_images::query_images(const ccd::lab::points& query, std::size_t count, source& random) {
    std::array<std::array<std::array<double, 2>, 4>, 3> value{}, zero{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t i = 0; i < count; ++i)
            value[axis][i] = {at(query[i].t0, axis), at(query[i].t1, axis)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (auto& form : axes_[axis].as) form.at = value[axis];
        axes_[axis].exact_count = 0;
        add_if_exact(axis, image::form::plain, count, zero[axis]);

        const auto origin =
            static_cast<std::size_t>(random.between(0, static_cast<int>(count) - 1));
        auto added = zero[axis];
        for (auto& ends : added) ends = {-value[axis][origin][0], -value[axis][origin][1]};
        add_if_exact(axis, image::form::at_point, count, added);

        std::array<double, 2> shift{};
        for (std::size_t end = 0; end < 2; ++end) {
            const double near = value[axis][origin][end];
            const int size = near == 0 ? 0 : std::ilogb(near);
            shift[end] = std::ldexp(random.one_in(2) ? 1 : -1, size + random.between(-4, 4));
        }
        std::ranges::fill(added, shift);
        add_if_exact(axis, image::form::moved, count, added);

        // Only later axes are added, so that the map stays invertible.
        if (axis == 2) continue;
        added = value[static_cast<std::size_t>(random.between(static_cast<int>(axis) + 1, 2))];
        const double side = random.one_in(2) ? 1 : -1;
        for (auto& ends : added)
            for (double& x : ends) x *= side;
        add_if_exact(axis, image::form::sheared, count, added);
    }
}

void query_images::add_if_exact(std::size_t axis, image::form as, std::size_t count,
                                const std::array<std::array<double, 2>, 4>& added) {
    choice& c = axes_[axis];
    coordinates sum = c.as[static_cast<std::size_t>(as)];
    constexpr int widest = 1000;  // so that 2^exponent is a double
    sum.low = -widest, sum.high = widest;
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t end = 0; end < 2; ++end) {
            double& x = sum.at[i][end];
            if (!sum_is_exact(x, added[i][end])) return;
            x += added[i][end];
            if (x == 0) continue;
            sum.high = std::min(sum.high, 1023 - std::ilogb(x));
            sum.low = std::max(sum.low, -1074 - lowest_exponent(x));
        }
    }
    c.as[static_cast<std::size_t>(as)] = sum;
    c.exact[static_cast<std::size_t>(c.exact_count++)] = as;
}

image query_images::draw(source& random) const {
    image m;
    m.reversed = random.one_in(2);
    for (int last = 2; last > 0; --last)
        std::swap(m.axes[static_cast<std::size_t>(last)].from,
                  m.axes[static_cast<std::size_t>(random.between(0, last))].from);
    enum { none, common, each };
    const int scaled = random.one_in(2) ? none : random.one_in(2) ? common : each;
    int low = -1000, high = 1000;
    for (auto& axis : m.axes) {
        const choice& c = axes_[axis.from];
        axis.negated = random.one_in(2);
        axis.as = c.exact[static_cast<std::size_t>(
            std::max(0, random.between(1 - c.exact_count, c.exact_count - 1)))];
        const coordinates& of = c.as[static_cast<std::size_t>(axis.as)];
        low = std::max(low, of.low);
        high = std::min(high, of.high);
    }
    const auto exponent = [&random](int least, int largest) {
        const int how = random.between(0, 5);
        if (how == 0) return least;
        if (how == 1) return largest;
        if (how == 2) return random.between(least, largest);
        return std::clamp(random.between(-40, 40), least, largest);
    };
    const int all = scaled == common ? exponent(low, high) : 0;
    for (auto& axis : m.axes) {
        const coordinates& of = axes_[axis.from].as[static_cast<std::size_t>(axis.as)];
        axis.exponent = scaled == each ? exponent(of.low, of.high) : all;
    }
    return m;
}

ccd::lab::points query_images::of(const image& m) const {
    const auto axis_of = [&](std::size_t k) {
        const image::axis& axis = m.axes[k];
        auto values = axes_[axis.from].as[static_cast<std::size_t>(axis.as)].at;
        const double factor =
            std::bit_cast<double>(static_cast<std::uint64_t>(axis.exponent + 1023) << 52) *
            (axis.negated ? -1 : 1);
        for (auto& ends : values) {
            for (double& x : ends) x *= factor;
            if (m.reversed) std::swap(ends[0], ends[1]);
        }
        return values;
    };
    const auto x = axis_of(0), y = axis_of(1), z = axis_of(2);
    ccd::lab::points p;
    for (std::size_t i = 0; i < p.size(); ++i)
        p[i] = {{x[i][0], y[i][0], z[i][0]}, {x[i][1], y[i][1], z[i][1]}};
    return p;
}

std::string text_of(const image& m) {
    constexpr const char* forms[] = {"", " from a point", " moved", " sheared"};
    std::string text;
    for (std::size_t k = 0; k < 3; ++k) {
        const image::axis& axis = m.axes[k];
        text += std::string(1, "xyz"[k]) + " = " + (axis.negated ? "-" : "") + "xyz"[axis.from] +
                forms[static_cast<std::size_t>(axis.as)];
        if (axis.exponent != 0) text += " times 2^" + std::to_string(axis.exponent);
        text += k < 2 ? ", " : "";
    }
    return text + (m.reversed ? ", time reversed" : "");
}

std::span<const slot_map> slot_maps(kind query, kind image) {
    static constexpr slot_map vf[] = {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 1, 3},
                                      {0, 2, 3, 1}, {0, 3, 1, 2}, {0, 3, 2, 1}},
                              ee[] = {{0, 1, 2, 3}, {1, 0, 2, 3}, {0, 1, 3, 2}, {1, 0, 3, 2},
                                      {2, 3, 0, 1}, {2, 3, 1, 0}, {3, 2, 0, 1}, {3, 2, 1, 0}},
                              ve[] = {{0, 1, 2}, {0, 2, 1}}, vv[] = {{0, 1}, {1, 0}},
                              // A face or an edge with repeated vertices.
        ve_as_vf[] = {{0, 1, 1, 2}, {0, 1, 2, 1}, {0, 2, 1, 1},
                      {0, 2, 2, 1}, {0, 2, 1, 2}, {0, 1, 2, 2}},
                              ve_as_ee[] = {{0, 0, 1, 2}, {0, 0, 2, 1}, {1, 2, 0, 0}, {2, 1, 0, 0}},
                              vv_as_ve[] = {{0, 1, 1}, {1, 0, 0}},
                              vv_as_vf[] = {{0, 1, 1, 1}, {1, 0, 0, 0}},
                              vv_as_ee[] = {{0, 0, 1, 1}, {1, 1, 0, 0}};
    if (query == image) {
        switch (query) {
            case kind::vertex_face:
                return vf;
            case kind::edge_edge:
                return ee;
            case kind::vertex_edge:
                return ve;
            case kind::vertex_vertex:
                return vv;
        }
    }
    if (query == kind::vertex_edge) {
        if (image == kind::vertex_face) return ve_as_vf;
        if (image == kind::edge_edge) return ve_as_ee;
    }
    if (query == kind::vertex_vertex) {
        if (image == kind::vertex_edge) return vv_as_ve;
        if (image == kind::vertex_face) return vv_as_vf;
        if (image == kind::edge_edge) return vv_as_ee;
    }
    return {};
}

}  // namespace soak
