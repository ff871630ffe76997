#include "ccd/report/tasks.hpp"

#include <utility>

namespace ccd::report {

task_list::task_list(const options& settings, const machine& here)
    : settings_(settings),
      size_(sizes(settings.quick)),
      program_({{"program", program_fingerprint()},
                {"commit", settings.commit},
                {"processor", here.processor}}) {
    for (const std::string& name : settings.methods) {
        if (name != batch_name) singly_.push_back(name);
    }
}

void task_list::add(std::string name, row depends_on, double cost, row about,
                    std::function<rows(const progress&)> measure, rows& into) {
    row all = program_;
    all.update(depends_on);
    tasks.push_back(
        {{std::move(name), std::move(all)}, cost, std::move(about), std::move(measure), &into});
}

void task_list::add(const data_set& data) {
    data_.push_back(&data);
    data.queries.for_each([&](const auto& known) { add(data, known); });
}

void task_list::add_part(const part_of& part, const std::string& what, row depends_on, double cost,
                         std::function<rows(const progress&)> measure, rows& into) {
    depends_on["data"] = part.data.fingerprint;
    add(part.data.name + " " + std::string(short_name(part.kind)) + ": " + what,
        std::move(depends_on), cost,
        {{"data_set", part.data.name},
         {"origin", name(part.data.origin)},
         {"kind", short_name(part.kind)}},
        std::move(measure), into);
}

template <class Query>
void task_list::add_methods(const part_of& part, const queries_with_truth<Query>& known) {
    const std::size_t n = known.queries.size();
    for (const std::string& method : settings_.methods) {
        add_part(
            part, "errors of " + method, {{"method", method}}, static_cast<double>(n) / 2,
            [&known, method, this](const progress& show) {
                return count_errors(known, method, settings_.threads, show);
            },
            errors);
    }
    add_part(
        part, "ns per query",
        {{"methods", settings_.methods}, {"at_most", size_.speed}, {"repeats", size_.repeats}},
        static_cast<double>(std::min(n, size_.speed) * settings_.methods.size()) *
            (1 + size_.repeats),
        [&known, this](const progress& show) {
            return race_methods(known, settings_.methods, size_, show);
        },
        speeds);
}

template <class Query>
void task_list::add(const data_set& data, const queries_with_truth<Query>& known) {
    const std::size_t n = known.queries.size();
    if (n == 0) return;
    const part_of part{data, kind_of<Query>};
    const auto drawn = [n](std::size_t limit) { return static_cast<double>(std::min(n, limit)); };

    if (settings_.wants("methods")) add_methods(part, known);
    if (settings_.wants("times")) {
        add_part(
            part, "times of single queries",
            {{"methods", singly_}, {"at_most", size_.times}, {"repeats", size_.repeats}},
            drawn(size_.times) * static_cast<double>(singly_.size()) * size_.repeats,
            [&known, this](const progress& show) {
                return time_queries(known, singly_, size_, show);
            },
            times);
    }
    if (settings_.wants("contacts")) {
        add_part(
            part, "first contacts",
            {{"at_most", size_.speed}, {"contacts", size_.times}, {"repeats", size_.repeats}},
            static_cast<double>(n) / 10 + 4.0 * drawn(size_.speed) * (1 + size_.repeats),
            [&known, this](const progress& show) {
                return find_contacts(known.queries, size_, settings_.threads, show);
            },
            contacts);
    }
    if (settings_.wants("bounds")) {
        add_part(
            part, "bounds", {{"at_most", size_.bounds}}, drawn(size_.bounds),
            [&known, this](const progress&) { return take_bounds(known, size_); }, bounds);
    }
}

void task_list::add_others() {
    if (settings_.wants("tightness")) add_tightness();
    for (const stress::family& family : stress::families()) {
        if (settings_.wants("contacts") && family.finite) add_contacts(family);
    }
    for (const stress::family& family : stress::families()) {
        if (settings_.wants("stress")) add_methods(family);
    }
}

void task_list::add_tightness() {
#ifdef ERRBOUND_HAVE_MPFR
    add(
        "tightness: expressions", {{"number", size_.expressions}},
        20.0 * static_cast<double>(size_.expressions), {{"part", "expressions"}},
        [this](const progress& show) {
            return measure_expressions(size_, settings_.threads, show);
        },
        tightness);
    row all = row::array();
    for (const data_set* data : data_) all.push_back(data->fingerprint);
    add(
        "tightness: queries", {{"data", all}, {"at_most", size_.tightness}},
        2000.0 * static_cast<double>(size_.tightness * data_.size()), {{"part", "queries"}},
        [this](const progress& show) {
            return measure_tightness(data_, size_, settings_.threads, show);
        },
        tightness);
#endif
}

void task_list::add_contacts(const stress::family& family) {
    add(
        "first contacts of stress: " + std::string(family.name),
        {{"queries", size_.stress_queries}, {"repeats", size_.repeats}},
        20.0 * static_cast<double>(size_.stress_queries * family.knobs.size()) * size_.repeats,
        {{"data_set", family.name}, {"origin", "stress"}},
        [&family, this](const progress& show) {
            return find_contacts(family, size_, settings_.threads, show);
        },
        contacts);
}

void task_list::add_methods(const stress::family& family) {
    const auto knobs = static_cast<double>(family.knobs.size());
    const auto methods = static_cast<double>(settings_.methods.size());
    add(
        "stress: " + std::string(family.name),
        {{"methods", settings_.methods}, {"quick", settings_.quick}},
        2e6 * size_.stress_seconds * knobs * (methods + 1),
        {{"family", family.name}, {"knob_name", family.knob_name}},
        [&family, this](const progress& show) {
            return stress_methods(family, settings_.methods, size_, settings_.threads, show);
        },
        stress);
}

}  // namespace ccd::report
