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

/// One line of the table. Step i is from frame i to frame i + 1.
struct audited_step {
    std::size_t index = 0, crossing = 0, touching = 0, overlapping = 0, contacts = 0;
    std::optional<double> low, high, depth, least_distance;

    bool is_free() const { return crossing + touching + overlapping + contacts == 0; }
};

/// Calls visit(name, member) for each column.
template <class Step, class Visit>
void for_each_column(Step& step, const Visit& visit) {
    visit("step", step.index);
    visit("crossing", step.crossing);
    visit("touching", step.touching);
    visit("overlapping", step.overlapping);
    visit("contacts", step.contacts);
    visit("low", step.low);
    visit("high", step.high);
    visit("depth", step.depth);
    visit("least_distance", step.least_distance);
}

row row_of(const audited_step& step) {
    row all;
    for_each_column(step, [&]<class Value>(const char* name, const Value& value) {
        if constexpr (std::is_same_v<Value, std::size_t>)
            all[name] = value;
        else
            all[name] = value ? row(*value) : row(nullptr);
    });
    return all;
}

/// The heading and the line of the table.
std::pair<std::string, std::string> lines_of(const audited_step& step) {
    const row values = row_of(step);
    const std::string both =
        errbound::support::csv_of(errbound::support::columns_of({values}), {values});
    const std::size_t end = both.find('\n') + 1;
    return {both.substr(0, end), both.substr(end)};
}

/// Reads a line that lines_of wrote. Returns nothing for any other line.
std::optional<audited_step> step_of(const std::string& line) {
    audited_step step;
    std::size_t begin = 0;
    bool good = true;
    for_each_column(step, [&]<class Value>(const char*, Value& value) {
        const std::size_t end = std::min(line.find_first_of(",\n", begin), line.size());
        const std::string field = line.substr(std::min(begin, line.size()), end - begin);
        begin = end + 1;
        if constexpr (std::is_same_v<Value, std::size_t>) {
            const row number = row::parse(field, nullptr, false);
            good = good && number.is_number_unsigned();
            if (good) value = number.template get<std::size_t>();
        } else if (!field.empty()) {
            const io::number number = io::parse_double(field, false);
            good = good && number.status == io::number_status::ok;
            value = number.value;
        }
    });
    if (!good || lines_of(step).second != line) return std::nullopt;
    return step;
}

/// The steps in an earlier table, which are `first`, first + 1, ... Their lines, with the heading,
/// have `bytes`. A last line without its end, of a run that was killed, is no part of it.
struct earlier_table {
    std::vector<audited_step> steps = {};
    std::size_t bytes = 0;
};

earlier_table table_in(const std::filesystem::path& path, std::size_t first, std::size_t most) {
    std::string text = errbound::support::read_whole(path);
    const std::string name = path.string(), heading = lines_of({}).first;
    if (heading.starts_with(text) && text.size() < heading.size()) return {};
    if (!text.starts_with(heading))
        io::fail_at(name, 1, "heading differs; expected " + heading.substr(0, heading.size() - 1));
    text.erase(text.rfind('\n') + 1);
    earlier_table table;
    std::vector<audited_step>& steps = table.steps;
    for (std::size_t at = heading.size(); at < text.size();) {
        const std::size_t end = text.find('\n', at) + 1;
        const std::string line = text.substr(at, end - at);
        const auto step = step_of(line);
        if (!step || step->index != first + steps.size())
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
        return std::ranges::all_of(found_, &audited_step::is_free) ? done : check_failed;
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

    audited_step audited(mesh_steps& steps, std::size_t index, const vertex_rows& positions) const {
        const certificate found = certify(steps, positions, options_);
        const auto& start = found.step.intersections_at_start;
        audited_step step;
        step.index = index;
        step.crossing = number_of(start, errbound::relation::crossing);
        step.touching = number_of(start, errbound::relation::touching);
        step.overlapping = number_of(start, errbound::relation::overlapping);
        // A face or rod of size 0 touches without intersecting, and may then pass.
        if (start.empty()) step.touching = number_of(found.step.touching_at_start);
        step.contacts = found.contacts();
        if (found.step.first_contact.outcome == outcome::collides) {
            step.low = found.step.first_contact.low;
            step.high = found.step.first_contact.high;
        }
        const passage& deepest = found.deepest();
        if (std::isfinite(deepest.depth_error)) step.depth = deepest.depth;
        const double least =
            least_distance(steps, positions,
                           {.threads = options_.threads, .filter = options_.filter})
                .low;
        if (std::isfinite(least)) step.least_distance = least;
        return step;
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
        if (csv_ && earlier.bytes == 0) errbound::support::write_whole(*csv_, lines_of({}).first);
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
            const audited_step step = audited(steps, index, vertex_rows(before, after));
            const std::string line = lines_of(step).second;
            if (i < known) {
                if (line != lines_of(found_[i]).second)
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
    const audited_step& shown() const {
        const auto with_contacts =
            std::ranges::find_if(found_, [](const audited_step& s) { return s.contacts > 0; });
        if (with_contacts != found_.end()) return *with_contacts;
        const auto with_any = std::ranges::find_if_not(found_, &audited_step::is_free);
        if (with_any != found_.end()) return *with_any;
        return *std::ranges::min_element(found_, {}, [](const audited_step& s) {
            return s.least_distance.value_or(std::numeric_limits<double>::infinity());
        });
    }

    void report(const io::frame_sequence& frames, mesh_steps& steps) const {
        const audited_step& one = shown();
        std::vector<reason> first;
        pair_lists first_pairs;
        std::vector<errbound::support::output> outputs;
        if (one.contacts > 0 || view_) {
            const auto before = frames.positions(one.index),
                       after = frames.positions(one.index + 1);
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
        row all = {{"free", std::ranges::all_of(found_, &audited_step::is_free)},
                   {"shown", shown().index},
                   {"first_pairs", json_of_reasons(first)},
                   {"steps", row::array()}};
        for (const audited_step& step : found_) all["steps"].push_back(row_of(step));
        return all;
    }

    /// All steps if they are few, otherwise those that are not free.
    std::string text_of_steps() const {
        constexpr std::size_t most = 40;
        errbound::support::rows rows;
        std::size_t not_free = 0;
        for (const audited_step& step : found_) {
            not_free += !step.is_free();
            if ((found_.size() <= most || !step.is_free()) && rows.size() < most)
                rows.push_back(row_of(step));
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
    std::vector<audited_step> found_;
    unused_vertices_option unused_{line_};
};

}  // namespace

std::unique_ptr<command> audit_command(CLI::App& program) {
    return std::make_unique<audit>(program);
}

}  // namespace ccd::program
