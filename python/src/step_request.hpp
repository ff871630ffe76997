// Options of steps, and conversions that steps and distributed steps share.
#pragma once

#include <nanobind/nanobind.h>

#include <ccd/advance.hpp>
#include <ccd/nearness.hpp>
#include <ccd/step.hpp>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "arrays.hpp"
#include "results.hpp"

namespace errbound::python {

using positions = input<double, -1, 3>;
using numbers = input<double, -1>;
using group_numbers = input<std::int32_t, -1>;
using flags = input<std::uint8_t, -1>;
using numbered = input<std::uint64_t, -1>;

/// Converts a callback's result, a bool or NumPy's. None, of a missing return, is an error.
inline bool truth_of(const nb::object& result) {
    if (result.is_none())
        throw nb::type_error("result of can_collide is None; expected True or False");
    const int truth = PyObject_IsTrue(result.ptr());
    if (truth < 0) throw nb::python_error();
    return truth > 0;
}

/// Options that Python sets by name. They keep the arrays to which their spans refer.
struct step_request {
    std::string method = "exact";
    int threads = 0;
    bool count_candidates = false, stages = false, initial_contact = false, first_contact = false,
         times = false, between_groups = true, skip_unused = false;
    double t_max = 1, distance = 0;
    std::optional<numbers> thickness;
    std::optional<group_numbers> groups, islands;
    std::optional<flags> pinned;
    nb::object can_collide = nb::none();

    ccd::pair_distances distances() const {
        ccd::pair_distances of_pairs{.all = distance};
        if (thickness) of_pairs.thickness = items_of<double>(*thickness);
        return of_pairs;
    }
    ccd::pair_filter filter() const {
        using rule = ccd::pair_filter::group_rule;
        ccd::pair_filter of_pairs;
        of_pairs.skip_unused = skip_unused;
        of_pairs.rule = between_groups ? rule::between_groups : rule::within_groups;
        if (groups) of_pairs.groups = items_of<int>(*groups);
        if (pinned) of_pairs.pinned = items_of<std::uint8_t>(*pinned);
        if (!can_collide.is_none())
            of_pairs.can_collide = [this](ccd::vertex_index v, ccd::vertex_index w) {
                nb::gil_scoped_acquire held;
                return truth_of(can_collide(v, w));
            };
        return of_pairs;
    }
    ccd::step_options step_options() const {
        return {.method = method_of(method),
                .threads = threads,
                .count_candidates = count_candidates,
                .explain = stages,
                .initial_contact = initial_contact,
                .first_contact = first_contact,
                .times = times,
                .t_max = t_max,
                .distances = distances(),
                .filter = filter()};
    }
    ccd::near_options near_options() const { return {.threads = threads, .filter = filter()}; }
    ccd::advance_options advance_options() const {
        ccd::advance_options options{
            .distances = distances(), .threads = threads, .filter = filter()};
        if (islands) options.groups = items_of<int>(*islands);
        return options;
    }
};

inline ccd::vertex_rows rows(const positions& before, const positions& after) {
    if (before.shape(0) != after.shape(0))
        throw std::invalid_argument("number of vertices in after is " +
                                    std::to_string(after.shape(0)) + "; expected " +
                                    std::to_string(before.shape(0)) + ", as in before");
    return {before.data(), after.data(), before.shape(0)};
}

template <template <ccd::kind> class Of, class Convert>
nb::dict of_each_kind(ccd::by_kind<Of>&& all, const Convert& convert) {
    nb::dict found;
    ccd::for_each_kind([&]<ccd::kind K>() {
        found[std::string(ccd::kind_traits<K>::name).c_str()] =
            convert(std::move(all.template of<K>()));
    });
    return found;
}
template <class Number = ccd::vertex_index, class Lists>
nb::dict pairs_of(Lists&& pairs) {
    return of_each_kind(std::move(pairs),
                        [](auto&& list) { return rows_of<Number>(std::move(list)); });
}
inline nb::object counts_of(std::optional<ccd::pair_counts>&& counts) {
    if (!counts) return nb::none();
    return of_each_kind(std::move(*counts), [](std::size_t count) { return nb::cast(count); });
}

}  // namespace errbound::python
