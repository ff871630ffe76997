// Which files a view is of.
#include "ccd/io/view/view_files.hpp"

#include <stdexcept>
#include <string>

#include "ccd/io/view/checks.hpp"

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
    throw std::invalid_argument("found '" + name +
                                "', expected a name that ends in .html, .vtp or .pvd");
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

}  // namespace ccd::io
