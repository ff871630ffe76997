// Distributions of log10 of a ratio, as counts.

#include <algorithm>
#include <cmath>
#include <errbound/validation/distribution.hpp>
#include <limits>

namespace errbound::validation {

std::size_t distribution::bin_of(double log10_ratio) {
    const double inside = std::clamp(log10_ratio, least_log, max_log);
    return static_cast<std::size_t>(std::lround((inside - least_log) / resolution));
}

void distribution::add(double log10_ratio) {
    if (bins_.empty()) bins_.resize(bin_of(max_log) + 1);
    ++bins_[bin_of(log10_ratio)];
    least_ = ratios_ == 0 ? log10_ratio : std::min(least_, log10_ratio);
    most_ = ratios_ == 0 ? log10_ratio : std::max(most_, log10_ratio);
    ++ratios_;
}

void distribution::merge(const distribution& other) {
    exact_ += other.exact_;
    unknown_ += other.unknown_;
    if (other.ratios_ == 0) return;
    if (bins_.empty()) bins_.resize(other.bins_.size());
    for (std::size_t i = 0; i < bins_.size(); ++i) bins_[i] += other.bins_[i];
    least_ = ratios_ == 0 ? other.least_ : std::min(least_, other.least_);
    most_ = ratios_ == 0 ? other.most_ : std::max(most_, other.most_);
    ratios_ += other.ratios_;
}

double distribution::quantile(double share) const {
    if (ratios_ == 0) return std::numeric_limits<double>::quiet_NaN();
    if (share <= 0) return least_;
    if (share >= 1) return most_;
    const double wanted = share * static_cast<double>(ratios_);
    std::uint64_t seen = 0;
    std::size_t bin = 0;
    while (static_cast<double>(seen += bins_[bin]) < wanted) ++bin;
    return std::clamp(least_log + resolution * static_cast<double>(bin), least_, most_);
}

}  // namespace errbound::validation
