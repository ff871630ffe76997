// Comparison of queries bit for bit.
#pragma once

#include <ccd/io/query_file.hpp>
#include <cstdint>
#include <cstring>
#include <vector>

namespace test_queries {

/// The bits of queries, and their truth.
struct content {
    std::vector<std::uint64_t> bits;
    std::vector<bool> truth;

    content() = default;
    explicit content(const ccd::io::query_file& file) { add(file); }
    void add(const ccd::io::query_file& file) {
        std::visit(
            [this](const auto& all) {
                const std::size_t size = bits.size();
                bits.resize(size + 24 * all.size());
                if (!all.empty()) std::memcpy(bits.data() + size, all.data(), 24 * 8 * all.size());
            },
            file.queries);
        if (file.truth) truth.insert(truth.end(), file.truth->begin(), file.truth->end());
    }
    bool operator==(const content&) const = default;
};

}  // namespace test_queries
