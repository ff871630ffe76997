#include "ccd/mpi/decomposition.hpp"

#include <algorithm>
#include <numeric>

namespace ccd::mpi::detail {
namespace {

/// The number of samples of all ranks. Every rank holds all of them: at most 50 MB for up to 10,000
/// ranks.
std::size_t samples_wanted(std::size_t ranks) {
    const std::size_t most = std::max<std::size_t>(1 << 19, 64 * ranks);
    return std::max<std::size_t>(4096, std::min(256 * ranks, most));
}

constexpr std::size_t compared_samples = 4096;

/// The work of a candidate relative to that of an element.
constexpr double work_of_candidate = 0.1;

bool touch(const swept_box& a, const swept_box& b) {
    for (std::size_t k = 0; k < 3; ++k)
        if (a.low[k] > b.high[k] || b.low[k] > a.high[k]) return false;
    return true;
}

/// Returns a position so that samples before it have about this share of the work; 0 without
/// samples. Linear time.
template <class Sample, class Place>
double weighted_quantile(std::span<Sample> samples, const Place& place, double share) {
    if (samples.empty()) return 0;
    const auto sum = [](std::span<const Sample> some) {
        return std::transform_reduce(some.begin(), some.end(), 0.0, std::plus<>(),
                                     [](const Sample& s) { return s.work; });
    };
    double left = share * sum(samples);
    while (samples.size() > 1) {
        const std::size_t middle = samples.size() / 2;
        std::ranges::nth_element(samples, samples.begin() + static_cast<std::ptrdiff_t>(middle), {},
                                 place);
        const double half = sum(samples.first(middle));
        if (half >= left) {
            samples = samples.first(middle);
        } else {
            left -= half;
            samples = samples.subspan(middle);
        }
    }
    return place(samples.front());
}

double size(const swept_box& b) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += b.high[k] - b.low[k];
    return sum;
}

}  // namespace

decomposition::decomposition(exchanger& ranks, std::span<const swept_box> boxes)
    : parts_(ranks.size()) {
    std::vector<sample> samples = weighted_samples(ranks, boxes);
    cut(0, ranks.size(), samples, {});
}

/// A pair begins near the smaller of its boxes, so that box counts its work.
std::vector<decomposition::sample> decomposition::weighted_samples(
    exchanger& ranks, std::span<const swept_box> boxes) {
    std::size_t elements = 0;
    for (const std::size_t n : ranks.gather(std::vector{boxes.size()}).items) elements += n;
    const std::size_t wanted = samples_wanted(ranks.size());
    // Each rank's share of the samples equals its share of the elements.
    std::vector<sample> own(elements <= wanted ? boxes.size()
                                               : (boxes.size() * wanted + elements - 1) / elements);
    for (std::size_t i = 0; i < own.size(); ++i)
        own[i] = {boxes[i * boxes.size() / own.size()],
                  static_cast<double>(boxes.size()) / static_cast<double>(own.size())};
    received<sample> all = ranks.gather(own);
    const std::size_t step = std::max<std::size_t>(1, all.items.size() / compared_samples);
    std::vector<double> work;
    for (const sample& s : own) {
        double candidates = 0;
        for (std::size_t i = 0; i < all.items.size(); i += step) {
            const sample& other = all.items[i];
            if (size(s.box) <= size(other.box) && touch(s.box, other.box))
                candidates += static_cast<double>(step) * other.elements;
        }
        // `candidates` may include the sample itself.
        work.push_back(s.elements *
                       (1 + work_of_candidate * std::max(0.0, candidates - s.elements)));
    }
    const std::vector<double> of_all = ranks.gather(work).items;
    for (std::size_t i = 0; i < of_all.size(); ++i) all.items[i].work = of_all[i];
    return std::move(all.items);
}

std::size_t decomposition::cut(std::size_t first, std::size_t count, std::span<sample> samples,
                               const space_region& part) {
    const std::size_t i = nodes_.size();
    nodes_.push_back({first, count});
    if (count == 1) {
        parts_[first] = part;
        return i;
    }
    const auto spread = [&](std::size_t k) {
        if (samples.empty()) return 0.0;
        const auto [least, most] =
            std::ranges::minmax(samples, {}, [k](const sample& s) { return s.box.low[k]; });
        return most.box.low[k] - least.box.low[k];
    };
    const std::array spreads{spread(0), spread(1), spread(2)};
    const auto axis = static_cast<std::size_t>(std::ranges::max_element(spreads) - spreads.begin());
    const auto place = [axis](const sample& s) { return s.box.low[axis]; };
    const std::size_t below = count / 2;
    // Without samples the quantile is arbitrary. Clamp it, so that both halves stay in the part.
    const double at = std::clamp(
        weighted_quantile(samples, place, static_cast<double>(below) / static_cast<double>(count)),
        part.low[axis], part.high[axis]);
    // Samples at the cut are above it.
    const auto above = std::partition(samples.begin(), samples.end(),
                                      [&](const sample& s) { return place(s) < at; });
    const auto of_below = static_cast<std::size_t>(above - samples.begin());

    space_region low = part, high = part;
    low.high[axis] = high.low[axis] = at;
    const std::size_t a = cut(first, below, samples.first(of_below), low);
    const std::size_t b = cut(first + below, count - below, samples.subspan(of_below), high);
    nodes_[i] = {first, count, axis, at, a, b};
    return i;
}

}  // namespace ccd::mpi::detail
