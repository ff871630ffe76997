#include <algorithm>
#include <ccd/advance.hpp>
#include <ccd/io/mesh_file.hpp>
#include <ccd/step.hpp>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "ccd/io/view/view_files.hpp"
#include "ccd/lab/timing.hpp"
#include "ccd/program/command.hpp"
#include "ccd/program/first_pairs.hpp"
#include "ccd/program/options.hpp"
#include "ccd/program/pair_lines.hpp"
#include "errbound/support/output_file.hpp"
#include "errbound/support/system/system.hpp"
#include "errbound/support/table.hpp"

namespace ccd::program {
namespace {

using errbound::support::entry_named;
using errbound::support::fixed;
using errbound::support::table;
using errbound::support::text_of;
using errbound::support::usage_error;
using errbound::support::write_whole;

struct step_request {
    std::filesystem::path before, after;
    ccd::method method = ccd::method::exact;
    device_choice device;
    int threads = 0;
    std::optional<instruction_set> set;
    bool explain = false, check_start = true;
    bool times = false, advance = false, replay = false;

    bool needs_first_contact() const { return times || advance || replay; }
    double distance = 0, t_max = 1;
    io::mesh_options reading;
    std::size_t unused = 0;
    bool skip_unused = false;

    step_options options() const {
        return {.method = method,
                .threads = threads,
                .set = set,
                .count_candidates = method != ccd::method::exact,  // others test every candidate
                .explain = explain,
                .first_contact = needs_first_contact(),
                .times = times,
                .check_start = check_start,
                .t_max = t_max,
                .distances = {distance},
                .filter = {.skip_unused = skip_unused}};
    }
};

struct step_outcome {
    step_result result;
    std::optional<advance_result> advance;
    std::vector<reason> reasons;  ///< with --replay
    double read_seconds = 0;
    std::size_t memory = 0;
};

const first_time& first_contact_of(const step_outcome& found) {
    return found.advance ? found.advance->first_contact : found.result.first_contact;
}
const pair_lists& first_pairs_of(const step_outcome& found) {
    return found.advance ? found.advance->first_pairs : found.result.first_pairs;
}

std::uint64_t undecided(const stage_report::entry& entry) {
    return entry.entered - entry.separate - entry.collides;
}

void add_contacts(const step_request& request, const step_outcome& found,
                  nlohmann::ordered_json& document) {
    if (!request.needs_first_contact()) return;
    const first_time& first = first_contact_of(found);
    document["touching_at_start"] = number_of(found.result.touching_at_start);
    if (found.advance && request.distance != 0)
        document["near_at_start"] = number_of(found.advance->near_at_start);
    document["first_contact"] = json_of_contact(first);
    if (found.advance) document["advance"] = found.advance->fraction;
    if (request.replay) document["first_pairs"] = json_of_reasons(found.reasons);
}

struct possible_pairs {
    double vertex_face, edge_edge;
};

/// Counts all pairs of distinct elements in doubles, which do not overflow.
possible_pairs pairs_of_mesh(const step_request& request, const mesh& mesh) {
    const std::size_t skipped = request.skip_unused ? request.unused : 0;
    const auto vertices = static_cast<double>(mesh.vertices.size() - skipped),
               faces = static_cast<double>(unique_faces(mesh.faces).size()),
               edges = static_cast<double>(unique_edges(mesh.faces, mesh.edges).size());
    return {vertices * faces, edges * (edges - 1) / 2};
}

std::string json_of(const step_request& request, const mesh& before, const step_outcome& found) {
    const step_result& result = found.result;
    nlohmann::ordered_json document =
        json_of_counts(std::string(info(request.method).name), result);
    document["seconds"] = {
        {"read", found.read_seconds},          {"prepare", result.prepare_seconds},
        {"broad", result.broad_phase_seconds}, {"narrow", result.narrow_phase_seconds},
        {"sort", result.sort_seconds},         {"total", result.total_seconds}};
    document["threads"] = result.threads;
    document["peak_memory_bytes"] = found.memory;
    add_unused(document, request.unused, request.skip_unused);
    add_contacts(request, found, document);
    add_start(document, result.intersections_at_start);
    if (request.explain) {
        const auto [vertex_face, edge_edge] = pairs_of_mesh(request, before);
        document["pairs_of_mesh"] = {{name(kind::vertex_face), vertex_face},
                                     {name(kind::edge_edge), edge_edge}};
        document["stages"] = nlohmann::ordered_json::array();
        for (const stage_info& stage : exact_stages) {
            const stage_report::entry& entry = result.stages[stage.stage];
            document["stages"].push_back({{"stage", stage.name},
                                          {"entered", entry.entered},
                                          {"skipped", entry.skipped},
                                          {"separate", entry.separate},
                                          {"collides", entry.collides},
                                          {"undecided", undecided(entry)},
                                          {"seconds", entry.seconds}});
        }
    }
    return document.dump(2) + '\n';
}

std::string text_of_boxes(const step_request& request, const mesh& before,
                          const step_result& result) {
    const auto row = [](const char* kind, double possible, std::size_t candidates) {
        return std::vector<std::string>{kind, fixed(possible, "%.0f"),
                                        fixed(possible - static_cast<double>(candidates), "%.0f"),
                                        std::to_string(candidates)};
    };
    const auto [vertex_face, edge_edge] = pairs_of_mesh(request, before);
    const table rows = {{"pairs", "of the mesh", "apart", "candidates"},
                        row("vertex-face", vertex_face, result.candidates->vertex_face),
                        row("edge-edge", edge_edge, result.candidates->edge_edge)};
    return text_of(rows, 1) + "apart: swept boxes do not touch, or a vertex is shared; found in " +
           fixed(1e3 * result.broad_phase_seconds, "%.2f ms") + " by a tree of boxes\n";
}

std::string text_of_stages(const step_result& result) {
    table rows = {{"stage", "queries", "skipped", "separate", "collide", "undecided", "thread ms",
                   "ns/query"}};
    std::string notes;
    double seconds = 0;
    for (const stage_info& stage : exact_stages) {
        const stage_report::entry& entry = result.stages[stage.stage];
        rows.push_back(
            {std::string(stage.name), std::to_string(entry.entered), std::to_string(entry.skipped),
             std::to_string(entry.separate), std::to_string(entry.collides),
             std::to_string(undecided(entry)), fixed(1e3 * entry.seconds, "%.2f"),
             entry.entered == 0
                 ? "-"
                 : fixed(1e9 * entry.seconds / static_cast<double>(entry.entered), "%.1f")});
        notes += std::string(stage.name) + ": " + std::string(stage.question) + " In " +
                 std::string(stage.arithmetic) + ".\n";
        if (entry.skipped > 0)
            notes += "    skipped where it decided fewer than a quarter of the queries before\n";
        seconds += entry.seconds;
    }
    const double rest = result.narrow_phase_seconds * result.threads - seconds;
    return text_of(rows, 1) + "thread ms: of all threads together; reading positions and moving " +
           "queries from stage to stage took " + fixed(1e3 * std::max(rest, 0.0), "%.2f") +
           "\n\nY is zero where the four points are coplanar; no G_i is negative where that "
           "happens\n"
           "within both features. Undecided and skipped queries go to the next stage.\n" +
           notes;
}

std::string text_of_contacts(const step_request& request, const step_outcome& found) {
    if (!request.needs_first_contact()) return "";
    const first_time& first = first_contact_of(found);
    table rows = {
        {request.distance != 0 ? "within at start" : "touching at start", "first contact"},
        {std::to_string(number_of(found.result.touching_at_start)), text_of_contact(first)}};
    if (found.advance) {
        rows[0].push_back("free to");
        rows[1].push_back(fixed(found.advance->fraction, "%.17g"));
    }
    return '\n' + text_of(rows, 0) + text_of_reasons(found.reasons);
}

std::string text_of_step(const step_request& request, const mesh& before,
                         const step_outcome& found) {
    const step_result& result = found.result;
    const table costs = {
        {"read", "prepare", "broad phase", "narrow phase", "sort", "threads", "peak memory"},
        {fixed(1e3 * found.read_seconds, "%.1f ms"), fixed(1e3 * result.prepare_seconds, "%.1f ms"),
         fixed(1e3 * result.broad_phase_seconds, "%.1f ms"),
         fixed(1e3 * result.narrow_phase_seconds, "%.1f ms"),
         fixed(1e3 * result.sort_seconds, "%.1f ms"), std::to_string(result.threads),
         fixed(static_cast<double>(found.memory) / (1 << 20), "%.1f MiB")}};
    return text_of(table_of_counts(std::string(info(request.method).name), result), 1) + '\n' +
           text_of(costs, 0) + text_of_contacts(request, found) +
           (request.check_start ? text_of_start(result.intersections_at_start) : "") +
           (request.explain
                ? '\n' + text_of_boxes(request, before, result) + '\n' + text_of_stages(result)
                : "");
}

class step final : public command {
  public:
    explicit step(CLI::App& program)
        : command(program, "step", "Find the colliding pairs of one step of a mesh") {
        add(line_, "FRAME0", request_.before, "PLY or OBJ; -: standard input").required().input();
        add(line_, "FRAME1", request_.after, "PLY or OBJ, same topology; -: standard input")
            .required()
            .input();
        add(line_, "--method", method_, "The method; exact by default").type("M");
        add_outputs();
        add_threads_option(line_, request_.threads);
        add(line_, "--instruction-set", set_,
            "For exact: baseline, avx2 or avx512; by default the fastest that runs here")
            .type("SET");
        add_flag(line_, "--explain", request_.explain,
                 "Print decided and skipped queries and cost of each stage of exact; counts "
                 "candidates");
        add_flag(line_, "!--no-check-start", request_.check_start,
                 "Do not look for elements that intersect in FRAME0");
        add_output(line_, "--json", json_, "Write counts and seconds as JSON; -: standard output");
        add_triangulate_option(line_, request_.reading.triangulate);
    }

