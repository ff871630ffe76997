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

#include "errbound/support/output_file.hpp"

namespace soak {
namespace {

namespace fs = std::filesystem;
using clock = std::chrono::steady_clock;
using nlohmann::json;
using query_families::families;
using query_families::kind;

double seconds_since(clock::time_point start) {
    return std::chrono::duration<double>(clock::now() - start).count();
}

json json_of(const difference& d) {
    return {{"family", families[d.family].name},
            {"kind", short_name(d.which)},
            {"index", d.index},
            {"collides", d.collides},
            {"wrong", d.wrong}};
}

/// Refuses what is not a whole number or is too large to have been counted.
std::uint64_t whole(const json& j) {
    if (!j.is_number_unsigned() || j.get<std::uint64_t>() >> 48 != 0)
        throw std::runtime_error("not the state of a run: found " + j.dump() +
                                 ", expected a count");
    return j.get<std::uint64_t>();
}

difference difference_of(const json& j) {
    difference d;
    const auto family = j.at("family").get<std::string>();
    const auto found = std::ranges::find(families, family, &query_families::family::name);
    if (found == std::end(families)) throw std::runtime_error("no family \"" + family + "\"");
    d.family = static_cast<std::size_t>(found - std::begin(families));
    d.which = ccd::find_kind(j.at("kind").get<std::string>()).value();
    d.index = whole(j.at("index"));
    d.collides = j.at("collides").get<bool>();
    d.wrong = j.at("wrong").get<std::vector<std::string>>();
    return d;
}

/// Finished blocks, added up in their order.
class collector {
  public:
    explicit collector(totals from) : sum_(std::move(from)) {}

    void add(std::uint64_t block, totals found) {
        waiting_.emplace(block, std::move(found));
        for (auto next = waiting_.find(sum_.blocks); next != waiting_.end();
             next = waiting_.find(sum_.blocks)) {
            sum_.add(next->second);
            waiting_.erase(next);
        }
    }
    const totals& sum() const { return sum_; }

  private:
    totals sum_;
    std::map<std::uint64_t, totals> waiting_;
};

/// Threads that compare block after block, and what they have found.
class comparing_threads {
  public:
    comparing_threads(const state& from, const run_options& options, const decider& truth,
                      std::span<const decider> deciders, const std::atomic<bool>& stop)
        : seed_(from.seed),
          blocks_(options.blocks),
          truth_(truth),
          deciders_(deciders),
          stop_(stop),
          next_(from.found.blocks),
          found_(from.found) {
        const unsigned count = options.threads > 0
                                   ? options.threads
                                   : std::max(1u, std::thread::hardware_concurrency());
        working_ = count;
        for (unsigned i = 0; i < count; ++i) threads_.emplace_back([this] { work(); });
    }
    /// Waits for the blocks that are begun.
    ~comparing_threads() { ending_ = true; }

