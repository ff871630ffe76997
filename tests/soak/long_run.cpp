#include "tests/soak/long_run.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>
#include <utility>

#include "errbound/support/joined_threads.hpp"
#include "errbound/support/output_file.hpp"

namespace soak {

using nlohmann::json;

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(count_table::row, name, counts);
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(count_table, title, columns, largest, rows);
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(difference, text, file, lines);
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(findings, blocks, tables, different, differences, checksum);

namespace {

namespace fs = std::filesystem;
using clock = std::chrono::steady_clock;

double seconds_since(clock::time_point start) {
    return std::chrono::duration<double>(clock::now() - start).count();
}

/// Threads that compare block after block, and their findings.
class comparing_threads {
  public:
    comparing_threads(const state& from, const run_options& options, const part& what,
                      const std::atomic<int>& stop)
        : seed_(from.seed),
          first_(what.blocks_for(from.first)),
          blocks_(options.blocks),
          what_(what),
          stop_(stop),
          next_(from.found.blocks),
          sum_(from.found) {
        const unsigned count = options.threads > 0
                                   ? options.threads
                                   : std::max(1u, std::thread::hardware_concurrency());
        working_ = count;
        try {
            for (unsigned i = 0; i < count; ++i) threads_.start([this] { work(); });
        } catch (...) {  // the system has no more threads: the running ones end, too
            ending_ = true;
            throw;
        }
    }
    /// Waits for the blocks in progress.
    ~comparing_threads() { ending_ = true; }

    bool finished_within(std::chrono::milliseconds time) {
        std::unique_lock lock(mutex_);
        return finished_.wait_for(lock, time, [&] { return working_ == 0; });
    }
    /// Results of all blocks before the first that is missing.
    findings found() {
        const std::scoped_lock lock(mutex_);
        return sum_;
    }
    void rethrow_failure() {
        const std::scoped_lock lock(mutex_);
        if (failure_) std::rethrow_exception(failure_);
    }

  private:
    // Threads stop only between blocks: all blocks in progress are finished, so none is lost.
    void work() {
        while (stop_ == 0 && !ending_) {
            const std::uint64_t block = next_++;
            if (block >= blocks_) break;
            try {
                findings of_block = what_.compare_block(seed_, first_ + block);
                const std::scoped_lock lock(mutex_);
                add(block, std::move(of_block));
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
    void add(std::uint64_t block, findings of_block) {
        waiting_.emplace(block, std::move(of_block));
        for (auto next = waiting_.begin(); next != waiting_.end() && next->first == sum_.blocks;
             next = waiting_.erase(next))
            sum_.add(next->second);
    }

    std::uint64_t seed_, first_, blocks_;
    const part& what_;
    const std::atomic<int>& stop_;
    std::atomic<bool> ending_ = false;
    std::atomic<std::uint64_t> next_;
    std::mutex mutex_;  // of all that follows
    std::condition_variable finished_;
    findings sum_;
    std::map<std::uint64_t, findings> waiting_;  // for blocks before them
    std::exception_ptr failure_;
    unsigned working_ = 0;
    errbound::support::joined_threads threads_;  // joined before the other members are destroyed
};

}  // namespace

std::vector<std::uint64_t>& count_table::operator[](std::string_view name) {
    auto found = std::ranges::find(rows, name, &row::name);
    if (found == rows.end()) {
        rows.push_back({std::string(name), std::vector<std::uint64_t>(columns.size())});
        found = rows.end() - 1;
    }
    return found->counts;
}

const count_table& findings::table(std::string_view title) const {
    const auto found = std::ranges::find(tables, title, &count_table::title);
    if (found == tables.end()) throw std::out_of_range("no table \"" + std::string(title) + "\"");
    return *found;
}

count_table& findings::table(std::string_view title) {
    return const_cast<count_table&>(std::as_const(*this).table(title));
}

void findings::differ(difference d) {
    ++different;
    if (differences.size() < max_kept) differences.push_back(std::move(d));
}

void findings::add(const findings& next) {
    blocks += next.blocks;
    if (tables.empty())
        tables = next.tables;
    else
        for (const count_table& from : next.tables) {
            count_table& into = table(from.title);
            for (const auto& [name, counts] : from.rows)
                std::ranges::transform(counts, into[name], into[name].begin(),
                                       [&](std::uint64_t a, std::uint64_t b) {
                                           return from.largest ? std::max(a, b) : a + b;
                                       });
        }
    different += next.different;
    for (const difference& d : next.differences)
        if (differences.size() < max_kept) differences.push_back(d);
    stir(next.checksum);
}

std::uint64_t part::blocks_for(std::uint64_t questions) const {
    std::uint64_t low = 0, high = 1;
    while (count(high) < questions) high *= 2;
    while (low < high) {
        const std::uint64_t middle = low + (high - low) / 2;
        if (count(middle) >= questions)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

std::string to_json(const state& s, const part& of) {
    json all = s.found;
    all.update({{"part", of.name},
                {"version", of.version},
                {"seed", s.seed},
                {"first", s.first},
                {"seconds", s.seconds}});
    return all.dump(1) + "\n";
}

state from_json(const std::string& text, const part& of) {
    try {
        const json all = json::parse(text);
        if (all.at("part") != of.name || all.at("version") != of.version)
            throw std::runtime_error("the run has other questions than this program");
        return {all.at("seed").get<std::uint64_t>(), all.at("first").get<std::uint64_t>(),
                all.get<findings>(), all.at("seconds").get<double>()};
    } catch (const json::exception& error) {
        throw std::runtime_error(std::string("not the state of a run: ") + error.what());
    }
}

fs::path state_path(const fs::path& folder) {
    return folder / "state.json";
}

void save(const state& s, const part& of, const fs::path& folder) {
    fs::create_directories(folder);
    std::map<std::string, std::string> files;
    for (const difference& d : s.found.differences)
        if (!d.file.empty()) files[d.file] += d.lines;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("differences") && !files.contains(name)) fs::remove(entry.path());
    }
    for (const auto& [name, lines] : files) errbound::support::write_whole(folder / name, lines);
    errbound::support::write_whole(state_path(folder), to_json(s, of));
}

state run(state from, const run_options& options, const part& what, const std::atomic<int>& stop,
          const std::function<void(const state&)>& show) {
    // A folder that cannot be written to is refused now, not in an hour.
    save(from, what, options.folder);
    const clock::time_point start = clock::now();
    comparing_threads threads(from, options, what, stop);
    const auto now = [&] {
        return state{from.seed, from.first, threads.found(), from.seconds + seconds_since(start)};
    };
    clock::time_point saved = start;
    while (!threads.finished_within(std::chrono::milliseconds(100))) {
        const state current = now();
        if (seconds_since(saved) >= options.seconds_between_saves) {
            save(current, what, options.folder);
            saved = clock::now();
        }
        show(current);
    }
    const state last = now();
    save(last, what, options.folder);
    threads.rethrow_failure();
    return last;
}

}  // namespace soak
