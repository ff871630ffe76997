#include <algorithm>
#include <ccd/certify.hpp>
#include <ccd/io/step_view.hpp>
#include <ccd/nearness.hpp>
#include <cmath>
#include <errbound/support/error.hpp>
#include <fstream>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "ccd/io/frame_sequence.hpp"
#include "ccd/io/text.hpp"
#include "ccd/program/command.hpp"
#include "ccd/program/first_pairs.hpp"
#include "ccd/program/options.hpp"
#include "ccd/program/pair_lines.hpp"
#include "errbound/support/output_file.hpp"
#include "errbound/support/progress_line.hpp"
#include "errbound/support/rows.hpp"
#include "errbound/support/table.hpp"

namespace ccd::program {
namespace {

using errbound::support::file_error;
using errbound::support::row;
using errbound::support::usage_error;

/// A line of the table. Step i is from frame i to frame i + 1. The first columns are counts; the
/// others are numbers, or null.
const std::vector<std::string> columns{"step", "crossing", "touching", "overlapping",   "contacts",
                                       "low",  "high",     "depth",    "least_distance"};
constexpr std::size_t counts = 5;

std::size_t count(const row& step, const std::string& column) {
    return step[column].get<std::size_t>();
}

bool is_free(const row& step) {
    return count(step, "crossing") + count(step, "touching") + count(step, "overlapping") +
               count(step, "contacts") ==
           0;
}

std::string heading() {
    return errbound::support::csv_of(columns, {});
}
std::string line_of(const row& step) {
    return errbound::support::csv_of(columns, {step}).substr(heading().size());
}

/// Reads a line that line_of wrote. Returns nothing for any other line.
std::optional<row> step_of(const std::string& line) {
    row step;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const std::size_t end = std::min(line.find_first_of(",\n", begin), line.size());
        const std::string field = line.substr(std::min(begin, line.size()), end - begin);
        const row value = field.empty() ? row() : row::parse(field, nullptr, false);
        if (i < counts ? !value.is_number_unsigned() : !value.is_null() && !value.is_number_float())
            return std::nullopt;
        step[columns[i]] = value;
        begin = end + 1;
    }
    if (line_of(step) != line) return std::nullopt;
    return step;
}

/// The steps in an earlier table, which are `first`, first + 1, ... Their lines, with the heading,
/// have `bytes`. A last line without its end, of a run that was killed, is no part of it.
struct earlier_table {
    errbound::support::rows steps = {};
    std::size_t bytes = 0;
};

earlier_table table_in(const std::filesystem::path& path, std::size_t first, std::size_t most) {
    std::string text = errbound::support::read_whole(path);
    const std::string name = path.string(), first_line = heading();
    if (first_line.starts_with(text) && text.size() < first_line.size()) return {};
    if (!text.starts_with(first_line))
        io::fail_at(name, 1,
                    "heading differs; expected " + first_line.substr(0, first_line.size() - 1));
    text.erase(text.rfind('\n') + 1);
    earlier_table table;
    errbound::support::rows& steps = table.steps;
    for (std::size_t at = first_line.size(); at < text.size();) {
        const std::size_t end = text.find('\n', at) + 1;
        const std::string line = text.substr(at, end - at);
        const auto step = step_of(line);
        if (!step || count(*step, "step") != first + steps.size())
            io::fail_at(name, steps.size() + 2,
                        "line is " + io::excerpt(line) + "; expected a whole line of step " +
                            std::to_string(first + steps.size()));
        steps.push_back(*step);
        at = end;
    }
    if (steps.size() > most)
        throw file_error(name + ": number of steps is " + std::to_string(steps.size()) +
                         "; expected at most " + std::to_string(most));
    table.bytes = text.size();
    return table;
}

class audit final : public command {
  public:
    explicit audit(CLI::App& program)
        : command(program, "audit", "Find contacts and intersections in a recorded simulation") {
        add(line_, "FRAME", paths_,
            "PLY or OBJ, a frame each; or .npy or .npz (numpy.savez, positions) of\n"
            "float32 or float64, shape (n, 3) or (frames, n, 3)")
            .required();
        add(line_, "--mesh", mesh_, "PLY or OBJ with the faces; by default the first FRAME")
            .type("FILE");
        add_range_options(line_, first_, count_,
                          "Skip the first N steps; step N is from frame N to N + 1",
                          "Audit at most N steps; all by default");
        add_output(line_, "--csv", csv_,
                   "Write a line for each step as soon as it is done; -: standard output");
        add_flag(line_, "--resume", resume_,
                 "Continue the table of --csv, if it exists, after its last step");
        add_output(line_, "--json", json_, "Write all steps as JSON; -: standard output");
        add(line_, "--view", view_,
            "Write a page for a browser with the first step that has contacts, else\n"
            "with the first that starts with intersections, else with the nearest pair")
            .ends_in(".html");
        add_replay_option(line_, replay_);
        add_triangulate_option(line_, reading_.triangulate);
        add_threads_option(line_, options_.threads);
    }

