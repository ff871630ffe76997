// Fuzzes the reader of explanations: any bytes are results or a file_error, never a crash; what is
// read is written as what reads the same, and its tables and pictures have no control characters.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <errbound/support/error.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "errbound/program/explanation_file.hpp"
#include "errbound/program/flame_graph.hpp"

namespace {

bool is_plain(std::string_view text) {
    return std::none_of(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) < 0x20 && c != '\n') || c == 0x7f;
    });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using errbound::explaining::parse_explanations;
    std::vector<errbound::explanation> results;
    try {
        results = parse_explanations({reinterpret_cast<const char*>(data), size}, "fuzz");
    } catch (const errbound::support::file_error& error) {
        if (!std::string_view(error.what()).starts_with("fuzz: ")) std::abort();
        return 0;
    }
    const std::string text = json_of(results);
    if (json_of(parse_explanations(text, "again")) != text) std::abort();
    for (const errbound::explanation& e : results)
        if (!is_plain(text_of(e))) std::abort();
    const std::string picture = errbound::explaining::flame_graphs(results);
    if (!is_plain(picture)) std::abort();
    if (std::count(picture.begin(), picture.end(), '<') !=
        std::count(picture.begin(), picture.end(), '>'))
        std::abort();
    return 0;
}
