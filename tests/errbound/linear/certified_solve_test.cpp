// certified_solve compared with exact rationals, and with solutions that are known by construction.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <errbound/binary128.hpp>
#include <errbound/certified_solve.hpp>
#include <errbound/eigen.hpp>
#include <limits>
#include <numeric>
#include <string_view>
#include <utility>

#include "tests/errbound/linear/matrix_families.hpp"
#include "tests/errbound/linear/rational_systems.hpp"
#include "tests/support/scaled.hpp"

namespace {

using errbound::certified_solve;
using errbound::solve_status;
using matrix_families::family;
using rational_systems::rational;
using rational_systems::table;

constexpr double u = 0x1p-53;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Checks that a certified answer is right.
template <class A, class B>
solve_status check(const A& a, const B& b) {
    const auto x = certified_solve(a, b);
    const auto exact = rational_systems::solve(a, b);
    EXPECT_TRUE(exact || !x.certified()) << "a singular matrix was certified";
    if (!x.certified()) {
        EXPECT_TRUE(x.values.array().isNaN().all() && (x.errors.array() == infinity).all());
        return x.status;
    }
    EXPECT_LT(x.contraction, 1);
    for (Eigen::Index i = 0; exact && i < x.values.rows(); ++i)
        for (Eigen::Index j = 0; j < x.values.cols(); ++j) {
            EXPECT_TRUE(std::isfinite(x.errors(i, j)));
            EXPECT_TRUE(rational_systems::holds(x.values(i, j), x.errors(i, j), (*exact)(i, j)))
                << i << ' ' << j << '\n'
                << a << "\n\n"
                << b;
        }
    return x.status;
}

TEST(CertifiedSolve, HoldsOnEveryFamily) {
    matrix_families::generator make(1);
    for (const family f : matrix_families::all) {
        SCOPED_TRACE(matrix_families::names[int(f)]);
        int certified = 0, refused = 0, systems = 0;
        for (const int n : {1, 2, 3, 4, 5, 8, 12})
            for (int k = 0; k < support::scaled(n > 8 ? 2 : 20); ++k, ++systems) {
                const Eigen::MatrixXd a = make.make(f, n);
                Eigen::MatrixXd b = make.uniform(n, make.whole(1, 2));
                if (k % 3 == 0) b *= std::ldexp(1.0, make.whole(-1070, 900));
                const solve_status status = check(a, b);
                certified += status == solve_status::certified;
                refused += status == solve_status::nearly_singular;
            }
        const bool singular = f == family::dependent || f == family::zero;
        const bool good = f == family::uniform || f == family::scaled_rows_and_columns ||
                          f == family::tridiagonal;
        EXPECT_TRUE(!singular || refused == systems);
        EXPECT_TRUE(!good || refused <= systems / 20);
        EXPECT_TRUE(singular || certified > 0);
    }
}

TEST(CertifiedSolve, HoldsAtFixedSizes) {
    matrix_families::generator make(2);
    for (const family f : matrix_families::all)
        for (int k = 0; k < support::scaled(20); ++k) {
            check(Eigen::Matrix2d(make.make(f, 2)), Eigen::Vector2d(make.uniform(2, 1)));
            check(Eigen::Matrix<double, 5, 5, Eigen::RowMajor>(make.make(f, 5)),
                  Eigen::Matrix<double, 5, 2>(make.uniform(5, 2)));
        }
}

TEST(CertifiedSolve, ErrorsAreNearHalfAUnitInTheLastPlace) {
    matrix_families::generator make(3);
    for (const int n : {2, 10, 50, 200}) {
        const auto x = certified_solve(make.uniform(n, n), make.uniform(n, 1));
        ASSERT_TRUE(x.certified());
        EXPECT_TRUE((x.errors.array() <= 1.001 * u * x.values.array().abs()).all()) << n;
    }
}

/// The inverse of Hilbert's matrix is whole, and so is the matrix times the least common multiple
/// of 1 to 2n - 1.
TEST(CertifiedSolve, RefusesHilbertMatricesNearSingularOnes) {
    int last = 0;
    for (int n = 1; n <= 20; ++n) {
        double multiple = 1;
        for (int k = 2; k < 2 * n && multiple < 0x1p40; ++k)
            multiple = double(std::lcm(std::int64_t(multiple), std::int64_t(k)));
        const Eigen::MatrixXd a = Eigen::MatrixXd::NullaryExpr(
            n, n, [&](auto i, auto j) { return multiple / double(i + j + 1); });
        const solve_status status = check(a, Eigen::VectorXd(Eigen::VectorXd::Ones(n)));
        const bool certified = status == solve_status::certified;
        EXPECT_TRUE(certified || (n > 10 && status == solve_status::nearly_singular)) << n;
        if (certified) last = n;
    }
    EXPECT_LT(last, 14);
}

/// Solves 3a·x = ay, whose solution is y/3; the system is exact for integers.
void expect_thirds(const Eigen::MatrixXd& a, const Eigen::MatrixXd& y, bool must_be_certified) {
    const auto x = certified_solve(3 * a, a * y);
    EXPECT_TRUE(x.certified() || !must_be_certified) << a.rows();
    if (!x.certified()) return;
    for (Eigen::Index i = 0; i < y.rows(); ++i)
        for (Eigen::Index j = 0; j < y.cols(); ++j) {
            const rational off = 3 * rational(x.values(i, j)) - rational(y(i, j));
            EXPECT_LE(abs(off), 3 * rational(x.errors(i, j))) << i << ' ' << j;
        }
}

#if LDBL_MANT_DIG == 113 || (defined(__SIZEOF_FLOAT128__) && defined(__GLIBC__))
/// certified_solve refuses the system. The LU decomposition of numbers tracked in binary128 solves
/// it, with errors of at most `most` of each entry.
void expect_solved_in_binary128(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double most) {
    using number = errbound::tracked<errbound::float128, errbound::residual>;
    EXPECT_EQ(errbound::certified_solve(a, b).status, solve_status::nearly_singular);
    const Eigen::MatrixX<number> x = a.cast<number>().partialPivLu().solve(b.cast<number>()).eval();
    const auto exact = rational_systems::solve(a, b);
    ASSERT_TRUE(exact);
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
        const rational truth = (*exact)(i, 0), error = exactly(x(i, 0).error());
        EXPECT_LE(abs(rational(exactly(x(i, 0).value()) - truth)), error) << i;
        EXPECT_LE(error, rational(most) * abs(truth)) << i;
    }
}
TEST(CertifiedSolve, RefusesSystemsThatBinary128Solves) {
    Eigen::MatrixXd hilbert(12, 12);
    for (Eigen::Index i = 0; i < 12; ++i)
        for (Eigen::Index j = 0; j < 12; ++j) hilbert(i, j) = 1 / double(i + j + 1);
    expect_solved_in_binary128(hilbert, Eigen::MatrixXd::Ones(12, 1), 1e-15);
    // S. M. Rump: the solution is (205117922, 83739041).
    Eigen::MatrixXd rump(2, 2);
    rump << 64919121, -159018721, 41869520.5, -102558961;
    expect_solved_in_binary128(rump, Eigen::MatrixXd::Identity(2, 1), 1e-15);
}
#endif

