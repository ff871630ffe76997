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
        for (std::size_t k = 0; k < std::size(kinds); ++k) {
            entry[std::string(short_name(kinds[k]))] = {
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
            for (std::size_t k = 0; k < std::size(kinds); ++k) {
                const json& counts = listed.at(f).at(std::string(short_name(kinds[k])));
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
    for (const kind which : kinds) {
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
    save(from,
         options.folder);  // a folder that cannot be written to is refused now, not in an hour
    const clock::time_point start = clock::now();
    const std::uint64_t seed = from.seed;
    std::mutex mutex;  // of all that follows, but `next` and `failed`
    std::condition_variable finished;
    collector found(from.found);
    std::exception_ptr failure;
    const unsigned threads =
        options.threads > 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
    unsigned working = threads;
    std::atomic<std::uint64_t> next = from.found.blocks;
    std::atomic<bool> failed = false;

    std::vector<std::jthread> workers;
    for (unsigned i = 0; i < threads; ++i) {
        workers.emplace_back([&] {
            // Stopping only between blocks, all that are begun are finished, so none is lost.
            while (!stop && !failed) {
                const std::uint64_t block = next++;
                if (block >= options.blocks) break;
                try {
                    totals part = compare_block(seed, block, truth, deciders);
                    const std::scoped_lock lock(mutex);
                    found.add(block, std::move(part));
                } catch (...) {
                    failed = true;
                    const std::scoped_lock lock(mutex);
                    failure = std::current_exception();
                }
            }
            const std::scoped_lock lock(mutex);
            --working;
            finished.notify_all();
        });
    }

    const auto now = [&] { return state{seed, found.sum(), from.seconds + seconds_since(start)}; };
    clock::time_point saved = start;
    std::unique_lock lock(mutex);
    while (!finished.wait_for(lock, std::chrono::milliseconds(100), [&] { return working == 0; })) {
        const state current = now();
        lock.unlock();
        if (seconds_since(saved) >= options.seconds_between_saves) {
            try {
                save(current, options.folder);
            } catch (...) {
                failed = true;  // the workers, which must end before this does
                throw;
            }
            saved = clock::now();
        }
        progress(current);
        lock.lock();
    }
    const state last = now();
    save(last, options.folder);
    if (failure) std::rethrow_exception(failure);
    return last;
}

}  // namespace soak
