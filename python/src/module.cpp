#include <ccd/kind.hpp>
#include <errbound/support/error.hpp>

#include "bindings.hpp"

NB_MODULE(_native, m) {
    namespace nb = nanobind;
    m.doc() = "Functions for errbound's modules. Arguments are made by errbound._arrays.";
    nb::exception<errbound::support::file_error>(m, "FileError", PyExc_ValueError).attr("__doc__") =
        "An invalid file: its name, the line or element, the value and the expected one.";
    // NumPy 2.4 leaks a reference to an operand if its reduction (numpy.prod) raises.
    nb::set_leak_warnings(false);
    errbound::python::bind_queries(m);
    errbound::python::bind_steps(m);
    errbound::python::bind_bodies(m);
    errbound::python::bind_files(m);
    errbound::python::bind_views(m);
    errbound::python::bind_predicates(m);
    errbound::python::bind_roots(m);
    errbound::python::bind_tracked(m);
}
