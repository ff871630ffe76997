// Numbered blocks of work on several threads, whose results are merged in order.
#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <future>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace errbound::support {

/// Calls compute(block) for blocks first, ..., end − 1 on threads (0: one per core), and
/// merge(result) for each, in this order, on the calling thread. So what is merged does not depend
/// on the number of threads. Results of later blocks are kept until an earlier one ends. Ends
/// early, between blocks, when `stop` is not 0. Throws the exception of a block or of `merge`, and
/// std::system_error if the system has no more threads.
template <class Compute, class Merge>
void merge_in_order(std::uint64_t first, std::uint64_t end, unsigned threads,
                    const Compute& compute, const Merge& merge, const std::atomic<int>& stop) {
    if (threads == 0) threads = std::thread::hardware_concurrency();
    std::mutex mutex;  // of the variables that follow
    std::condition_variable changed;
    std::map<std::uint64_t, decltype(compute(first))> results;
    std::uint64_t next = first,
                  working = std::clamp<std::uint64_t>(end - first, 1, std::max(threads, 1U));
    std::exception_ptr failure;
    const auto work = [&] {
        std::unique_lock lock(mutex);
        try {
            while (stop == 0 && next < end) {
                const std::uint64_t block = next++;
                lock.unlock();
                auto result = compute(block);
                lock.lock();
                results.emplace(block, std::move(result));
                changed.notify_one();
            }
        } catch (...) {
            if (!lock) lock.lock();
            failure = std::current_exception();
            next = end;
        }
        --working;
        changed.notify_one();
    };
    std::vector<std::future<void>> workers;  // their destructors wait
    try {
        for (auto left = working; left > 0; --left)
            workers.push_back(std::async(std::launch::async, work));
        for (std::uint64_t merged = first; merged < end; ++merged) {
            std::unique_lock lock(mutex);
            changed.wait(lock, [&] { return results.contains(merged) || working == 0; });
            const auto result = results.extract(merged);
            if (result.empty()) break;
            lock.unlock();
            merge(result.mapped());
        }
    } catch (...) {
        const std::scoped_lock lock(mutex);
        next = end;
        throw;
    }
    if (failure) std::rethrow_exception(failure);
}

}  // namespace errbound::support
