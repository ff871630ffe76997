// Fuzzes the PLY reader beside CGAL's: the same mesh, or both refuse, or a listed
// difference says why.
#include <array>
#include <cstdlib>

#include "tests/ccd/io/peers/ply_peer.hpp"
#include "tests/ccd/io/peers/token_mutator.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace ccd::peers;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const std::string given = rewritten(ply_rewritings(), text);
    if (!is_explained(ply_differences(), compare_ply(text, given), text, given)) std::abort();
    return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
    constexpr std::array<std::string_view, 24> words{"ply",
                                                     "format",
                                                     "ascii",
                                                     "binary_little_endian",
                                                     "binary_big_endian",
                                                     "1.0",
                                                     "element",
                                                     "vertex",
                                                     "face",
                                                     "edge",
                                                     "property",
                                                     "list",
                                                     "char",
                                                     "uint8",
                                                     "short",
                                                     "ushort",
                                                     "int32",
                                                     "uint",
                                                     "float",
                                                     "double",
                                                     "x",
                                                     "vertex_index",
                                                     "property uchar red",
                                                     "end_header"};
    return ccd::peers::mutate_tokens(data, size, max_size, seed, words, ccd::fuzz::spelled_ply);
}
