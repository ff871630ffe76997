#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <ccd/io/step_view.hpp>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "ccd/io/view/view_files.hpp"
#include "errbound/support/output_file.hpp"

namespace errbound::python {
namespace {

using positions = input<double, -1, 3>;

/// Converts dictionaries by kind: arrays of vertices, and optional rows (low, high) of times.
struct listed_pairs {
    ccd::pair_lists pairs;
    ccd::time_lists times;

    listed_pairs(const nb::dict& vertices, const nb::dict& rows_of_times) {
        ccd::for_each_kind([&]<ccd::kind K>() {
            using pair = ccd::pair_of_kind<K>;
            const std::string name(ccd::name(K));
            constexpr auto columns = sizeof(pair) / sizeof(ccd::vertex_index);
            const auto rows = nb::cast<input<std::uint32_t, -1, columns>>(vertices[name.c_str()]);
            const auto found = items_of<pair>(rows);
            pairs.of<K>().assign(found.begin(), found.end());
            if (!rows_of_times.contains(name.c_str())) return;
            const auto known = nb::cast<input<double, -1, 2>>(rows_of_times[name.c_str()]);
            for (std::size_t i = 0; i < known.shape(0); ++i)
                times.of<K>().push_back({ccd::outcome::collides, known(i, 0), known(i, 1)});
        });
    }
};

/// Converts a dictionary by kind of tuples: vertices, relations, segments (NaN if unknown).
std::vector<ccd::intersection> intersections_of(const nb::dict& arrays) {
    std::vector<ccd::intersection> all;
    for (const ccd::intersection_kind kind : ccd::intersection_kinds) {
        const std::string key(name(kind));
        if (!arrays.contains(key.c_str())) continue;
        const nb::tuple of_kind = nb::cast<nb::tuple>(arrays[key.c_str()]);
        const auto vertices = nb::cast<input<std::uint32_t, -1, -1>>(of_kind[0]);
        const auto relations = nb::cast<input<std::uint8_t, -1>>(of_kind[1]);
        const auto segments = nb::cast<input<double, -1, 6>>(of_kind[2]);
        const std::size_t second = kind == ccd::intersection_kind::face_face ||
                                           kind == ccd::intersection_kind::edge_face ||
                                           kind == ccd::intersection_kind::vertex_face
                                       ? 3
                                   : kind == ccd::intersection_kind::vertex_vertex ? 1
                                                                                   : 2;
        const std::size_t first = vertices.shape(1) - second;
        for (std::size_t i = 0; i < vertices.shape(0); ++i) {
            ccd::intersection& pair = all.emplace_back();
            pair.a.size = static_cast<std::uint8_t>(first);
            pair.b.size = static_cast<std::uint8_t>(second);
            for (std::size_t k = 0; k < first; ++k) pair.a.indices[k] = vertices(i, k);
            for (std::size_t k = 0; k < second; ++k) pair.b.indices[k] = vertices(i, first + k);
            pair.relation = static_cast<relation>(relations(i));
            if (std::isnan(segments(i, 0))) continue;
            pair.segment.emplace();
            for (std::size_t k = 0; k < 6; ++k)
                (*pair.segment)[k / 3].position[k % 3] = segments(i, k);
        }
    }
    return all;
}

void write_view(const std::string& path, const positions& before, const positions& after,
                const input<std::uint32_t, -1, 3>& faces, const input<std::uint32_t, -1, 2>& edges,
                const nb::dict& pairs, const nb::dict& times, const nb::dict& intersections) {
    ccd::io::view_paths(path);  // throws before the pairs are converted
    const listed_pairs listed(pairs, times);
    const std::vector<ccd::intersection> at_start = intersections_of(intersections);
    const nb::gil_scoped_release released;
    support::write_whole(ccd::io::view_files(path, {{before.data(), after.data(), before.shape(0)},
                                                    items_of<ccd::face>(faces),
                                                    items_of<ccd::edge>(edges),
                                                    listed.pairs,
                                                    listed.times,
                                                    at_start}));
}

void write_pvd(const std::string& path, const std::vector<double>& times,
               const std::vector<std::string>& files) {
    std::vector<ccd::io::series_entry> series;
    for (std::size_t i = 0; i < times.size(); ++i) series.push_back({times[i], files.at(i)});
    support::write_whole(path, ccd::io::pvd_of(series));
}

}  // namespace

void bind_views(nb::module_& m) {
    m.def("write_view", write_view, nb::arg("path"), nb::arg("before"), nb::arg("after"),
          nb::arg("faces"), nb::arg("edges"), nb::arg("pairs"), nb::arg("times"),
          nb::arg("intersections"));
    m.def("write_pvd", write_pvd, nb::arg("path"), nb::arg("times"), nb::arg("files"));
}

}  // namespace errbound::python
