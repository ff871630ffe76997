// A view of a step as files, whose format is that of the name.
#pragma once

#include <ccd/io/step_view.hpp>
#include <filesystem>
#include <vector>

#include "errbound/support/output_file.hpp"

namespace ccd::io {

/// The files that a view of that name is of: NAME.html and `-` a page; NAME.vtp the frame before;
/// NAME.pvd a series of NAME-0.vtp and NAME-1.vtp, which are those before it. Throws
/// std::invalid_argument where the name ends otherwise.
std::vector<std::filesystem::path> view_paths(const std::filesystem::path& path);

/// The same, with what goes into each. Throws as page_of does, too.
std::vector<errbound::support::output> view_files(const std::filesystem::path& path,
                                                  const step_view& step);

}  // namespace ccd::io
