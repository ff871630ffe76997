// Options of steps, and conversions that steps and distributed steps share.
#pragma once

#include <nanobind/nanobind.h>

#include <algorithm>
#include <array>
#include <ccd/advance.hpp>
#include <ccd/nearness.hpp>
#include <ccd/step.hpp>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

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
         times = false, between_groups = true, skip_unused = false, check_start = false,
         each_vertex = false, adjacent_rods = false;
    // Options of intersections:
    bool segments = true, edge_faces = false, merge_equal_positions = false, first_only = false;
    double t_max = 1, distance = 0, keep = 0.1, conservative = 1;
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
                .check_start = check_start,
                .adjacent_rods = adjacent_rods,
                .t_max = t_max,
                .distances = distances(),
                .filter = filter()};
    }
    ccd::near_options near_options() const { return {.threads = threads, .filter = filter()}; }
    ccd::advance_options advance_options() const {
        ccd::advance_options options{.each_vertex = each_vertex,
                                     .distances = distances(),
                                     .keep = keep,
                                     .threads = threads,
                                     .filter = filter(),
                                     .check_start = check_start,
                                     .conservative = conservative};
        if (islands) options.groups = items_of<int>(*islands);
        return options;
    }
    ccd::intersection_options intersection_options() const {
        using amount = ccd::intersection_options::amount;
        return {.wanted = first_only ? amount::first : amount::all,
                .segments = segments,
                .edge_faces = edge_faces,
                .merge_equal_positions = merge_equal_positions,
                .threads = threads,
                .filter = filter()};
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
/// Vertices, relations, segments and their errors of the intersections of one kind.
template <std::size_t Vertices, class Intersection>
nb::dict intersections_of_kind(const std::vector<Intersection>& all, ccd::intersection_kind kind) {
    using number = std::remove_const_t<
        typename decltype(std::declval<Intersection>().a.vertices())::element_type>;
    std::vector<std::array<number, Vertices>> vertices;
    std::vector<std::uint8_t> relations;
    std::vector<std::array<double, 6>> segments;
    std::vector<std::array<double, 2>> errors;
    for (const Intersection& pair : all) {
        if (pair.kind() != kind) continue;
        auto& row = vertices.emplace_back();
        std::ranges::copy(pair.b.vertices(), std::ranges::copy(pair.a.vertices(), row.begin()).out);
        relations.push_back(static_cast<std::uint8_t>(pair.relation));
        constexpr double none = std::numeric_limits<double>::quiet_NaN();
        auto& segment = segments.emplace_back();
        for (std::size_t i = 0; i < segment.size(); ++i)
            segment[i] = pair.segment ? (*pair.segment)[i / 3].position[i % 3] : none;
        errors.push_back(pair.segment
                             ? std::array{(*pair.segment)[0].error, (*pair.segment)[1].error}
                             : std::array{none, none});
    }
    nb::dict found;
    found["vertices"] = rows_of<number>(std::move(vertices));
    found["relation"] = numbers_of<std::uint8_t>(std::move(relations));
    found["segment"] = rows_of<double>(std::move(segments));
    found["error"] = rows_of<double>(std::move(errors));
    return found;
}
/// Converts ccd::intersection or ccd::mpi::numbered_intersection.
template <class Intersection>
nb::dict intersections_of(const std::vector<Intersection>& all) {
    nb::dict found;
    const auto add = [&]<std::size_t Vertices>(ccd::intersection_kind kind) {
        found[std::string(name(kind)).c_str()] = intersections_of_kind<Vertices>(all, kind);
    };
    using enum ccd::intersection_kind;
    add.template operator()<6>(face_face);
    add.template operator()<5>(edge_face);
    add.template operator()<4>(vertex_face);
    add.template operator()<4>(edge_edge);
    add.template operator()<3>(vertex_edge);
    add.template operator()<2>(vertex_vertex);
    return found;
}

inline nb::object counts_of(std::optional<ccd::pair_counts>&& counts) {
    if (!counts) return nb::none();
    return of_each_kind(std::move(*counts), [](std::size_t count) { return nb::cast(count); });
}

}  // namespace errbound::python
