// Results for errbound/ccd.py: dictionaries of arrays.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include <ccd/certify.hpp>
#include <ccd/contact.hpp>
#include <ccd/explain.hpp>
#include <ccd/method.hpp>
#include <ccd/nearness.hpp>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
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

/// The columns of a member of type ccd::first_contact, except its time.
template <class Item>
void add_contacts(nb::dict& found, const shared_items<Item>& shared, const ccd::first_contact& c) {
    const auto code = [](const auto& x) -> auto& {
        return reinterpret_cast<const std::uint8_t&>(x);
    };
    found["features"] = shared.column(code(c.features.kind));
    found["points"] = shared.columns(c.features.points.data(), 4);
    found["weights"] = shared.columns(c.weights.data(), 4);
    found["weight_error"] = shared.column(c.weight_error);
    found["normal"] = shared.columns(&c.normal.x, 3);
    found["normal_error"] = shared.column(c.normal_error);
    found["normal_from"] = shared.column(code(c.normal_from));
    found["sided"] = shared.column(c.sided);
    found["normal_velocity"] = shared.column(c.normal_velocity);
    found["normal_velocity_error"] = shared.column(c.normal_velocity_error);
}

inline nb::dict passages_of(std::vector<ccd::passage>&& passages) {
    const shared_items<ccd::passage> shared(std::move(passages));
    const ccd::passage& p = shared.first();
    nb::dict found;
    found["low"] = shared.column(p.contact.time.low);
    found["high"] = shared.column(p.contact.time.high);
    add_contacts(found, shared, p.contact);
    found["motion"] = shared.column(reinterpret_cast<const std::uint8_t&>(p.motion));
    found["depth"] = shared.column(p.depth);
    found["depth_error"] = shared.column(p.depth_error);
    return found;
}

inline nb::dict nearness_of(std::vector<ccd::nearness>&& data) {
    const shared_items<ccd::nearness> shared(std::move(data));
    const ccd::nearness& n = shared.first();
    nb::dict found;
    found["features"] = shared.column(reinterpret_cast<const std::uint8_t&>(n.features.kind));
    found["points"] = shared.columns(n.features.points.data(), 4);
    found["weights"] = shared.columns(n.weights.data(), 4);
    found["weight_error"] = shared.column(n.weight_error);
    found["squared_distance"] = shared.column(n.squared_distance);
    found["squared_distance_error"] = shared.column(n.squared_distance_error);
    found["distance"] = shared.column(n.distance);
    found["distance_error"] = shared.column(n.distance_error);
    found["normal"] = shared.columns(&n.normal.x, 3);
    found["normal_error"] = shared.column(n.normal_error);
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
