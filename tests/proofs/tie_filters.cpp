// Compares static and semi-static filters of expressions of coordinates, in double and float, with
// the proofs' definitions (proofs/tie/tie_filters.ml), bit for bit: error counts of types, values,
// sizes, bounds and signs.
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <errbound/filters/semi_static_filter.hpp>
#include <errbound/filters/static_filter.hpp>
#include <errbound/predicates.hpp>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "tests/proofs/drawn_query.hpp"
#include "tests/proofs/table.hpp"

#ifdef __clang__
#pragma clang diagnostic ignored "-Wimplicit-const-int-float-conversion"  // a constant is rounded
#endif

namespace {

using errbound::filters::filtered_coordinate;
using errbound::filters::measured_coordinate;
using errbound::filters::semi_static_coordinate;
using tie::hash;

/// Equal for both zeros, and for all NaN.
void put(hash& h, double x) {
    if (std::isnan(x))
        h.put_both(0x7ff8000000000000U);
    else
        h.put_both(std::bit_cast<std::uint64_t>(x == 0 ? 0.0 : x));
}
void put(hash& h, int n) {
    h.put(static_cast<std::uint32_t>(n));
}

/// Three coordinates of each of five points.
template <class T>
using numbers = std::array<T, 15>;
template <class Scalar>
using points = std::array<std::array<Scalar, 3>, 5>;

/// Coordinates: small integers, about 1 except for a few ulps, of one size, with products that
/// underflow or overflow, of every size; one NaN or the largest number.
template <class T>
numbers<T> draw_numbers(tie::sequence& s) {
    using limits = std::numeric_limits<T>;
    constexpr int largest = limits::max_exponent;
    const int mode = tie::draw(s, 8);
    int e = 0;
    if (mode == 2) e = tie::draw(s, 20) - 10;
    if (mode == 3 || mode == 7) e = -tie::draw(s, largest);
    if (mode == 4) e = tie::draw(s, largest);
    numbers<T> x;
    for (T& number : x) {
        double drawn;
        if (mode == 0 || mode == 7) {
            drawn = std::ldexp(tie::draw(s, 7) - 3, e);
        } else if (mode == 1) {
            drawn = 1 + std::ldexp(tie::draw(s, 9), 1 - limits::digits);
        } else {
            drawn = tie::unit(s) - 0.5;
            if (mode == 5) e = tie::draw(s, largest / 2) - largest / 4;
            drawn = std::ldexp(drawn, e);
        }
        number = static_cast<T>(drawn);
    }
    if (mode == 6) {
        constexpr std::array<T, 4> special{limits::infinity(), -limits::infinity(),
                                           limits::quiet_NaN(), limits::max()};
        T& number = x[static_cast<std::size_t>(tie::draw(s, 15))];
        number = special[static_cast<std::size_t>(tie::draw(s, 4))];
    }
    return x;
}

template <class T, class Expression>
void put_static(hash& h, tie::sequence& s, const Expression& expression) {
    const numbers<T> x = draw_numbers<T>(s);
    points<filtered_coordinate<T>> p;
    for (std::size_t i = 0; i < x.size(); ++i) p[i / 3][i % 3].value = x[i];
    const auto e = expression(p);
    const auto f = as_filtered(e);
    put(h, f.roundings);
    put(h, f.products);
    put(h, f.plain);
    put(h, f.value);
    put(h, f.size);
    put(h, f.full_size());
    put(h, f.bound());
    put(h, static_cast<int>(sign_of(e)));
}
/// Mass and allowances, if no factor is 0.
template <class T, class Expression>
void put_semi_static(hash& h, tie::sequence& s, const Expression& expression) {
    const numbers<T> x = draw_numbers<T>(s);
    T largest = 0;
    points<semi_static_coordinate<T>> p;
    for (std::size_t i = 0; i < x.size(); ++i) p[i / 3][i % 3] = {x[i], &largest};
    const auto f = as_semi_static(expression(p));
    put(h, f.roundings);
    put(h, f.degree);
    put(h, f.value);
    T largest_measured = 0;
    points<measured_coordinate<T>> q;
    for (std::size_t i = 0; i < x.size(); ++i) q[i / 3][i % 3] = {x[i], &largest_measured};
    const T value = expression(q);
    const bool is_same = value == f.value || (std::isnan(value) && std::isnan(f.value));
    if (!is_same || largest != largest_measured) put(h, largest_measured);
    if (f.mass < f.most) {
        put(h, f.mass);
        put(h, f.allowances);
    }
    put(h, largest);
    put(h, f.bound(largest));
}

// Expressions of points

template <class... Expressions>
struct list {};
template <class... Expressions>
list<Expressions...> listed(Expressions...) {
    return {};
}
constexpr auto area = [](const auto& p) { return errbound::forms::area(p[0], p[1], p[2]); };
constexpr auto volume = [](const auto& p) {
    return errbound::forms::volume(p[0], p[1], p[2], p[3]);
};
constexpr auto lifted_area = [](const auto& p) {
    return errbound::forms::lifted_area(p[0], p[1], p[2], p[3], errbound::forms::unweighted);
};
constexpr auto lifted_volume = [](const auto& p) {
    return errbound::forms::lifted_volume(p[0], p[1], p[2], p[3], p[4],
                                          errbound::forms::unweighted);
};

/// A coordinate as an expression.
constexpr auto c = [](const auto& p, std::size_t k) { return p[k][0]; };
constexpr auto d = [](const auto& p, std::size_t k, std::size_t i) {
    return p[k][i] - p[k + 1][i];
};
const auto homogeneous =
    listed([](const auto& p) { return c(p, 0); }, [](const auto& p) { return -c(p, 0); },
           [](const auto& p) { return d(p, 0, 0); }, [](const auto& p) { return -d(p, 0, 0); },
           [](const auto& p) { return c(p, 0) + d(p, 0, 1); },
           [](const auto& p) { return d(p, 0, 1) - c(p, 0); },
           [](const auto& p) { return c(p, 0) * c(p, 1); },
           [](const auto& p) { return -(c(p, 0) * c(p, 0) - d(p, 0, 1) * c(p, 1)); },
           [](const auto& p) { return c(p, 0) * d(p, 0, 1) * -c(p, 2); },
           [](const auto& p) { return (c(p, 0) + -d(p, 0, 1)) * (d(p, 1, 0) * d(p, 1, 1)); },
           [](const auto& p) {
               const auto s = c(p, 0) * c(p, 1) + d(p, 0, 1) * d(p, 1, 2);
               return s * (c(p, 3) * d(p, 0, 2) - d(p, 1, 1) * d(p, 2, 0)) * s;
           },
           [](const auto& p) {
               const auto square = d(p, 0, 0) * d(p, 0, 0);
               return square * square * square * d(p, 0, 1);
           },
           [](const auto& p) { return 3 * d(p, 0, 0); },
           [](const auto& p) { return c(p, 0) * -7 - d(p, 0, 1) * 16777217; },
           [](const auto& p) { return (d(p, 0, 0) * 3 + d(p, 0, 1)) * 0; },
           [](const auto& p) { return d(p, 0, 0) * 1048576 * (d(p, 0, 1) * 8); },
           [](const auto& p) { return d(p, 0, 0) * 1048576 * (16 * d(p, 0, 1)); },
           [](const auto& p) { return d(p, 0, 0) * 1048576 * (32 * d(p, 0, 1)); },
           // Allowances of 2^24.
           [](const auto& p) {
               return d(p, 0, 0) * d(p, 0, 1) * 2097152 + d(p, 1, 0) * d(p, 1, 1) * 2097151;
           },
           [](const auto& p) {
               const auto e = d(p, 0, 0) * 1048576 * (d(p, 0, 1) * 1048576);
               return e * (e * d(p, 1, 1));
           });
/// Expressions of mixed degree, which only static filters bound.
const auto mixed = listed(
    [](const auto& p) { return 5 + c(p, 0); }, [](const auto& p) { return c(p, 0) - 16777217; },
    [](const auto& p) { return 3 - c(p, 1); },
    [](const auto& p) { return c(p, 0) * c(p, 1) + -1 - 1; },
    [](const auto& p) { return 1 - d(p, 0, 0) * d(p, 0, 1); },
    [](const auto& p) { return (c(p, 0) * c(p, 1) + 2147483647) * (d(p, 0, 0) + 0); });

/// The lines, in the order in which they draw numbers.
class all_lines {
  public:
    std::vector<tie::line> take() {
        add_format<double>();
        add_format<float>();
        return std::move(lines_);
    }

