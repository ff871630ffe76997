// Runs parallel work on a given number of threads. Internal.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace ccd::detail {

/// Returns the number of threads: one per core if `threads` is 0 or exceeds the cores. Throws
/// std::invalid_argument if it is negative.
inline int threads_of(int threads) {
    if (threads < 0)
        throw std::invalid_argument("ccd: number of threads is " + std::to_string(threads) +
                                    "; expected 0 (one per core) or more");
    const int cores = tbb::info::default_concurrency();
    return threads > 0 ? std::min(threads, cores) : cores;
}

/// On MinGW-w64, keeps oneTBB's threads until the program ends, since ending them earlier can
/// deadlock. A std::thread holds a lock of MinGW's while destructors of its thread_local objects
/// take the loader's lock; a native thread that ends takes these locks in the other order.
inline void keep_workers() {
#ifdef __MINGW32__
    static const tbb::task_scheduler_handle kept{tbb::attach{}};
#endif
}

template <class Work>
int on_threads(int threads, const Work& work) {
    keep_workers();
    tbb::task_arena arena(threads_of(threads));
    arena.execute(work);
    return arena.max_concurrency();
}

/// Calls visit(begin, end) for intervals that partition [0, count), on at most `threads` threads.
template <class Visit>
void for_each_part(std::size_t count, int threads, const Visit& visit) {
    constexpr std::size_t few = 64;
    if (threads_of(threads) == 1 || count <= few) return visit(std::size_t{0}, count);
    on_threads(threads, [&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, few),
                          [&](const auto& range) { visit(range.begin(), range.end()); });
    });
}
template <class Visit>
void for_each_index(std::size_t count, int threads, const Visit& visit) {
    for_each_part(count, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) visit(i);
    });
}

}  // namespace ccd::detail
