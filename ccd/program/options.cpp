#include "ccd/program/options.hpp"

#include <algorithm>
#include <ccd/io/query_file.hpp>

#include "ccd/io/text.hpp"
#include "errbound/support/command_line.hpp"
#include "errbound/support/hexadecimal.hpp"

namespace ccd::program {

using errbound::support::entry_named;
using errbound::support::usage_error;

ccd::method method_named(const std::string& name) {
    return entry_named("--method", name, ccd::methods(), &method_info::name).method;
}

methods_option::methods_option(CLI::App& line)
    : option_(line.add_option("--method", list_, "Methods M[,M...]; all by default")
                  ->type_name("M[,M...]")) {}

std::vector<ccd::method> methods_option::methods() const {
    if (was_given()) return errbound::support::all_named("--method", list_, method_named);
    std::vector<ccd::method> all;
    for (const method_info& entry : ccd::methods()) all.push_back(entry.method);
    return all;
}

device_options::device_options(CLI::App& line) {
    line.add_option("--device", device_, "Device to use: cpu or cuda")
        ->check(CLI::IsMember({"cpu", "cuda"}))
        ->capture_default_str();
    line.add_option("--precision", precision_,
                    "With --device cuda: the arithmetic of the first stage, float64 (the default)\n"
                    "or float32; queries that float32 cannot decide are decided in float64")
        ->check(CLI::IsMember({"float64", "float32"}));
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
    : name_(name), option_(line.add_option(name, text_, description)->type_name("NUMBER")) {}

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
    line.add_option(
            "--unused-vertices", choice_,
            "Vertices without faces and edges: skip them (default if the file has faces or\n"
            "edges), or treat them as points (default if it has none)")
        ->check(CLI::IsMember({"skip", "points"}));
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
    line.add_option(
            "FILE", paths,
            "CSV, 8 rows per query: v f0 f1 f2 (or a0 a1 b0 b1) at t = 0, then at t = 1; a row "
            "is\n"
            "xnum,xden,ynum,yden,znum,zden or x,y,z, then optionally the truth, 0 or 1;\n"
            "or an HDF5 store of ccd convert; -: standard input")
        ->required()
        ->transform(errbound::support::input_named);
    line.add_option("--kind", kind,
                    "Kind of query; by default taken from the path (vertex-face or vf, edge-edge "
                    "or ee)")
        ->check(CLI::IsMember(io::kind_names()));
    line.add_flag(
        "--round", round,
        "Round rationals and hexadecimal floats that no double equals; by default they are\n"
        "errors (decimals are always rounded to the nearest double)");
}

void add_triangulate_option(CLI::App& line, bool& triangulate) {
    line.add_flag("--triangulate", triangulate,
                  "Split faces of more than three vertices into triangles (fans, in the order of "
                  "their vertices)");
}

void add_threads_option(CLI::App& line, int& threads, const std::string& description) {
    line.add_option("--threads", threads, description)->check(CLI::Range(0, 4096));
}

}  // namespace ccd::program
