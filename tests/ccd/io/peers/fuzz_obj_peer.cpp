// Fuzzes the OBJ reader beside tinyobjloader's: the same mesh, or both refuse, or a listed
// difference says why.
#include <array>
#include <cstdlib>

#include "tests/ccd/io/peers/obj_peer.hpp"
#include "tests/ccd/io/peers/token_mutator.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace ccd::peers;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const std::string given = rewritten(obj_rewritings(), text);
    if (!is_explained(obj_differences(), compare_obj(text, given), text, given)) std::abort();
    return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
    constexpr std::array<std::string_view, 24> words{
        "v",   "f",        "l",    "p",     "vn",    "vt",       "g a",     "o b",
        "s 1", "usemtl m", "fo",   "V",     "curv",  "mtllib m", "vp",      "#",
        "# c", "1/1",      "2//2", "3/3/3", "-1/-1", "1/0",      "f 1 2 3", "l 1 2"};
    return ccd::peers::mutate_tokens(data, size, max_size, seed, words, ccd::fuzz::spelled_obj);
}