    exit_status run() override {
        check_options();
        const auto start = lab::clock::now();
        const mesh before = io::read_mesh(request_.before, request_.reading);
        const mesh after = io::read_mesh(request_.after, request_.reading);
        io::require_same_topology(before, request_.before.string(), after, request_.after.string());
        step_outcome found;
        found.read_seconds = lab::seconds_since(start);
        report_unused(before);

        found.result = request_.device.cuda ? device_step(before, after)
                                            : ccd::step(before, after, request_.options());
        if (advance_)
            found.advance = ccd::advance(before, after,
                                         {.distances = {request_.distance},
                                          .threads = request_.threads,
                                          .set = request_.set,
                                          .filter = {.skip_unused = request_.skip_unused}});
        if (replay_)
            found.reasons = reasons(vertex_rows(before, after), first_pairs_of(found),
                                    first_contact_of(found), {request_.distance});
        found.memory = errbound::support::system::peak_memory_bytes();
        write(before, after, found);
        stream_for_people() << text_of_step(request_, before, found);
        if (replay_) stream_for_people() << text_of_replay(*replay_, first_pairs_of(found));
        return done;
    }

  private:
    std::ostream& stream_for_people() const {
        return errbound::support::stream_for_people({pairs_, toi_, advance_, json_, view_});
    }

