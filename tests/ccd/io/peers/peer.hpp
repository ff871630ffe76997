// Comparison of a reader of meshes with that of another library, on random legal texts. Texts that
// are refused: tests/ccd/io/spellings_test.cpp.
#pragma once

#include <gtest/gtest.h>

#include <ccd/io/mesh_file.hpp>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "tests/ccd/io/fuzz/spellings.hpp"

namespace peers {

/// Expects that same(our mesh, the peer's mesh) is true for each text.
template <class Spelled, class Ours, class Theirs, class Same>
void expect_same(const Spelled& spelled, const Ours& ours, const Theirs& theirs, const Same& same) {
    std::minstd_rand random(1);
    for (int i = 0; i < 20000; ++i) {
        std::vector<std::uint8_t> bytes(400);
        for (std::uint8_t& b : bytes) b = static_cast<std::uint8_t>(random() >> 8);
        const std::string text = spelled(bytes, ccd::fuzz::dialect::common).text;
        const std::optional<ccd::mesh> peers_mesh = theirs(text);
        ASSERT_TRUE(peers_mesh.has_value()) << text;
        ASSERT_TRUE(same(ours(text, "peers", {}), *peers_mesh)) << text;
    }
}

}  // namespace peers
