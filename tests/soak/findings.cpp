#include "tests/soak/findings.hpp"

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <utility>

namespace soak {

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
                std::ranges::transform(counts, into[name], into[name].begin(), std::plus());
        }
    different += next.different;
    for (const difference& d : next.differences)
        if (differences.size() < max_kept) differences.push_back(d);
    stir(next.checksum);
}

void collector::add(std::uint64_t block, findings found) {
    waiting_.emplace(block, std::move(found));
    for (auto next = waiting_.find(sum_.blocks); next != waiting_.end();
         next = waiting_.find(sum_.blocks)) {
        sum_.add(next->second);
        waiting_.erase(next);
    }
}

}  // namespace soak