  private:
    template <class T>
    void add_format() {
        format_ = sizeof(T) == sizeof(double) ? ".double" : ".float";
        add_static<T>("area", area);
        add_static<T>("volume", volume);
        add_static<T>("lifted_area", lifted_area);
        add_static<T>("lifted_volume", lifted_volume);
        add_all([this](const std::string& name, auto e) { this->template add_static<T>(name, e); },
                "homogeneous", homogeneous);
        add_all([this](const std::string& name, auto e) { this->template add_static<T>(name, e); },
                "mixed", mixed);
        add_semi_static<T>("area", area);
        add_semi_static<T>("volume", volume);
        add_semi_static<T>("lifted_area", lifted_area);
        add_semi_static<T>("lifted_volume", lifted_volume);
        add_all(
            [this](const std::string& name, auto e) { this->template add_semi_static<T>(name, e); },
            "homogeneous", homogeneous);
    }
    template <class Add, class... Expressions>
    static void add_all(const Add& add, const std::string& name, list<Expressions...>) {
        int i = 0;
        (add(name + "<" + std::to_string(i++) + ">", Expressions{}), ...);
    }
    template <class T, class Expression>
    void add_static(const std::string& name, Expression e) {
        add(name, [e](hash& h, std::uint64_t) { put_static<T>(h, drawn, e); });
    }
    template <class T, class Expression>
    void add_semi_static(const std::string& name, Expression e) {
        add("semi_static." + name,
            [e](hash& h, std::uint64_t) { put_semi_static<T>(h, drawn, e); });
    }
    template <class Put>
    void add(const std::string& name, Put put) {
        lines_.push_back({"expression " + name + format_, 2000, put});
    }

    inline static tie::sequence drawn{1};
    const char* format_ = "";
    std::vector<tie::line> lines_;
};

}  // namespace

int main(int argc, char**) {
    return tie::compare(all_lines().take(), argc);
}
