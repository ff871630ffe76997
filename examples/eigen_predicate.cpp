// Predicates on points of other types, without copies: Eigen's and custom structs.
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdio>
#include <errbound/predicate_batch.hpp>
#include <errbound/predicates.hpp>
#include <vector>

using errbound::sign_type;

// Structs with members or member functions x and y (and z) are points.
struct vertex {
    float x, y;
    int id;
};

// Other structs need one function in their namespace.
namespace survey {
struct station {
    double easting, northing;
};
constexpr double coordinate_of(const station& s, int i) {
    return i == 0 ? s.easting : s.northing;
}
}  // namespace survey

int main() {
    // One by one. 0.1 + 0.2 and 0.3 are different doubles: c is left of the line by 2^-54.
    const Eigen::Vector2d a(0, 0), b(1, 1), c(0.3, 0.1 + 0.2);
    const double raw[] = {0.3, 0.1 + 0.2};
    bool right = errbound::orient2d(a, b, c) == sign_type::positive;
    right = right &&
            errbound::orient2d(a, b, Eigen::Map<const Eigen::Vector2d>(raw)) == sign_type::positive;
    right = right &&
            errbound::orient2d(a, vertex{1, 1, 7}, survey::station{0.5, 0.5}) == sign_type::zero;

    // In batches: n points left of the line ab, on it, or right of it.
    const Eigen::Index n = 10'000;
    Eigen::MatrixX2d by_coordinate(n, 2);  // all x, then all y: the fastest form
    Eigen::Matrix2Xd by_point(2, n);       // x y, x y, ...
    std::vector<Eigen::Vector2d> list(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const double x = 0.1 * double(i);
        by_coordinate.row(i) << x, x + double(i % 3 - 1) * 0x1p-44;
        by_point.col(i) = list[std::size_t(i)] = by_coordinate.row(i);
    }
    const errbound::coordinate_arrays<double, 2> arrays{
        {by_coordinate.col(0).data(), by_coordinate.col(1).data()}, std::size_t(n)};
    const errbound::every<std::array<double, 2>> from{{0, 0}}, to{{1, 1}};  // a and b

    std::vector<sign_type> signs(n), of_columns(n), of_list(n);
    errbound::batch_signs(errbound::orient2d, signs, from, to, arrays);
    errbound::batch_signs(errbound::orient2d, of_columns, from, to, by_point.colwise());
    errbound::batch_signs(errbound::orient2d, of_list, from, to, list);
    std::array<int, 3> count{};
    for (Eigen::Index i = 0; i < n; ++i) {
        const sign_type s = signs[std::size_t(i)];
        ++count[std::size_t(s)];
        right = right && s == errbound::orient2d(a, b, by_coordinate.row(i)) &&
                s == of_columns[std::size_t(i)] && s == of_list[std::size_t(i)];
    }
    std::printf("right %d, on %d, left %d: %s\n", count[0], count[1], count[2],
                right ? "the same in all forms" : "forms differ");
    return right ? 0 : 1;
}
