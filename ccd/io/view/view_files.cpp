#include "ccd/io/view/view_files.hpp"

#include <algorithm>
#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <stdexcept>

namespace ccd::io {

using errbound::support::output;
namespace fs = std::filesystem;

std::vector<fs::path> view_paths(const fs::path& path) {
    const std::string name = path.string(), extension = path.extension().string();
    if (name == "-" || extension == ".html" || extension == ".vtp") return {path};
    if (extension == ".pvd") {
        detail::require_xml_name(name);
        const std::string stem = name.substr(0, name.size() - extension.size());
        return {stem + "-0.vtp", stem + "-1.vtp", path};
    }
    throw std::invalid_argument("path is '" + name +
                                "'; expected a name that ends in .html, .vtp or .pvd");
}

std::vector<output> view_files(const fs::path& path, const step_view& step) {
    const std::vector<fs::path> paths = view_paths(path);
    if (paths.size() == 1)
        return {{path, path.extension() == ".vtp" ? vtp_of(step, frame::before) : page_of(step)}};
    const std::vector<series_entry> series = {{0, paths[0].filename().string()},
                                              {1, paths[1].filename().string()}};
    return {{paths[0], vtp_of(step, frame::before)},
            {paths[1], vtp_of(step, frame::after)},
            {paths[2], pvd_of(series)}};
}

namespace detail {

void append_base64(std::string& text, std::string bytes) {
    using namespace boost::archive::iterators;
    using digits = base64_from_binary<transform_width<std::string::const_iterator, 6, 8>>;
    const std::size_t padding = (3 - bytes.size() % 3) % 3;
    bytes.append(padding, '\0');
    text.reserve(text.size() + bytes.size() / 3 * 4);
    text.append(digits(bytes.cbegin()), digits(bytes.cend()));
    text.replace(text.size() - padding, padding, padding, '=');
}

void require_view(const step_view& step) {
    const auto require = [&step](std::string_view list, std::size_t row, const auto& element) {
        for (const vertex_index v : element)
            if (v >= step.positions.vertices)
                throw std::invalid_argument("vertex index in row " + std::to_string(row) + " of " +
                                            std::string(list) + " is " + std::to_string(v) +
                                            "; expected less than " +
                                            std::to_string(step.positions.vertices));
    };
    for (std::size_t i = 0; i < step.faces.size(); ++i) require("faces", i, step.faces[i]);
    for (std::size_t i = 0; i < step.edges.size(); ++i) require("edges", i, step.edges[i]);
    for (std::size_t i = 0; i < step.intersections.size(); ++i) {
        require("intersections", i, step.intersections[i].a.vertices());
        require("intersections", i, step.intersections[i].b.vertices());
    }
    const bool timed = step.times != time_lists{};
    for_each_kind([&]<kind K>() {
        const auto& pairs = step.pairs.of<K>();
        const std::size_t times = step.times.of<K>().size();
        for (std::size_t i = 0; i < pairs.size(); ++i) require(name(K), i, vertices_of(pairs[i]));
        if (timed && times != pairs.size())
            throw std::invalid_argument("number of times of " + std::string(name(K)) + " is " +
                                        std::to_string(times) + "; expected " +
                                        std::to_string(pairs.size()) + ", one for each pair");
    });
}

void require_xml_name(std::string_view name) {
    if (std::ranges::any_of(name, [](char c) { return static_cast<unsigned char>(c) < 0x20; }))
        throw std::invalid_argument("name is '" + std::string(name) +
                                    "'; expected a name without control characters");
}

}  // namespace detail

}  // namespace ccd::io
