// Runs parallel work on a wanted number of threads. Internal.
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

/// How many are meant by `threads`: 0, or more than the machine has cores, one per core. Throws
/// std::invalid_argument if it is negative.
inline int threads_of(int threads) {
    if (threads < 0)
        throw std::invalid_argument("ccd: found " + std::to_string(threads) +
                                    " threads, expected 0 (one per core) or more");
    const int cores = tbb::info::default_concurrency();
    return threads > 0 ? std::min(threads, cores) : cores;
}

/// On MinGW-w64, keeps oneTBB's threads until the program ends. By itself oneTBB ends them when the
/// last thread ends that has used it, and that can wait for ever there: a std::thread holds a lock
/// of MinGW's while destructors of its thread_local objects take the loader's, a native thread that
/// ends holds the loader's and takes MinGW's.
inline void keep_workers() {
#ifdef __MINGW32__
    static const tbb::task_scheduler_handle kept{tbb::attach{}};
#endif
}

/// Runs `work` where parallel loops use at most threads_of(threads). Returns that number.
template <class Work>
int on_threads(int threads, const Work& work) {
    keep_workers();
    tbb::task_arena arena(threads_of(threads));
    arena.execute(work);
    return arena.max_concurrency();
}

/// Calls visit(begin, end) for parts of 0 to `count`, on at most so many threads.
template <class Visit>
void for_each_part(std::size_t count, int threads, const Visit& visit) {
    constexpr std::size_t few = 64;
    if (threads_of(threads) == 1 || count <= few) return visit(std::size_t{0}, count);
    on_threads(threads, [&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, few),
                          [&](const auto& range) { visit(range.begin(), range.end()); });
    });
}
/// Calls visit(i) for i below `count`, the same way.
template <class Visit>
void for_each_index(std::size_t count, int threads, const Visit& visit) {
    for_each_part(count, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) visit(i);
    });
}

}  // namespace ccd::detail
