// The oracle's decision: contact at one instant is a sentence in signs of polynomials in t, and
// Tarski queries give those signs at any algebraic instant.
//
// Why this is complete. "The features share a point at t" depends only on the signs at t of a
// finite list of polynomials, so it is constant between neighbouring roots of the list's nonzero
// members; and the instants of contact form a closed set, so contact on such an open stretch shows
// at its ends too. Hence the roots in [0, 1] together with 0 and 1 are enough to look at. Where a
// nonzero polynomial must vanish at every contact, its roots alone are enough.
#include "tests/support/oracle.hpp"

#include <algorithm>
#include <array>
#include <boost/multiprecision/gmp.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace oracle {
namespace {

namespace mp = boost::multiprecision;
using integer = mp::number<mp::gmp_int, mp::et_off>;

// ---- Polynomials in t: coefficients of 1, t, t^2, ...; the last is nonzero, zero is empty ----

using polynomial = std::vector<integer>;

void trim(polynomial& p) {
    while (!p.empty() && p.back().is_zero()) p.pop_back();
}

polynomial operator+(const polynomial& a, const polynomial& b) {
    polynomial sum = a.size() < b.size() ? b : a;
    const polynomial& shorter = a.size() < b.size() ? a : b;
    for (std::size_t i = 0; i < shorter.size(); ++i) sum[i] += shorter[i];
    trim(sum);
    return sum;
}

polynomial operator-(polynomial a) {
    for (integer& c : a) c = -c;
    return a;
}

polynomial operator-(const polynomial& a, const polynomial& b) {
    return a + -b;
}

polynomial operator*(const polynomial& a, const polynomial& b) {
    if (a.empty() || b.empty()) return {};
    polynomial product(a.size() + b.size() - 1);
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t j = 0; j < b.size(); ++j) product[i + j] += a[i] * b[j];
    }
    return product;
}

polynomial derivative(const polynomial& p) {
    polynomial d;
    for (std::size_t i = 1; i < p.size(); ++i) d.push_back(p[i] * i);
    return d;
}

// A positive multiple of the remainder of a by b: the factor |leading coefficient of b| keeps the
// coefficients whole and every sign as it is.
polynomial remainder(polynomial a, const polynomial& b) {
    const integer lead = abs(b.back());
    const bool negative = b.back().sign() < 0;
    while (a.size() >= b.size()) {
        const integer top = negative ? integer(-a.back()) : a.back();
        const std::size_t shift = a.size() - b.size();
        for (std::size_t i = 0; i < a.size(); ++i) {
            a[i] *= lead;
            if (i >= shift) a[i] -= top * b[i - shift];
        }
        trim(a);
    }
    return a;
}

// The instant numerator / 2^shift.
struct dyadic {
    integer numerator;
    unsigned shift = 0;
};

int sign_at(const polynomial& p, const dyadic& t) {
    integer value = 0;
    unsigned scale = 0;
    for (std::size_t i = p.size(); i-- > 0; scale += t.shift) {
        value = value * t.numerator + (p[i] << scale);
    }
    return value.sign();
}

// p without its root t. With an odd numerator the divisor 2^shift t - numerator is primitive, so
// by Gauss's lemma every division below is exact.
polynomial without_root(const polynomial& p, const dyadic& t) {
    polynomial quotient(p.size() - 1);
    integer carry = 0;
    for (std::size_t i = quotient.size(); i-- > 0;) {
        carry = (p[i + 1] + carry * t.numerator) >> t.shift;
        quotient[i] = carry;
    }
    return quotient;
}

// ---- Tarski queries ----

using chain = std::vector<polynomial>;

// The signed remainder sequence that starts with p and q.
chain signed_remainders(const polynomial& p, polynomial q) {
    chain sequence{p};
    while (!q.empty()) {
        sequence.push_back(std::move(q));
        q = -remainder(sequence[sequence.size() - 2], sequence.back());
    }
    return sequence;
}

int sign_changes(const chain& sequence, const dyadic& t) {
    int changes = 0;
    int last = 0;
    for (const polynomial& p : sequence) {
        const int sign = sign_at(p, t);
        if (sign != 0 && last != 0 && sign != last) ++changes;
        if (sign != 0) last = sign;
    }
    return changes;
}

// The sum over the distinct roots of p in (low, high) of the sign of g there, for p nonzero at both
// ends. Multiple roots count once, so p need not be squarefree.
int tarski_query(const polynomial& p, const polynomial& g, const dyadic& low, const dyadic& high) {
    const polynomial reduced = remainder(g, p);
    if (reduced.empty()) return 0;
    const chain sequence = signed_remainders(p, remainder(derivative(p) * reduced, p));
    return sign_changes(sequence, low) - sign_changes(sequence, high);
}

// ---- Instants at which to look ----

// One instant: the number `low` itself, or the single root of p in (low, high).
struct instant {
    polynomial p;
    dyadic low, high;

    int sign(const polynomial& g) const {
        if (g.size() < 2) return g.empty() ? 0 : g[0].sign();
        return p.empty() ? sign_at(g, low) : tarski_query(p, g, low, high);
    }
};

