// For the readers of OBJ and PLY: checks of elements, and shares of a file.
#pragma once

#include <ccd/io/mesh_file.hpp>
#include <ccd/mesh.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace ccd::io {

std::string text_of(std::span<const vertex_index> element);

/// The end of a message if an index is not below `vertices`, or a face has too few or many corners.
std::optional<std::string> fault_of(std::span<const vertex_index> element, std::size_t vertices);

std::optional<std::string> fault_of_corners(std::uint64_t corners, const mesh_options& options);

/// The sizes of two shares differ by at most one element.
struct share_of_file {
    std::uint64_t share = 0, shares = 1;

    std::uint64_t first_of(std::uint64_t count) const { return start(count, share); }
    std::uint64_t last_of(std::uint64_t count) const { return start(count, share + 1); }

  private:
    /// count * i / shares, without overflow.
    std::uint64_t start(std::uint64_t count, std::uint64_t i) const {
        return count / shares * i + count % shares * i / shares;
    }
};

/// Skips other shares: in ascii line by line, else at once. Only a whole file can be triangulated.
mesh_share parse_share_ply(std::string_view text, const std::string& name, share_of_file share,
                           const mesh_options& options = {});

}  // namespace ccd::io
