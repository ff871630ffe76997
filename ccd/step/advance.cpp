#include <algorithm>
#include <ccd/advance.hpp>
#include <ccd/contact.hpp>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "ccd/step/advancing.hpp"
#include "ccd/step/checks.hpp"
#include "ccd/step/vertex_groups.hpp"

namespace ccd {
namespace {

detail::vertex_groups groups_of(std::size_t vertices, std::span<const int> groups) {
    if (!groups.empty() && groups.size() != vertices)
        throw std::invalid_argument("ccd::advance: number of groups is " +
                                    std::to_string(groups.size()) + "; expected " +
                                    std::to_string(vertices) + ", one for each vertex");
    detail::vertex_groups made(vertices);
    if (groups.empty()) made.join_all();
    for (vertex_index v = 0; v < groups.size(); ++v) made.join_named(groups[v], v);
    return made;
}

}  // namespace

advance_result advance(mesh_steps& steps, const vertex_rows& positions,
                       const advance_options& options) {
    detail::check_conservative(options.conservative);
    detail::vertex_groups groups = groups_of(positions.vertices, options.groups);
    detail::no_others nobody;
    advance_result result =
        detail::advancing(steps, positions, options, !options.groups.empty(), groups, nobody).run();
    for (const double f : result.fractions) result.fraction = std::min(result.fraction, f);
    return result;
}

advance_result advance(const mesh& before, const mesh& after, const advance_options& options) {
    detail::check_frames(before, after);
    mesh_steps steps(before);
    return advance(steps, vertex_rows(before, after), options);
}

namespace {

/// Finds contacts on ways from the same positions. Pairs in contact there are skipped.
class way_test {
  public:
    way_test(mesh_steps& steps, const advance_options& options) : steps_(steps), options_(options) {
        if (!options.groups.empty())
            throw std::invalid_argument("ccd::free_step: number of groups is " +
                                        std::to_string(options.groups.size()) + "; expected none");
    }

    /// The first call sets lists at the start, which depend on way.before only.
    free_step_result first_contact(const vertex_rows& way) {
        step_options options{.threads = options_.threads,
                             .set = options_.set,
                             .distances = options_.distances,
                             .stop = options_.stop,
                             .filter = options_.filter};
        options.check_start = options_.check_start && is_first_;
        free_step_result result;
        detail::no_others nobody;
        step_result found =
            detail::step_to_first_contact(way, options, nobody, [&](const step_options& o) {
                step_result one = steps_.run(way, o);
                if (o.check_start)
                    result.intersections_at_start = std::move(one.intersections_at_start);
                return one;
            });
        result.first_contact = found.first_contact;
        result.first_pairs = std::move(found.first_pairs);
        if (options.distances.is_contact())
            result.touching_at_start = std::move(found.touching_at_start);
        else
            for_each_kind([&]<kind K>() { test_near<K>(way, found, result); });
        is_first_ = false;
        return result;
    }

  private:
    /// Pairs within their distance at the start: finds contacts.
    template <kind K>
    void test_near(const vertex_rows& way, const step_result& found, free_step_result& result) {
        const auto& near = found.touching_at_start.of<K>();
        const std::vector<first_time> times = first_times(
            way, near, {.threads = options_.threads, .set = options_.set, .stop = options_.stop});
        for (std::size_t i = 0; i < near.size(); ++i) {
            const bool touch = times[i].at_start();
            (touch ? result.touching_at_start : result.near_at_start).of<K>().push_back(near[i]);
            if (times[i].outcome == outcome::collides && !touch)
                detail::add_first(times[i], near[i], result);
        }
    }

    mesh_steps& steps_;
    const advance_options& options_;
    bool is_first_ = true;
};

double rounded_twice(double x, double alpha, double p) {
    volatile double product = alpha * p;  // so that no compiler fuses the two operations
    return x + product;
}

/// The two forms of x + alpha * p. Returns false if a position is not finite.
bool move(const vertex_rows& directed, double alpha, std::vector<point<double>>& rounded,
          std::vector<point<double>>& fused) {
    bool finite = true;
    for (std::size_t v = 0; v < directed.vertices; ++v) {
        const auto [x, p] = directed[static_cast<vertex_index>(v)];
        rounded[v] = {rounded_twice(x.x, alpha, p.x), rounded_twice(x.y, alpha, p.y),
                      rounded_twice(x.z, alpha, p.z)};
        fused[v] = {std::fma(alpha, p.x, x.x), std::fma(alpha, p.y, x.y),
                    std::fma(alpha, p.z, x.z)};
        for (const point<double>& q : {rounded[v], fused[v]})
            finite &= std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z);
    }
    return finite;
}

}  // namespace

free_step_result free_step(mesh_steps& steps, const vertex_rows& directed,
                           const advance_options& options) {
    detail::check_conservative(options.conservative);
    for (std::size_t i = 0; directed.after != nullptr && i < 3 * directed.vertices; ++i)
        if (!std::isfinite(directed.after[i]))
            throw std::invalid_argument("ccd::free_step: displacement of vertex " +
                                        std::to_string(i / 3) + " has " + "xyz"[i % 3] + " " +
                                        std::to_string(directed.after[i]) +
                                        "; expected a finite number");
    way_test test(steps, options);
    std::vector<point<double>> rounded(directed.vertices), fused(directed.vertices);
    const auto way_to = [&](const std::vector<point<double>>& end) {
        return vertex_rows(directed.before, reinterpret_cast<const double*>(end.data()),
                           directed.vertices);
    };
    double alpha = 1;
    while (!move(directed, alpha, rounded, fused)) alpha /= 2;
    free_step_result result = test.first_contact(way_to(rounded));
    first_time found = result.first_contact;
    // A later contact is due to rounding: alpha decreases by a few ulps, then by more and more.
    for (double less = 0; alpha > 0; less = std::max(0x1p-52, 4 * less)) {
        if (found.outcome != outcome::collides && fused != rounded)
            found = test.first_contact(way_to(fused)).first_contact;
        if (found.outcome != outcome::collides) break;
        const double before = detail::last_before(found);
        alpha *=
            less == 0 ? options.conservative * before : std::max(0.0, std::min(before, 1 - less));
        move(directed, alpha, rounded, fused);
        found = test.first_contact(way_to(rounded)).first_contact;
    }
    result.alpha = alpha;
    result.positions = std::move(rounded);
    return result;
}

}  // namespace ccd
