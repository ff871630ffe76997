#include "examples/simulation/output/run_folder.hpp"

#include <array>
#include <ccd/io/mesh_file.hpp>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <errbound/support/error.hpp>
#include <fstream>
#include <functional>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "errbound/support/output_file.hpp"
#include "errbound/support/system/system.hpp"

namespace simulation {
namespace {

using errbound::support::file_error;
namespace system = errbound::support::system;
using errbound::support::read_whole;
using errbound::support::write_whole;

constexpr char magic[8] = {'s', 'i', 'm', 's', 't', 'a', 't', '3'};

/// The checksum at the end of a state. Only the same standard library can read it.
std::uint64_t checksum_of(std::string_view bytes) {
    return std::hash<std::string_view>()(bytes);
}

struct stored_force {
    std::array<vertex_index, 4> pair;
    std::array<double, 3> force;
};

template <class T>
void append(std::string& text, const T* data, Eigen::Index count) {
    text.append(reinterpret_cast<const char*>(data), sizeof(T) * static_cast<std::size_t>(count));
}

std::string bytes_of(const run_state& state) {
    const auto vertices = state.positions.rows();
    const std::int64_t numbers[] = {state.frame, vertices, std::int64_t(state.forces.size())};
    std::string text(magic, sizeof magic);
    append(text, numbers, 3);
    append(text, state.positions.data(), 3 * vertices);
    append(text, state.velocities.data(), 3 * vertices);
    for (const auto& [pair, force] : state.forces) {
        const stored_force stored{pair, {force.x(), force.y(), force.z()}};
        append(text, &stored, 1);
    }
    const std::uint64_t checksum = checksum_of(text);
    append(text, &checksum, 1);
    return text;
}

/// Returns the bytes before the checksum. Throws file_error if it does not match.
std::string_view checked(const std::string& text, const std::filesystem::path& path) {
    std::uint64_t checksum = 0;
    const bool whole = text.size() >= sizeof magic + sizeof checksum;
    const std::string_view bytes(text.data(), whole ? text.size() - sizeof checksum : 0);
    if (whole) std::memcpy(&checksum, text.data() + bytes.size(), sizeof checksum);
    if (!whole || std::memcmp(text.data(), magic, sizeof magic) != 0 ||
        checksum != checksum_of(bytes))
        throw file_error(path.string() + ": state of " + std::to_string(text.size()) +
                         " bytes is damaged; expected one written by this program");
    return bytes;
}

run_state state_of(const std::string& file, const std::filesystem::path& path,
                   Eigen::Index vertices) {
    const std::string_view text = checked(file, path);
    std::int64_t numbers[3] = {};
    const std::size_t head = sizeof magic + sizeof numbers;
    if (text.size() >= head) std::memcpy(numbers, text.data() + sizeof magic, sizeof numbers);
    const std::size_t part = 3 * sizeof(double) * std::size_t(vertices);
    const std::size_t expected = head + 2 * part + sizeof(stored_force) * std::size_t(numbers[2]);
    if (text.size() != expected || numbers[1] != vertices)
        throw file_error(path.string() + ": number of vertices is " + std::to_string(numbers[1]) +
                         "; expected " + std::to_string(vertices));
    run_state state{int(numbers[0]), rows(vertices, 3), rows(vertices, 3), {}};
    std::memcpy(state.positions.data(), text.data() + head, part);
    std::memcpy(state.velocities.data(), text.data() + head + part, part);
    for (std::size_t i = head + 2 * part; i < expected; i += sizeof(stored_force)) {
        stored_force stored;
        std::memcpy(&stored, text.data() + i, sizeof stored);
        state.forces[stored.pair] = vec3(stored.force[0], stored.force[1], stored.force[2]);
    }
    return state;
}

/// Drops rows after the state's frame: the run was stopped between writing the two.
std::string rows_until(int last, const std::filesystem::path& path) {
    std::istringstream table(read_whole(path));
    std::string kept, line;
    for (int frame = 0; frame <= last; ++frame) {
        const std::string begin = std::to_string(frame) + ',';
        const bool found = bool(std::getline(table, line));
        if (!found || (frame == 0 ? line + '\n' != csv_heading() : !line.starts_with(begin)))
            throw file_error(
                path.string() + ": line " + std::to_string(frame + 1) + " is '" +
                (found ? line : "") + "'; expected " +
                (frame == 0 ? "a heading of frames" : "the row of frame " + std::to_string(frame)));
        kept += line + '\n';
    }
    return kept;
}

std::string text_of(double x) {
    char buffer[32];
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, x).ptr};
}

}  // namespace

