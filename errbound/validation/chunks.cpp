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

evidence with_mpfr(evidence examined) {
    return {.chunks = examined.chunks,
            .report_of =
                [work = std::move(examined.report_of)](std::uint64_t chunk) {
                    const freed_mpfr_cache cache;
                    const exponents range = exponents::widest();
                    return work(chunk);
                },
            .describe =
                [work = std::move(examined.describe)](report& found) {
                    const freed_mpfr_cache cache;
                    const exponents range = exponents::widest();
                    work(found);
                }};
}

report examine(const evidence& examined, int threads, const progress& show) {
    static const std::atomic<int> no_stop = 0;
    report all;
    std::uint64_t done = 0;
    support::merge_in_order(
        0, examined.chunks, static_cast<unsigned>(std::max(threads, 0)), examined.report_of,
        [&](report found) {
            all.merge(std::move(found));
            if (show) show(++done, examined.chunks);
        },
        no_stop);
    examined.describe(all);
    return all;
}

}  // namespace errbound::validation