TEST(CertifiedSolve, LargerSystemsWithKnownSolutions) {
    matrix_families::generator make(4);
    for (const int n : {60, 150, 300, 600}) {
        if (n > support::scaled(600)) break;
        const Eigen::MatrixXd y = make.whole_numbers(n, 3, 1000);
        expect_thirds(make.whole_numbers(n, n, 1000), y, true);
        expect_thirds(make.unimodular(n, 1), y, false);
        Eigen::MatrixXd hadamard = Eigen::MatrixXd::NullaryExpr(n, n, [](auto i, auto j) {
            return std::popcount(std::uint64_t(i & j)) % 2 == 0 ? 1.0 : -1.0;
        });
        hadamard.diagonal().array() += n;
        expect_thirds(hadamard, y, true);
        Eigen::MatrixXd singular = make.whole_numbers(n, n, 1000);
        singular.col(n / 2) = singular.col(0) - singular.col(n - 1);
        EXPECT_EQ(certified_solve(singular, y).status, solve_status::nearly_singular);
    }
}

TEST(CertifiedSolve, ReportsTheReasonOfARefusal) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(3, 3);
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(3);
    EXPECT_EQ(certified_solve(identity, Eigen::VectorXd::Ones(2)).status,
              solve_status::sizes_differ);
    EXPECT_EQ(certified_solve(identity.leftCols(2), ones).status, solve_status::sizes_differ);
    for (const double x : {nan, infinity, -infinity}) {
        Eigen::MatrixXd a = identity;
        a(1, 2) = x;
        EXPECT_EQ(certified_solve(a, ones).status, solve_status::not_finite);
        EXPECT_EQ(certified_solve(identity, x * ones).status, solve_status::not_finite);
    }
    EXPECT_EQ(certified_solve(0 * identity, ones).status, solve_status::nearly_singular);
    EXPECT_EQ(certified_solve(0x1p-1000 * identity, 0x1p1000 * ones).status,
              solve_status::out_of_range);
    EXPECT_NE(std::string_view(reason(solve_status::out_of_range)), "certified");
}