std::string csv_heading() {
    return "frame,solver_seconds,detection_seconds,response_seconds,certification_seconds,"
           "candidates,contacts,reported,uncertain,iterations,zones,converged,fraction,"
           "passed_through,near_at_start,least_distance,kinetic_energy,elastic_energy,"
           "potential_energy\n";
}

std::string csv_row(const frame_record& r) {
    const response_report& c = r.response;
    const auto optional = [](const std::optional<std::size_t>& n) {
        return n ? std::to_string(*n) : std::string();
    };
    const std::string cells[] = {std::to_string(r.frame),
                                 text_of(r.solver_seconds),
                                 text_of(c.detection_seconds),
                                 text_of(c.response_seconds),
                                 text_of(c.certification_seconds),
                                 optional(c.candidates),
                                 std::to_string(c.contacts),
                                 std::to_string(c.reported),
                                 std::to_string(c.uncertain),
                                 std::to_string(c.iterations),
                                 std::to_string(c.zones),
                                 c.converged ? "1" : "0",
                                 text_of(c.fraction),
                                 optional(c.passed_through),
                                 std::to_string(c.near_at_start),
                                 c.near_at_start > 0 ? text_of(c.least_distance) : std::string(),
                                 text_of(r.kinetic_energy),
                                 text_of(r.elastic_energy),
                                 text_of(r.potential_energy)};
    std::string row;
    for (const std::string& cell : cells) row += (row.empty() ? "" : ",") + cell;
    return row + '\n';
}

folder_lock::folder_lock(const std::filesystem::path& folder)
    : descriptor_(system::lock(system::native_name(folder))) {
    // Some network file systems have no locks. Then the folder is not locked.
    if (descriptor_ >= 0 || errno != EWOULDBLOCK) return;
    throw file_error(folder.string() +
                     ": another process uses the folder; expected a separate folder");
}

folder_lock::~folder_lock() {
    if (descriptor_ >= 0) system::close(descriptor_);
}

run_folder::run_folder(std::filesystem::path folder, const std::string& description)
    : folder_(std::move(folder)) {
    std::error_code failed;
    std::filesystem::create_directories(folder_ / "frames", failed);
    if (failed)
        throw file_error(folder_.string() + ": " + failed.message() +
                         "; expected a writable folder");
    lock_.emplace(folder_);
    is_new_ = !std::filesystem::exists(folder_ / "state");
    const std::filesystem::path about = folder_ / "run.txt";
    if (!is_new_ || std::filesystem::exists(about))
        if (const std::string found = read_whole(about); found != description)
            throw file_error(about.string() + ": run is '" + found +
                             "'; expected the run to continue, '" + description + "'");
    if (!is_new_) return;
    write_whole(about, description);
    write_whole(folder_ / "frames.csv", csv_heading());
}

std::filesystem::path run_folder::frame_file(const char* in, int frame) const {
    char name[16];
    std::snprintf(name, sizeof name, "%05d.ply", frame);
    return folder_ / in / name;
}

void run_folder::write_frame(const char* in, const simulation_run& run,
                             const rows& positions) const {
    write_whole(frame_file(in, run.state().frame),
                ccd::io::ply_of(run.of().bodies.surface(positions)));
}

void run_folder::store_proposal(const simulation_run& run) const {
    std::filesystem::create_directories(folder_ / "proposals");
    write_frame("proposals", run, run.proposed());
}

void run_folder::store_start(const simulation_run& run) {
    if (is_new_) write_frame("frames", run, run.state().positions);
}

void run_folder::restore(simulation_run& run) const {
    if (is_new_) return;
    const std::filesystem::path path = folder_ / "state";
    run.restore(state_of(read_whole(path), path, run.state().positions.rows()));
    const std::filesystem::path last = frame_file("frames", run.state().frame);
    if (read_whole(last) != ccd::io::ply_of(run.of().bodies.surface(run.state().positions)))
        throw file_error(last.string() + ": frame differs from that of '" + path.string() +
                         "'; expected the last one of the run");
    const std::filesystem::path table = folder_ / "frames.csv";
    write_whole(table, rows_until(run.state().frame, table));
}

void run_folder::store(const simulation_run& run, const frame_record& record) {
    write_frame("frames", run, run.state().positions);
    const std::filesystem::path table = folder_ / "frames.csv";
    std::ofstream out(table, std::ios::app);
    out << csv_row(record) << std::flush;
    if (!out) throw file_error(table.string() + ": cannot be written");
    write_whole(folder_ / "state", bytes_of(run.state()));
    is_new_ = false;
}

}  // namespace simulation
