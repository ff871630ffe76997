#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include <ccd/advance.hpp>
#include <ccd/certify.hpp>
#include <ccd/nearness.hpp>
#include <ccd/step.hpp>
#include <cstdint>
#include <mutex>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "interruptible.hpp"
#include "results.hpp"
#include "step_request.hpp"

namespace errbound::python {
namespace {

nb::dict result_of(ccd::step_result&& result, const step_request& request) {
    nb::dict seconds, found;
    seconds["prepare"] = result.prepare_seconds;
    seconds["broad_phase"] = result.broad_phase_seconds;
    seconds["narrow_phase"] = result.narrow_phase_seconds;
    seconds["sort"] = result.sort_seconds;
    seconds["contact"] = result.contact_seconds;
    seconds["start"] = result.start_seconds;
    seconds["total"] = result.total_seconds;
    found["candidates"] = counts_of(std::move(result.candidates));
    found["pairs"] = pairs_of(std::move(result.pairs));
    found["touching_at_start"] = pairs_of(std::move(result.touching_at_start));
    found["times"] = nb::none();
    if (request.times)
        found["times"] = of_each_kind(std::move(result.times),
                                      [](auto&& times) { return times_of(std::move(times)); });
    found["first_contact"] = time_of(result.first_contact);
    found["first_pairs"] = pairs_of(std::move(result.first_pairs));
    found["seconds"] = seconds;
    found["threads"] = result.threads;
    found["intersections_at_start"] = nb::none();
    if (request.check_start)
        found["intersections_at_start"] = intersections_of(result.intersections_at_start);
    found["stages"] = request.stages ? nb::object(stages_of(result.stages)) : nb::none();
    return found;
}

class steps {
    template <class Call>
    nb::dict free_result(const step_request& request, const Call& call) {
        ccd::advance_options options = request.advance_options();
        ccd::advance_result result = alone([&](const ccd::stop_query& stop) {
            options.stop = stop;
            return call(options);
        });
        nb::dict found;
        found["positions"] = rows_of<double>(std::move(result.positions));
        found["fraction"] = result.fraction;
        found["fractions"] = numbers_of<double>(std::move(result.fractions));
        found["first_contact"] = time_of(result.first_contact);
        found["first_pairs"] = pairs_of(std::move(result.first_pairs));
        found["touching_at_start"] = pairs_of(std::move(result.touching_at_start));
        found["near_at_start"] = pairs_of(std::move(result.near_at_start));
        found["intersections_at_start"] = nb::none();
        if (request.check_start)
            found["intersections_at_start"] = intersections_of(result.intersections_at_start);
        return found;
    }
    /// Throws if a call is running: a callback that waited for its own call would deadlock.
    template <class Call>
    auto alone(const Call& call) {
        const std::unique_lock held(mutex_, std::try_to_lock);
        if (!held)
            throw std::runtime_error("Steps: another call is under way; expected one at a time");
        return without_gil(call);
    }

  public:
    steps(const input<std::uint32_t, -1, 3>& faces, const input<std::uint32_t, -1, 2>& edges,
          std::size_t vertices)
        : steps_(items_of<ccd::face>(faces), items_of<ccd::edge>(edges), vertices) {}
    explicit steps(ccd::mesh_steps&& made) : steps_(std::move(made)) {}

