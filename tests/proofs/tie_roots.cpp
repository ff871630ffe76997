// Compares the components of root isolation with the proofs' definitions on the same numbers
// (proofs/tie/tie_roots.ml). They are dyadic numbers, residues, sign variations, rows of Bernstein
// coefficients, polynomials, bounds of roots and their refinement, and local forms.
#include <algorithm>
#include <array>
#include <bit>
#include <boost/multiprecision/cpp_int.hpp>
#include <cstddef>
#include <cstdint>
#include <errbound/integers/dyadic.hpp>
#include <errbound/multiprecision.hpp>
#include <errbound/roots/fixed_row.hpp>
#include <errbound/roots/integer_polynomial.hpp>
#include <errbound/roots/local_form.hpp>
#include <errbound/roots/prime_field.hpp>
#include <errbound/roots/root_isolation.hpp>
#include <errbound/roots/sign_variations.hpp>
#include <errbound/roots/work_meter.hpp>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "tests/proofs/drawn_query.hpp"
#include "tests/proofs/table.hpp"

namespace {

using errbound::roots::prime_field;
using tie::hash;
using tie::sequence;
using whole = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<>,
                                            boost::multiprecision::et_off>;
using point = errbound::dyadic<whole>;
using polynomial = errbound::roots::integer_form<whole>;

/// Puts the sign, and words of 32 bits from the last.
void put(hash& h, const whole& n) {
    h.put(static_cast<std::uint32_t>(n.sign() + 1));
    for (whole rest = abs(n); rest != 0; rest >>= 32)
        h.put(static_cast<std::uint32_t>(whole(rest & 0xffffffffU)));
}
void put_int(hash& h, int n) {
    h.put(static_cast<std::uint32_t>(n));
}
void put(hash& h, const polynomial& p) {
    put_int(h, static_cast<int>(p.size()));
    for (const whole& c : p) put(h, c);
}
void put(hash& h, const point& x) {
    put(h, x.numerator());
    put_int(h, x.exponent());
}
void put_double(hash& h, double x) {
    h.put_both(std::bit_cast<std::uint64_t>(x == 0 ? 0.0 : x));
}

/// Draws numbers like tie_roots.ml.
class drawn_numbers {
  public:
    int draw(int n) { return tie::draw(s_, n); }
    /// A nonnegative number of `bits` bits.
    whole natural(int bits) {
        whole n = 0;
        for (; bits > 0; bits -= 30) n = (n << 30) + draw(1 << 30);
        return n;
    }
    whole with_sign(const whole& n) { return draw(2) == 0 ? n : whole(-n); }
    /// A number that is zero, small, one word or longer.
    whole number() {
        const int kind = draw(5);
        if (kind == 0) return 0;
        if (kind < 3) return draw(7) - 3;
        const whole n = natural(kind == 3 ? 60 : 30 * (1 + draw(10)));
        return with_sign(n);
    }
    polynomial form(int degree) {
        polynomial p;
        for (int i = 0; i <= degree; ++i) p.push_back(number());
        if (p.back() == 0) p.back() = 1;
        return p;
    }
    /// Irreducible by Eisenstein's criterion, so that no factor is removed.
    polynomial irreducible(int degree) {
        polynomial p{with_sign(1 + 3 * draw(1000)) * 3};
        for (int i = 1; i < degree; ++i) p.push_back(number() * 3);
        p.push_back(with_sign(1));
        return p;
    }
    int exponent() { return draw(81) - 40; }
    point place() {
        const whole n = number();
        return {n, exponent()};
    }
    point positive() {
        const whole n = natural(60) + 1;
        return {n, exponent()};
    }

