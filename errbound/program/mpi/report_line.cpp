// A report as a line of JSON: arrays, without names of members, since journals have many of them.
#include "errbound/program/mpi/report_line.hpp"

#include <nlohmann/json.hpp>
#include <utility>

namespace errbound::validation {
namespace {

using nlohmann::json;

json packed(const rule_counts& c) {
    return {c.rule, c.number, c.cases, c.values, c.violations, c.undetermined};
}
json packed(const violation& v) {
    return {v.rule, v.number, v.index, v.what, v.code};
}
json packed(const tightness& t) {
    const distribution::counts& c = t.log10.stored();
    return {t.rule,    t.number,    t.quantity, t.measure, c.exact,
            c.unknown, c.first_bin, c.bins,     c.least,   c.most};
}

void unpack(const json& from, rule_counts& c) {
    from.at(0).get_to(c.rule);
    from.at(1).get_to(c.number);
    from.at(2).get_to(c.cases);
    from.at(3).get_to(c.values);
    from.at(4).get_to(c.violations);
    from.at(5).get_to(c.undetermined);
}
void unpack(const json& from, violation& v) {
    from.at(0).get_to(v.rule);
    from.at(1).get_to(v.number);
    from.at(2).get_to(v.index);
    from.at(3).get_to(v.what);
    from.at(4).get_to(v.code);
}
void unpack(const json& from, tightness& t) {
    from.at(0).get_to(t.rule);
    from.at(1).get_to(t.number);
    from.at(2).get_to(t.quantity);
    from.at(3).get_to(t.measure);
    distribution::counts c;
    from.at(4).get_to(c.exact);
    from.at(5).get_to(c.unknown);
    from.at(6).get_to(c.first_bin);
    from.at(7).get_to(c.bins);
    from.at(8).get_to(c.least);
    from.at(9).get_to(c.most);
    t.log10 = distribution(std::move(c));
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
                      all_packed(found.distributions)};
    return all.dump(-1, ' ', true, json::error_handler_t::replace);
}

report report_from(const std::string& line) {
    const json all = json::parse(line);
    report found;
    unpack_all(all.at(0), found.counts);
    unpack_all(all.at(1), found.violations);
    unpack_all(all.at(2), found.distributions);
    return found;
}

}  // namespace errbound::validation
