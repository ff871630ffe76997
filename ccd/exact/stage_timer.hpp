// Counts and times one stage. Internal; everything is forced inline, because kernels for several
// instruction sets include it (see ccd/batch/batch_kernels.hpp).
#pragma once

#include <ccd/explain.hpp>
#include <chrono>
#include <cstddef>

namespace ccd::detail {

/// Does nothing if there is no report.
class stage_timer {
  public:
    [[gnu::always_inline]] inline stage_timer(stage_report* report, stage s)
        : entry_(report != nullptr ? &report->stages[static_cast<std::size_t>(s)] : nullptr) {
        if (entry_ != nullptr) start_ = now();
    }
    [[gnu::always_inline]] inline ~stage_timer() { end(); }
    stage_timer(const stage_timer&) = delete;
    stage_timer& operator=(const stage_timer&) = delete;

    [[gnu::always_inline]] inline void count(std::size_t entered, std::size_t separate,
                                             std::size_t collides) {
        if (entry_ == nullptr) return;
        entry_->entered += entered;
        entry_->separate += separate;
        entry_->collides += collides;
    }

    [[gnu::always_inline]] inline void skip(std::size_t queries) {
        if (entry_ != nullptr) entry_->skipped += queries;
    }

    [[gnu::always_inline]] inline void end() {
        if (entry_ != nullptr) entry_->seconds += now() - start_;
        entry_ = nullptr;
    }

  private:
    [[gnu::always_inline]] static inline double now() {
        using clock = std::chrono::steady_clock;
        constexpr double tick = double(clock::period::num) / double(clock::period::den);
        return tick * static_cast<double>(clock::now().time_since_epoch().count());
    }

    stage_report::entry* entry_;
    double start_ = 0;
};

}  // namespace ccd::detail
