// The checksum of a chunk of queries.
//
// HDF5's own, Fletcher32, adds words of 16 bits modulo 65535, and so takes 0x0000 for 0xffff: two
// zero bytes of a coordinate that become ones would not be seen.
#pragma once

#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace ccd::io {

/// CRC-32, as zlib's and PNG's, of the bytes of points, queries and truth one after the other, as
/// they are stored. (Stores are built where numbers have their least significant byte first.)
inline std::uint32_t checksum(std::span<const std::byte> points, std::span<const std::byte> queries,
                              std::span<const std::byte> truth) {
    uLong sum = crc32_z(0, nullptr, 0);
    for (const std::span<const std::byte> part : {points, queries, truth})
        if (!part.empty())  // of a null pointer crc32_z makes the sum of nothing at all
            sum = crc32_z(sum, reinterpret_cast<const Bytef*>(part.data()), part.size());
    return static_cast<std::uint32_t>(sum);
}

}  // namespace ccd::io
