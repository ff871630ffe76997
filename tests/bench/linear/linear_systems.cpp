// certified_solve compared with Eigen's solution by LU decomposition: time, and certified errors
// next to true ones. The systems have known exact solutions.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <errbound/certified_solve.hpp>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/bench/harness.hpp"
#include "tests/errbound/linear/matrix_families.hpp"

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The system 3a·x = ay with whole numbers a and y. It is exact; its solution, y/3, is usually not
/// a double.
struct linear_system {
    std::string name;
    MatrixXd a;
    VectorXd y;
};

std::vector<linear_system> systems(bool quick) {
    matrix_families::generator make(1);
    std::vector<linear_system> all;
    const auto add = [&](const char* name, const MatrixXd& a) {
        all.push_back({name, a, make.whole_numbers(a.rows(), 1, 1000)});
    };
    const Index largest = quick ? 100 : 2000;
    for (const Index n : {3, 10, 30, 100, 300, 1000, 2000})
        if (n <= largest) add("uniform", make.whole_numbers(n, n, 1000));
    const auto of_diagonals = [&](Index n) {
        const MatrixXd diagonals = make.whole_numbers(2 * n, 1, 1000);
        return MatrixXd::NullaryExpr(n, n, [=](Index i, Index j) { return diagonals(n + i - j); });
    };
    const auto second_difference = [](Index i, Index j) {
        return i == j ? 2.0 : std::abs(i - j) == 1 ? -1.0 : 0.0;
    };
    add("Toeplitz", of_diagonals(largest));
    add("second difference", MatrixXd::NullaryExpr(largest, largest, second_difference));
    for (const Index n : {20, 40, 60, 80}) add("unimodular", make.unimodular(n, 1));
    for (const Index n : {4, 8, 10, 11, 12}) {
        std::int64_t multiple = 1;
        for (std::int64_t k = 2; k < 2 * n; ++k) multiple = std::lcm(multiple, k);
        add("Hilbert", MatrixXd::NullaryExpr(
                           n, n, [=](Index i, Index j) { return double(multiple / (i + j + 1)); }));
    }
    return all;
}

/// |x − y/3|. The difference 3x − y is exact in 64 bits.
double true_error(double x, double y) {
    return double(std::abs(3.0L * x - y) / 3);
}

double greatest(const std::vector<double>& numbers) {
    return numbers.empty() ? 0 : *std::max_element(numbers.begin(), numbers.end());
}

bench::row row_of(const linear_system& s, bool quick) {
    const MatrixXd a = 3 * s.a;
    const VectorXd b = s.a * s.y;
    VectorXd plain;
    auto certified = errbound::certified_solve(a, b);
    const auto timings = bench::race({[&] { plain = a.partialPivLu().solve(b); },
                                      [&] { certified = errbound::certified_solve(a, b); }},
                                     quick            ? 1
                                     : a.rows() > 500 ? 3
                                                      : 25);
    std::vector<double> of_plain, bounds, ratios;
    for (Index i = 0; i < a.rows(); ++i) {
        const double size = std::abs(s.y(i)) / 3 * 0x1p-53;
        if (size == 0) continue;
        of_plain.push_back(true_error(plain(i), s.y(i)) / size);
        if (!certified.certified()) continue;
        const double error = true_error(certified.values(i), s.y(i));
        if (!(error <= certified.errors(i)))
            throw std::runtime_error(s.name + ": an error exceeds its certified bound");
        bounds.push_back(certified.errors(i) / size);
        if (error > 0) ratios.push_back(certified.errors(i) / error);
    }
    bench::row r = {{"system", s.name},
                    {"n", a.rows()},
                    {"plain_ms", timings[0].ms()},
                    {"certified_ms", timings[1].ms()},
                    {"ratio", timings[1].minimum / timings[0].minimum},
                    {"plain:_greatest_error", greatest(of_plain)}};
    if (!certified.certified()) return r;
    std::sort(ratios.begin(), ratios.end());
    r["certified:_greatest_error"] = greatest(bounds);
    if (ratios.empty()) return r;
    r["overestimate_-_1,_median"] = ratios[ratios.size() / 2] - 1;
    r["greatest"] = ratios.back() - 1;
    return r;
}

}  // namespace

int main(int argc, char** argv) {
    bench::program bench("./run bench --linear",
                         "certified_solve next to Eigen's plain solution by LU decomposition.");
    return bench.run(argc, argv, [&](bench::report& out) {
        bench::rows all;
        for (const linear_system& s : systems(bench.quick)) all.push_back(row_of(s, bench.quick));
        out.table(
            "linear", {},
            "certified_solve next to partialPivLu().solve, ms (least of some passes); errors "
            "in units of 2^-53 of the solution; overestimate: certified over true error, less 1",
            all);
    });
}
