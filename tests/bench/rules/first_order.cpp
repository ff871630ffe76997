// Tightness of each rule in chains of square roots and quotients: a vector's length, a fused sum,
// Cholesky and QR decompositions, an orbit by Verlet's method. A cell is the geometric mean of
// error() divided by the true error, which the same program in float128 gives.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <errbound/binary128.hpp>
#include <errbound/functions.hpp>
#include <errbound/rules/affine.hpp>
#include <random>
#include <vector>

namespace {

using errbound::float128;
using errbound::tracked;

float128 sqrt(const float128& x) {
    return errbound::number_traits<float128>::sqrt(x);
}
float128 fma(const float128& a, const float128& b, const float128& c) {
    return a * b + c;
}

using inputs = std::vector<double>;

template <class S>
std::vector<S> length(const inputs& in) {
    return {sqrt(S(in[0]) * S(in[0]) + S(in[1]) * S(in[1]) + S(in[2]) * S(in[2]))};
}
/// x³ + x² + x + y by Horner's rule, at a root.
template <class S>
std::vector<S> fused(const inputs& in) {
    const S x = sqrt(S(in[0]));
    return {fma(fma(fma(x, S(1), S(1)), x, S(1)), x, S(in[1]))};
}

constexpr std::size_t size = 10;
/// The lower Cholesky factor of the matrix with 2·size on its diagonal and inputs elsewhere.
template <class S>
std::vector<S> cholesky(const inputs& in) {
    std::vector<S> l(size * size, S(0));
    for (std::size_t i = 0; i < size; ++i)
        for (std::size_t j = 0; j <= i; ++j) {
            S sum(i == j ? 2.0 * size : in[i * size + j]);
            for (std::size_t k = 0; k < j; ++k) sum = sum - l[i * size + k] * l[j * size + k];
            l[i * size + j] = i == j ? sqrt(sum) : sum / l[j * size + j];
        }
    return l;
}
/// The upper factor R of a QR decomposition, column by column (modified Gram-Schmidt).
template <class S>
std::vector<S> orthogonal(const inputs& in) {
    std::vector<S> q(in.begin(), in.end()), r(size * size, S(0));
    const auto dot = [&](std::size_t i, std::size_t j) {
        S sum(0);
        for (std::size_t k = 0; k < size; ++k) sum = sum + q[k * size + i] * q[k * size + j];
        return sum;
    };
    for (std::size_t i = 0; i < size; ++i) {
        r[i * size + i] = sqrt(dot(i, i));
        for (std::size_t k = 0; k < size; ++k) q[k * size + i] = q[k * size + i] / r[i * size + i];
        for (std::size_t j = i + 1; j < size; ++j) {
            const S c = dot(i, j);
            r[i * size + j] = c;
            for (std::size_t k = 0; k < size; ++k)
                q[k * size + j] = q[k * size + j] - c * q[k * size + i];
        }
    }
    return r;
}
/// The position on an orbit after 50 steps of 1/64.
template <class S>
std::vector<S> verlet(const inputs& in) {
    S x(1 + in[0] / 8), y(in[1] / 8), vx(in[2] / 8), vy(1);
    const S step(0x1p-6), half(0x1p-7);
    const auto kick = [&] {
        const S square = x * x + y * y, cube = square * sqrt(square);
        vx = vx - half * (x / cube);
        vy = vy - half * (y / cube);
    };
    for (int i = 0; i < 50; ++i) {
        kick();
        x = x + step * vx;
        y = y + step * vy;
        kick();
    }
    return {x, y};
}

struct mean {
    double logarithms = 0;
    int count = 0;
    bool unknown = false;

    template <class Rule>
    void add(const tracked<double, Rule>& x, const float128& truth) {
        const double off = std::abs(static_cast<double>(float128(x.value()) - truth));
        if (off == 0) return;
        if (!std::isfinite(x.error())) unknown = true;
        logarithms += std::log(x.error() / off);
        ++count;
    }
};

template <class Rule, class Program>
void print_cell(const Program& program, std::size_t inputs_each) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> between(0.1, 1);
    mean m;
    for (int run = 0; run < 100; ++run) {
        inputs in(inputs_each);
        for (double& x : in) x = between(random);
        const auto found = program.template operator()<tracked<double, Rule>>(in);
        const auto truth = program.template operator()<float128>(in);
        for (std::size_t i = 0; i < found.size(); ++i) m.add(found[i], truth[i]);
    }
    if (m.unknown)
        std::printf(" unknown |");
    else
        std::printf(" %.3g |", std::exp(m.logarithms / m.count));
}
template <class Program>
void print_row(const char* name, std::size_t inputs_each, const Program& program) {
    std::printf("| %s |", name);
    print_cell<errbound::tight>(program, inputs_each);
    print_cell<errbound::sharp>(program, inputs_each);
    print_cell<errbound::interval>(program, inputs_each);
    print_cell<errbound::residual>(program, inputs_each);
    print_cell<errbound::affine>(program, inputs_each);
    std::printf("\n");
}

}  // namespace

int main() {
    std::printf("| bound / true error | tight | sharp | interval | residual | affine |\n");
    std::printf("|---|---|---|---|---|---|\n");
    print_row("length of a vector", 3, []<class S>(const inputs& in) { return length<S>(in); });
    print_row("`fma`, three times", 2, []<class S>(const inputs& in) { return fused<S>(in); });
    print_row("Cholesky, 10 × 10", size * size,
              []<class S>(const inputs& in) { return cholesky<S>(in); });
    print_row("QR, 10 × 10", size * size,
              []<class S>(const inputs& in) { return orthogonal<S>(in); });
    print_row("Verlet, 50 steps", 3, []<class S>(const inputs& in) { return verlet<S>(in); });
    return 0;
}
