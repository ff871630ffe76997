// Distributions of log10 of a ratio, as counts: adding and merging in any order give the same.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace errbound::validation {

class distribution {
  public:
    /// Quantiles are known to within this.
    static constexpr double resolution = 0.02;

    /// A ratio by its log10.
    void add(double log10_ratio);
    /// The true error is zero, or too small for the reference to tell.
    void add_exact() { ++exact_; }
    /// The bound is infinite or NaN: nothing is claimed.
    void add_unknown() { ++unknown_; }
    void merge(const distribution& other);

    std::uint64_t ratios() const { return ratios_; }
    std::uint64_t exact() const { return exact_; }
    std::uint64_t unknown() const { return unknown_; }
    std::uint64_t count() const { return ratios_ + exact_ + unknown_; }
    /// Of the ratios: the least log10 that at least `share` of them do not exceed, 0 <= share <= 1;
    /// 0 and 1 are the extremes themselves. NaN without ratios.
    double quantile(double share) const;

  private:
    // Beyond these ends, ratios share the outermost bins; the extremes are still kept exactly.
    static constexpr double least_log = -40, max_log = 100;
    static std::size_t bin_of(double log10_ratio);

    std::vector<std::uint64_t> bins_;  // empty until there is a ratio
    std::uint64_t ratios_ = 0, exact_ = 0, unknown_ = 0;
    double least_ = 0, most_ = 0;
};

}  // namespace errbound::validation
