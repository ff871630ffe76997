// Timing of contestants alternately, so that a disturbance of the machine hits all alike.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

namespace ccd::lab {

using clock = std::chrono::steady_clock;

inline double seconds_since(clock::time_point start) {
    return std::chrono::duration<double>(clock::now() - start).count();
}

template <class T>
void keep(const T& value) {
    asm volatile("" : : "g"(&value) : "memory");
}

/// Seconds of one pass.
struct timing {
    double minimum = 0;
    double median = 0;

    double ms() const { return 1e3 * minimum; }
    /// Nanoseconds of each of `count` items of the pass.
    double ns(std::size_t count) const { return 1e9 * minimum / static_cast<double>(count); }
    double median_ns(std::size_t count) const { return 1e9 * median / static_cast<double>(count); }
};

/// Times `passes` alternately: a warm-up, then `repeats` rounds, back and forth. A pass shorter
/// than 2 ms is repeated until it takes 2 ms. Between timings, `show` gets the finished share.
std::vector<timing> race(
    const std::vector<std::function<void()>>& passes, int repeats,
    const std::function<void(double)>& show = [](double) {});

/// The seconds of the fastest pass. Passes take at least `least_total` in total, and there are at
/// least three, unless three take ten times as long.
template <class Pass>
double fastest_of(const Pass& pass, double least_total) {
    double fastest = std::numeric_limits<double>::infinity(), elapsed = 0;
    const clock::time_point start = clock::now();
    for (int passes = 0;
         passes == 0 || elapsed < least_total || (passes < 3 && elapsed < 10 * least_total);
         ++passes) {
        const clock::time_point begin = clock::now();
        pass();
        fastest = std::min(fastest, seconds_since(begin));
        elapsed = seconds_since(start);
    }
    return fastest;
}

/// The least difference of two successive readings of the clock, in seconds.
double clock_overhead();

}  // namespace ccd::lab
