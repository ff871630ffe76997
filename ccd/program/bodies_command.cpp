#include <algorithm>
#include <ccd/bodies/steps.hpp>
#include <ccd/io/step_view.hpp>
#include <cstdint>
#include <iostream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ccd/io/body_scene.hpp"
#include "ccd/program/command.hpp"
#include "ccd/program/options.hpp"
#include "ccd/program/pair_lines.hpp"
#include "errbound/support/command_line.hpp"
#include "errbound/support/output_file.hpp"
#include "errbound/support/progress_line.hpp"
#include "errbound/support/rows.hpp"

namespace ccd::program {
namespace {

using errbound::support::row;
using errbound::support::usage_error;

/// The pairs of elements of two bodies that touch in a step, and those that cross at its start.
struct meeting {
    first_time first;  ///< the earliest
    std::size_t at_start = 0, crossing = 0;
    pair_counts pairs;
};

struct decided_step {
    std::size_t index = 0;
    body_step_result found;
    std::map<std::pair<std::size_t, std::size_t>, meeting> meetings;  ///< by bodies

    bool is_after_start() const { return found.first_contact.outcome == outcome::collides; }
};

std::map<std::pair<std::size_t, std::size_t>, meeting> meetings_of(const body_steps& steps,
                                                                   const body_step_result& found) {
    std::map<std::pair<std::size_t, std::size_t>, meeting> all;
    for_each_kind([&]<kind K>() {
        const auto& pairs = found.pairs.of<K>();
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const auto& vertices = vertices_of(pairs[i]);
            const std::size_t a = steps.body_of(vertices.front()),
                              b = steps.body_of(vertices.back());
            const first_time& time = found.times.of<K>()[i];
            meeting& both = all[{std::min(a, b), std::max(a, b)}];
            if (both.first.outcome != outcome::collides ||
                std::pair(time.low, time.high) < std::pair(both.first.low, both.first.high))
                both.first = time;
            both.at_start += time.at_start();
            ++both.pairs.of<K>();
        }
    });
    for (const auto& [e, f] : found.crossing_at_start) {
        meeting& both = all[std::minmax(steps.body_of(e[0]), steps.body_of(f[0]))];
        both.first = {outcome::collides, 0, 0};
        ++both.crossing;
    }
    return all;
}

nlohmann::ordered_json bracket_of(const first_time& time) {
    if (time.outcome != outcome::collides) return nullptr;
    return {time.low, time.high};
}

class bodies final : public command {
  public:
    explicit bodies(CLI::App& program)
        : command(program, "bodies",
                  "Find the contacts of bodies that move and turn. Two bodies whose poses do not "
                  "change in a step\nare not tested in it") {
        add(line_, "SCENE", path_, "JSON with the bodies' meshes and poses").required();
        add_range_options(line_, first_, count_,
                          "Skip the first N steps; step N is from frame N to N + 1",
                          "Decide at most N steps; all by default");
        add_output(line_, "--csv", csv_,
                   "Write a line for each step and each two bodies that touch in it;\n"
                   "-: standard output");
        add_output(line_, "--pairs", pairs_,
                   "Write lines STEP,vf,v,f0,f1,f2,low,high (also ee, ve, vv) of the pairs of\n"
                   "elements that touch, and STEP,ef,e0,e1,f0,f1,f2 of edges that cross faces\n"
                   "at the start. Vertices are numbered consecutively over all bodies;\n"
                   "-: standard output");
        add_output(line_, "--json", json_, "Write all steps as JSON; -: standard output");
        add(line_, "--view", view_,
            "Write a page for a browser with the first step that has new contacts,\n"
            "else with the first that has any, else with the first")
            .ends_in(".html");
        add_triangulate_option(line_, reading_.triangulate);
        add_threads_option(line_, options_.threads);
        options_.check_start = true;
        add_flag(line_, "!--no-check-start", options_.check_start,
                 "Do not look for edges that cross faces at a step's start");
    }

    exit_status run() override {
        options_.distance = {separation_.value(0, std::numeric_limits<double>::max())};
        const std::vector outputs{csv_, pairs_, json_, view_};
        errbound::support::require_good_outputs(outputs, {path_});
        scene_ = io::read_body_scene(path_, reading_);
        errbound::support::require_good_outputs(outputs, scene_.mesh_files);
        if (first_ >= scene_.steps.size())
            throw usage_error("--first is " + std::to_string(first_) + "; expected 0 to " +
                              std::to_string(scene_.steps.size() - 1) + ", as there are " +
                              std::to_string(scene_.times.size()) + " frames");
        options_.may_touch = [this](std::size_t a, std::size_t b) {
            return scene_.may_touch(a, b);
        };
        body_steps steps(std::move(scene_.meshes));
        decide_all(steps);
        write(steps);
        errbound::support::stream_for_people({csv_, pairs_, json_}) << text();
        const bool free = std::ranges::all_of(
            steps_, [](const decided_step& step) { return step.meetings.empty(); });
        return free ? done : check_failed;
    }

