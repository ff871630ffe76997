#include "errbound/validation/chunks.hpp"

#include <algorithm>
#include <atomic>
#include <errbound/validation/ball.hpp>
#include <utility>

#include "errbound/support/ordered_blocks.hpp"

namespace errbound::validation {
namespace {

/// Frees the thread's MPFR cache at the end.
struct freed_mpfr_cache {
    freed_mpfr_cache() = default;
    freed_mpfr_cache(const freed_mpfr_cache&) = delete;
    freed_mpfr_cache& operator=(const freed_mpfr_cache&) = delete;
    ~freed_mpfr_cache() { mpfr_free_cache(); }
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
    static const std::atomic<int> no_stop = 0;
    report all;
    std::uint64_t done = 0;
    support::merge_in_order(
        0, what.chunks, static_cast<unsigned>(std::max(threads, 0)), what.report_of,
        [&](report found) {
            all.merge(std::move(found));
            if (show) show(++done, what.chunks);
        },
        no_stop);
    what.describe(all);
    return all;
}

}  // namespace errbound::validation
