// Values kept in files, so that a stopped run continues.
#pragma once

#include <optional>
#include <string>

#include "ccd/lab/tables.hpp"

namespace ccd::lab {

/// JSON with the value, all that it depends on, and a checksum.
std::string kept_text(const row& depends_on, const row& value);

/// The value of such a text; nothing if the text is damaged or has other dependencies.
std::optional<row> kept_value(const std::string& text, const row& depends_on);

}  // namespace ccd::lab
