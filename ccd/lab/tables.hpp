// The sinks of experiments: tallies of answers, quantiles, kept values, folders.
#pragma once

#include <ccd/verdict.hpp>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "errbound/support/rows.hpp"

namespace ccd::lab {

using errbound::support::row, errbound::support::rows;

/// Compares answers with the truth. Uncertain counts as a collision.
struct tally {
    std::size_t queries = 0, colliding = 0;  ///< by the truth
    std::size_t collisions = 0, uncertain = 0, false_positives = 0, false_negatives = 0;

    void add(outcome answer, bool collides);
    tally& operator+=(const tally& more);
};

/// The nearest-rank quantile; NaN if there are no numbers.
double quantile(std::span<const double> sorted, double p);

/// 64-bit FNV-1a, as 16 hexadecimal digits: it detects accidental changes, not malicious ones.
std::string fingerprint_of(std::string_view bytes);

/// JSON with the value, all that it depends on, and a checksum.
std::string kept_text(const row& depends_on, const row& value);

/// The value of such a text; nothing if the text is damaged or has other dependencies.
std::optional<row> kept_value(const std::string& text, const row& depends_on);

/// Throws errbound::support::file_error if it cannot be written to.
void make_folder(const std::filesystem::path& folder);

}  // namespace ccd::lab
