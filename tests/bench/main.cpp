// ./run bench: tables of the cost of `exact` and of the other methods.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "ccd/lab/machine.hpp"
#include "errbound/support/output_file.hpp"
#include "tests/bench/sections.hpp"

namespace {

/// Prints the machine and the build, and returns them as JSON.
nlohmann::json head(const std::string& commit) {
    nlohmann::json here = ccd::lab::this_machine();
    here["commit"] = commit;
    for (const char* key :
         {"processor", "cores", "load", "instruction_sets", "compiler", "flags", "commit"})
        bench::report::say(key + (": " + (here[key].is_string() ? here[key].get<std::string>()
                                                                : here[key].dump())));
    return here;
}

void run_scene(const std::string& name, const bench::options& o, bench::report& out) {
    bench::scene s;
    const bench::clock::time_point start = bench::clock::now();
    if (!bench::load(name, s)) {
        bench::report::say("\n== " + name + ": skipped, its data is missing");
        return;
    }
    char seconds[32];
    std::snprintf(seconds, sizeof seconds, "%.1f s", bench::seconds_since(start));
    bench::report::say("\n== " + name + ": " +
                       (s.is_step() ? bench::count(s.before.vertices.size()).text + " vertices, " +
                                          bench::count(s.before.faces.size()).text + " faces, "
                                    : "") +
                       bench::count(s.queries.vertex_face.size()).text + " vf and " +
                       bench::count(s.queries.edge_edge.size()).text + " ee " +
                       (s.is_step() ? "candidates" : "queries") + " (prepared in " + seconds + ")");
    if (o.wants("methods")) bench::methods(s, o, out);
    if (o.wants("stages")) bench::stages(s, o, out);
    if (o.wants("contacts")) bench::contacts(s, o, out);
    if (o.wants("steps") && s.is_step()) bench::steps(s, o, out);
    if (o.wants("growth") && s.is_step()) bench::growth(s, o, out);
}

}  // namespace

int main(int argc, char** argv) try {
    CLI::App app{"Times exact and the other methods; prints tables."};
    app.name("./run bench");
    app.footer(
        "./run bench also takes, as its first argument, --linear, --predicates, --roots or "
        "--rules: those next to\nother libraries; --worst: worst cases; and --native: these by a "
        "build for this processor\nnext to these.");
    bench::options o;
    std::string json, commit = "unknown";
    app.add_flag("--quick", o.quick, "Fewer queries and repeats: tests that everything runs");
    app.add_option("--json", json, "The tables as JSON, to this file");
    app.add_option("--scene", o.scene, "Only scenes whose name contains this");
    app.add_option("--sections", o.sections,
                   "Only these: methods, stages, contacts, steps, growth, predicates, curves")
        ->delimiter(',')
        ->check(CLI::IsMember(std::vector<std::string>(std::begin(bench::section_names),
                                                       std::end(bench::section_names))));
    app.add_option("--commit", commit, "Commit to print with the results");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }

    const nlohmann::json machine = head(commit);
    bench::report out;
    bool any = false;
    for (const std::string& name : bench::scene_names()) {
        if (name.find(o.scene) == std::string::npos) continue;
        any = true;
        if (o.wants_scenes()) run_scene(name, o, out);
    }
    if (!any) {
        std::string names;
        for (const std::string& name : bench::scene_names()) names += " " + name;
        std::fprintf(stderr, "bench: found no scene \"%s\", expected part of one of:%s\n",
                     o.scene.c_str(), names.c_str());
        return 1;
    }
    if (o.wants("predicates") && o.scene.empty()) bench::predicates(o, out);
    if (o.wants("curves") && o.scene.empty()) bench::curves(o, out);
    if (!json.empty()) {
        errbound::support::write_whole(
            json, nlohmann::json{{"machine", machine}, {"tables", out.tables()}}.dump(1) + "\n");
    }
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "bench: %s\n", error.what());
    return 1;
}