  private:
    void decide_all(body_steps& steps) {
        const std::size_t count = std::min<std::uint64_t>(count_, scene_.steps.size() - first_);
        errbound::support::progress_line progress;
        for (std::size_t i = 0; i < count; ++i) {
            progress.show(i, count, "step " + std::to_string(first_ + i));
            decided_step& step = steps_.emplace_back();
            step.index = first_ + i;
            step.found = steps.run(scene_.steps[step.index], options_);
            step.meetings = meetings_of(steps, step.found);
        }
    }

    /// A lower bound of a time of a step, in the scene's times.
    double scene_time(std::size_t step, const first_time& time) const {
        return detail::time_between(scene_.times[step], scene_.times[step + 1], time.low).first;
    }

    /// A line for each two bodies that touch.
    errbound::support::rows rows_of(const decided_step& step) const {
        errbound::support::rows all;
        for (const auto& [bodies, meeting] : step.meetings) {
            const auto& found = meeting;  // clang 14 captures no structured binding
            row& line = all.emplace_back(row{{"step", step.index},
                                             {"body_a", scene_.names[bodies.first]},
                                             {"body_b", scene_.names[bodies.second]},
                                             {"time", scene_time(step.index, found.first)},
                                             {"low", found.first.low},
                                             {"high", found.first.high},
                                             {"touching_at_start", found.at_start},
                                             {"crossing_at_start", found.crossing}});
            for_each_kind([&]<kind K>() { line[std::string(name(K))] = found.pairs.of<K>(); });
        }
        return all;
    }

    std::string text() const {
        constexpr std::size_t most = 40;
        errbound::support::rows rows;
        std::size_t free = 0, lines = 0;
        for (const decided_step& step : steps_) {
            free += step.meetings.empty();
            for (row& line : rows_of(step)) {
                if (lines++ >= most) continue;
                line["time"] = errbound::support::fixed(line["time"].get<double>(), "%.6g");
                rows.push_back(std::move(line));
            }
        }
        std::string text = errbound::support::text_of(rows);
        if (lines > most) text += "and " + std::to_string(lines - most) + " more\n";
        return text + (rows.empty() ? "" : "\n") + std::to_string(free) + " of " +
               std::to_string(steps_.size()) + " steps are free of contact\n";
    }

    std::string csv() const {
        errbound::support::rows all;
        for (const decided_step& step : steps_)
            for (row& line : rows_of(step)) all.push_back(std::move(line));
        std::vector<std::string> columns = {"step",
                                            "body_a",
                                            "body_b",
                                            "time",
                                            "low",
                                            "high",
                                            "touching_at_start",
                                            "crossing_at_start"};
        for_each_kind([&]<kind K>() { columns.emplace_back(name(K)); });
        return errbound::support::csv_of(columns, all);
    }

    std::string lines() const {
        std::string all;
        for (const decided_step& step : steps_) {
            const std::string of_step = lines_of_pairs(step.found.pairs, &step.found.times) +
                                        lines_of_edge_faces(step.found.crossing_at_start);
            for (std::size_t at = 0; at < of_step.size();) {
                const std::size_t end = of_step.find('\n', at) + 1;
                all += std::to_string(step.index) + ',' + of_step.substr(at, end - at);
                at = end;
            }
        }
        return all;
    }

    std::string json() const {
        row document = {{"bodies", scene_.names}, {"steps", row::array()}};
        for (const decided_step& step : steps_) {
            row one = {{"step", step.index},
                       {"from", scene_.times[step.index]},
                       {"to", scene_.times[step.index + 1]},
                       {"body_pairs", step.found.body_pairs},
                       {"candidates", row::object()},
                       {"first_contact", bracket_of(step.found.first_contact)},
                       {"contacts", rows_of(step)}};
            for_each_kind([&]<kind K>() {
                one["candidates"][std::string(name(K))] = step.found.candidates.of<K>();
            });
            document["steps"].push_back(std::move(one));
        }
        return errbound::support::json_of(document, 2) + '\n';
    }

    const decided_step& shown() const {
        auto found = std::ranges::find_if(steps_, &decided_step::is_after_start);
        if (found == steps_.end())
            found = std::ranges::find_if(
                steps_, [](const decided_step& step) { return !step.meetings.empty(); });
        return found == steps_.end() ? steps_.front() : *found;
    }

    void write(const body_steps& steps) const {
        std::vector<errbound::support::output> outputs;
        if (csv_) outputs.push_back({*csv_, csv()});
        if (pairs_) outputs.push_back({*pairs_, lines()});
        if (json_) outputs.push_back({*json_, json()});
        if (view_) {
            const decided_step& step = shown();
            outputs.push_back({*view_, io::page_of(steps, scene_.steps[step.index], step.found)});
        }
        write_whole(outputs);
    }

    std::filesystem::path path_;
    std::optional<std::filesystem::path> csv_, pairs_, json_, view_;
    std::uint64_t first_ = 0, count_ = std::numeric_limits<std::uint64_t>::max();
    io::mesh_options reading_;
    body_step_options options_;
    number_option separation_{line_, "--separation",
                              "Report pairs that come within NUMBER instead of contacts"};
    io::body_scene scene_;
    std::vector<decided_step> steps_;
};

}  // namespace

std::unique_ptr<command> bodies_command(CLI::App& program) {
    return std::make_unique<bodies>(program);
}

}  // namespace ccd::program