    nb::dict run(const positions& before, const positions& after, const step_request& request) {
        ccd::step_options options = request.step_options();
        return result_of(alone([&](const ccd::stop_query& stop) {
                             options.stop = stop;
                             return steps_.run(rows(before, after), options);
                         }),
                         request);
    }
    /// The request has times and check_start.
    nb::dict certify(const positions& before, const positions& after, const step_request& request) {
        ccd::step_options options = request.step_options();
        ccd::certificate result = alone([&](const ccd::stop_query& stop) {
            options.stop = stop;
            return ccd::certify(steps_, rows(before, after), options);
        });
        nb::dict found;
        found["passages"] = of_each_kind(std::move(result.passages), [](auto&& passages) {
            return passages_of(std::move(passages));
        });
        found["step"] = result_of(std::move(result.step), request);
        return found;
    }
    nb::dict candidates(const positions& before, const positions& after,
                        const step_request& request) {
        ccd::step_options options = request.step_options();
        return pairs_of(alone([&](const ccd::stop_query& stop) {
            options.stop = stop;
            return steps_.candidates(rows(before, after), options);
        }));
    }
    nb::dict advance(const positions& before, const positions& after, const step_request& request) {
        return free_result(request, [&](const ccd::advance_options& options) {
            return ccd::advance(steps_, rows(before, after), options);
        });
    }
    nb::dict free_step(const positions& x, const positions& p, const step_request& request) {
        return free_result(request, [&](const ccd::advance_options& options) {
            return ccd::free_step(steps_, rows(x, p), options);
        });
    }
    nb::dict intersections(const positions& at, const step_request& request) {
        ccd::intersection_options options = request.intersection_options();
        ccd::intersection_result result = alone([&](const ccd::stop_query& stop) {
            options.stop = stop;
            return steps_.intersections({at.data(), nullptr, at.shape(0)}, options);
        });
        nb::dict found = intersections_of(result.pairs);
        found["edge_faces"] = nb::none();
        if (request.edge_faces)
            found["edge_faces"] = rows_of<ccd::vertex_index>(std::move(result.edge_faces));
        found["seconds"] = result.seconds;
        return found;
    }

    nb::dict near_pairs(const positions& at, const step_request& request) {
        ccd::near_options options = request.near_options();
        ccd::near_lists near = alone([&](const ccd::stop_query& stop) {
            options.stop = stop;
            return ccd::near_pairs(steps_, rows(at, at), request.distances(), options);
        });
        nb::dict found;
        found["pairs"] = pairs_of(std::move(near.pairs));
        found["data"] = of_each_kind(std::move(near.data),
                                     [](auto&& data) { return nearness_of(std::move(data)); });
        return found;
    }
    nb::dict least_distance(const positions& at, const step_request& request) {
        ccd::near_options options = request.near_options();
        const ccd::least_distance_result least = alone([&](const ccd::stop_query& stop) {
            options.stop = stop;
            return ccd::least_distance(steps_, rows(at, at), options);
        });
        nb::dict found;
        found["low"] = least.low;
        found["high"] = least.high;
        found["kind"] = std::string(ccd::name(least.kind));
        found["vertices"] = rows_of<ccd::vertex_index>(std::vector{least.vertices});
        found["data"] = nearness_of(std::vector{least.data});
        return found;
    }

