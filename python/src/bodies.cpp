#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <ccd/bodies/steps.hpp>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "bindings.hpp"
#include "interruptible.hpp"
#include "results.hpp"
#include "step_request.hpp"

namespace errbound::python {
namespace {

/// Rows of 7 numbers, a position and a quaternion w x y z, or of 12, the rows of (A | p).
using poses = input<double, -1, -1>;
constexpr std::size_t affine_size = 12;

ccd::pose rigid_pose(const double* row) {
    return {{row[3], row[4], row[5], row[6]}, {row[0], row[1], row[2]}};
}
void set_affine(const double* row, ccd::matrix3& a, ccd::point<double>& p) {
    for (std::size_t i = 0; i < 3; ++i) std::copy_n(row + 4 * i, 3, a[i].begin());
    p = {row[3], row[7], row[11]};
}
ccd::body_motion motion_of(const double* from, const double* to, std::size_t size) {
    if (size != affine_size) return ccd::shorter_arc(rigid_pose(from), rigid_pose(to));
    ccd::affine_motion m;
    set_affine(from, m.a0, m.p0);
    set_affine(to, m.a1, m.p1);
    return m;
}
std::vector<ccd::body_motion> motions_of(const poses& from, const poses& to) {
    const std::size_t size = from.shape(1);
    std::vector<ccd::body_motion> all;
    for (std::size_t b = 0; b < from.shape(0); ++b)
        all.push_back(motion_of(from.data() + b * size, to.data() + b * size, size));
    return all;
}

std::array<double, 7> rigid_end(const ccd::body_motion& motion) {
    const auto& m = std::get<ccd::rigid_motion>(motion);
    return {m.p1.x, m.p1.y, m.p1.z, m.q1.w, m.q1.x, m.q1.y, m.q1.z};
}
std::array<double, affine_size> affine_end(const ccd::body_motion& motion) {
    const auto& [a0, a, p0, p] = std::get<ccd::affine_motion>(motion);
    return {a[0][0], a[0][1], a[0][2], p.x,     a[1][0], a[1][1],
            a[1][2], p.y,     a[2][0], a[2][1], a[2][2], p.z};
}
template <class EndOf>
nb::object ends_of(const std::vector<ccd::body_motion>& motions, const EndOf& end_of) {
    std::vector<decltype(end_of(motions[0]))> rows;
    for (const auto& m : motions) rows.push_back(end_of(m));
    return rows_of<double>(std::move(rows));
}

using shape =
    std::tuple<input<double, -1, 3>, input<std::uint32_t, -1, 3>, input<std::uint32_t, -1, 2>>;
std::vector<ccd::mesh> meshes_of(const std::vector<shape>& shapes) {
    std::vector<ccd::mesh> meshes;
    for (const auto& [vertices, faces, edges] : shapes) {
        const auto v = items_of<ccd::point<double>>(vertices);
        const auto f = items_of<ccd::face>(faces);
        const auto e = items_of<ccd::edge>(edges);
        meshes.push_back({{v.begin(), v.end()}, {f.begin(), f.end()}, {e.begin(), e.end()}});
    }
    return meshes;
}

class bodies {
    using pair = std::array<std::int32_t, 2>;

    template <class Call>
    auto alone(const Call& call) {
        const std::unique_lock held(mutex_, std::try_to_lock);
        if (!held)
            throw std::runtime_error("Bodies: another call is under way; expected one at a time");
        return without_gil(call);
    }

    ccd::body_step_options options(double distance, double t_max, bool check_start, int threads,
                                   const ccd::stop_query& stop) const {
        ccd::body_step_options options{.distance = {distance, 0},
                                       .t_max = t_max,
                                       .check_start = check_start,
                                       .threads = threads,
                                       .stop = stop};
        if (groups_.empty() && skipped_.empty()) return options;
        options.may_touch = [this](std::size_t a, std::size_t b) {
            return (groups_.empty() || groups_[a] != groups_[b]) &&
                   !std::ranges::binary_search(
                       skipped_, pair{static_cast<std::int32_t>(a), static_cast<std::int32_t>(b)});
        };
        return options;
    }

  public:
    bodies(const std::vector<shape>& shapes, const input<std::int32_t, -1>& groups,
           const input<std::int32_t, -1, 2>& skipped)
        : steps_(meshes_of(shapes)),
          groups_(groups.data(), groups.data() + groups.size()),
          skipped_(items_of<pair>(skipped).begin(), items_of<pair>(skipped).end()) {}

    nb::dict run(const poses& from, const poses& to, double distance, double t_max,
                 bool check_start, int threads) {
        const auto motions = motions_of(from, to);
        ccd::body_step_result result = alone([&](const ccd::stop_query& stop) {
            return steps_.run(motions, options(distance, t_max, check_start, threads, stop));
        });
        nb::dict found;
        found["candidates"] = counts_of(result.candidates);
        found["pairs"] = pairs_of(std::move(result.pairs));
        found["times"] = of_each_kind(std::move(result.times),
                                      [](auto&& times) { return times_of(std::move(times)); });
        found["touching_at_start"] = pairs_of(std::move(result.touching_at_start));
        add_crossing(found, result.crossing_at_start, check_start);
        found["first_contact"] = time_of(result.first_contact);
        found["first_pairs"] = pairs_of(std::move(result.first_pairs));
        found["body_pairs"] = result.body_pairs;
        return found;
    }
    nb::dict advance(const poses& from, const poses& to, double distance, double conservative,
                     bool check_start, int threads) {
        const auto motions = motions_of(from, to);
        ccd::body_advance result = alone([&](const ccd::stop_query& stop) {
            return steps_.advance(motions,
                                  {options(distance, 1, check_start, threads, stop), conservative});
        });
        nb::dict found;
        found["poses"] = from.shape(1) == affine_size ? ends_of(result.motions, affine_end)
                                                      : ends_of(result.motions, rigid_end);
        found["fraction"] = result.fraction;
        found["first_contact"] = time_of(result.first_contact);
        found["first_pairs"] = pairs_of(std::move(result.first_pairs));
        found["touching_at_start"] = pairs_of(std::move(result.touching_at_start));
        add_crossing(found, result.crossing_at_start, check_start);
        return found;
    }

  private:
    static void add_crossing(nb::dict& found, std::vector<ccd::edge_face_pair>& crossing,
                             bool check_start) {
        found["crossing_at_start"] = nb::none();
        if (check_start)
            found["crossing_at_start"] = rows_of<ccd::vertex_index>(std::move(crossing));
    }

    ccd::body_steps steps_;
    std::vector<std::int32_t> groups_;  ///< one per body, or none
    std::vector<pair> skipped_;         ///< sorted, the lesser body first
    std::mutex mutex_;
};

}  // namespace

void bind_bodies(nb::module_& m) {
    nb::class_<bodies>(m, "Bodies")
        .def(nb::init<const std::vector<shape>&, const input<std::int32_t, -1>&,
                      const input<std::int32_t, -1, 2>&>(),
             nb::arg("shapes"), nb::arg("groups"), nb::arg("skipped"))
        .def("run", &bodies::run, nb::arg("start"), nb::arg("end"), nb::arg("distance"),
             nb::arg("t_max"), nb::arg("check_start"), nb::arg("threads"))
        .def("advance", &bodies::advance, nb::arg("start"), nb::arg("end"), nb::arg("distance"),
             nb::arg("conservative"), nb::arg("check_start"), nb::arg("threads"));
}

}  // namespace errbound::python
