// Distributions of log10 of a ratio, as counts.

#include <algorithm>
#include <cmath>
#include <errbound/validation/distribution.hpp>
#include <limits>

namespace errbound::validation {
namespace {

std::size_t bin_of(double log10_ratio) {
    const double inside = std::clamp(log10_ratio, distribution::least_log, distribution::max_log);
    return static_cast<std::size_t>(
        std::lround((inside - distribution::least_log) / distribution::resolution));
}

}  // namespace

void distribution::make_room(std::size_t first_bin, std::size_t bins) {
    auto& b = counts_.bins;
    if (b.empty()) counts_.first_bin = first_bin;
    const std::size_t first = std::min(first_bin, counts_.first_bin);
    const std::size_t end = std::max(first_bin + bins, counts_.first_bin + b.size());
    b.reserve(end - first);
    b.insert(b.begin(), counts_.first_bin - first, 0);
    counts_.first_bin = first;
    b.resize(end - first);
}

void distribution::widen(double least, double most) {
    counts_.least = ratios_ == 0 ? least : std::min(counts_.least, least);
    counts_.most = ratios_ == 0 ? most : std::max(counts_.most, most);
}

void distribution::add(double log10_ratio) {
    const std::size_t bin = bin_of(log10_ratio);
    make_room(bin, 1);
    ++counts_.bins[bin - counts_.first_bin];
    if (log10_ratio >= 0) ++counts_.covered;
    widen(log10_ratio, log10_ratio);
    ++ratios_;
}

void distribution::merge(const distribution& other) {
    const counts& from = other.counts_;
    if (other.ratios_ > 0) {
        make_room(from.first_bin, from.bins.size());
        for (std::size_t i = 0; i < from.bins.size(); ++i)
            counts_.bins[from.first_bin - counts_.first_bin + i] += from.bins[i];
        widen(from.least, from.most);
        ratios_ += other.ratios_;
    }
    counts_.exact += from.exact;
    counts_.unknown += from.unknown;
    counts_.covered += from.covered;
}

double distribution::quantile(double share) const {
    if (ratios_ == 0) return std::numeric_limits<double>::quiet_NaN();
    if (share <= 0) return counts_.least;
    if (share >= 1) return counts_.most;
    const double wanted = share * static_cast<double>(ratios_);
    std::uint64_t seen = 0;
    std::size_t i = 0;
    while (static_cast<double>(seen += counts_.bins[i]) < wanted) ++i;
    const auto bin = static_cast<double>(counts_.first_bin + i);
    return std::clamp(least_log + resolution * bin, counts_.least, counts_.most);
}

bool distribution::is_clamped(double share) const {
    if (ratios_ == 0) return false;
    const double value = quantile(share);
    if (share <= 0 || share >= 1) return value == least_log || value == max_log;
    return bin_of(value) == 0 || bin_of(value) == bin_of(max_log);
}

}  // namespace errbound::validation
