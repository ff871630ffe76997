// Fuzzes the reader of stored queries: any bytes are queries or a file_error, never a crash; what
// is read survives being written as hexadecimal floats.
#include <array>
#include <bit>
#include <ccd/io/query_file.hpp>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <errbound/support/error.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace {

using ccd::kind;
using ccd::io::query_file;

using row = std::array<double, 3>;

std::vector<row> rows_of(const query_file& file) {
    std::vector<row> rows;
    const auto add = [&rows](const auto& a, const auto& b, const auto& c, const auto& d) {
        for (const auto* p : {&a, &b, &c, &d}) rows.push_back({p->t0.x, p->t0.y, p->t0.z});
        for (const auto* p : {&a, &b, &c, &d}) rows.push_back({p->t1.x, p->t1.y, p->t1.z});
    };
    std::visit(
        [&add](const auto& queries) {
            for (const auto& [a, b, c, d] : queries) add(a, b, c, d);
        },
        file.queries);
    return rows;
}

std::string hexadecimal_rows(const query_file& file) {
    std::string text;
    const std::vector<row> rows = rows_of(file);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        char line[128];
        std::snprintf(line, sizeof line, "%a,%a,%a", rows[i][0], rows[i][1], rows[i][2]);
        text += line;
        if (file.truth) text += (*file.truth)[i / 8] ? ",1" : ",0";
        text += '\n';
    }
    return text;
}

void require_same(const query_file& a, const query_file& b) {
    const std::vector<row> rows_a = rows_of(a), rows_b = rows_of(b);
    if (rows_a.size() != rows_b.size() || a.truth != b.truth) std::abort();
    for (std::size_t i = 0; i < rows_a.size(); ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            if (std::bit_cast<std::uint64_t>(rows_a[i][j]) !=
                std::bit_cast<std::uint64_t>(rows_b[i][j])) {
                std::abort();
            }
        }
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const ccd::kind kind = size % 2 == 0 ? ccd::kind::vertex_face : ccd::kind::edge_edge;
    query_file rounded;
    try {
        rounded = ccd::io::parse_queries(text, "fuzz", kind, true);
    } catch (const errbound::support::file_error&) {
    }
    try {
        const query_file exact = ccd::io::parse_queries(text, "fuzz", kind, false);
        require_same(exact, rounded);
        require_same(exact, ccd::io::parse_queries(hexadecimal_rows(exact), "again", kind, false));
    } catch (const errbound::support::file_error&) {
        if (rounded.size() == 0) return 0;
        // Refused only for not being exact; then what was rounded to is exact, and must be read.
        require_same(rounded,
                     ccd::io::parse_queries(hexadecimal_rows(rounded), "again", kind, false));
    }
    return 0;
}
