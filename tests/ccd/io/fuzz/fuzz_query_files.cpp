// Fuzzes the readers of stored queries and of truth: any bytes are queries or a file_error, never a
// crash; queries survive being written as hexadecimal floats, truth as JSON.
#include <bit>
#include <ccd/io/query_file.hpp>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <errbound/support/error.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "tests/ccd/io/content.hpp"

namespace {

using ccd::io::query_file;

/// Returns the result of `parse`, or nothing for a file_error.
template <class Parse>
auto read_by(const Parse& parse) -> std::optional<decltype(parse())> {
    try {
        return parse();
    } catch (const errbound::support::file_error&) {
        return std::nullopt;
    }
}

void require(bool holds) {
    if (!holds) std::abort();
}

std::string hexadecimal_rows(const query_file& file) {
    std::string text;
    const test_queries::content content(file);
    for (std::size_t row = 0; row < 8 * file.size(); ++row) {
        const std::size_t query = row / 8, time = row / 4 % 2, point = row % 4;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::uint64_t bits = content.bits[24 * query + 6 * point + 3 * time + axis];
            char number[40];
            std::snprintf(number, sizeof number, ",%a", std::bit_cast<double>(bits));
            text += number + (axis == 0);
        }
        if (file.truth) text += (*file.truth)[query] ? ",1" : ",0";
        text += '\n';
    }
    return text;
}

void require_same(const query_file& a, const query_file& b) {
    require(a.truth == b.truth && test_queries::content(a) == test_queries::content(b));
}

void fuzz_queries(std::string_view text) {
    const ccd::kind kind = text.size() % 2 == 0 ? ccd::kind::vertex_face : ccd::kind::edge_edge;
    const auto rounded = read_by([&] { return ccd::io::parse_queries(text, "fuzz", kind, true); });
    const auto exact = read_by([&] { return ccd::io::parse_queries(text, "fuzz", kind, false); });
    require(rounded || !exact);
    if (exact) require_same(*exact, *rounded);
    // Rounded numbers are exact in hexadecimal.
    if (rounded)
        require_same(*rounded,
                     ccd::io::parse_queries(hexadecimal_rows(*rounded), "again", kind, false));
}

void fuzz_truth(std::string_view text) {
    const auto truth = read_by([&] { return ccd::io::parse_truth(text, "fuzz"); });
    if (!truth) return;
    std::string again = "[";
    for (const bool value : *truth)
        again += std::string(again.size() > 1 ? "," : "") + (value ? "true" : "false");
    require(ccd::io::parse_truth(again + "]", "again") == *truth);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    fuzz_queries(text);
    fuzz_truth(text);
    return 0;
}