    bool finished_within(std::chrono::milliseconds time) {
        std::unique_lock lock(mutex_);
        return finished_.wait_for(lock, time, [&] { return working_ == 0; });
    }
    totals found() {
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
        while (!stop_ && !ending_) {
            const std::uint64_t block = next_++;
            if (block >= blocks_) break;
            try {
                totals part = compare_block(seed_, block, truth_, deciders_);
                const std::scoped_lock lock(mutex_);
                found_.add(block, std::move(part));
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

    std::uint64_t seed_, blocks_;
    const decider& truth_;
    std::span<const decider> deciders_;
    const std::atomic<bool>& stop_;
    std::atomic<bool> ending_ = false;
    std::atomic<std::uint64_t> next_;
    std::mutex mutex_;  // of all that follows
    std::condition_variable finished_;
    collector found_;
    std::exception_ptr failure_;
    unsigned working_ = 0;
    std::vector<std::jthread> threads_;  // joined before anything else goes
};

}  // namespace

std::string to_json(const state& s) {
    json all{{"seed", s.seed},
             {"blocks", s.found.blocks},
             {"seconds", s.seconds},
             {"differing_queries", s.found.differing_queries},
             {"families", json::array()},
             {"deciders", json::array()},
             {"differences", json::array()}};
    for (std::size_t f = 0; f < family_count; ++f) {
        json entry{{"name", families[f].name}, {"thinning", families[f].thinning}};
        for (std::size_t k = 0; k < ccd::stored_kinds.size(); ++k) {
            entry[std::string(short_name(ccd::stored_kinds[k]))] = {
                {"queries", s.found.families[k][f].queries},
                {"collisions", s.found.families[k][f].collisions}};
        }
        all["families"].push_back(std::move(entry));
    }
    for (const decider_counts& d : s.found.deciders) {
        all["deciders"].push_back(
            {{"name", d.name}, {"compared", d.compared}, {"differences", d.differences}});
    }
    for (const difference& d : s.found.differences) all["differences"].push_back(json_of(d));
    return all.dump(1) + "\n";
}

state from_json(const std::string& text) {
    try {
        const json all = json::parse(text);
        state s;
        s.seed = all.at("seed").get<std::uint64_t>();
        s.seconds = all.at("seconds").get<double>();
        s.found.blocks = whole(all.at("blocks"));
        s.found.differing_queries = whole(all.at("differing_queries"));
        const json& listed = all.at("families");
        for (std::size_t f = 0; f < family_count; ++f) {
            if (listed.size() != family_count || listed.at(f).at("name") != families[f].name ||
                listed.at(f).at("thinning") != families[f].thinning) {
                throw std::runtime_error("the run was of other families than this program has");
            }
            for (std::size_t k = 0; k < ccd::stored_kinds.size(); ++k) {
                const json& counts = listed.at(f).at(std::string(short_name(ccd::stored_kinds[k])));
                s.found.families[k][f] = {whole(counts.at("queries")),
                                          whole(counts.at("collisions"))};
            }
        }
        for (const json& d : all.at("deciders")) {
            s.found.deciders.push_back({d.at("name").get<std::string>(), whole(d.at("compared")),
                                        whole(d.at("differences"))});
        }
        for (const json& d : all.at("differences")) s.found.differences.push_back(difference_of(d));
        return s;
    } catch (const json::exception& error) {
        throw std::runtime_error(std::string("not the state of a run: ") + error.what());
    }
}

fs::path state_path(const fs::path& folder) {
    return folder / "state.json";
}

fs::path differences_path(const fs::path& folder, kind which) {
    return folder / ("differences-" + std::string(short_name(which)) + ".csv");
}

void save(const state& s, const fs::path& folder) {
    fs::create_directories(folder);
    for (const kind which : ccd::stored_kinds) {
        const std::string queries = differing_queries_csv(s.found, s.seed, which);
        if (queries.empty()) {
            fs::remove(differences_path(folder, which));
        } else {
            errbound::support::write_whole(differences_path(folder, which), queries);
        }
    }
    errbound::support::write_whole(state_path(folder), to_json(s));
}

state run(state from, const run_options& options, const decider& truth,
          std::span<const decider> deciders, const std::atomic<bool>& stop,
          const std::function<void(const state&)>& progress) {
    // A folder that cannot be written to is refused now, not in an hour.
    save(from, options.folder);
    const clock::time_point start = clock::now();
    comparing_threads threads(from, options, truth, deciders, stop);
    const auto now = [&] {
        return state{from.seed, threads.found(), from.seconds + seconds_since(start)};
    };
    clock::time_point saved = start;
    while (!threads.finished_within(std::chrono::milliseconds(100))) {
        const state current = now();
        if (seconds_since(saved) >= options.seconds_between_saves) {
            save(current, options.folder);
            saved = clock::now();
        }
        progress(current);
    }
    const state last = now();
    save(last, options.folder);
    threads.rethrow_failure();
    return last;
}

}  // namespace soak
