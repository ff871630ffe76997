// The extension module errbound._native.
#include <ccd/kind.hpp>
#include <errbound/support/error.hpp>

#include "bindings.hpp"

NB_MODULE(_native, m) {
    namespace nb = nanobind;
    m.doc() = "What errbound's modules call: arguments are as errbound._arrays makes them.";
    nb::exception<errbound::support::file_error>(m, "FileError", PyExc_ValueError).attr("__doc__") =
        "What is wrong with a file: its name, the line or element, found, expected.";
    // NumPy keeps a reference to an operand whose reduction, as by numpy.prod, raises (2.4).
    nb::set_leak_warnings(false);
    errbound::python::bind_queries(m);
    errbound::python::bind_steps(m);
    errbound::python::bind_files(m);
    errbound::python::bind_views(m);
    errbound::python::bind_predicates(m);
    errbound::python::bind_roots(m);
    errbound::python::bind_tracked(m);
}
