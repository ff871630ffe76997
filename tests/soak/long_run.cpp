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
#include <vector>

#include "errbound/support/joined_threads.hpp"
#include "errbound/support/output_file.hpp"

namespace soak {
namespace {

namespace fs = std::filesystem;
using clock = std::chrono::steady_clock;
using nlohmann::json;

double seconds_since(clock::time_point start) {
    return std::chrono::duration<double>(clock::now() - start).count();
}

/// Refuses what is not a whole number or is too large to have been counted.
std::uint64_t whole(const json& j) {
    if (!j.is_number_unsigned() || j.get<std::uint64_t>() >> 48 != 0)
        throw std::runtime_error("not the state of a run: found " + j.dump() +
                                 ", expected a count");
    return j.get<std::uint64_t>();
}

json json_of(const count_table& table) {
    json all{{"title", table.title}, {"columns", table.columns}, {"rows", json::array()}};
    for (const auto& [name, counts] : table.rows)
        all["rows"].push_back({{"name", name}, {"counts", counts}});
    return all;
}

count_table table_of(const json& j) {
    count_table table{j.at("title").get<std::string>(),
                      j.at("columns").get<std::vector<std::string>>()};
    for (const json& row : j.at("rows")) {
        auto& counts = table[row.at("name").get<std::string>()];
        for (std::size_t k = 0; k < counts.size(); ++k) counts[k] = whole(row.at("counts").at(k));
    }
    return table;
}

json json_of(const findings& f) {
    json all{{"blocks", f.blocks},
             {"checksum", f.checksum},
             {"different", f.different},
             {"tables", json::array()},
             {"differences", json::array()}};
    for (const count_table& table : f.tables) all["tables"].push_back(json_of(table));
    for (const difference& d : f.differences)
        all["differences"].push_back({{"text", d.text}, {"file", d.file}, {"lines", d.lines}});
    return all;
}

findings findings_of(const json& all) {
    findings f;
    f.blocks = whole(all.at("blocks"));
    f.checksum = all.at("checksum").get<std::uint64_t>();
    f.different = whole(all.at("different"));
    for (const json& table : all.at("tables")) f.tables.push_back(table_of(table));
    for (const json& d : all.at("differences"))
        f.differences.push_back({d.at("text").get<std::string>(), d.at("file").get<std::string>(),
                                 d.at("lines").get<std::string>()});
    return f;
}

/// Threads that compare block after block, and what they have found.
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
          found_(from.found) {
        const unsigned count = options.threads > 0
                                   ? options.threads
                                   : std::max(1u, std::thread::hardware_concurrency());
        working_ = count;
        try {
            for (unsigned i = 0; i < count; ++i) threads_.start([this] { work(); });
        } catch (...) {  // no more threads: those begun end, too
            ending_ = true;
            throw;
        }
    }
    /// Waits for the blocks that are begun.
    ~comparing_threads() { ending_ = true; }

    bool finished_within(std::chrono::milliseconds time) {
        std::unique_lock lock(mutex_);
        return finished_.wait_for(lock, time, [&] { return working_ == 0; });
    }
    findings found() {
        const std::scoped_lock lock(mutex_);
        return found_.sum();
    }
    void rethrow_failure() {
        const std::scoped_lock lock(mutex_);
        if (failure_) std::rethrow_exception(failure_);
    }

  private:
    // Stopping only between blocks, all that are begun are finished, so none is lost.
    void work() {
        while (stop_ == 0 && !ending_) {
            const std::uint64_t block = next_++;
            if (block >= blocks_) break;
            try {
                findings of_block = what_.compare_block(seed_, first_ + block);
                const std::scoped_lock lock(mutex_);
                found_.add(block, std::move(of_block));
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

    std::uint64_t seed_, first_, blocks_;
    const part& what_;
    const std::atomic<int>& stop_;
    std::atomic<bool> ending_ = false;
    std::atomic<std::uint64_t> next_;
    std::mutex mutex_;  // of all that follows
    std::condition_variable finished_;
    collector found_;
    std::exception_ptr failure_;
    unsigned working_ = 0;
    errbound::support::joined_threads threads_;  // joined before anything else goes
};

}  // namespace

std::uint64_t part::blocks_for(std::uint64_t questions) const {
    std::uint64_t low = 0, high = 1;
    while (count(high) < questions) high *= 2;
    while (low < high) {
        const std::uint64_t middle = low + (high - low) / 2;
        if (count(middle) >= questions) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    return low;
}

std::string to_json(const state& s, const part& of) {
    json all = json_of(s.found);
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
            throw std::runtime_error("the run asked other questions than this program does");
        return {all.at("seed").get<std::uint64_t>(), whole(all.at("first")), findings_of(all),
                all.at("seconds").get<double>()};
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
          const progress& show) {
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
