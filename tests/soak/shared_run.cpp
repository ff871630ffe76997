// A long run that the ranks of MPI share.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>
#include <utility>

#include "tests/soak/long_run.hpp"

namespace soak {
namespace {

using clock = std::chrono::steady_clock;
constexpr double seconds_of_round = 3;

double seconds_since(clock::time_point start) {
    return std::chrono::duration<double>(clock::now() - start).count();
}

/// What each of these blocks has found, as text.
std::vector<std::string> compared(const part& what, std::uint64_t seed,
                                  const std::vector<std::uint64_t>& blocks, unsigned threads) {
    std::vector<std::string> texts(blocks.size());
    std::atomic<std::size_t> next = 0;
    std::mutex mutex;
    std::exception_ptr failure;
    const auto work = [&] {
        for (std::size_t i = next++; i < blocks.size(); i = next++) try {
                texts[i] =
                    to_json({.seed = seed, .found = what.compare_block(seed, blocks[i])}, what);
            } catch (...) {
                const std::scoped_lock lock(mutex);
                failure = std::current_exception();
                next = blocks.size();
            }
    };
    {
        std::vector<std::jthread> all;
        for (unsigned i = 0; i < threads; ++i) all.emplace_back(work);
    }
    if (failure) std::rethrow_exception(failure);
    return texts;
}

/// What a rank tells of a round: texts, or why there are none.
struct told {
    std::vector<std::string> texts;
    std::string failure;
};
std::string text_of(const told& t) {
    return nlohmann::json{{"texts", t.texts}, {"failure", t.failure}}.dump(
        -1, ' ', false, nlohmann::json::error_handler_t::replace);
}
told told_of(const std::string& text) {
    const nlohmann::json all = nlohmann::json::parse(text);
    return {all.at("texts").get<std::vector<std::string>>(), all.at("failure").get<std::string>()};
}

/// One rank's part in rounds of `each` blocks a rank, and on rank 0 the sum.
class shared_run {
  public:
    shared_run(const team& who, state from, const run_options& options, const part& what)
        : who_(who), options_(options), what_(what), sum_(std::move(from)) {}

    /// Blocks [sum's, until) of the whole run.
    void round(std::uint64_t until) {
        const std::uint64_t first = sum_.found.blocks;
        std::vector<std::uint64_t> own;
        for (std::uint64_t b = first + who_.rank; b < until; b += who_.size) own.push_back(b);
        told of_round;
        try {
            of_round.texts = compared(what_, sum_.seed, own, threads());
        } catch (const std::exception& error) {
            of_round.failure = "rank " + std::to_string(who_.rank) + ": " + error.what();
        }
        std::vector<told> all;
        for (const std::string& text : who_.gather(text_of(of_round))) all.push_back(told_of(text));
        std::string failure;
        for (const told& t : all)
            if (failure.empty()) failure = t.failure;
        failure = who_.share(failure);
        if (!failure.empty()) throw std::runtime_error(failure);
        if (who_.rank != 0) {
            sum_.found.blocks = until;
            return;
        }
        for (std::uint64_t b = first; b < until; ++b) {
            const std::string& text = all[(b - first) % who_.size].texts[(b - first) / who_.size];
            sum_.found.add(from_json(text, what_).found);
        }
    }
    state& sum() { return sum_; }

  private:
    unsigned threads() const {
        return options_.threads > 0 ? options_.threads
                                    : std::max(1u, std::thread::hardware_concurrency());
    }
    const team& who_;
    const run_options& options_;
    const part& what_;
    state sum_;
};

}  // namespace

state run_shared(const team& who, state from, const run_options& options, const part& what,
                 const std::atomic<bool>& stop, const std::function<void(const state&)>& progress) {
    const bool is_root = who.rank == 0;
    const double before = from.seconds;
    if (is_root) save(from, what, options.folder);
    shared_run run(who, std::move(from), options, what);
    const clock::time_point start = clock::now();
    clock::time_point saved = start;
    std::uint64_t each = 1;
    while (run.sum().found.blocks < options.blocks) {
        // How many blocks for each rank; 0: stop.
        const std::uint64_t asked = std::stoull(who.share(std::to_string(stop ? 0 : each)));
        if (asked == 0) break;
        const clock::time_point begin = clock::now();
        const std::uint64_t first = run.sum().found.blocks;
        run.round(std::min(options.blocks, first + asked * who.size));
        if (!is_root) continue;
        const double seconds = std::max(1e-3, seconds_since(begin));
        each = std::clamp<std::uint64_t>(
            static_cast<std::uint64_t>(static_cast<double>(asked) * seconds_of_round / seconds), 1,
            2 * asked);
        run.sum().seconds = before + seconds_since(start);
        if (seconds_since(saved) >= options.seconds_between_saves) {
            save(run.sum(), what, options.folder);
            saved = clock::now();
        }
        progress(run.sum());
    }
    if (is_root) save(run.sum(), what, options.folder);
    return run.sum();
}

}  // namespace soak