    /// Looks for intersections at the start on the host.
    step_result device_step(const mesh& before, const mesh& after) const {
        step_options options = request_.options();
        options.check_start = false;
        step_result result = step_on_device(before, after, options, request_.device.precision);
        if (request_.check_start)
            result.intersections_at_start =
                intersections(before, {.segments = false, .filter = options.filter}).pairs;
        return result;
    }

    /// Prints before the step, since coincident points may need much time and memory.
    void report_unused(const mesh& before) {
        const std::size_t vertices = before.vertices.size();
        request_.unused = unused_vertices(before.faces, before.edges, vertices).size();
        request_.skip_unused = unused_.skips(request_.unused, vertices);
        stream_for_people() << text_of_unused(request_.unused, vertices, request_.skip_unused)
                            << std::flush;
    }

    void add_outputs() {
        add_output(line_, "--pairs", pairs_,
                   "Write lines vf,v,f0,f1,f2 and ee,a0,a1,b0,b1 (ve,v,a0,a1 and vv,v0,v1 if the\n"
                   "mesh has rods or points) of vertex indices; -: standard output");
        add_output(line_, "--toi", toi_,
                   "Write the lines of --pairs, each followed by ,low,high: the first contact\n"
                   "is between these times (see ccd query --help); -: standard output");
        add(line_, "--advance", advance_,
            "Write a frame (PLY, in doubles) as close to FRAME1 as is free: a step to it\n"
            "has only pairs that touch, or are within --separation, at the start; the\n"
            "latter keep a tenth of their distance")
            .ends_in(".ply", true);
        add_replay_option(line_, replay_);
        add_output(line_, "--view", view_,
                   "Write the step for a viewer, with times if --toi is given. OUT.html, or -: a "
                   "page\nfor a browser; for ParaView, OUT.vtp: FRAME0 with displacements, "
                   "OUT.pvd: both\nframes, in OUT-0.vtp and OUT-1.vtp")
            .check([](const std::string& path) {
                try {
                    io::view_paths(path);
                } catch (const std::invalid_argument& error) {
                    return std::string(error.what());
                }
                return std::string();
            });
    }

