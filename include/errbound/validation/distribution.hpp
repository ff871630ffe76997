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
    // Beyond these ends, ratios share the outermost bins; the extremes are still kept exactly.
    static constexpr double least_log = -40, max_log = 100;

    /// A ratio by its log10, which is finite.
    void add(double log10_ratio);
    /// The true error is zero, or too small for the reference to tell.
    void add_exact() { ++counts_.exact; }
    /// The bound is infinite or NaN: nothing is claimed.
    void add_unknown() { ++counts_.unknown; }
    void merge(const distribution& other);

    std::uint64_t ratios() const { return ratios_; }
    /// Ratios that are at least 1.
    std::uint64_t covered() const { return counts_.covered; }
    std::uint64_t exact() const { return counts_.exact; }
    std::uint64_t unknown() const { return counts_.unknown; }
    std::uint64_t count() const { return ratios_ + exact() + unknown(); }
    /// Of the ratios: the least log10 that at least `share` of them do not exceed, 0 <= share <= 1;
    /// 0 and 1 are the extremes themselves. NaN without ratios.
    double quantile(double share) const;
    /// Whether that quantile is at an end or beyond, where ratios are not told apart: it is no more
    /// than least_log, or no less than max_log. An extreme is, where it stands for 0 or infinity.
    bool is_clamped(double share) const;

  private:
    void make_room(std::size_t first_bin, std::size_t bins);
    void widen(double least, double most);

    /// Bin i counts the ratios whose log10 is nearest to least_log + i · resolution. bins[0] is bin
    /// first_bin. The first and the last bin are not zero.
    struct counts {
        std::uint64_t exact = 0, unknown = 0, covered = 0;
        std::size_t first_bin = 0;
        std::vector<std::uint64_t> bins{};
        double least = 0, most = 0;  ///< log10 of the extremes; 0 without ratios
    };

    counts counts_;
    std::uint64_t ratios_ = 0;  // the sum of the bins
};

}  // namespace errbound::validation
