// What a PLY file says that it holds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ccd::io::ply {

enum class scalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Whether all values are whole numbers.
bool is_integer(scalar type);
std::size_t bytes_of(scalar type);

struct property {
    std::string name;
    scalar type{};
    std::optional<scalar> count_type;  ///< of a list
};

struct element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<property> properties;
};

enum class encoding { ascii, little, big };

struct header {
    encoding format{};
    std::vector<element> elements;
    std::size_t lines = 0;
};

/// Takes the header, to the line after end_header, off the front of the text. Throws
/// errbound::support::file_error.
header parse_header(std::string_view& text, const std::string& name);

}  // namespace ccd::io::ply
