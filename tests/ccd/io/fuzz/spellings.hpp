// Small meshes and many legal spellings of OBJ and PLY for them, chosen by bytes.
#pragma once

#include <ccd/mesh.hpp>
#include <cstdint>
#include <span>
#include <string>

namespace ccd::fuzz {

struct spelling {
    mesh meant;
    std::string text;
};

enum class dialect {
    whole,   ///< everything that the format permits
    common,  ///< only spellings that other libraries read, too
};

/// A mesh and a spelling of it, both chosen by the bytes; any bytes will do.
spelling spelled_obj(std::span<const std::uint8_t> bytes, dialect = dialect::whole);
spelling spelled_ply(std::span<const std::uint8_t> bytes, dialect = dialect::whole);

}  // namespace ccd::fuzz
