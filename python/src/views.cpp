#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <ccd/io/step_view.hpp>
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

void write_view(const std::string& path, const positions& before, const positions& after,
                const input<std::uint32_t, -1, 3>& faces, const input<std::uint32_t, -1, 2>& edges,
                const nb::dict& pairs, const nb::dict& times) {
    ccd::io::view_paths(path);  // throws before the pairs are converted
    const listed_pairs listed(pairs, times);
    const nb::gil_scoped_release released;
    support::write_whole(ccd::io::view_files(path, {{before.data(), after.data(), before.shape(0)},
                                                    items_of<ccd::face>(faces),
                                                    items_of<ccd::edge>(edges),
                                                    listed.pairs,
                                                    listed.times}));
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
          nb::arg("faces"), nb::arg("edges"), nb::arg("pairs"), nb::arg("times"));
    m.def("write_pvd", write_pvd, nb::arg("path"), nb::arg("times"), nb::arg("files"));
}

}  // namespace errbound::python
