#include "ccd/batch/threads.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <stdexcept>
#include <string>

namespace ccd::detail {
namespace {

/// On MinGW-w64, keeps oneTBB's threads until the program ends, since ending them earlier can
/// deadlock. A std::thread holds a lock of MinGW's while destructors of its thread_local objects
/// take the loader's lock; a native thread that ends takes these locks in the other order.
void keep_workers() {
#ifdef __MINGW32__
    static const tbb::task_scheduler_handle kept{tbb::attach{}};
#endif
}

}  // namespace

int threads_of(int threads) {
    if (threads < 0)
        throw std::invalid_argument("ccd: number of threads is " + std::to_string(threads) +
                                    "; expected 0 (one per core) or more");
    const int cores = tbb::info::default_concurrency();
    return threads > 0 ? std::min(threads, cores) : cores;
}

std::size_t threads_here() {
    return static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
}

int on_threads(int threads, const std::function<void()>& work) {
    keep_workers();
    tbb::task_arena arena(threads_of(threads));
    arena.execute(work);
    return arena.max_concurrency();
}

void for_each_range(std::size_t count, std::size_t few,
                    const std::function<void(std::size_t, std::size_t)>& visit) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, few),
                      [&](const auto& range) { visit(range.begin(), range.end()); });
}

void for_each_task(std::size_t count, const std::function<void(std::size_t)>& act) {
    tbb::parallel_for(
        std::size_t(0), count, [&](std::size_t i) { act(i); }, tbb::simple_partitioner());
}

struct pointer_per_thread::table {
    tbb::enumerable_thread_specific<std::shared_ptr<void>> pointers;
};
pointer_per_thread::pointer_per_thread() : table_(std::make_unique<table>()) {}
pointer_per_thread::~pointer_per_thread() = default;

std::shared_ptr<void>& pointer_per_thread::local() {
    return table_->pointers.local();
}
std::vector<void*> pointer_per_thread::all() const {
    std::vector<void*> set;
    for (const auto& p : table_->pointers)
        if (p) set.push_back(p.get());
    return set;
}

}  // namespace ccd::detail
