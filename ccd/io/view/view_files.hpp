// Views of a step as files, and what their writers share.
#pragma once

#include <ccd/io/step_view.hpp>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "errbound/support/output_file.hpp"

namespace ccd::io {

/// NAME.html or `-` is a page; NAME.vtp is the frame before; NAME.pvd is a series of NAME-0.vtp and
/// NAME-1.vtp, which precede it in the list. Throws std::invalid_argument for other names.
std::vector<std::filesystem::path> view_paths(const std::filesystem::path& path);

/// Throws as view_paths and page_of.
std::vector<errbound::support::output> view_files(const std::filesystem::path& path,
                                                  const step_view& step);

namespace detail {

/// Appends bytes in base64, padded.
void append_base64(std::string& text, std::string bytes);

/// Throws std::invalid_argument as page_of.
void require_view(const step_view& step);

/// Refuses control characters: XML cannot hold them, and readers replace line ends by blanks.
void require_xml_name(std::string_view name);

}  // namespace detail

}  // namespace ccd::io
