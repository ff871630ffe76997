// What both parts of the comparison of predicates share: work in chunks, over all threads.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string_view>
#include <thread>
#include <tuple>

#include "errbound/support/joined_threads.hpp"
#include "tests/errbound/predicates/predicate_list.hpp"
#include "tests/soak/predicates/predicates.hpp"

namespace soak {

/// Calls work(random, inputs, findings) for chunks that together have all inputs; the same chunks
/// whatever the number of threads. `Findings` is summed up by add(findings, more).
template <class Findings, class Work, class Add>
Findings in_chunks(const predicate_run& run, std::string_view name, const Work& work,
                   const Add& add) {
    constexpr std::uint64_t chunk_size = 1 << 14;
    const std::uint64_t chunks = (run.inputs + chunk_size - 1) / chunk_size;
    std::atomic<std::uint64_t> next = 0;
    std::mutex mutex;
    Findings all;
    const auto worker = [&] {
        for (std::uint64_t c; (c = next++) < chunks;) {
            std::seed_seq seed{run.seed >> 32, run.seed,
                               std::uint64_t{std::hash<std::string_view>()(name)}, c};
            predicate_inputs::generator random(seed);
            const Findings found = work(random, std::min(chunk_size, run.inputs - c * chunk_size));
            const std::lock_guard lock(mutex);
            add(all, found);
        }
    };
    const unsigned count = run.threads != 0 ? run.threads : std::thread::hardware_concurrency();
    {
        errbound::support::joined_threads threads;
        for (unsigned i = 0; i < std::max(count, 1u); ++i) threads.start(worker);
    }
    return all;
}

/// job.operator()<T>(entry, name of T) for each predicate that the run names, timed; then show.
template <class Job, class Show>
void for_each_predicate(const predicate_run& run, const Job& job, const Show& show) {
    const auto timed = [&]<class T>(const auto& entry, std::string_view number_type, T) {
        const auto start = std::chrono::steady_clock::now();
        auto found = job.template operator()<T>(entry);
        found.predicate = entry.name;
        found.number_type = number_type;
        found.seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        show(found);
    };
    const auto both = [&](const auto& entry) {
        if (entry.name.find(run.predicate) == std::string_view::npos) return;
        timed(entry, "float", float());
        timed(entry, "double", double());
    };
    std::apply([&](const auto&... entry) { (both(entry), ...); }, predicate_list::all);
}

}  // namespace soak