const dyadic start{0, 0};
const dyadic finish{1, 0};

// Isolates all roots of p between low and high by bisection. If a middle happens to be a root it
// stops and returns true, with that root at the end of `found`: a Tarski query may not end on a
// root, so the search must start anew without it.
bool hits_root(const polynomial& p, const chain& sturm, const dyadic& low, const dyadic& high,
               int changes_low, int changes_high, std::vector<instant>& found) {
    if (changes_low == changes_high) return false;
    if (changes_low - changes_high == 1) {
        found.push_back({p, low, high});
        return false;
    }
    const unsigned shift = std::max(low.shift, high.shift) + 1;
    const dyadic middle{
        (low.numerator << (shift - low.shift - 1)) + (high.numerator << (shift - high.shift - 1)),
        shift};
    if (sign_at(p, middle) == 0) {
        found.push_back({{}, middle, middle});
        return true;
    }
    const int changes = sign_changes(sturm, middle);
    return hits_root(p, sturm, low, middle, changes_low, changes, found) ||
           hits_root(p, sturm, middle, high, changes, changes_high, found);
}

// The distinct roots in [0, 1] of a nonzero p.
std::vector<instant> roots(polynomial p) {
    std::vector<instant> exact;
    const auto divide_out = [&](const dyadic& t) {
        exact.push_back({{}, t, t});
        while (sign_at(p, t) == 0) p = without_root(p, t);
    };
    if (sign_at(p, start) == 0) divide_out(start);
    if (sign_at(p, finish) == 0) divide_out(finish);
    for (;;) {
        const chain sturm = signed_remainders(p, derivative(p));
        std::vector<instant> isolated;
        if (!hits_root(p, sturm, start, finish, sign_changes(sturm, start),
                       sign_changes(sturm, finish), isolated)) {
            exact.insert(exact.end(), isolated.begin(), isolated.end());
            return exact;
        }
        dyadic t = isolated.back().low;
        while (t.shift > 0 && !bit_test(t.numerator, 0)) {
            t.numerator >>= 1;
            --t.shift;
        }
        divide_out(t);
    }
}

// Does `contact` hold at some instant? `vanishing` must all be zero at a contact; `all` are the
// polynomials whose signs decide it.
template <class Contact>
bool holds_somewhere(std::span<const polynomial> vanishing, std::span<const polynomial> all,
                     const Contact& contact) {
    const auto any = [&](const std::vector<instant>& instants) {
        return std::any_of(instants.begin(), instants.end(), contact);
    };
    for (const polynomial& p : vanishing) {
        if (!p.empty()) return any(roots(p));
    }
    if (contact(instant{{}, start, start}) || contact(instant{{}, finish, finish})) return true;
    return std::any_of(all.begin(), all.end(),
                       [&](const polynomial& p) { return p.size() > 1 && any(roots(p)); });
}

// ---- Points and the predicates of contact at one instant ----

using vector = std::array<polynomial, 3>;

vector operator-(const vector& a, const vector& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

polynomial dot(const vector& a, const vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

vector cross(const vector& a, const vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Is the point at w from one end of the closed segment e on that segment? On the segment's line it
// is exactly where w and w - e do not point the same way; the same words hold for e = 0.
struct on_segment {
    vector line;
    polynomial between;

    on_segment(const vector& w, const vector& e) : line(cross(w, e)), between(dot(w, w - e)) {}

    bool operator()(const instant& t) const {
        return std::all_of(line.begin(), line.end(),
                           [&](const polynomial& p) { return t.sign(p) == 0; }) &&
               t.sign(between) <= 0;
    }

    void append_to(std::vector<polynomial>& list) const {
        list.insert(list.end(), line.begin(), line.end());
        list.push_back(between);
    }
};

// Coplanar features at an instant where `normal` is nonzero: a coordinate in which it is nonzero
// may be dropped, and what is left is a question of the plane. Each of `weights` over `normal` in
// that coordinate must be at least 0. Where the normal vanishes, one of `segments` must hold.
struct planar_contact {
    polynomial volume;
    vector normal;
    std::vector<vector> weights;
    std::vector<on_segment> segments;

    bool operator()(const instant& t) const {
        if (t.sign(volume) != 0) return false;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const int side = t.sign(normal[axis]);
            if (side == 0) continue;
            return std::all_of(weights.begin(), weights.end(),
                               [&](const vector& w) { return side * t.sign(w[axis]) >= 0; });
        }
        return std::any_of(segments.begin(), segments.end(),
                           [&](const on_segment& touches) { return touches(t); });
    }

    bool holds() const {
        std::vector<polynomial> all{normal.begin(), normal.end()};
        for (const vector& w : weights) all.insert(all.end(), w.begin(), w.end());
        for (const on_segment& segment : segments) segment.append_to(all);
        return holds_somewhere({&volume, 1}, all, *this);
    }
};

using moving = ccd::moving_point<double>;

// mantissa * 2^exponent with an odd mantissa, or zero.
struct scaled {
    std::int64_t mantissa = 0;
    int exponent = std::numeric_limits<int>::max();

    explicit scaled(double x) {
        if (x == 0) return;
        mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &exponent), 53));
        for (exponent -= 53; mantissa % 2 == 0; ++exponent) mantissa /= 2;
    }
};

