// Linear systems with certified errors: of plain doubles, and of entries with errors.
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cstdio>
#include <errbound/certified_solve.hpp>
#include <errbound/eigen.hpp>

using Eigen::Index;

/// Hilbert's matrix times the least common multiple of 1 to 11. Its entries are integers up to n =
/// 6 and rounded beyond.
Eigen::MatrixXd hilbert(Index n) {
    return Eigen::MatrixXd::NullaryExpr(
        n, n, [](Index i, Index j) { return 27720.0 / double(i + j + 1); });
}

int main() {
    // A plain solution has an unknown number of right digits; certified_solve bounds each error.
    for (const Index n : {3, 6, 9, 14}) {
        const Eigen::MatrixXd a = hilbert(n);
        const Eigen::VectorXd b = Eigen::VectorXd::Ones(n), plain = a.partialPivLu().solve(b);
        const auto x = errbound::certified_solve(a, b);
        if (!x.certified()) {
            std::printf("n = %d: %s\n", int(n), errbound::reason(x.status));
            continue;
        }
        std::printf("n = %d: x0 = %.17g +- %.1e; plain: %.17g\n", int(n), x.values(0), x.errors(0),
                    plain(0));
    }

    using number = errbound::tracked<double>;
    const auto about = [](double x) { return number::within(x, x / 1000); };
    const number g01 = about(2), g12 = about(3), g02 = about(1), ground = about(0.5);
    Eigen::Matrix<number, 3, 3> laplacian;
    laplacian << g01 + g02 + ground, -g01, -g02,  //
        -g01, g01 + g12, -g12,                    //
        -g02, -g12, g02 + g12 + ground;
    const Eigen::Matrix<number, 3, 1> current(number(1), number(0), number(-1));
    const auto cholesky = laplacian.llt();
    const Eigen::Matrix<number, 3, 1> potential = cholesky.solve(current);
    const bool definite = cholesky.info() == Eigen::Success;
    std::printf("%s positive definite; potential 0: %.3f +- %.3f, determinant %.2f +- %.2f\n",
                definite ? "certainly" : "perhaps not", potential(0).value(), potential(0).error(),
                laplacian.determinant().value(), laplacian.determinant().error());
    return definite ? 0 : 1;
}
