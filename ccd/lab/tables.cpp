#include "ccd/lab/tables.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <errbound/support/error.hpp>
#include <limits>
#include <system_error>

#include "errbound/support/system/system.hpp"

namespace ccd::lab {

using errbound::support::file_error;

void tally::add(outcome answer, bool collides) {
    const bool reported = answer != outcome::separate;
    ++queries;
    colliding += collides;
    collisions += reported;
    uncertain += answer == outcome::uncertain;
    false_positives += reported && !collides;
    false_negatives += !reported && collides;
}

tally& tally::operator+=(const tally& more) {
    queries += more.queries;
    colliding += more.colliding;
    collisions += more.collisions;
    uncertain += more.uncertain;
    false_positives += more.false_positives;
    false_negatives += more.false_negatives;
    return *this;
}

double quantile(std::span<const double> sorted, double p) {
    if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
    const auto last = static_cast<double>(sorted.size());
    return sorted[static_cast<std::size_t>(std::clamp(std::ceil(p * last), 1.0, last)) - 1];
}

std::string fingerprint_of(std::string_view bytes) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}

namespace {

std::string checksum_of(const row& value) {
    return fingerprint_of(errbound::support::json_of(value, -1));
}

}  // namespace

std::string kept_text(const row& depends_on, const row& value) {
    const row document = {
        {"depends_on", depends_on}, {"check", checksum_of(value)}, {"value", value}};
    return errbound::support::json_of(document, 1) + '\n';
}

std::optional<row> kept_value(const std::string& text, const row& depends_on) {
    const row document = row::parse(text, nullptr, false);
    if (!document.is_object() || !document.contains("value") ||
        document.value("depends_on", row()) != depends_on ||
        document.value("check", row()) != checksum_of(document["value"]))
        return std::nullopt;
    return document["value"];
}

void make_folder(const std::filesystem::path& folder) {
    namespace system = errbound::support::system;
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error || !std::filesystem::is_directory(folder))
        throw file_error(folder.string() + ": cannot be made a folder" +
                         (error ? " (" + error.message() + ")" : std::string()));
    if (!system::may_write_in(system::native_name(folder)))
        throw file_error(folder.string() + ": cannot be written to");
}

}  // namespace ccd::lab
