// Which elements of a file are a share of it.
#pragma once

#include <ccd/io/mesh_file.hpp>
#include <cstdint>
#include <string>
#include <string_view>

namespace ccd::io {

/// One of so many shares, as large as one another but for one element.
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

/// Reads a share of a PLY file. Elements of other shares are skipped, in ascii line by line, else
/// at once. Only a whole file can be triangulated.
mesh_share parse_share_ply(std::string_view text, const std::string& name, share_of_file share,
                           const mesh_options& options = {});

}  // namespace ccd::io
