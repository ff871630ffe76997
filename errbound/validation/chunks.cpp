// Runs the chunks of evidence on several threads and merges them in order.
#include "errbound/validation/chunks.hpp"

#include <atomic>
#include <chrono>
#include <errbound/validation/ball.hpp>
#include <future>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace errbound::validation {
namespace {

/// Frees MPFR's cache of the thread at the end, also after an exception.
struct freed_mpfr_cache {
    freed_mpfr_cache() = default;
    freed_mpfr_cache(const freed_mpfr_cache&) = delete;
    freed_mpfr_cache& operator=(const freed_mpfr_cache&) = delete;
    ~freed_mpfr_cache() { mpfr_free_cache(); }
};

class ordered_sum {
  public:
    void add(std::uint64_t chunk, report found) {
        const std::scoped_lock lock(guard_);
        waiting_.emplace(chunk, std::move(found));
        for (auto first = waiting_.begin(); first != waiting_.end() && first->first == merged_;
             first = waiting_.erase(first), ++merged_)
            sum_.merge(std::move(first->second));
    }
    report take() { return std::move(sum_); }

  private:
    std::mutex guard_;
    std::map<std::uint64_t, report> waiting_;
    std::uint64_t merged_ = 0;
    report sum_;
};

}  // namespace

evidence with_mpfr(evidence what) {
    return {.chunks = what.chunks,
            .report_of =
                [work = std::move(what.report_of)](std::uint64_t chunk) {
                    const freed_mpfr_cache cache;
                    const exponents range = exponents::widest();
                    return work(chunk);
                },
            .describe =
                [work = std::move(what.describe)](report& found) {
                    const freed_mpfr_cache cache;
                    const exponents range = exponents::widest();
                    work(found);
                }};
}

report examine(const evidence& what, int threads, const progress& show) {
    ordered_sum sum;
    std::atomic<std::uint64_t> next = 0, done = 0;
    const auto run = [&] {
        try {
            for (std::uint64_t chunk = next++; chunk < what.chunks; chunk = next++) {
                sum.add(chunk, what.report_of(chunk));
                ++done;
            }
        } catch (...) {
            next = what.chunks;  // the others need not go on
            throw;
        }
    };
    const std::uint64_t wanted =
        threads > 0 ? static_cast<unsigned>(threads) : std::thread::hardware_concurrency();
    std::vector<std::future<void>> running(
        std::clamp<std::uint64_t>(wanted, 1, std::max<std::uint64_t>(what.chunks, 1)));
    for (auto& one : running) one = std::async(std::launch::async, run);
    for (auto& one : running)
        while (one.wait_for(std::chrono::milliseconds(100)) == std::future_status::timeout)
            if (show) show(done, what.chunks);
    for (auto& one : running) one.get();
    report all = sum.take();
    what.describe(all);
    return all;
}

}  // namespace errbound::validation
