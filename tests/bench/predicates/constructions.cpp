// Times of whole constructions, the examples of examples/geometry: with exact signs, with plain
// doubles in the same code, and by CGAL. All points are in general position.
#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>
#include <string>

#include "examples/geometry/arrangement.hpp"
#include "examples/geometry/delaunay3d.hpp"
#include "examples/geometry/polygons.hpp"
#include "tests/bench/harness.hpp"
#include "tests/bench/predicates/peers.hpp"

namespace bench {
namespace {

class generator {
  public:
    double uniform() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
    template <std::size_t D>
    std::vector<std::array<double, D>> points(std::size_t count) {
        std::vector<std::array<double, D>> all(count);
        for (auto& p : all)
            for (double& x : p) x = uniform();
        return all;
    }
    /// Counterclockwise, and simple: a star.
    plane_points polygon(std::size_t count, double x, double y) {
        plane_points all;
        for (std::size_t i = 0; i < count; ++i) {
            const double angle = 6.28318530717958648 * (static_cast<double>(i) + uniform() / 2) /
                                 static_cast<double>(count);
            const double radius = 1 + uniform();
            all.push_back({x + radius * std::cos(angle), y + radius * std::sin(angle)});
        }
        return all;
    }

  private:
    std::mt19937_64 random_{1};
};

using construction = std::function<std::size_t()>;

void add_construction(rows& table, int repeats, std::size_t inputs, const std::string& name,
                      const construction& exact, const construction& plain,
                      const construction& cgal) {
    std::array<std::size_t, 3> results{};
    std::vector<std::function<void()>> passes{[&] { results[0] = exact(); },
                                              [&] { results[1] = plain(); }};
    if constexpr (have_cgal) passes.push_back([&] { results[2] = cgal(); });
    const auto timings = race(passes, repeats);
    if (results[0] != results[1] || (have_cgal && results[0] != results[2]))
        throw std::runtime_error(name + ": " + std::to_string(results[0]) + ", " +
                                 std::to_string(results[1]) + " and " + std::to_string(results[2]) +
                                 " parts");
    table.push_back(
        {{"construction", name},
         {"inputs", inputs},
         {"parts", results[0]},
         {"errbound_ms", timings[0].ms()},
         {"plain_double_ms", timings[1].ms()},
         {"errbound/plain", timings[0].minimum / timings[1].minimum},
         {"CGAL_ms", have_cgal ? row(timings[2].ms()) : row("")},
         {"CGAL/errbound", have_cgal ? row(timings[2].minimum / timings[0].minimum) : row("")}});
}

/// The number of finite simplices.
template <bool Exact>
std::size_t count_simplices(const space_points& points) {
    const delaunay3d::triangulation<Exact> result(points);
    std::size_t count = 0;
    for (const auto& s : result.simplices)
        count += s.vertex[0] != delaunay3d::none && s.corner_of(result.infinity) == 4;
    return count;
}

}  // namespace

void whole_constructions(bool quick, report& out) {
    generator random;
    rows table;
    const int repeats = quick ? 1 : 5;
    const auto sites = random.points<3>(quick ? 100 : 5000);
    add_construction(
        table, repeats, sites.size(), "Delaunay triangulation in space",
        [&] { return count_simplices<true>(sites); }, [&] { return count_simplices<false>(sites); },
        [&]() -> std::size_t {
            if constexpr (have_cgal) return cgal_delaunay3d(sites);
            return 0;
        });

    const auto ends = random.points<2>(quick ? 40 : 600);
    std::vector<arrangements::segment> segments;
    for (std::size_t i = 0; i < ends.size(); i += 2)
        segments.push_back(ends[i] < ends[i + 1] ? arrangements::segment{ends[i], ends[i + 1]}
                                                 : arrangements::segment{ends[i + 1], ends[i]});
    add_construction(
        table, repeats, segments.size(), "arrangement of segments",
        [&] { return arrangements::sweep<true>(segments).run().vertices; },
        [&] { return arrangements::sweep<false>(segments).run().vertices; },
        [&]() -> std::size_t {
            if constexpr (have_cgal) return cgal_arrangement(ends);
            return 0;
        });

    const std::size_t size = quick ? 20 : 500;
    const auto first = random.polygon(size, 0, 0), second = random.polygon(size, 0.2, 0.1);
    const auto common = [&]<bool Exact>() {
        return polygons::overlay<Exact, double>(first, second)
            .border(polygons::operation::intersection)
            .size();
    };
    add_construction(
        table, repeats, 2 * size, "intersection of polygons",
        [&] { return common.operator()<true>(); }, [&] { return common.operator()<false>(); },
        [&]() -> std::size_t {
            if constexpr (have_cgal) return cgal_intersection(first, second);
            return 0;
        });
    out.table("predicates", {{"what", "constructions"}}, "examples/geometry, ms", table);
}

}  // namespace bench
