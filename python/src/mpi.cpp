// The extension module errbound._mpi, separate so that errbound._native does not require MPI.
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include <ccd/mpi.hpp>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "arrays.hpp"
#include "interruptible.hpp"
#include "results.hpp"
#include "step_request.hpp"

namespace errbound::python {
namespace {

/// A rank's elements of a mesh, and the communicator as Fortran's handle.
struct distributed_mesh {
    int comm;
    numbered vertices;
    positions before, after;
    input<std::uint32_t, -1, 3> faces;
    input<std::uint32_t, -1, 2> edges;

    MPI_Comm communicator() const { return MPI_Comm_f2c(comm); }
    ccd::mpi::mesh_part part() const {
        return {items_of<ccd::mpi::vertex_number>(vertices), rows(before, after),
                items_of<ccd::face>(faces), items_of<ccd::edge>(edges)};
    }
};

nb::dict dict_of(const ccd::mpi::rank_work& work) {
    nb::dict found;
    found["elements_given"] = work.elements_given;
    found["elements_held"] = work.elements_held;
    found["bytes_sent"] = work.bytes_sent;
    found["seconds"] = work.seconds;
    return found;
}

nb::dict step(const distributed_mesh& mesh, const step_request& request, bool gather) {
    ccd::step_options options = request.step_options();
    ccd::mpi::step_result result = without_gil([&](const ccd::stop_query& stop) {
        options.stop = stop;
        return ccd::mpi::step(mesh.communicator(), mesh.part(), options,
                              gather ? ccd::mpi::placement::root : ccd::mpi::placement::owners);
    });
    nb::dict found;
    found["candidates"] = counts_of(std::move(result.candidates));
    found["pairs"] = pairs_of<ccd::mpi::vertex_number>(std::move(result.pairs));
    found["touching_at_start"] =
        pairs_of<ccd::mpi::vertex_number>(std::move(result.touching_at_start));
    found["times"] = nb::none();
    if (request.times)
        found["times"] = of_each_kind(std::move(result.times),
                                      [](auto&& times) { return times_of(std::move(times)); });
    found["first_contact"] = time_of(result.first_contact);
    found["intersections_at_start"] = nb::none();
    if (request.check_start)
        found["intersections_at_start"] = intersections_of(result.intersections_at_start);
    found["work"] = dict_of(result.work);
    return found;
}

nb::dict intersections(const distributed_mesh& mesh, const step_request& request, bool gather) {
    ccd::intersection_options options = request.intersection_options();
    ccd::mpi::intersection_result result = without_gil([&](const ccd::stop_query& stop) {
        options.stop = stop;
        return ccd::mpi::intersections(
            mesh.communicator(), mesh.part(), options,
            gather ? ccd::mpi::placement::root : ccd::mpi::placement::owners);
    });
    nb::dict found;
    found["pairs"] = intersections_of(result.pairs);
    found["total"] = result.counts.total();
    found["work"] = dict_of(result.work);
    return found;
}

nb::dict advance(const distributed_mesh& mesh, const step_request& request) {
    ccd::advance_options options = request.advance_options();
    ccd::mpi::advance_result result = without_gil([&](const ccd::stop_query& stop) {
        options.stop = stop;
        return ccd::mpi::advance(mesh.communicator(), mesh.part(), options);
    });
    nb::dict found;
    found["positions"] = rows_of<double>(std::move(result.positions));
    found["fraction"] = result.fraction;
    found["fractions"] = numbers_of<double>(std::move(result.fractions));
    found["first_contact"] = time_of(result.first_contact);
    found["first_pairs"] = pairs_of<ccd::mpi::vertex_number>(std::move(result.first_pairs));
    found["touching_at_start"] =
        pairs_of<ccd::mpi::vertex_number>(std::move(result.touching_at_start));
    found["near_at_start"] = pairs_of<ccd::mpi::vertex_number>(std::move(result.near_at_start));
    found["intersections_at_start"] = nb::none();
    if (request.check_start)
        found["intersections_at_start"] = intersections_of(result.intersections_at_start);
    found["work"] = dict_of(result.work);
    return found;
}

std::string library_version() {
    char text[MPI_MAX_LIBRARY_VERSION_STRING];
    int length = 0;
    MPI_Get_library_version(text, &length);
    return text;  // length may include the terminating null
}

}  // namespace
}  // namespace errbound::python

NB_MODULE(_mpi, m) {
    using namespace errbound::python;
    m.doc() = "Functions for errbound.mpi. Arguments are made by errbound._arrays.";
    nb::module_::import_("errbound._native");  // defines step_request
    m.def("library_version", &library_version);
    nb::class_<distributed_mesh>(m, "Mesh").def(
        nb::init<int, numbered, positions, positions, input<std::uint32_t, -1, 3>,
                 input<std::uint32_t, -1, 2>>(),
        nb::arg("comm"), nb::arg("numbers"), nb::arg("before"), nb::arg("after"), nb::arg("faces"),
        nb::arg("edges"));
    m.def("step", &step, nb::arg("mesh"), nb::arg("request"), nb::arg("gather"));
    m.def("intersections", &intersections, nb::arg("mesh"), nb::arg("request"), nb::arg("gather"));
    m.def("advance", &advance, nb::arg("mesh"), nb::arg("request"));
}
