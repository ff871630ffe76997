#pragma once

#include <nanobind/nanobind.h>

namespace errbound::python {

void bind_bodies(nanobind::module_& m);
void bind_files(nanobind::module_& m);
void bind_predicates(nanobind::module_& m);
void bind_queries(nanobind::module_& m);
void bind_roots(nanobind::module_& m);
void bind_steps(nanobind::module_& m);
void bind_tracked(nanobind::module_& m);
void bind_views(nanobind::module_& m);

}  // namespace errbound::python
