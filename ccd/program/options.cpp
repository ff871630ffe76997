#include "ccd/program/options.hpp"

#include <algorithm>
#include <ccd/io/query_file.hpp>
#include <system_error>

#include "ccd/io/text.hpp"
#include "errbound/support/hexadecimal.hpp"

namespace ccd::program {

using errbound::support::add, errbound::support::add_flag, errbound::support::entry_named;
using errbound::support::usage_error;

ccd::method method_named(const std::string& name) {
    return entry_named("--method", name, ccd::methods(), &method_info::name).method;
}

methods_option::methods_option(CLI::App& line)
    : option_(add(line, "--method", list_, "Methods M[,M...]; all by default").type("M[,M...]")) {}

std::vector<ccd::method> methods_option::methods() const {
    if (was_given()) return errbound::support::all_named("--method", list_, method_named);
    std::vector<ccd::method> all;
    for (const method_info& entry : ccd::methods()) all.push_back(entry.method);
    return all;
}

device_options::device_options(CLI::App& line) {
    add(line, "--device", device_, "Device to use: cpu or cuda")
        .among({"cpu", "cuda"})
        .shows_default();
    add(line, "--precision", precision_,
        "With --device cuda: the arithmetic of the first stage, float64 (the default)\n"
        "or float32; queries that float32 cannot decide are decided in float64")
        .among({"float64", "float32"});
}

device_choice device_options::chosen() const {
    if (device_ == "cpu") {
        if (!precision_.empty())
            throw usage_error("--device is cpu; expected cuda with --precision");
        return {};
    }
    require_device();
    return {true, precision_ == "float32" ? cuda::precision::float32 : cuda::precision::float64};
}

void require_on_device(ccd::method m) {
    const std::vector<ccd::method> possible = methods_on_device();
    if (std::ranges::find(possible, m) != possible.end()) return;
    const auto name = [](ccd::method known) { return std::string(info(known).name); };
    throw usage_error("--method is '" + name(m) + "' with --device cuda; expected one of " +
                      errbound::support::listed(possible, name));
}

number_option::number_option(CLI::App& line, const std::string& name,
                             const std::string& description)
    : name_(name), option_(add(line, name, text_, description).type("NUMBER")) {}

double number_option::value(double otherwise, double max) const {
    if (!was_given()) return otherwise;
    const io::number number = io::parse_double(text_, false);
    if (number.status != io::number_status::ok)
        throw usage_error(io::describe(number.status, name_, io::excerpt(text_)));
    if (number.value >= 0 && number.value <= max) return number.value;
    throw usage_error(name_ + " is " + io::excerpt(text_) + "; expected a number " +
                      (max == 1 ? "from 0 to 1" : ">= 0"));
}

unused_vertices_option::unused_vertices_option(CLI::App& line) {
    add(line, "--unused-vertices", choice_,
        "Vertices without faces and edges: skip them (default if the file has faces or\n"
        "edges), or treat them as points (default if it has none)")
        .among({"skip", "points"});
}

bool unused_vertices_option::skips(std::size_t unused, std::size_t vertices) const {
    return unused > 0 && (choice_.empty() ? unused < vertices : choice_ == "skip");
}

std::string text_of_unused(std::size_t unused, std::size_t vertices, bool skipped) {
    if (unused == 0) return "";
    return "vertices on no face and no edge: " + std::to_string(unused) + " of " +
           std::to_string(vertices) +
           (skipped ? ", skipped (--unused-vertices points takes them as points)\n"
                    : ", taken as points (--unused-vertices skip skips them)\n");
}

std::string text_of_time(const first_time& time) {
    if (time.outcome != outcome::collides) return "-";
    return errbound::support::hexadecimal(time.low) + "," +
           errbound::support::hexadecimal(time.high);
}

void query_files::add_options(CLI::App& line) {
    add(line, "FILE", paths,
        "CSV, 8 rows per query: v f0 f1 f2 (or a0 a1 b0 b1) at t = 0, then at t = 1; a row is\n"
        "xnum,xden,ynum,yden,znum,zden or x,y,z, then optionally the truth, 0 or 1;\n"
        "or an HDF5 store of ccd convert; -: standard input")
        .required()
        .input();
    add_kind_option(line, kind);
    add_round_option(line, round);
}

std::filesystem::path bundled_scenes() {
    std::error_code error;
    const std::filesystem::path installed =
        std::filesystem::read_symlink("/proc/self/exe", error).parent_path() /
        ERRBOUND_RELATIVE_SCENES;
    if (!error && std::filesystem::is_directory(installed)) return installed.lexically_normal();
    return ERRBOUND_SCENES;
}

void add_range_options(CLI::App& line, std::uint64_t& first, std::uint64_t& count,
                       const std::string& of_first, const std::string& of_count) {
    constexpr std::uint64_t most = std::uint64_t{1} << 48;
    add(line, "--first", first, of_first).type("N").between(std::uint64_t{0}, most).shows_default();
    add(line, "--count", count, of_count).type("N").between(std::uint64_t{1}, most);
}

void add_kind_option(CLI::App& line, std::string& kind) {
    add(line, "--kind", kind,
        "Kind of query; by default taken from the path (vertex-face or vf, edge-edge or ee)")
        .among(io::kind_names());
}

void add_round_option(CLI::App& line, bool& round) {
    add_flag(line, "--round", round,
             "Round rationals and hexadecimal floats that no double equals; by default they are\n"
             "errors (decimals are always rounded to the nearest double)");
}

void add_triangulate_option(CLI::App& line, bool& triangulate) {
    add_flag(line, "--triangulate", triangulate,
             "Split faces of more than three vertices into triangles (fans, in the order of their "
             "vertices)");
}

void add_threads_option(CLI::App& line, int& threads, const std::string& description) {
    add(line, "--threads", threads, description).between(0, 4096);
}

}  // namespace ccd::program
