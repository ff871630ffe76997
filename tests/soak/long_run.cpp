#include "tests/soak/long_run.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "errbound/support/ordered_blocks.hpp"
#include "errbound/support/output_file.hpp"

namespace soak {

namespace fs = std::filesystem;
using namespace std::string_view_literals;

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

bool findings::have(std::string_view fault) const {
    return std::ranges::any_of(differences, [fault](const difference& d) {
        return d.text.find(fault) != std::string::npos && d.text.find("0x1") != std::string::npos;
    });
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

namespace {

constexpr std::array own_files{"differences.txt"sv, "differences-vf.csv"sv, "differences-ee.csv"sv};

/// Writes the files of differences, and removes those of an earlier run.
void save(const std::vector<difference>& differences, const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const difference& d : differences) {
        files["differences.txt"] += d.text + "\n";
        if (!d.file.empty()) files[d.file] += d.lines;
    }
    for (const auto& entry : fs::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (std::ranges::find(own_files, name) != own_files.end() && !files.contains(name))
            fs::remove(entry.path());
    }
    for (const auto& [name, lines] : files) errbound::support::write_whole(folder / name, lines);
}

}  // namespace

findings run(const run_options& options, const part& what, const std::atomic<int>& stop,
             const std::function<void(const findings&)>& show) {
    fs::create_directories(options.folder);
    // A folder that cannot be written to is refused now, not in an hour.
    errbound::support::write_whole(options.folder / "differences.txt", "");
    findings sum;
    const auto merge = [&](const findings& next) {
        const std::size_t saved = sum.differences.size();
        sum.add(next);
        if (sum.differences.size() > saved) save(sum.differences, options.folder);
        show(sum);
    };
    errbound::support::merge_in_order(
        options.first, options.end, options.threads,
        [&](std::uint64_t block) { return what.compare_block(options.seed, block); }, merge, stop);
    save(sum.differences, options.folder);
    return sum;
}

}  // namespace soak
