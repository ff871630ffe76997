// Motion along curves: a ball under gravity (degree 2) and a face with a vertex on a cubic. Then a
// spline of two pieces, and the cost of such queries.
#include <array>
#include <ccd/curves.hpp>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <random>
#include <vector>

namespace {

using control_points = std::vector<ccd::point<double>>;

/// Prints the mean time of first contacts of random cubics in the unit cube, and their number.
void time_random_queries() {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> coordinate(0, 1);
    constexpr std::size_t count = 5000;
    std::vector<std::array<control_points, 4>> motions(count);
    for (auto& motion : motions)
        for (control_points& points : motion)
            for (int i = 0; i < 4; ++i)
                points.push_back({coordinate(random), coordinate(random), coordinate(random)});
    std::size_t contacts = 0;
    const auto start = std::chrono::steady_clock::now();
    for (const auto& [v, f0, f1, f2] : motions) {
        const auto found = ccd::time_of_impact(ccd::vertex_face_curves{v, f0, f1, f2});
        contacts += found.outcome == ccd::outcome::collides;
    }
    const std::chrono::duration<double, std::micro> spent =
        std::chrono::steady_clock::now() - start;
    std::printf("%zu random cubics: %zu contacts, %.1f us each\n", count, contacts,
                spent.count() / static_cast<double>(count));
}

}  // namespace

int main() {
    // z = 1 + 2t − 4t², from its values and slopes at both ends.
    const control_points ball{{0.25, 0.25, 1}, {0.25, 0.25, 2}, {0.25, 0.25, -1}};
    const control_points f0{{0, 0, 0}}, f1{{1, 0, 0}};
    const control_points f2{{0, 1, 0}, {0, 1, 0.5}, {0, 1, 0.5}, {0, 1, 0}};
    const ccd::vertex_face_curves query{ball, f0, f1, f2};

    const ccd::first_time touch = ccd::time_of_impact(query);
    std::printf("touches between t = %.17g and %.17g\n", touch.low, touch.high);
    const ccd::first_time near = ccd::time_within(query, {0.25, 0.125});  // two radii
    std::printf("within 0.375 from t = %.17g\n", near.low);

    // A spline of two pieces: the ball waits for a second before it is thrown.
    const control_points rest{ball.front()};
    const std::vector<ccd::spline_piece<ccd::vertex_face_curves>> pieces{{0, 1, {rest, f0, f1, f2}},
                                                                         {1, 3, query}};
    const ccd::spline_time contact = ccd::first_time_of_pieces(pieces);
    std::printf("on the spline: in piece %zu, at time %.6f\n", contact.piece, contact.low);

    time_random_queries();
}
