// Matrices of linear systems: random, structured, ill-conditioned, singular, badly scaled.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>

namespace matrix_families {

enum class family : std::uint8_t {
    uniform,
    small_integers,
    hilbert,
    unimodular,
    nearly_dependent,
    dependent,
    scaled_rows_and_columns,
    any_scales,
    subnormal,
    triangular,
    tridiagonal,
    toeplitz,
    vandermonde,
    zero,
};
inline constexpr std::array names{
    "uniform",     "small integers", "Hilbert",     "unimodular", "nearly dependent",
    "dependent",   "scaled",         "any scales",  "subnormal",  "triangular",
    "tridiagonal", "Toeplitz",       "Vandermonde", "zero"};
inline constexpr auto all = [] {
    std::array<family, names.size()> each{};
    for (std::size_t i = 0; i < each.size(); ++i) each[i] = family(i);
    return each;
}();
static_assert(all.back() == family::zero);

class generator {
  public:
    explicit generator(std::uint64_t seed) : random_(seed) {}

    double uniform() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
    int whole(int least, int most) {
        return std::uniform_int_distribution<int>(least, most)(random_);
    }
    std::mt19937_64& random() { return random_; }

    Eigen::MatrixXd uniform(Eigen::Index n, Eigen::Index m) {
        return Eigen::MatrixXd::NullaryExpr(n, m, [this] { return uniform(); });
    }
    /// Entries of −most to most.
    Eigen::MatrixXd whole_numbers(Eigen::Index n, Eigen::Index m, int most) {
        return Eigen::MatrixXd::NullaryExpr(n, m, [&] { return double(whole(-most, most)); });
    }
    /// A matrix of determinant 1, whose condition number grows with n and with `most`.
    Eigen::MatrixXd unimodular(Eigen::Index n, int most) {
        Eigen::MatrixXd lower = Eigen::MatrixXd::Identity(n, n), upper = lower;
        for (Eigen::Index i = 1; i < n; ++i) {
            lower(i, i - 1) = whole(-most, most);
            upper(i - 1, i) = whole(-most, most);
            if (i > 1) lower(i, whole(0, int(i) - 2)) = whole(-1, 1);
        }
        return lower * upper;
    }

    Eigen::MatrixXd make(family f, Eigen::Index n);

  private:
    /// Powers of two from 2^−most to 2^most.
    Eigen::ArrayXd powers(Eigen::Index n, int most) {
        return Eigen::ArrayXd::NullaryExpr(n, [&] { return std::ldexp(1.0, whole(-most, most)); });
    }
    Eigen::MatrixXd structured(family f, Eigen::Index n);

    std::mt19937_64 random_;
};

inline Eigen::MatrixXd generator::structured(family f, Eigen::Index n) {
    const Eigen::VectorXd nodes = uniform(2 * n, 1);
    return Eigen::MatrixXd::NullaryExpr(n, n, [&](Eigen::Index i, Eigen::Index j) {
        if (f == family::triangular) return i < j ? 0 : uniform();
        if (f == family::tridiagonal) return std::abs(i - j) > 1 ? 0 : uniform();
        if (f == family::toeplitz) return nodes(n + i - j);
        if (f == family::vandermonde) return std::pow(nodes(i), double(j));
        return 1 / double(i + j + 1);
    });
}

inline Eigen::MatrixXd generator::make(family f, Eigen::Index n) {
    Eigen::MatrixXd a = uniform(n, n);
    switch (f) {
        case family::uniform:
            return a;
        case family::small_integers:
            return whole_numbers(n, n, 3);
        case family::unimodular:
            return unimodular(n, whole(1, 40));
        case family::nearly_dependent:
        case family::dependent:
            a = whole_numbers(n, n, 1000);
            a.row(n - 1) = n > 1 ? Eigen::RowVectorXd(a.topRows(n - 1).colwise().sum())
                                 : Eigen::RowVectorXd::Zero(n);
            if (f == family::nearly_dependent)
                a(n - 1, whole(0, int(n) - 1)) += std::ldexp(1.0, -whole(0, 40));
            return a;
        case family::scaled_rows_and_columns:
            return powers(n, 400).matrix().asDiagonal() * a * powers(n, 400).matrix().asDiagonal();
        case family::any_scales:
            return a.array() * powers(n * n, 1000).reshaped(n, n);
        case family::subnormal:
            return whole_numbers(n, n, 1000) * 0x1p-1074;
        case family::zero:
            return Eigen::MatrixXd::Zero(n, n);
        default:
            return structured(f, n);
    }
}

}  // namespace matrix_families