  private:
    sequence s_{1};
};

void put_dyadics(hash& h, drawn_numbers& s) {
    const whole n = s.number();
    const int e = s.exponent();
    const point a(n, e);
    const int kind = s.draw(4);
    const point b = kind == 0 ? a : kind == 1 ? a + point(1, s.exponent()) : s.place();
    for (const point& x : {a, -a, a + b, a - b, a * b, point::power_of_two(e), middle(a, b)})
        put(h, x);
    put(h, scale(a, s.exponent()));
    h.put(a == b);
    h.put(a < b ? 0 : a > b ? 2 : 1);
    if (!a.is_zero()) put_int(h, floor_log2(a));
    put(h, a.in_units(a.exponent() - s.draw(50)));
    const point u = s.positive(), v = s.positive();
    put(h, quotient(v, u, s.draw(100)));
}

std::uint64_t drawn_modulus(drawn_numbers& s) {
    const int kind = s.draw(8);
    if (kind < 4) return errbound::roots::large_primes[static_cast<std::size_t>(kind)];
    if (kind < 6) return kind == 4 ? 3 : 5;
    return 2 * static_cast<std::uint64_t>(s.natural(kind == 6 ? 30 : 60) + 1) + 1;
}
void put_field(hash& h, drawn_numbers& s) {
    const prime_field field(drawn_modulus(s));
    const auto word = [&]() -> std::uint64_t {
        const int kind = s.draw(5);
        if (kind < 2) return static_cast<std::uint64_t>(kind);
        if (kind == 2) return field.modulus() - 1;
        return static_cast<std::uint64_t>(s.natural(60)) % field.modulus();
    };
    const std::uint64_t a = word(), b = word(), c = word(), d = word();
    for (const std::uint64_t x :
         {field.one(), field.add(a, b), field.subtract(a, b), field.multiply(a, b),
          field.multiply_and_subtract(a, b, c, d), field.to_form(a), field.from_form(a)})
        put(h, whole(x));
    const whole n = s.draw(2) == 0 ? whole(s.draw(70)) : s.natural(60);
    put(h, whole(field.power(a, static_cast<std::uint64_t>(n))));
}
/// Residues that are factors of the modulus.
void put_zero_divisors(hash& h, drawn_numbers& s) {
    const auto a = 2 * static_cast<std::uint64_t>(s.draw(1 << 29)) + 3,
               b = 2 * static_cast<std::uint64_t>(s.draw(1 << 29)) + 3;
    put(h, whole(prime_field(a * b).multiply(a, b)));
}
/// Residues of a multiple of the modulus, or next to one.
void put_residue(hash& h, drawn_numbers& s) {
    const prime_field field(errbound::roots::large_primes[static_cast<std::size_t>(s.draw(4))]);
    const whole multiple = (s.draw(5) - 2) * whole(field.modulus());
    put(h, whole(errbound::roots::residue(whole(multiple + s.draw(3) - 1), field)));
}
/// Values of a random polynomial, and of one that is zero there.
void put_value_modulo(hash& h, drawn_numbers& s) {
    const prime_field field(errbound::roots::large_primes[static_cast<std::size_t>(s.draw(4))]);
    const polynomial p = s.form(s.draw(6));
    const point x = s.place();
    const int e = x.exponent();
    const polynomial linear{e < 0 ? -x.numerator() : whole(-x.numerator() << e),
                            e < 0 ? whole(1) << -e : whole(1)};
    for (const polynomial& f : {p, linear}) {
        const auto residues = errbound::roots::residues(f, field);
        for (const std::uint64_t residue : residues) put(h, whole(residue));
        put(h, whole(value_at(residues, field, x)));
    }
}

void put_variations(hash& h, drawn_numbers& s) {
    std::vector<int> signs(static_cast<std::size_t>(1 + s.draw(9)));
    const int seldom = 2 + s.draw(6);
    for (int& sign : signs) sign = s.draw(seldom) == 0 ? 0 : 2 * s.draw(2) - 1;
    const auto at = [&](std::size_t i) { return signs[i]; };
    put_int(h, errbound::roots::sign_variations(signs.size(), at));
    put_int(h, errbound::roots::max_sign_variations(signs.size(), at));
}

using row = errbound::roots::fixed_row<4>;
void put(hash& h, const row& r) {
    put_int(h, static_cast<int>(r.size()));
    const std::vector<double> nearby = r.nearby_values();
    for (std::size_t i = 0; i < r.size(); ++i) {
        put_int(h, r.sign(i));
        put_double(h, nearby[i]);
    }
}
/// Puts the row, and its halves a few times.
void put(hash& h, row r, drawn_numbers& s) {
    put(h, r);
    for (int steps = 1 + s.draw(6); steps > 0; --steps) {
        auto halves = std::move(r).halves();
        put(h, halves.first);
        put(h, halves.second);
        r = s.draw(2) == 0 ? std::move(halves.first) : std::move(halves.second);
    }
}
void put_rows(hash& h, drawn_numbers& s) {
    polynomial b = s.form(s.draw(9));
    if (s.draw(3) == 0)
        for (whole& c : b) c <<= 200;
    const int kind = s.draw(4);
    const whole error = kind == 0   ? whole(0)
                        : kind == 1 ? whole(s.draw(5))
                                    : s.natural(kind == 2 ? 60 : 270);
    put(h, row(b, error), s);
}
/// Errors that are small, or about once or twice the largest that a row keeps, and coefficients of
/// that size. The last row is not rounded.
void put_row_edges(hash& h, drawn_numbers& s) {
    const int kind = s.draw(3);
    const whole error = kind == 0 ? whole(s.draw(5)) : (whole(1) << (59 + kind)) - 4 + s.draw(4);
    polynomial b;
    for (int i = 1 + s.draw(8); i > 0; --i) {
        const whole size = error + s.draw(16);
        b.push_back(s.with_sign(size));
    }
    b.push_back(whole(1) << 252);
    put(h, row(b, error), s);
}

void put_polynomial(hash& h, drawn_numbers& s, int degree) {
    const polynomial p = s.form(degree);
    put(h, errbound::roots::derivative(p));
    put(h, errbound::roots::mirrored(p));
    put_int(h, errbound::roots::positive_root_exponent(p));
    const point x = s.place();
    put(h, errbound::roots::value_at(p, x));
    h.put(static_cast<std::uint32_t>(errbound::roots::sign_at(p, x)));
    const int kind = s.draw(3);
    const point y = kind == 0 ? point() : kind == 1 ? x + point(1, s.exponent()) : s.place();
    if (x != y) put(h, errbound::roots::control_values_on(p, std::min(x, y), std::max(x, y)));
}
void put_polynomial(hash& h, drawn_numbers& s) {
    put_polynomial(h, s, s.draw(16) == 0 ? 38 + s.draw(6) : s.draw(9));
}
/// A polynomial whose weights may exceed 64 bits.
void put_long_polynomial(hash& h, drawn_numbers& s) {
    put_polynomial(h, s, 44 + s.draw(8));
}
void put_empty_polynomial(hash& h, drawn_numbers& s) {
    const point x = s.draw(2) == 0 ? point() : s.place();
    put(h, errbound::roots::value_at(polynomial(), x));
    h.put(static_cast<std::uint32_t>(errbound::roots::sign_at(polynomial(), x)));
}

using isolation = errbound::roots::root_isolation<whole>;
isolation isolation_of(const polynomial& p) {
    errbound::roots::work_meter unlimited;
    return {p, 1, unlimited};
}
void put_half_lines(hash& h, drawn_numbers& s) {
    const polynomial p = s.irreducible(1 + s.draw(7));
    const isolation roots = isolation_of(p);
    put(h, roots.upper_bound());
    put(h, roots.lower_bound());
    put(h, roots.least_positive());
    put(h, roots.greatest_negative());
}

void put_refined(hash& h, drawn_numbers& s, const polynomial& p, const point& a, const point& b) {
    const isolation roots = isolation_of(p);
    isolation::interval i{std::min(a, b), std::max(a, b)};
    const point low = errbound::roots::value_at(p, i.low),
                high = errbound::roots::value_at(p, i.high);
    if (!(low * high < point())) return;
    const auto put_interval = [&h](const isolation::interval& interval) {
        put(h, interval.low);
        put(h, interval.high);
    };
    isolation::interval once = i;
    errbound::roots::work_meter unlimited;
    roots.refine(once, unlimited);
    put_interval(once);
    roots.refine(once, unlimited);
    put_interval(once);
    roots.refine(i, scale(i.high - i.low, -s.draw(200)), unlimited);
    put_interval(i);
}
void put_refined(hash& h, drawn_numbers& s) {
    const polynomial p = s.irreducible(s.draw(2) == 0 ? 1 : 1 + s.draw(7));
    const int e = s.draw(30) - 20;
    const point a(s.draw(4000) - 2000, e), b(s.draw(4000) - 2000, e);
    put_refined(h, s, p, a, b);
}
/// A whole root, where two subintervals meet after halvings.
void put_whole_root(hash& h, drawn_numbers& s) {
    const polynomial q = s.irreducible(2 + s.draw(3));
    const int root = s.draw(2000) - 1000;
    polynomial p(q.size() + 1);
    for (std::size_t i = 0; i < q.size(); ++i) {
        p[i] -= root * q[i];
        p[i + 1] += q[i];
    }
    const int bits = s.draw(8), low = root - 1 - s.draw(1 << bits);
    put_refined(h, s, p, {low, 0}, {low + (2 << bits), 0});
}

using local = errbound::roots::local_form<whole>;
void put(hash& h, const local& f, drawn_numbers& s) {
    const auto put_row = [&h](const auto& r) {
        put(h, r.values);
        put(h, r.error);
    };
    put_row(f.scaled_coefficients(std::numeric_limits<int>::max()));
    const int bits = s.draw(120);
    put_row(f.scaled_coefficients(bits));
    put_row(f.coefficients(bits));
    for (const signed char sign : f.signs(bits)) put_int(h, sign);
    h.put(f.surely_rootless());
    h.put(f.low_end_is_certain());
    h.put(f.high_end_is_certain());
}
local drawn_part(const local& f, drawn_numbers& s) {
    const int depth = 1 + s.draw(8), from = s.draw(1 << depth),
              length = 1 + s.draw((1 << depth) - from);
    return f.part(from, length, depth);
}
/// Subintervals, and subintervals of them.
void put_parts(hash& h, drawn_numbers& s, const local& f) {
    put(h, f, s);
    const local once = drawn_part(f, s);
    put(h, once, s);
    put(h, drawn_part(once, s), s);
}
void put_near(hash& h, drawn_numbers& s) {
    const polynomial p = s.form(s.draw(10) == 0 ? 30 : s.draw(9));
    const point low = s.positive();
    const whole n = s.natural(30) + 1;
    const int size = floor_log2(low) - static_cast<int>(msb(n)) - 1;
    const point width(n, size + s.draw(100) - 90);
    constexpr std::array<int, 4> bits{0, 20, 64, 256};
    const int some = bits[static_cast<std::size_t>(s.draw(4))];
    put_parts(h, s, {p, low, width, some + s.draw(10)});
}
/// A polynomial of few bits, which the numerators of powers of `low` just exceed.
void put_near_small(hash& h, drawn_numbers& s) {
    const polynomial p = s.form(s.draw(4) == 0 ? 30 : s.draw(5));
    const int numerator = 2 * s.draw(4) + 1;
    const point low(numerator, s.exponent());
    const int size = floor_log2(low) - 2 - s.draw(8);
    const point width(1 + s.draw(8), size);
    put_parts(h, s, {p, low, width, s.draw(16)});
}
/// c + 2^20·(x − 1), or its negative, whose values are about as large as the error.
void put_near_error(hash& h, drawn_numbers& s) {
    const int bits = 4 + s.draw(8);
    const whole slope = s.with_sign(1 << 20), c = whole(s.draw(140)) << (18 - bits);
    const point width(1 + s.draw(63), -(bits + 2));
    put_parts(h, s, {{c - slope, slope}, {1, 0}, width, bits});
}
/// d·(x − 1)² + 2^20·(x − 1), whose last term is about as large as the error.
void put_near_small_term(hash& h, drawn_numbers& s) {
    const whole size = 1 + s.draw(1 << 20), d = s.with_sign(size), slope = 1 << 20;
    const point width(1 + s.draw(1 << 10), -12);
    put_parts(h, s, {{d - slope, slope - 2 * d, d}, {1, 0}, width, 13 + s.draw(4)});
}
/// 24·(x − c)² + d, or its negative. Its Bernstein coefficients have one sign if d is large; for
/// smaller d, only those of higher degree.
void put_near_minimum(hash& h, drawn_numbers& s) {
    const int low = 1 + s.draw(1000), d = s.draw(32);
    const whole c = low + 1, factor = s.with_sign(1);
    const polynomial p{factor * (24 * c * c + d), factor * -48 * c, factor * 24};
    put_parts(h, s, {p, {low, 0}, {2, 0}, 40});
}
/// (x − low)³, whose signs are all uncertain.
void put_near_triple_root(hash& h, drawn_numbers& s) {
    const whole low = 1 + s.draw(1000);
    const point width(1, -90 - s.draw(10));
    const polynomial p{-low * low * low, 3 * low * low, -3 * low, 1};
    put_parts(h, s, {p, {low, 0}, width, s.draw(8)});
}

std::vector<tie::line> all_lines() {
    static drawn_numbers numbers;
    std::vector<tie::line> lines;
    const auto tied = [&](const std::string& name, std::uint64_t cases,
                          void (*put_case)(hash&, drawn_numbers&)) {
        lines.push_back(
            {"roots " + name, cases, [put_case](hash& h, std::uint64_t) { put_case(h, numbers); }});
    };
    tied("dyadic", 4000, put_dyadics);
    tied("field", 4000, put_field);
    tied("value_modulo", 1000, put_value_modulo);
    tied("variations", 5000, put_variations);
    tied("row", 1000, put_rows);
    tied("polynomial", 2000, put_polynomial);
    tied("half_line", 1000, put_half_lines);
    tied("refine", 2000, put_refined);
    tied("near", 1500, put_near);
    tied("zero_divisor", 100, put_zero_divisors);
    tied("residue", 100, put_residue);
    tied("row_edge", 1000, put_row_edges);
    tied("whole_root", 500, put_whole_root);
    tied("long_polynomial", 20, put_long_polynomial);
    tied("empty_polynomial", 10, put_empty_polynomial);
    tied("near_small", 1000, put_near_small);
    tied("near_error", 1000, put_near_error);
    tied("near_small_term", 3000, put_near_small_term);
    tied("near_minimum", 200, put_near_minimum);
    tied("near_triple_root", 500, put_near_triple_root);
    return lines;
}

}  // namespace

int main(int argc, char**) {
    return tie::compare(all_lines(), argc);
}
