#include <algorithm>
#include <array>
#include <ccd/curves.hpp>
#include <random>

#include "tests/bench/sections.hpp"

namespace bench {
namespace {

using control_points = std::vector<ccd::point<double>>;

/// Random control points in the unit cube: features meet in one of seven cubics.
std::vector<std::array<control_points, 4>> random_motions(std::size_t count, int degree) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> coordinate(0, 1);
    std::vector<std::array<control_points, 4>> motions(count);
    for (auto& motion : motions)
        for (control_points& points : motion)
            for (int i = 0; i <= degree; ++i)
                points.push_back({coordinate(random), coordinate(random), coordinate(random)});
    return motions;
}

template <class Query>
row row_of(std::string_view kind, int degree, const options& o) {
    const auto motions = random_motions(o.quick ? 200 : 1'000, degree);
    std::vector<ccd::first_time> contacts(motions.size()), near(motions.size());
    const auto compute = [&motions](std::vector<ccd::first_time>& times, ccd::separation d) {
        for (std::size_t i = 0; i < motions.size(); ++i) {
            const auto& [a, b, c, e] = motions[i];
            times[i] = ccd::time_within(Query{a, b, c, e}, d);
        }
    };
    const auto timings =
        race({[&] { compute(contacts, {}); }, [&] { compute(near, {0.01}); }}, o.repeats());
    const auto found = [](const std::vector<ccd::first_time>& times) {
        return std::ranges::count(times, ccd::outcome::collides, &ccd::first_time::outcome);
    };
    return {{"kind", kind},
            {"degree", degree},
            {"queries", motions.size()},
            {"contacts", found(contacts)},
            {"us_contact", 1e-3 * timings[0].ns(motions.size())},
            {"within_0.01", found(near)},
            {"us_within", 1e-3 * timings[1].ns(motions.size())}};
}

}  // namespace

void curves(const options& o, report& out) {
    rows all;
    for (const int degree : {1, 2, 3, 5}) {
        all.push_back(row_of<ccd::vertex_face_curves>("vf", degree, o));
        all.push_back(row_of<ccd::edge_edge_curves>("ee", degree, o));
    }
    out.table("curves", {},
              "First times along curves, control points all over the unit cube, us per query", all);
}

}  // namespace bench
