#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <ccd/io/mesh_file.hpp>
#include <ccd/io/query_file.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "errbound/support/output_file.hpp"

namespace errbound::python {
namespace {

nb::tuple read_mesh(const std::string& path, bool triangulate) {
    ccd::mesh mesh = ccd::io::read_mesh(path, {.triangulate = triangulate});
    return nb::make_tuple(rows_of<double>(std::move(mesh.vertices)),
                          rows_of<std::uint32_t>(std::move(mesh.faces)),
                          rows_of<std::uint32_t>(std::move(mesh.edges)));
}

void write_mesh(const std::string& path, const input<double, -1, 3>& vertices,
                const input<std::uint32_t, -1, 3>& faces,
                const input<std::uint32_t, -1, 2>& edges) {
    const auto copy = []<class Item>(std::span<const Item> items) {
        return std::vector<Item>(items.begin(), items.end());
    };
    support::write_whole(path, ccd::io::ply_of({copy(items_of<ccd::point<double>>(vertices)),
                                                copy(items_of<ccd::face>(faces)),
                                                copy(items_of<ccd::edge>(edges))}));
}

void write_text(const std::string& path, const std::string& text) {
    support::write_whole(path, text);
}

nb::tuple read_queries(const std::string& path, const std::optional<std::string>& kind,
                       bool round) {
    std::optional<ccd::kind> wanted;
    if (kind) wanted = ccd::find_kind(*kind);
    ccd::io::query_file file = ccd::io::read_queries(path, wanted, round);
    nb::object truth = nb::none();
    if (file.truth)
        truth = numbers_of<std::uint8_t>(
            std::vector<std::uint8_t>(file.truth->begin(), file.truth->end()));
    const std::string name(ccd::name(file.kind()));
    nb::object queries =
        std::visit([](auto& all) { return rows_of<double>(std::move(all)); }, file.queries);
    return nb::make_tuple(name, queries, truth);
}

}  // namespace

void bind_files(nb::module_& m) {
    m.def("read_mesh", read_mesh, nb::arg("path"), nb::arg("triangulate"));
    m.def("write_mesh", write_mesh, nb::arg("path"), nb::arg("vertices"), nb::arg("faces"),
          nb::arg("edges"));
    m.def("write_text", write_text, nb::arg("path"), nb::arg("text"));
    m.def("read_queries", read_queries, nb::arg("path"), nb::arg("kind").none(), nb::arg("round"));
}

}  // namespace errbound::python
