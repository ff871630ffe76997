// ./run bench: the cost of `exact` next to the other methods, as tables.
#include <algorithm>
#include <array>
#include <iterator>
#include <stdexcept>
#include <string>

#include "tests/bench/sections.hpp"

namespace {

using namespace bench;

struct section {
    std::string_view name;
    void (*print)(const scene&, const options&, report&);
    bool of_steps;
};
constexpr section sections_of_scenes[] = {{"methods", methods, false},
                                          {"stages", stages, false},
                                          {"contacts", contacts, false},
                                          {"steps", steps, true},
                                          {"growth", growth, true}};

bool wants(const options& o, std::string_view name) {
    return o.sections.empty() || std::ranges::find(o.sections, name) != o.sections.end();
}

void run_scene(const std::string& name, const options& o, report& out) {
    const auto loaded = load(name);
    if (!loaded) return say("\n== " + name + ": skipped, its data is missing");
    const scene& s = *loaded;
    std::string sizes;
    s.queries.for_each([&]<class Query>(const ccd::lab::queries_with_truth<Query>& known) {
        sizes += ", " + errbound::support::grouped(known.queries.size()) + " " +
                 std::string(short_name(ccd::kind_of<Query>));
    });
    say("\n== " + name + ": " + errbound::support::grouped(s.before.vertices.size()) +
        " vertices, " + errbound::support::grouped(s.before.faces.size()) + " faces" + sizes +
        " queries");
    for (const auto& [section, print, of_steps] : sections_of_scenes)
        if (wants(o, section) && (is_step(s) || !of_steps)) print(s, o, out);
}

}  // namespace

int main(int argc, char** argv) {
    bench::program bench("./run bench", "Times exact and the other methods; prints tables.");
    bench.line.footer(
        "./run bench also takes, as its first argument, --integers, --intersections, --linear, "
        "--predicates,\n--roots or --rules: those next to other libraries; --mpi; or --worst: "
        "worst "
        "cases.");
    options o;
    std::string only;
    bench.line.add_option("--scene", only, "Only scenes whose name holds this");
    bench.line
        .add_option("--sections", o.sections,
                    "Only these: methods, stages, contacts, steps, growth, curves, bodies")
        ->delimiter(',')
        ->check(CLI::IsMember(
            std::vector<std::string>(std::begin(section_names), std::end(section_names))));
    return bench.run(argc, argv, [&](report& out) {
        o.quick = bench.quick;
        const bool of_scenes = std::ranges::any_of(
            sections_of_scenes, [&](const section& s) { return wants(o, s.name); });
        bool any = false;
        std::string names;
        for (const std::string& name : scene_names()) {
            names += " " + name;
            if (name.find(only) == std::string::npos) continue;
            any = true;
            if (of_scenes) run_scene(name, o, out);
        }
        if (!any)
            throw std::runtime_error("--scene is '" + only + "'; expected part of one of:" + names);
        if (wants(o, "curves") && only.empty()) curves(o, out);
        if (wants(o, "bodies") && only.empty()) bodies(o, out);
    });
}