    exit_status run() override {
        check_options();
        const io::frame_sequence frames(paths_, mesh_, reading_);
        if (frames.size() < 2)
            throw usage_error("number of frames is " + std::to_string(frames.size()) +
                              "; expected at least 2");
        if (first_ > frames.size() - 2)
            throw usage_error("--first is " + std::to_string(first_) + "; expected 0 to " +
                              std::to_string(frames.size() - 2) + ", as there are " +
                              std::to_string(frames.size()) + " frames");
        const mesh& mesh = frames.topology();
        const std::size_t unused =
            unused_vertices(mesh.faces, mesh.edges, mesh.vertices.size()).size();
        options_.filter.skip_unused = unused_.skips(unused, mesh.vertices.size());
        stream_for_people() << text_of_unused(unused, mesh.vertices.size(),
                                              options_.filter.skip_unused)
                            << std::flush;
        mesh_steps steps(mesh);
        find_all(frames, steps);
        report(frames, steps);
        return std::ranges::all_of(found_, is_free) ? done : check_failed;
    }

  private:
    std::ostream& stream_for_people() const {
        return errbound::support::stream_for_people({csv_, json_});
    }

    void check_options() const {
        if (resume_ && (!csv_ || errbound::support::descriptor_of(*csv_)))
            throw usage_error("--resume is given without a file; expected --csv OUT");
        std::vector<std::optional<std::filesystem::path>> outputs = {csv_, json_, view_};
        if (replay_)
            for (auto& path : replay_paths(*replay_)) outputs.push_back(std::move(path));
        std::vector<std::filesystem::path> inputs = paths_;
        if (mesh_) inputs.push_back(*mesh_);
        errbound::support::require_good_outputs(outputs, inputs);
    }

    row audited(mesh_steps& steps, std::size_t index, const vertex_rows& positions) const {
        const certificate found = certify(steps, positions, options_);
        const auto& start = found.step.intersections_at_start;
        const first_time& contact = found.step.first_contact;
        const double depth = found.deepest().depth;
        const double least =
            least_distance(steps, positions,
                           {.threads = options_.threads, .filter = options_.filter})
                .low;
        const auto or_null = [](bool known, double x) { return known ? row(x) : row(); };
        const bool collides = contact.outcome == outcome::collides;
        return {{"step", index},
                {"crossing", number_of(start, errbound::relation::crossing)},
                // A face or rod of size 0 touches without intersecting, and may then pass.
                {"touching", start.empty() ? number_of(found.step.touching_at_start)
                                           : number_of(start, errbound::relation::touching)},
                {"overlapping", number_of(start, errbound::relation::overlapping)},
                {"contacts", found.contacts()},
                {"low", or_null(collides, contact.low)},
                {"high", or_null(collides, contact.high)},
                {"depth", or_null(std::isfinite(found.deepest().depth_error), depth)},
                {"least_distance", or_null(std::isfinite(least), least)}};
    }

