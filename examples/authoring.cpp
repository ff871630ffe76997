// The predicate of docs/authoring-predicates.md (a point in a capsule), its tests and timings.
#include <algorithm>
#include <array>
#include <bit>
#include <boost/multiprecision/cpp_int.hpp>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <errbound/multiprecision.hpp>
#include <errbound/predicate_batch.hpp>
#include <errbound/predicates.hpp>
#include <errbound/predicates/constructed_points.hpp>
#include <errbound/predicates/perturbation.hpp>
#include <errbound/simplices/common_segment.hpp>
#include <random>
#include <span>
#include <vector>

using errbound::sign_of;
using errbound::sign_type;
// Without expression templates, whose results would refer to destroyed variables.
using rational = boost::multiprecision::number<boost::multiprecision::cpp_rational_backend,
                                               boost::multiprecision::et_off>;
using point = std::array<double, 3>;

// Positive if p is nearer than r to the line ab.
constexpr auto cylinder = [](const auto& a, const auto& b, const auto& p, const auto& r) {
    const auto dx = b[0] - a[0], dy = b[1] - a[1], dz = b[2] - a[2];
    const auto qx = p[0] - a[0], qy = p[1] - a[1], qz = p[2] - a[2];
    const auto x = dy * qz - dz * qy, y = dz * qx - dx * qz, z = dx * qy - dy * qx;
    return r * r * (dx * dx + dy * dy + dz * dz) - (x * x + y * y + z * z);
};
constexpr auto in_cylinder = errbound::predicate<errbound::points<3, 3, 3, 0>>(cylinder);

static_assert(in_cylinder.counts.roundings == 11);
static_assert(in_cylinder.static_constant<double> < 1.0001 * 11 * 0x1p-53);
static_assert(in_cylinder.counts.degree == 4 && !in_cylinder.counts.mixed);

// Returns the distance of p beyond `from` in the direction from a to b, times |ab|.
constexpr auto along(const auto& a, const auto& b, const auto& from, const auto& p) {
    return (b[0] - a[0]) * (p[0] - from[0]) + (b[1] - a[1]) * (p[1] - from[1]) +
           (b[2] - a[2]) * (p[2] - from[2]);
}

// An equal expression, by Lagrange's identity.
constexpr auto lagrange = [](const auto& a, const auto& b, const auto& p, const auto& r) {
    const auto dd = along(a, b, a, b), qq = along(a, p, a, p), dq = along(a, b, a, p);
    return r * r * dd - (dd * qq - dq * dq);
};
constexpr auto by_lagrange = errbound::predicate<errbound::points<3, 3, 3, 0>>(lagrange);
static_assert(by_lagrange.counts.roundings == 12);

// The caller passes r squared: terms of degree 4 and one that counts as degree 3.
constexpr auto with_square = [](const auto& a, const auto& b, const auto& p, const auto& square) {
    const auto dd = along(a, b, a, b), qq = along(a, p, a, p), dq = along(a, b, a, p);
    return square * dd - (dd * qq - dq * dq);
};
constexpr auto by_square = errbound::predicate<errbound::points<3, 3, 3, 0>>(with_square);
static_assert(by_square.counts.mixed);
// The degree is 4 if the square counts as degree 2.
struct square_options : errbound::predicate_options {
    static constexpr std::array<int, 10> degrees{1, 1, 1, 1, 1, 1, 1, 1, 1, 2};  // a, b, p, square
};
constexpr auto by_square_of_degree_2 =
    errbound::predicate<errbound::points<3, 3, 3, 0>, square_options>(with_square);
static_assert(by_square_of_degree_2(std::array{0., 0., 0.}, std::array{1., 0., 0.},
                                    std::array{0., 1., 0.}, 1.0) == sign_type::zero);

// p is before a, beyond b, or between them.
constexpr auto capsule = [](const auto& a, const auto& b, const auto& p, const auto& r) {
    using errbound::forms::squared_distance3d;
    const sign_type past_a = sign_of(along(a, b, a, p)), past_b = sign_of(along(a, b, b, p));
    if (!certain(past_a) || !certain(past_b)) return sign_type::uncertain;
    if (past_a != sign_type::positive) return sign_of(r * r - squared_distance3d(a, p));
    if (past_b != sign_type::negative) return sign_of(r * r - squared_distance3d(b, p));
    return sign_of(cylinder(a, b, p, r));
};
constexpr auto in_capsule = errbound::predicate<errbound::points<3, 3, 3, 0>>(capsule);
static_assert(in_capsule.counts.complete && !in_capsule.counts.mixed);

struct with_tight : errbound::predicate_options {
    using tracked_rule = errbound::tight;
};
struct with_rationals : errbound::predicate_options {
    using exact_type = rational;
};
constexpr auto cylinder_tight =
    errbound::predicate<errbound::points<3, 3, 3, 0>, with_tight>(cylinder);
