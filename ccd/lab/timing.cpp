#include "ccd/lab/timing.hpp"

#include <algorithm>
#include <limits>

namespace ccd::lab {

std::vector<timing> race(const std::vector<std::function<void()>>& passes, int repeats,
                         const std::function<void(double)>& show) {
    constexpr double least_seconds = 2e-3;
    std::vector<int> runs;  // repetitions of each pass per measurement
    for (const auto& pass : passes) {
        const auto seconds_of_one = [&pass] {
            const clock::time_point start = clock::now();
            pass();
            return seconds_since(start);
        };
        // The first pass meets cold caches and new pages. It counts only if it is so long that
        // these are negligible.
        double one = seconds_of_one();
        if (one < 10 * least_seconds) one = seconds_of_one();
        runs.push_back(1 + static_cast<int>(least_seconds / std::max(one, 1e-7)));
    }
    std::vector<std::vector<double>> seconds(passes.size());
    for (int repeat = 0; repeat < repeats; ++repeat) {
        for (std::size_t i = 0; i < passes.size(); ++i) {
            const std::size_t which = repeat % 2 == 0 ? i : passes.size() - 1 - i;
            const clock::time_point start = clock::now();
            for (int run = 0; run < runs[which]; ++run) passes[which]();
            seconds[which].push_back(seconds_since(start) / runs[which]);
            show((repeat + static_cast<double>(i) / static_cast<double>(passes.size())) / repeats);
        }
    }
    std::vector<timing> timings;
    for (auto& s : seconds) {
        std::ranges::sort(s);
        timings.push_back({s.front(), s[s.size() / 2]});
    }
    return timings;
}

double clock_overhead() {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 10'000; ++i) {
        const clock::time_point start = clock::now();
        least = std::min(least, seconds_since(start));
    }
    return least;
}

}  // namespace ccd::lab
