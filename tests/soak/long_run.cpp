#include "tests/soak/long_run.hpp"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "ccd/lab/tables.hpp"
#include "ccd/lab/timing.hpp"
#include "errbound/support/ordered_blocks.hpp"
#include "errbound/support/output_file.hpp"

namespace soak {

using nlohmann::json;

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(count_table::row, name, counts);
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(count_table, title, columns, largest, rows);
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(difference, text, file, lines);
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(findings, blocks, tables, different, differences, checksum);

namespace {

namespace fs = std::filesystem;
using ccd::lab::clock, ccd::lab::seconds_since;

ccd::lab::row dependencies_of(const part& of) {
    return {{"part", of.name}, {"version", of.version}};
}

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
    all.update({{"seed", s.seed}, {"first", s.first}, {"seconds", s.seconds}});
    return ccd::lab::kept_text(dependencies_of(of), all);
}

state from_json(const std::string& text, const part& of) {
    const auto kept = ccd::lab::kept_value(text, dependencies_of(of));
    if (!kept) throw std::runtime_error("the file is not the state of a run of these questions");
    try {
        const json all = *kept;
        return {all.at("seed").get<std::uint64_t>(), all.at("first").get<std::uint64_t>(),
                all.get<findings>(), all.at("seconds").get<double>()};
    } catch (const json::exception& error) {
        throw std::runtime_error(std::string("the file is not the state of a run: ") +
                                 error.what());
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
    const std::uint64_t first = what.blocks_for(from.first);
    findings sum = from.found;
    const auto now = [&] {
        return state{from.seed, from.first, sum, from.seconds + seconds_since(start)};
    };
    clock::time_point saved = start;
    const auto merge = [&](const findings& next) {
        sum.add(next);
        const state current = now();
        if (seconds_since(saved) >= options.seconds_between_saves) {
            save(current, what, options.folder);
            saved = clock::now();
        }
        show(current);
    };
    const auto save_last = [&] {
        const state last = now();
        save(last, what, options.folder);
        return last;
    };
    try {
        errbound::support::merge_in_order(
            sum.blocks, options.blocks, options.threads,
            [&](std::uint64_t block) { return what.compare_block(from.seed, first + block); },
            merge, stop);
    } catch (...) {
        save_last();
        throw;
    }
    return save_last();
}

}  // namespace soak