constexpr auto lagrange_tight =
    errbound::predicate<errbound::points<3, 3, 3, 0>, with_tight>(lagrange);
constexpr auto cylinder_rationals =
    errbound::predicate<errbound::points<3, 3, 3, 0>, with_rationals>(cylinder);

struct input {
    point a, b, p;
    double r;
};
using generator = std::mt19937_64;
double uniform(generator& random) {  // in [-1, 1)
    return static_cast<double>(static_cast<std::int64_t>(random())) * 0x1p-63;
}

input anywhere(generator& random) {
    const auto any = [&] { return point{uniform(random), uniform(random), uniform(random)}; };
    return {any(), any(), any(), uniform(random) / 2};
}
/// A point near a thin, long cylinder.
input wire(generator& random) {
    input x = anywhere(random);
    x.r = 1e-8;
    const double t = uniform(random);
    for (std::size_t k = 0; k < 3; ++k)
        x.p[k] = x.a[k] + t * (x.b[k] - x.a[k]) + 2 * x.r * uniform(random);
    return x;
}
/// A point exactly on a cylinder: (1, 2, 2) and (2, 1, -2) are perpendicular, of length 3.
input on_surface(generator& random) {
    const auto some = [&] { return static_cast<double>(random() % 2001) - 1000; };
    input x{{some(), some(), some()}, {}, {}, 0};
    const double length = some(), at = some(), radius = some();
    const point d{1, 2, 2}, e{2, 1, -2};
    for (std::size_t k = 0; k < 3; ++k) {
        x.b[k] = x.a[k] + length * d[k];
        x.p[k] = x.a[k] + at * d[k] + radius * e[k];
    }
    x.r = 3 * radius;
    return x;
}
template <class Move>
input moved(input x, const Move& move) {
    for (point* const p : {&x.a, &x.b, &x.p})
        for (double& coordinate : *p) coordinate = move(coordinate);
    x.r = move(x.r);
    return x;
}
/// A point on the cylinder, rounded and moved by a unit in the last place.
input near_surface(generator& random) {
    const double scale = 0.1 + std::abs(uniform(random));
    return moved(on_surface(random), [&](double x) {
        return std::nextafter(x * scale, random() % 2 == 0 ? -10000.0 : 10000.0);
    });
}
/// Scaled by any power of two: underflow and overflow.
input at_any_scale(generator& random) {
    const int e = static_cast<int>(random() % 2080) - 1074;
    return moved(random() % 2 == 0 ? on_surface(random) : near_surface(random),
                 [&](double x) { return std::ldexp(x, e); });
}
input any_bits(generator& random) {
    return moved({}, [&](double) {
        double x = 0;
        do x = std::bit_cast<double>(random());
        while (!std::isfinite(x));
        return x;
    });
}

struct family {
    const char* name;
    input (*make)(generator&);
};
constexpr family families[] = {{"anywhere", anywhere},         {"wire", wire},
                               {"on surface", on_surface},     {"near surface", near_surface},
                               {"at any scale", at_any_scale}, {"any bits", any_bits}};

/// Uses the nearest point of the segment, in rationals, and no code of the predicate.
sign_type capsule_sign(const input& x) {
    rational dd = 0, dq = 0, distance = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const rational d = rational(x.b[k]) - x.a[k];
        dd += d * d;
        dq += d * (rational(x.p[k]) - x.a[k]);
    }
    rational t = dd == 0 ? rational(0) : rational(dq / dd);
    t = std::clamp(t, rational(0), rational(1));
    for (std::size_t k = 0; k < 3; ++k) {
        const rational e = rational(x.p[k]) - (x.a[k] + t * (rational(x.b[k]) - x.a[k]));
        distance += e * e;
    }
    return sign_of(rational(rational(x.r) * x.r - distance));
}
sign_type cylinder_sign(const input& x) {
    return sign_of(in_cylinder.value<rational>(x.a, x.b, x.p, x.r));
}

/// Returns the number of wrong signs, of all stages. Prints the share that each stage decided.
template <class Predicate, class Exact>
int test(const char* name, const Predicate& predicate, const Exact& exact, int inputs) {
    int wrong = 0;
    for (const family& f : families) {
        generator random(1);
        errbound::predicate_report report;
        for (int i = 0; i < inputs; ++i) {
            const input x = f.make(random);
            const sign_type right = exact(x);
            wrong += predicate(report, x.a, x.b, x.p, x.r) != right;
            for (std::size_t k = 0; k < errbound::predicate_stage_count; ++k) {
                const auto stage = static_cast<errbound::predicate_stage>(k);
                const sign_type alone = predicate.by(stage, x.a, x.b, x.p, x.r);
                wrong += certain(alone) && alone != right;
            }
        }
        std::printf("%-20s %-13s", name, f.name);
        for (const auto decided : report.decided)
            std::printf(" %6.1f", 100.0 * static_cast<double>(decided) / inputs);
        std::printf("\n");
    }
    return wrong;
}

