// Counts of log10 of a ratio, independent of the order of adding and merging.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace errbound::validation {

class distribution {
  public:
    /// Quantiles are within this distance of the exact ones.
    static constexpr double resolution = 0.02;
    // Larger ratios share the outermost bins; extremes are kept exactly.
    static constexpr double least_log = -40, max_log = 100;

    /// Precondition: log10_ratio is finite.
    void add(double log10_ratio);
    /// Counts a result whose true error is zero, or too small for the reference.
    void add_exact() { ++counts_.exact; }
    /// Counts a result whose bound is infinite or NaN.
    void add_unknown() { ++counts_.unknown; }
    void merge(const distribution& other);

    std::uint64_t ratios() const { return ratios_; }
    std::uint64_t covered() const { return counts_.covered; }
    std::uint64_t exact() const { return counts_.exact; }
    std::uint64_t unknown() const { return counts_.unknown; }
    std::uint64_t count() const { return ratios_ + exact() + unknown(); }
    /// The least log10 that at least `share` of the ratios do not exceed, 0 <= share <= 1; 0 and 1
    /// give the extremes. NaN without ratios.
    double quantile(double share) const;
    /// True if that quantile is in an outermost bin, where ratios are not distinguished, or an
    /// extreme that stands for 0 or infinity.
    bool is_clamped(double share) const;

  private:
    void make_room(std::size_t first_bin, std::size_t bins);
    void widen(double least, double most);

    /// Bin i counts ratios with log10 nearest to least_log + i · resolution. bins[0] is bin
    /// first_bin.
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
