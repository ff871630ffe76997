// Numbered blocks of work on several threads, whose results are merged in order.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace errbound::support {

/// Threads that join at the end of a scope: std::jthread without a token (libc++ has it from 20
/// on).
class joined_threads {
  public:
    joined_threads() = default;
    joined_threads(const joined_threads&) = delete;
    joined_threads& operator=(const joined_threads&) = delete;
    ~joined_threads() {
        for (std::thread& t : threads_) t.join();
    }

    /// Starts a thread that calls `work`. Throws std::system_error if there are no more threads.
    template <class Work>
    void start(Work work) {
        threads_.emplace_back(std::move(work));
    }

  private:
    std::vector<std::thread> threads_;
};

/// Computes blocks first, ..., end − 1 on threads (0: one per core) and merges their results in
/// this order, so what is merged does not depend on the number of threads. Ends early, between
/// blocks, when `stop` is not 0, after an exception, or when it is destroyed.
template <class Result>
class ordered_blocks {
  public:
    /// Several threads call `compute`, one at a time calls `merge`. Throws std::system_error if the
    /// system has no more threads.
    ordered_blocks(std::uint64_t first, std::uint64_t end, unsigned threads,
                   std::function<Result(std::uint64_t)> compute, std::function<void(Result)> merge,
                   const std::atomic<int>& stop)
        : next_(first),
          merged_(first),
          end_(end),
          compute_(std::move(compute)),
          merge_(std::move(merge)),
          stop_(stop) {
        const std::uint64_t wanted = threads > 0 ? threads : std::thread::hardware_concurrency();
        working_ = std::clamp<std::uint64_t>(wanted, 1, std::max<std::uint64_t>(end - first, 1));
        try {
            for (std::uint64_t left = working_; left > 0; --left)
                threads_.start([this] { work(); });
        } catch (...) {
            ending_ = true;
            throw;
        }
    }
    ~ordered_blocks() { ending_ = true; }
    ordered_blocks(const ordered_blocks&) = delete;
    ordered_blocks& operator=(const ordered_blocks&) = delete;

    bool finished_within(std::chrono::milliseconds time) {
        std::unique_lock lock(mutex_);
        return finished_.wait_for(lock, time, [&] { return working_ == 0; });
    }
    /// Calls read(index of the next block to merge) while nothing is merged.
    template <class Read>
    auto between_merges(const Read& read) {
        const std::scoped_lock lock(mutex_);
        return read(merged_);
    }
    /// Rethrows the exception of a block, if any. Precondition: finished.
    void rethrow_failure() {
        const std::scoped_lock lock(mutex_);
        if (failure_) std::rethrow_exception(failure_);
    }

  private:
    void work() {
        while (stop_ == 0 && !ending_) {
            const std::uint64_t block = next_++;
            if (block >= end_) break;
            try {
                Result result = compute_(block);
                const std::scoped_lock lock(mutex_);
                waiting_.emplace(block, std::move(result));
                while (!merging_ && !waiting_.empty() && waiting_.begin()->first == merged_) {
                    auto next = waiting_.extract(waiting_.begin());
                    merging_ = true;
                    merge_(std::move(next.mapped()));
                    merging_ = false;
                    ++merged_;
                }
            } catch (...) {
                ending_ = true;
                const std::scoped_lock lock(mutex_);
                failure_ = std::current_exception();
            }
        }
        const std::scoped_lock lock(mutex_);
        --working_;
        finished_.notify_all();
    }

    std::atomic<std::uint64_t> next_;
    std::uint64_t merged_;
    const std::uint64_t end_;
    const std::function<Result(std::uint64_t)> compute_;
    const std::function<void(Result)> merge_;
    const std::atomic<int>& stop_;
    std::atomic<bool> ending_ = false;
    std::mutex mutex_;  // of merging and of the members that follow
    std::condition_variable finished_;
    std::map<std::uint64_t, Result> waiting_;  // for blocks before them
    bool merging_ = false;                     // stays true if merge throws
    std::exception_ptr failure_;
    std::uint64_t working_ = 0;
    joined_threads threads_;  // joined before the other members are destroyed
};

}  // namespace errbound::support
