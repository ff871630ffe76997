#include "ccd/lab/kept.hpp"

namespace ccd::lab {
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

}  // namespace ccd::lab