  private:
    ccd::mesh_steps steps_;
    std::mutex mutex_;
};

/// Vertex/face, edge/edge, vertex/edge and vertex/vertex pairs.
using pair_inputs = std::tuple<input<std::uint32_t, -1, 4>, input<std::uint32_t, -1, 4>,
                               input<std::uint32_t, -1, 3>, input<std::uint32_t, -1, 2>>;

nb::list reasons(const pair_inputs& pairs, const positions& before, const positions& after,
                 double low, double high, double distance,
                 const std::optional<numbers>& thickness) {
    const ccd::first_time time{ccd::outcome::collides, low, high};
    ccd::pair_distances distances{.all = distance};
    if (thickness) distances.thickness = items_of<double>(*thickness);
    ccd::pair_lists lists;
    const auto fill = [](auto& list, const auto& array) {
        const auto items =
            items_of<typename std::remove_cvref_t<decltype(list)>::value_type>(array);
        list.assign(items.begin(), items.end());
    };
    fill(lists.vertex_face, std::get<0>(pairs));
    fill(lists.edge_edge, std::get<1>(pairs));
    fill(lists.vertex_edge, std::get<2>(pairs));
    fill(lists.vertex_vertex, std::get<3>(pairs));
    nb::list found;
    for (const ccd::reason& r : ccd::reasons(rows(before, after), lists, time, distances))
        found.append(nb::make_tuple(
            std::string(ccd::name(r.kind)),
            nb::make_tuple(r.vertices[0], r.vertices[1], r.vertices[2], r.vertices[3]),
            static_cast<int>(r.motion), r.normal_velocity, r.normal_velocity_error,
            r.at_start.distance, r.at_start.distance_error));
    return found;
}

}  // namespace

void bind_steps(nb::module_& m) {
    nb::class_<step_request>(m, "StepRequest")
        .def(nb::init<>())
        .def_rw("method", &step_request::method)
        .def_rw("threads", &step_request::threads)
        .def_rw("count_candidates", &step_request::count_candidates)
        .def_rw("stages", &step_request::stages)
        .def_rw("initial_contact", &step_request::initial_contact)
        .def_rw("first_contact", &step_request::first_contact)
        .def_rw("times", &step_request::times)
        .def_rw("between_groups", &step_request::between_groups)
        .def_rw("skip_unused", &step_request::skip_unused)
        .def_rw("check_start", &step_request::check_start)
        .def_rw("adjacent_rods", &step_request::adjacent_rods)
        .def_rw("each_vertex", &step_request::each_vertex)
        .def_rw("keep", &step_request::keep)
        .def_rw("conservative", &step_request::conservative)
        .def_rw("segments", &step_request::segments)
        .def_rw("edge_faces", &step_request::edge_faces)
        .def_rw("merge_equal_positions", &step_request::merge_equal_positions)
        .def_rw("first_only", &step_request::first_only)
        .def_rw("t_max", &step_request::t_max)
        .def_rw("distance", &step_request::distance)
        .def_rw("thickness", &step_request::thickness, nb::arg("value").none())
        .def_rw("groups", &step_request::groups, nb::arg("value").none())
        .def_rw("islands", &step_request::islands, nb::arg("value").none())
        .def_rw("pinned", &step_request::pinned, nb::arg("value").none())
        .def_rw("can_collide", &step_request::can_collide, nb::arg("value").none());
    nb::class_<steps>(m, "Steps")
        .def(nb::init<const input<std::uint32_t, -1, 3>&, const input<std::uint32_t, -1, 2>&,
                      std::size_t>(),
             nb::arg("faces"), nb::arg("edges"), nb::arg("vertices"))
        .def_static(
            "in_plane",
            [](const input<std::uint32_t, -1, 2>& edges, std::size_t vertices) {
                return new steps(ccd::mesh_steps::in_plane(items_of<ccd::edge>(edges), vertices));
            },
            nb::arg("edges"), nb::arg("vertices"), nb::rv_policy::take_ownership)
        .def("run", &steps::run, nb::arg("before"), nb::arg("after"), nb::arg("request"))
        .def("certify", &steps::certify, nb::arg("before"), nb::arg("after"), nb::arg("request"))
        .def("candidates", &steps::candidates, nb::arg("before"), nb::arg("after"),
             nb::arg("request"))
        .def("advance", &steps::advance, nb::arg("before"), nb::arg("after"), nb::arg("request"))
        .def("free_step", &steps::free_step, nb::arg("x"), nb::arg("p"), nb::arg("request"))
        .def("intersections", &steps::intersections, nb::arg("positions"), nb::arg("request"))
        .def("near_pairs", &steps::near_pairs, nb::arg("positions"), nb::arg("request"))
        .def("least_distance", &steps::least_distance, nb::arg("positions"), nb::arg("request"));
    m.def("reasons", reasons, nb::arg("pairs"), nb::arg("before"), nb::arg("after"), nb::arg("low"),
          nb::arg("high"), nb::arg("distance"), nb::arg("thickness").none());
}

}  // namespace errbound::python