// The coordinate of all points as polynomials with whole coefficients. Every axis gets a unit of
// its own: stretching an axis moves no point into or out of a segment or a triangle.
template <std::size_t count>
void place_axis(std::size_t axis, const std::array<std::array<double, 2>, count>& ends,
                std::array<vector, count>& out) {
    int unit = std::numeric_limits<int>::max();
    for (const auto& [t0, t1] : ends) {
        unit = std::min({unit, scaled(t0).exponent, scaled(t1).exponent});
    }
    const auto whole = [&](double x) {
        const scaled s(x);
        return s.mantissa == 0 ? integer(0) : integer(s.mantissa) << (s.exponent - unit);
    };
    for (std::size_t i = 0; i < count; ++i) {
        const integer t0 = whole(ends[i][0]);
        polynomial& p = out[i][axis];
        p = {t0, whole(ends[i][1]) - t0};
        trim(p);
    }
}

template <std::size_t count>
std::array<vector, count> place(const std::array<moving, count>& points) {
    std::array<vector, count> out;
    std::array<std::array<double, 2>, count> x, y, z;
    for (std::size_t i = 0; i < count; ++i) {
        x[i] = {points[i].t0.x, points[i].t1.x};
        y[i] = {points[i].t0.y, points[i].t1.y};
        z[i] = {points[i].t0.z, points[i].t1.z};
    }
    place_axis(0, x, out);
    place_axis(1, y, out);
    place_axis(2, z, out);
    return out;
}

// Comparing doubles is exact, and points that move linearly stay in the box of their ends.
bool boxes_disjoint(std::span<const moving> a, std::span<const moving> b) {
    return std::ranges::any_of(
        std::array{&ccd::point<double>::x, &ccd::point<double>::y, &ccd::point<double>::z},
        [&](double ccd::point<double>::*axis) {
            const auto range = [axis](std::span<const moving> points) {
                double low = std::numeric_limits<double>::infinity();
                double high = -low;
                for (const moving& m : points) {
                    low = std::min({low, m.t0.*axis, m.t1.*axis});
                    high = std::max({high, m.t0.*axis, m.t1.*axis});
                }
                return std::pair{low, high};
            };
            const auto [low_a, high_a] = range(a);
            const auto [low_b, high_b] = range(b);
            return high_a < low_b || high_b < low_a;
        });
}

template <std::size_t count>
bool separate_at_once(const std::array<moving, count>& points, std::size_t first, shortcuts use) {
    const std::span<const moving> all(points);
    return use == shortcuts::on && boxes_disjoint(all.first(first), all.subspan(first));
}

}  // namespace

bool collides(const ccd::vertex_face<double>& query, shortcuts use) {
    const std::array points{query.v, query.f0, query.f1, query.f2};
    if (separate_at_once(points, 1, use)) return false;
    const auto [v, f0, f1, f2] = place(points);
    const vector e1 = f1 - f0;
    const vector e2 = f2 - f0;
    const vector e12 = f2 - f1;
    const vector w0 = v - f0;
    const vector w1 = v - f1;
    const vector normal = cross(e1, e2);
    return planar_contact{dot(normal, w0),
                          normal,
                          {cross(e1, w0), cross(w0, e2), cross(e12, w1)},
                          {on_segment(w0, e1), on_segment(w0, e2), on_segment(w1, e12)}}
        .holds();
}

bool collides(const ccd::edge_edge<double>& query, shortcuts use) {
    const std::array points{query.a0, query.a1, query.b0, query.b1};
    if (separate_at_once(points, 2, use)) return false;
    const auto [a0, a1, b0, b1] = place(points);
    const vector a = a1 - a0;
    const vector b = b1 - b0;
    const vector w = b0 - a0;
    const vector normal = cross(a, b);
    // a0 + s a = b0 + u b, crossed with b and with a: s normal = w x b and u normal = w x a.
    const vector s = cross(w, b);
    const vector u = cross(w, a);
    return planar_contact{
        dot(normal, w),
        normal,
        {s, normal - s, u, normal - u},
        {on_segment(w, a), on_segment(b1 - a0, a), on_segment(a0 - b0, b), on_segment(a1 - b0, b)}}
        .holds();
}

bool collides(const ccd::vertex_edge<double>& query, shortcuts use) {
    const std::array points{query.v, query.e0, query.e1};
    if (separate_at_once(points, 1, use)) return false;
    const auto [v, e0, e1] = place(points);
    const on_segment touches(v - e0, e1 - e0);
    return holds_somewhere(touches.line, {&touches.between, 1}, touches);
}

bool collides(const ccd::vertex_vertex<double>& query, shortcuts use) {
    const std::array points{query.v, query.w};
    if (separate_at_once(points, 1, use)) return false;
    const auto [v, w] = place(points);
    const vector gap = v - w;
    return holds_somewhere(gap, {}, [&](const instant& t) {
        return std::ranges::all_of(gap, [&](const polynomial& p) { return t.sign(p) == 0; });
    });
}

}  // namespace oracle
