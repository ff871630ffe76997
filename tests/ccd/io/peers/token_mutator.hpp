// Changes texts of meshes by lines and words.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <string_view>

#include "tests/ccd/io/fuzz/spellings.hpp"

namespace ccd::peers {

/// A fuzzer's custom mutator: a few lines, words or numbers of the text are exchanged, deleted,
/// doubled or spelled otherwise; now and then the text is another legal one, from `spelled`.
/// `words` are the format's. Returns the new size, at most `max_size`.
std::size_t mutate_tokens(std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed,
                          std::span<const std::string_view> words,
                          fuzz::spelling (*spelled)(std::span<const std::uint8_t>));

}  // namespace ccd::peers