template <class Run>
double nanoseconds(std::size_t inputs, const Run& run) {
    double best = 1e300;
    for (int repeat = 0; repeat < 15; ++repeat) {
        const auto start = std::chrono::steady_clock::now();
        run();
        const std::chrono::duration<double, std::nano> took =
            std::chrono::steady_clock::now() - start;
        best = std::min(best, took.count() / static_cast<double>(inputs));
    }
    return best;
}

template <class Predicate, class Formula>
void time(const char* name, const Predicate& predicate, const Formula& formula) {
    constexpr std::size_t n = 4096;
    for (const family& f : std::span(families).first(4)) {
        generator random(1);
        std::vector<point> a, b, p;
        std::vector<double> r;
        for (std::size_t i = 0; i < n; ++i) {
            const input x = f.make(random);
            a.push_back(x.a), b.push_back(x.b), p.push_back(x.p), r.push_back(x.r);
        }
        std::vector<sign_type> signs(n), batched(n);
        std::vector<double> values(n);
        const double plain = nanoseconds(n, [&] {
            for (std::size_t i = 0; i < n; ++i) values[i] = formula(a[i], b[i], p[i], r[i]);
        });
        const double single = nanoseconds(n, [&] {
            for (std::size_t i = 0; i < n; ++i) signs[i] = predicate(a[i], b[i], p[i], r[i]);
        });
        const double batch = nanoseconds(
            n, [&] { errbound::batch_signs(predicate, std::span(batched), a, b, p, r); });
        std::printf("%-20s %-13s %8.1f %8.1f %8.1f%s\n", name, f.name, plain, single, batch,
                    signs == batched ? "" : " and the batch differs");
    }
}

void print_relation() {
    using triangle = std::array<std::array<double, 3>, 3>;
    const triangle a{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}, b{{{1, 1, -1}, {1, 1, 1}, {3, 3, 0.5}}};
    if (errbound::relation_of(a, b) == errbound::relation::crossing) {
        const auto [from, to] = errbound::common_segment(a, b);
        std::printf("from x = %g +- %g to x = %g +- %g\n\n", from.position[0], from.error,
                    to.position[0], to.error);
    }
}

void print_special_signs() {
    using planar = std::array<double, 2>;
    const planar p{0, 0}, q{1, 1}, r{2, 2};  // on one line
    constexpr auto turn = errbound::perturbed(errbound::orient2d);
    const errbound::sign_type s = turn({4, 7, 9}, p, q, r);  // never zero
    std::printf("perturbed, they turn %s\n", s == sign_type::positive ? "left" : "right");
    const planar a{0, 3}, b{3, 0}, c{0, 1}, d{1, 2}, e{4, 0};
    const auto i = errbound::line_line_point(a, b, c, d);  // where the lines ab and cd cross
    const errbound::sign_type side = errbound::incircle(p, q, e, i);
    std::printf("the crossing is %s the circle\n", side == sign_type::positive ? "in" : "outside");
    using namespace errbound;
    constexpr auto turn_at_crossing =
        perturbed(with_constructed<line_line, given, given>(orient2d));
    // Four indices are for the parents of the crossing (lines pq and qr), two for the explicit
    // points p and r. Equal points have different indices here, so even equal lines cross.
    const sign_type t = turn_at_crossing({0, 1, 2, 3, 4, 5}, p, q, q, r, p, r);
    std::printf("the perturbed crossing is %s of the line\n\n",
                t == sign_type::positive ? "left" : "right");
}

int main() {
    print_relation();
    print_special_signs();
    std::printf("roundings: cylinder %d, lagrange %d, squared radius %d, capsule %d\n\n",
                in_cylinder.counts.roundings, by_lagrange.counts.roundings,
                by_square.counts.roundings, in_capsule.counts.roundings);

    std::printf("%% decided by%29s %6s %6s %6s %6s %6s %6s %6s\n", "semi", "filter", "track",
                "double", "short", "word", "2words", "long");
    constexpr int inputs = 500;
    int wrong = test("cylinder", in_cylinder, cylinder_sign, inputs);
    wrong += test("lagrange", by_lagrange, cylinder_sign, inputs);
    wrong += test("cylinder, tight", cylinder_tight, cylinder_sign, inputs);
    wrong += test("lagrange, tight", lagrange_tight, cylinder_sign, inputs);
    wrong += test("cylinder, rationals", cylinder_rationals, cylinder_sign, inputs);
    wrong += test("capsule", in_capsule, capsule_sign, inputs);

    std::printf("\nns%41s %8s %8s\n", "plain", "single", "batch");
    time("cylinder", in_cylinder, cylinder);
    time("lagrange", by_lagrange, lagrange);
    time("cylinder, tight", cylinder_tight, cylinder);
    time("lagrange, tight", lagrange_tight, lagrange);

    std::printf("\nwrong signs: %d\n", wrong);
    return wrong == 0 ? 0 : 1;
}
