// Results for errbound/ccd.py: dictionaries of arrays.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include <ccd/contact.hpp>
#include <ccd/explain.hpp>
#include <ccd/method.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "arrays.hpp"

namespace errbound::python {

inline nb::list stages_of(const ccd::stage_report& report) {
    nb::list rows;
    for (const ccd::stage_info& stage : ccd::exact_stages) {
        const auto& e = report[stage.stage];
        rows.append(nb::make_tuple(std::string(stage.name), e.entered, e.skipped, e.separate,
                                   e.collides, e.seconds));
    }
    return rows;
}

inline nb::object time_of(const ccd::first_time& time) {
    if (time.outcome != ccd::outcome::collides) return nb::none();
    return nb::make_tuple(time.low, time.high);
}

inline nb::dict times_of(std::vector<ccd::first_time>&& times) {
    const shared_items<ccd::first_time> shared(std::move(times));
    nb::dict found;
    found["low"] = shared.column(shared.first().low);
    found["high"] = shared.column(shared.first().high);
    return found;
}

inline ccd::method method_of(const std::string& name) {
    if (const auto method = ccd::find_method(name)) return *method;
    std::string expected;
    for (const auto& m : ccd::methods())
        expected += (expected.empty() ? "" : ", ") + std::string(m.name);
    throw std::invalid_argument("method is '" + name + "'; expected one of " + expected);
}

}  // namespace errbound::python
