#include "ccd/report/parts.hpp"

#include <cctype>
#include <cstdio>
#include <errbound/support/error.hpp>
#include <system_error>
#include <utility>

#include "ccd/report/measuring/machine.hpp"
#include "errbound/support/output_file.hpp"

namespace ccd::report {
namespace {

using errbound::support::file_error;
using errbound::support::read_whole;
using errbound::support::write_whole;

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr auto replace = ordered_json::error_handler_t::replace;  // a path need not be UTF-8

std::string dumped(const ordered_json& value) {
    return value.dump(-1, ' ', false, replace);
}

}  // namespace

part_store::part_store(fs::path folder) : folder_(std::move(folder)) {
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error || !fs::is_directory(folder_))
        throw file_error(folder_.string() + ": cannot be made a folder" +
                         (error ? " (" + error.message() + ")" : std::string()));
}

fs::path part_store::path_of(const part_key& key) const {
    // Legible, and yet different for names that differ in other characters alone.
    std::string name = key.name;
    for (char& c : name) {
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '.') c = '_';
    }
    return folder_ / (name.substr(0, 100) + "-" + fingerprint_of(key.name).substr(0, 8) + ".json");
}

bool part_store::find(const part_key& key, rows& into) const {
    const fs::path path = path_of(key);
    std::error_code error;
    if (!fs::is_regular_file(path, error)) return false;
    const ordered_json document = ordered_json::parse(read_whole(path), nullptr, false);
    if (!document.is_object() || !document.contains("rows") || !document["rows"].is_array() ||
        document.value("depends_on", ordered_json()) != key.depends_on ||
        document.value("check", ordered_json()) != fingerprint_of(dumped(document["rows"])))
        return false;
    into = document["rows"].get<rows>();
    return true;
}

void part_store::keep(const part_key& key, const rows& of_part) const {
    const ordered_json values = of_part;
    const ordered_json document = {{"part", key.name},
                                   {"depends_on", key.depends_on},
                                   {"check", fingerprint_of(dumped(values))},
                                   {"rows", values}};
    write_whole(path_of(key), document.dump(1, ' ', false, replace) + '\n');
}

}  // namespace ccd::report