    void write(const mesh& before, const mesh& after, step_outcome& found) const {
        std::vector<errbound::support::output> outputs;
        if (pairs_) outputs.push_back({*pairs_, lines_of_pairs(found.result.pairs)});
        if (toi_)
            outputs.push_back({*toi_, lines_of_pairs(found.result.pairs, &found.result.times)});
        if (replay_)
            for (auto& file :
                 replay_files(*replay_, vertex_rows(before, after), first_pairs_of(found)))
                outputs.push_back(std::move(file));
        if (advance_)
            outputs.push_back({*advance_, io::ply_of({std::move(found.advance->positions),
                                                      before.faces, before.edges})});
        if (json_) outputs.push_back({*json_, json_of(request_, before, found)});
        if (view_)
            for (auto& file :
                 io::view_files(*view_, {vertex_rows(before, after), before.faces, before.edges,
                                         found.result.pairs, found.result.times,
                                         found.result.intersections_at_start}))
                outputs.push_back(std::move(file));
        write_whole(outputs);
    }

    void check_times() {
        request_.times = toi_.has_value();
        request_.advance = advance_.has_value();
        request_.replay = replay_.has_value();
        request_.distance = separation_.value(0, std::numeric_limits<double>::max());
        request_.t_max = t_max_.value(1, 1);
        if (!request_.needs_first_contact() && !separation_.was_given() && !t_max_.was_given())
            return;
        if (request_.method != method::exact)
            throw usage_error(
                "--method is " + method_ +
                "; expected exact with --toi, --separation, --t-max, --advance or --replay");
        if (request_.device.cuda &&
            (request_.advance || request_.replay || separation_.was_given() || t_max_.was_given()))
            throw usage_error(
                "--device is cuda; expected cpu with --separation, --t-max, --advance or "
                "--replay");
        if (request_.advance && t_max_.was_given())
            throw usage_error("--t-max is given with --advance; expected the whole step");
        if (request_.explain && request_.distance != 0)
            throw usage_error(
                "--separation is given with --explain; expected contact, since only contact has "
                "stages");
    }

    void check_options() {
        request_.method = method_named(method_);
        if (was_given("--instruction-set"))
            request_.set = entry_named(
                "--instruction-set", set_, instruction_sets(),
                [](instruction_set known) { return std::string(name(known)); },
                " (kernels of this build that run on this machine)");
        if (request_.method != method::exact && (request_.explain || request_.set))
            throw usage_error("--method is " + method_ +
                              "; expected exact with --explain or --instruction-set");
        request_.device = device_.chosen();
        if (request_.device.cuda) {
            require_on_device(request_.method);
            if (request_.explain || request_.set || was_given("--threads"))
                throw usage_error(
                    "--device is cuda; expected cpu with --explain, --instruction-set or "
                    "--threads");
        }
        check_times();
        std::vector<std::optional<std::filesystem::path>> outputs = {pairs_, toi_, advance_, json_};
        if (view_)
            for (auto& path : io::view_paths(*view_)) outputs.push_back(std::move(path));
        if (replay_)
            for (auto& path : replay_paths(*replay_)) outputs.push_back(std::move(path));
        errbound::support::require_good_outputs(outputs, {request_.before, request_.after});
        errbound::support::require_one_standard_input("FRAME0 and FRAME1",
                                                      {request_.before, request_.after});
    }

    step_request request_;
    std::string method_ = "exact", set_;
    std::optional<std::filesystem::path> pairs_, toi_, advance_, json_, view_, replay_;
    number_option separation_{line_, "--separation",
                              "Report pairs that come within NUMBER instead of contacts"};
    number_option t_max_{line_, "--t-max", "Report pairs up to time NUMBER, from 0 to 1"};
    device_options device_{line_};
    unused_vertices_option unused_{line_};
};

}  // namespace

const command_maker step_command = make_command<step>;

}  // namespace ccd::program
