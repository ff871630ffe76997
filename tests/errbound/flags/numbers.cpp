// flags_test.py compiles this with each flag. It prints whether the environment is sound, and
// compares the library's results with integers of 128 bits.
#include <array>
#include <cstdint>
#include <cstdio>
#include <errbound/error_free.hpp>
#include <errbound/functions.hpp>
#include <errbound/predicates.hpp>
#include <errbound/tracked.hpp>

namespace {

__extension__ typedef __int128 wide;

std::uint64_t state = 1;
std::int64_t whole(int bits) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<std::int64_t>(state >> (64 - bits));
}
double scaled(double x, int exponent) {
    return errbound::number_traits<double>::scale(x, exponent);
}
wide size(wide x) {
    return x < 0 ? -x : x;
}
int wrong = 0;
void expect(bool right, const char* what) {
    if (!right && wrong++ == 0) std::printf("wrong: %s\n", what);
}

void check_error_free() {
    const std::int64_t a = whole(53), b = whole(53) - whole(53);
    const auto product = errbound::two_product(double(a), double(b));
    expect(wide(product.value) + wide(product.error) == wide(a) * b, "two_product");
    const double far = scaled(double(b), 20);
    const auto sum = errbound::two_sum(double(a), far);
    expect(wide(sum.value) + wide(sum.error) == wide(a) + wide(far), "two_sum");
}
/// Quotients of numbers of 53 bits, by the same divisor as compilers like them.
template <class Rule>
void check_division() {
    using number = errbound::tracked<double, Rule>;
    const std::int64_t b = whole(52) | (std::int64_t{1} << 52);
    const number divisor = double(b);
    for (int i = 0; i < 4; ++i) {
        const std::int64_t a = whole(52) | (std::int64_t{1} << 52);
        const number q = number(double(a)) / divisor;
        const wide off = size(wide(scaled(q.value(), 54)) * b - (wide(a) << 54));
        expect(off << 54 <= wide(scaled(q.error(), 108)) * b, Rule::name);
        expect(off <= wide(b) * (q.value() < 1 ? 1 : 2), "a quotient that is rounded once");
    }
}
template <class Rule>
void check_expression() {
    using number = errbound::tracked<double, Rule>;
    const std::int64_t a = whole(53), b = whole(53), c = whole(53), d = whole(53);
    const number x = number(double(a)) * double(b) - number(double(c)) * double(d);
    const wide exact = wide(a) * b - wide(c) * d;
    expect(size(wide(x.value()) - exact) <= wide(x.error()), Rule::name);
    // The same among subnormal numbers: in units of 2^-1074, rounded to 106 − 64 bits.
    const number small = scaled(double(a), -500), tiny = scaled(double(b), -638);
    const double unit = scaled(1, -1074);
    const wide shown = wide((small * tiny).value() / unit);
    const wide bound = wide((small * tiny).error() / unit);
    expect(size((shown << 64) - wide(a) * b) <= (bound + 1) << 64, "a product that underflows");
}
void check_long_doubles() {
    using number = errbound::tracked<long double>;
    using wider = long double;
    const std::int64_t a = whole(53), b = whole(53), c = whole(53), d = whole(53);
    const auto product = errbound::two_product(wider(a), wider(b));
    expect(wide(product.value) + wide(product.error) == wide(a) * b, "two_product of long doubles");
    const number x = number(wider(a)) * wider(b) - number(wider(c)) * wider(d);
    const wide exact = wide(a) * b - wide(c) * d;
    expect(size(wide(x.value()) - exact) <= wide(x.error()), "long doubles");
}
/// Whole numbers, of which products and sums are rounded; the plain loops' products are written to
/// memory, so that no compiler fuses them.
template <class Rule>
void check_sums() {
    using number = errbound::tracked<double, Rule>;
    std::array<number, 8> a, b;
    const std::int64_t x = whole(8);
    wide sum = 0, polynomial = 0;
    double plain_sum = 0, plain_polynomial = 0;
    for (std::size_t i = a.size(); i-- > 0;) {
        const std::int64_t c = whole(53);
        a[i] = double(c);
        volatile double product = plain_polynomial * double(x);
        plain_polynomial = product + double(c);
        polynomial = polynomial * x + c;
    }
    for (std::size_t i = 0; i < a.size(); ++i) {
        const std::int64_t c = whole(53);
        b[i] = double(c);
        volatile double product = a[i].value() * double(c);
        plain_sum = plain_sum + product;
        sum += wide(a[i].value()) * c;
    }
    const number found = dot(a, b), value = horner(a, number(double(x)));
    expect(found.value() == plain_sum && value.value() == plain_polynomial, "a plain loop's value");
    expect(size(wide(found.value()) - sum) <= wide(found.error()), Rule::name);
    expect(size(wide(value.value()) - polynomial) <= wide(value.error()), Rule::name);
}
void check_signs() {
    using errbound::sign_type;
    const std::int64_t x = whole(52), y = whole(52), u = whole(52), v = whole(52);
    const std::array<double, 2> o{0, 0}, p{double(x), double(y)}, q{double(u), double(v)},
        near{double(x) + double(whole(1)), double(y)};
    const auto sign = [](wide d) {
        return d > 0 ? sign_type::positive : d < 0 ? sign_type::negative : sign_type::zero;
    };
    expect(errbound::orient2d(o, p, q) == sign(wide(x) * v - wide(y) * u), "orient2d");
    expect(errbound::orient2d(o, p, near) == sign(wide(x) * y - wide(y) * std::int64_t(near[0])),
           "orient2d of a thin triangle");
    const errbound::tracked<double> infinite = std::numeric_limits<double>::infinity();
    expect(sign_of(infinite) == sign_type::uncertain, "the sign of infinity");
    expect(sign_of(infinite - infinite) == sign_type::uncertain, "the sign of NaN");
    const errbound::tracked<double> large = std::numeric_limits<double>::max();
    expect(sign_of(large * double(x) - large * double(y)) == sign_type::uncertain,
           "the sign of what overflows");
}

}  // namespace

bool other_unit_is_sound();

int main() {
    for (int i = 0; i < 20'000; ++i) {
        check_error_free();
        check_division<errbound::sharp>();
        check_division<errbound::tight>();
        check_expression<errbound::sharp>();
        check_expression<errbound::tight>();
        check_expression<errbound::safe>();
        check_expression<errbound::interval>();
        check_expression<errbound::residual>();
        check_sums<errbound::sharp>();
        check_sums<errbound::tight>();
        check_sums<errbound::interval>();
        check_sums<errbound::residual>();
        check_long_doubles();
        check_signs();
    }
    std::printf("%s, other unit %s, %d wrong\n",
                errbound::floating_point_environment().sound() ? "sound" : "unsound",
                other_unit_is_sound() ? "sound" : "unsound", wrong);
}
