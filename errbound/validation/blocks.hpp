// Work in numbered blocks on several threads, each with a state of its own. Internal.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <errbound/validation/ball.hpp>
#include <errbound/validation/validation.hpp>
#include <future>
#include <memory>
#include <thread>
#include <vector>

namespace errbound::validation {

/// What MPFR keeps for this thread is freed at the end, also by an exception.
struct freed_mpfr_cache {
    freed_mpfr_cache() = default;
    freed_mpfr_cache(const freed_mpfr_cache&) = delete;
    freed_mpfr_cache& operator=(const freed_mpfr_cache&) = delete;
    ~freed_mpfr_cache() { mpfr_free_cache(); }
};

/// Calls work(state, block) for every block; one State per thread, made on it. Returns the states,
/// in no particular order: what they hold must add up to the same in any. threads <= 0: one per
/// core. An exception of `work` is rethrown once all threads have ended.
template <class State, class Work>
std::vector<std::unique_ptr<State>> in_blocks(int threads, std::uint64_t blocks,
                                              const progress& show, const Work& work) {
    std::atomic<std::uint64_t> next = 0, done = 0;
    const auto run = [&] {
        const widest_exponents range;
        const freed_mpfr_cache cache;
        auto state = std::make_unique<State>();
        for (std::uint64_t block = next++; block < blocks; block = next++) {
            work(*state, block);
            ++done;
        }
        return state;
    };
    const unsigned count =
        threads > 0 ? static_cast<unsigned>(threads) : std::thread::hardware_concurrency();
    std::vector<std::future<std::unique_ptr<State>>> running(std::max(count, 1U));
    for (auto& one : running) one = std::async(std::launch::async, run);
    for (auto& one : running)
        while (one.wait_for(std::chrono::milliseconds(100)) == std::future_status::timeout)
            if (show && blocks > 0) show(done, blocks);
    std::vector<std::unique_ptr<State>> states;
    for (auto& one : running) states.push_back(one.get());
    return states;
}

}  // namespace errbound::validation
