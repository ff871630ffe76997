// Fuzzes the reader of truth files: any bytes are booleans or a file_error, never a crash.
#include <ccd/io/query_file.hpp>
#include <cstdint>
#include <cstdlib>
#include <errbound/support/error.hpp>
#include <string>
#include <string_view>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::vector<bool> truth;
    try {
        truth = ccd::io::parse_truth({reinterpret_cast<const char*>(data), size}, "fuzz");
    } catch (const errbound::support::file_error&) {
        return 0;
    }
    std::string text = "[";
    for (std::size_t i = 0; i < truth.size(); ++i) {
        text += i > 0 ? "," : "";
        text += truth[i] ? "true" : "false";
    }
    if (ccd::io::parse_truth(text + "]", "again") != truth) std::abort();
    return 0;
}