    /// Fills found_, and writes the lines of the table. The last step of an earlier table is
    /// repeated, since a table of other frames differs there.
    void find_all(const io::frame_sequence& frames, mesh_steps& steps) {
        const std::size_t count = std::min<std::uint64_t>(count_, frames.size() - 1 - first_);
        std::ofstream file;
        std::error_code ignored;
        earlier_table earlier;
        if (resume_ && std::filesystem::exists(*csv_, ignored))
            earlier = table_in(*csv_, first_, count);
        if (csv_ && earlier.bytes == 0) errbound::support::write_whole(*csv_, heading());
        found_ = std::move(earlier.steps);
        const bool to_output = csv_ && errbound::support::descriptor_of(*csv_) == 1;
        if (csv_ && !to_output) file.open(*csv_, std::ios::binary | std::ios::app);
        std::ostream& table = to_output ? std::cout : file;

        errbound::support::progress_line progress;
        const std::size_t known = found_.size(), begin = known > 0 ? known - 1 : 0;
        std::vector<point<double>> before, after = frames.positions(first_ + begin);
        for (std::size_t i = begin; i < count; ++i) {
            const std::size_t index = first_ + i;
            progress.show(i, count, frames.name(index));
            before = std::exchange(after, frames.positions(index + 1));
            const row step = audited(steps, index, vertex_rows(before, after));
            const std::string line = line_of(step);
            if (i < known) {
                if (line != line_of(found_[i]))
                    io::fail_at(csv_->string(), known + 1,
                                "step " + std::to_string(index) +
                                    " differs from these frames; expected a table of them");
                continue;
            }
            if (earlier.bytes > 0) std::filesystem::resize_file(*csv_, earlier.bytes);
            earlier.bytes = 0;
            if (csv_ && !(table << line << std::flush))
                throw file_error(csv_->string() + ": writing failed");
            found_.push_back(step);
        }
    }

    /// The step of the page and of the first pairs.
    const row& shown() const {
        const auto with_contacts =
            std::ranges::find_if(found_, [](const row& s) { return s["contacts"] != 0; });
        if (with_contacts != found_.end()) return *with_contacts;
        const auto with_any = std::ranges::find_if_not(found_, is_free);
        if (with_any != found_.end()) return *with_any;
        return *std::ranges::min_element(found_, {}, [](const row& s) {
            return s["least_distance"].is_null() ? std::numeric_limits<double>::infinity()
                                                 : s["least_distance"].get<double>();
        });
    }

    void report(const io::frame_sequence& frames, mesh_steps& steps) const {
        const row& one = shown();
        const auto index = count(one, "step");
        std::vector<reason> first;
        pair_lists first_pairs;
        std::vector<errbound::support::output> outputs;
        if (one["contacts"] != 0 || view_) {
            const auto before = frames.positions(index), after = frames.positions(index + 1);
            const vertex_rows positions(before, after);
            const certificate again = certify(steps, positions, options_);
            first_pairs = again.step.first_pairs;
            first = reasons(positions, first_pairs, again.step.first_contact);
            if (view_)
                outputs.push_back(
                    {*view_, io::page_of({positions, frames.topology().faces,
                                          frames.topology().edges, again.step.pairs,
                                          again.step.times, again.step.intersections_at_start})});
            if (replay_)
                for (auto& file : replay_files(*replay_, positions, first_pairs))
                    outputs.push_back(std::move(file));
        }
        if (json_)
            outputs.push_back({*json_, errbound::support::json_of(json_of(first), 2) + '\n'});
        write_whole(outputs);
        stream_for_people() << text_of_steps() << text_of_reasons(first);
        if (replay_) stream_for_people() << text_of_replay(*replay_, first_pairs);
    }

    row json_of(const std::vector<reason>& first) const {
        row all = {{"free", std::ranges::all_of(found_, is_free)},
                   {"shown", shown()["step"]},
                   {"first_pairs", json_of_reasons(first)},
                   {"steps", found_}};
        return all;
    }

    /// All steps if they are few, otherwise those that are not free.
    std::string text_of_steps() const {
        constexpr std::size_t most = 40;
        errbound::support::rows rows;
        std::size_t not_free = 0;
        for (const row& step : found_) {
            not_free += !is_free(step);
            if ((found_.size() <= most || !is_free(step)) && rows.size() < most)
                rows.push_back(step);
        }
        std::string text = errbound::support::text_of(rows);
        if (found_.size() > most && not_free > most)
            text += "and " + std::to_string(not_free - most) + " more steps\n";
        return text + (rows.empty() ? "" : "\n") + std::to_string(found_.size() - not_free) +
               " of " + std::to_string(found_.size()) + " steps are free\n";
    }

    std::vector<std::filesystem::path> paths_;
    std::optional<std::filesystem::path> mesh_, csv_, json_, view_, replay_;
    std::uint64_t first_ = 0, count_ = std::numeric_limits<std::uint64_t>::max();
    bool resume_ = false;
    io::mesh_options reading_;
    step_options options_;
    errbound::support::rows found_;
    unused_vertices_option unused_{line_};
};

}  // namespace

const command_maker audit_command = make_command<audit>;

}  // namespace ccd::program