TEST(CertifiedSolve, EdgesOfTheRange) {
    const Eigen::MatrixXd none(0, 0), identity = Eigen::MatrixXd::Identity(4, 4);
    EXPECT_TRUE(certified_solve(none, Eigen::VectorXd(0)).certified());
    EXPECT_TRUE(certified_solve(identity, Eigen::MatrixXd(4, 0)).certified());
    const auto zero = certified_solve(identity, Eigen::VectorXd::Zero(4));
    EXPECT_TRUE(zero.certified() && zero.values.isZero(0) && zero.errors.isZero(0));
    for (const double s : {0x1p-1074, 0x1p-1022, 0x1p1023})
        for (const double t : {0x1p-1074, 0x1p-1022, 1.0, 0x1p1023}) {
            Eigen::Matrix2d a;
            a << s, s / 2, -s, s;
            check(a, Eigen::Vector2d(t, t / 2));
        }
}

/// The greatest ratio of an error to its bound: of I − RA, of a residual, and of a solution.
double share(const Eigen::MatrixXd& given, const Eigen::VectorXd& y) {
    namespace linear = errbound::linear;
    const Eigen::Index n = given.rows();
    linear::scaled_matrix<Eigen::Dynamic> scaled(given);
    if (scaled.has_zero_row_or_column) return 0;
    const Eigen::MatrixXd a = scaled.entries;
    const linear::checked_inverse<Eigen::Dynamic> inverse(std::move(scaled.entries));
    if (!inverse.approximation().allFinite()) return 0;
    const Eigen::VectorXd v = y.cwiseAbs(), w = inverse.defect_times(v);
    const Eigen::VectorXd b = (a * y).cwiseMin(0x1p1000).cwiseMax(-0x1p1000);
    const auto r = linear::residual<Eigen::Dynamic>(a, b, y);
    const table ra(inverse.approximation()), ta(a);
    rational greatest = 0;
    const auto take = [&](const rational& error, double bound) {
        if (!std::isfinite(bound) || error == 0) return;
        greatest = std::max<rational>(greatest, bound > 0 ? error / rational(bound) : rational(2));
    };
    for (Eigen::Index i = 0; i < n; ++i) {
        rational defect = 0, residual = rational(b(i));
        for (Eigen::Index j = 0; j < n; ++j) {
            rational entry = i == j;
            for (Eigen::Index k = 0; k < n; ++k) entry -= ra(i, k) * ta(k, j);
            defect += abs(entry) * rational(v(j));
            residual -= ta(i, j) * rational(y(j));
        }
        take(defect, w(i));
        if (std::isfinite(r.value(i))) take(abs(residual - rational(r.value(i))), r.error(i));
    }
    const auto x = certified_solve(a, b);
    const auto exact = rational_systems::solve(a, b);
    if (x.certified() && !exact) return infinity;
    for (Eigen::Index i = 0; i < n && x.certified(); ++i)
        take(abs(rational(x.values(i)) - (*exact)(i, 0)), x.errors(i));
    return double(greatest);
}

/// A neighbour of x, another scale or sign, or another number.
double mutated(double x, double other, matrix_families::generator& make) {
    switch (make.whole(0, 6)) {
        case 0:
            return std::nextafter(x, infinity);
        case 1:
            return -x;
        case 2:
            return std::ldexp(x, make.whole(-3, 3));
        case 3:
            return std::clamp(std::ldexp(x, make.whole(-600, 600)), -0x1p500, 0x1p500);
        case 4:
            return other;
        case 5:
            return std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) ^
                                         (std::uint64_t(1) << make.whole(0, 51)));
        default:
            return make.uniform();
    }
}

TEST(CertifiedSolve, BoundsHoldInASearchForTheGreatestErrors) {
    matrix_families::generator make(5);
    double greatest = 0;
    for (int start = 0; start < support::scaled(28); ++start) {
        const Eigen::Index n = make.whole(1, 4);
        Eigen::MatrixXd a = make.make(
            matrix_families::all[std::size_t(start) % std::size(matrix_families::all)], n);
        if (a.cwiseAbs().maxCoeff() > 0x1p500) a *= 0x1p-500;
        Eigen::VectorXd y = make.uniform(n, 1);
        double best = share(a, y);
        for (int step = 0; step < 300; ++step) {
            Eigen::MatrixXd next = a;
            Eigen::VectorXd next_y = y;
            const Eigen::Index i = make.whole(0, int(n) - 1), j = make.whole(0, int(n) - 1);
            if (make.whole(0, 2) == 0)
                next_y(i) = mutated(y(i), y(j), make);
            else
                next(i, j) = mutated(a(i, j), a(j, i), make);
            const double of_next = share(next, next_y);
            if (of_next < best) continue;
            best = of_next;
            a = next;
            y = next_y;
        }
        ASSERT_LE(best, 1) << a << "\n\n" << y;
        greatest = std::max(greatest, best);
    }
    EXPECT_GT(greatest, 0.5);  // errors do come near their bounds
}

}  // namespace
