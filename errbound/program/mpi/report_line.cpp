// A report as a line of JSON: arrays, without names of members, since journals have many of them.
#include "errbound/program/mpi/report_line.hpp"

#include <nlohmann/json.hpp>
#include <tuple>
#include <utility>

namespace errbound::validation {
namespace {

using nlohmann::json;

// What is written of an entry, in order: for both ways.
auto members(rule_counts& c) {
    return std::tie(c.rule, c.number, c.cases, c.values, c.violations, c.undetermined);
}
auto members(violation& v) {
    return std::tie(v.rule, v.number, v.index, v.what, v.code);
}
auto members(tightness& t, distribution::counts& c) {
    return std::tie(t.rule, t.number, t.quantity, t.measure, t.claimed, c.exact, c.unknown,
                    c.covered, c.first_bin, c.bins, c.least, c.most);
}
json packed(const function_errors& f) {
    return {f.function, f.number, f.arguments, f.largest, f.at, f.assumed, f.violations};
}

template <class... Members>
json array_of(const std::tuple<Members&...>& members) {
    return std::apply([](const auto&... m) { return json::array({m...}); }, members);
}
template <class... Members>
void read_array(const json& from, const std::tuple<Members&...>& members) {
    std::size_t i = 0;
    std::apply([&](auto&... m) { (from.at(i++).get_to(m), ...); }, members);
}

template <class Entry>
json packed(Entry entry) {
    return array_of(members(entry));
}
json packed(tightness entry) {
    distribution::counts counts = entry.log10.stored();
    return array_of(members(entry, counts));
}

template <class Entry>
void unpack(const json& from, Entry& entry) {
    read_array(from, members(entry));
}
void unpack(const json& from, tightness& entry) {
    distribution::counts counts;
    read_array(from, members(entry, counts));
    entry.log10 = distribution(std::move(counts));
}
void unpack(const json& from, function_errors& f) {
    from.at(0).get_to(f.function);
    from.at(1).get_to(f.number);
    from.at(2).get_to(f.arguments);
    from.at(3).get_to(f.largest);
    from.at(4).get_to(f.at);
    from.at(5).get_to(f.assumed);
    from.at(6).get_to(f.violations);
}

template <class Entry>
json all_packed(const std::vector<Entry>& entries) {
    json all = json::array();
    for (const Entry& e : entries) all.push_back(packed(e));
    return all;
}
template <class Entry>
void unpack_all(const json& from, std::vector<Entry>& entries) {
    entries.resize(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) unpack(from[i], entries[i]);
}

}  // namespace

std::string report_line(const report& found) {
    const json all = {all_packed(found.counts), all_packed(found.violations),
                      all_packed(found.distributions), all_packed(found.functions)};
    return all.dump(-1, ' ', true, json::error_handler_t::replace);
}

report report_from(const std::string& line) {
    const json all = json::parse(line);
    report found;
    unpack_all(all.at(0), found.counts);
    unpack_all(all.at(1), found.violations);
    unpack_all(all.at(2), found.distributions);
    unpack_all(all.at(3), found.functions);
    return found;
}

}  // namespace errbound::validation
