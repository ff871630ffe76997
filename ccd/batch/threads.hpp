// Runs parallel work on a wanted number of threads. Internal.
#pragma once

#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace ccd::detail {

/// Runs `work` where parallel loops use at most `threads` threads: 0, or more than the machine has
/// cores, one per core. Returns that number.
template <class Work>
int on_threads(int threads, const Work& work) {
    const int cores = tbb::info::default_concurrency();
    tbb::task_arena arena(threads > 0 ? std::min(threads, cores) : cores);
    arena.execute(work);
    return arena.max_concurrency();
}

}  // namespace ccd::detail
