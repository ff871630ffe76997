// What a store of queries has in it, as it is written.
#pragma once

#include <ccd/io/query_store.hpp>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace ccd::io {

struct store_parts {
    std::string_view kind;
    const std::uint64_t* points;  ///< point_count rows of 6 doubles' bits
    std::size_t point_count;
    const std::uint32_t* queries;  ///< query_count rows of 4
    std::size_t query_count;
    std::span<const std::uint64_t> first_point;  ///< of each chunk, and their number
    std::span<const std::uint8_t> truth;         ///< empty: none
};

/// The file's bytes. Throws std::runtime_error.
std::string store_of(const store_parts& parts);

}  // namespace ccd::io
