// The program `simulate`: runs a scene with a chosen method for collision handling.
//
//   simulate funnel1 --out out/funnel1
//
// Ctrl-C stops it after a frame, and the same command continues. Exit status: 0 done or stopped, 1
// bad input, 2 bad usage.
#include <CLI/CLI.hpp>
#include <ccd/method.hpp>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>
#include <sstream>
#include <string>

#include "errbound/support/command_line.hpp"
#include "errbound/support/program.hpp"
#include "errbound/support/progress_line.hpp"
#include "examples/simulation/output/paraview.hpp"
#include "examples/simulation/output/run_folder.hpp"
#include "examples/simulation/output/summary.hpp"
#include "examples/simulation/scenes/scene.hpp"
#include "examples/simulation/simulation.hpp"

namespace simulation {
namespace {

volatile std::sig_atomic_t interrupted = 0;

struct arguments {
    std::string scene, method = "exact";
    std::optional<std::string> out;
    std::optional<int> frames, resolution;
    bool full = false, proposals = false, vtp = false;
    int threads = 0, seed = 0;
};

const scene_maker& maker_of(const std::string& name) {
    return errbound::support::entry_named("SCENE", name, scenes(), &scene_maker::name);
}

scene made(const arguments& given, const scene_maker& maker) {
    scene s = maker.make(given.resolution.value_or(given.full ? maker.full : maker.small));
    const auto& method = errbound::support::entry_named("--method", given.method, ccd::methods(),
                                                        &ccd::method_info::name);
    s.collision.method = method.method;
    s.collision.threads = given.threads;
    if (given.frames) s.frames = *given.frames;
    return s;
}

/// Returns the options that must be equal to continue a run. Frames and threads may differ.
std::string description(const arguments& given, const scene_maker& maker, const scene& made) {
    const int resolution = given.resolution.value_or(given.full ? maker.full : maker.small);
    std::ostringstream text;
    text << maker.name << " --resolution " << resolution << " --method " << given.method
         << " --seed " << given.seed << "\neye " << made.eye.transpose() << "\ntarget "
         << made.target.transpose() << "\n";
    return text.str();
}

int simulate(const arguments& given) {
    const scene_maker& maker = maker_of(given.scene);
    simulation_run run(made(given, maker), std::uint64_t(given.seed));
    run_folder folder(given.out.value_or("out/simulation/" + maker.name),
                      description(given, maker, run.of()));
    folder.restore(run);
    folder.store_start(run);
    std::signal(SIGINT, [](int) { interrupted = 1; });
    errbound::support::progress_line progress;
    while (run.state().frame < run.of().frames && interrupted == 0) {
        progress.show(std::size_t(run.state().frame), std::size_t(run.of().frames), maker.name);
        const rows before = run.state().positions;
        const frame_record record = run.next_frame();
        if (given.vtp) write_vtp(folder.path(), run.of(), record.frame - 1, before, run.proposed());
        if (given.proposals) folder.store_proposal(run);
        folder.store(run, record);
    }
    progress.clear();
    if (given.vtp) write_series(folder.path(), run.of());
    std::fputs(summary_of(folder.path() / "frames.csv").c_str(), stdout);
    std::printf("frames and table: %s\n", folder.path().string().c_str());
    if (run.state().frame < run.of().frames)
        std::printf("stopped after frame %d of %d; the same command continues\n", run.state().frame,
                    run.of().frames);
    return 0;
}

int run_command_line(int argc, char** argv) {
    arguments given;
    CLI::App app{"Simulates cloth and solids that do not pass through each other.", "simulate"};
    std::string names;
    for (const scene_maker& maker : scenes())
        names += "\n  " + maker.name + ": " + maker.description + " (resolution " +
                 std::to_string(maker.small) + ", --full " + std::to_string(maker.full) + ")";
    app.add_option("SCENE", given.scene, "One of:" + names)->required();
    app.add_option("--method", given.method,
                   "Method for collision detection (ccd methods lists them)")
        ->capture_default_str();
    const CLI::Range natural(0, std::numeric_limits<int>::max());
    app.add_option("--frames", given.frames, "Number of frames; by default the scene's")
        ->check(natural);
    app.add_option("--resolution", given.resolution, "Resolution of the scene")
        ->check(CLI::Range(3, 2000));
    app.add_flag("--full", given.full, "Run the scene at its full size");
    app.add_option("--out", given.out, "Folder; out/simulation/SCENE by default")
        ->check([](const std::string& path) {
            return path.empty() ? "folder is ''; expected a folder's name" : std::string();
        });
    app.add_flag("--proposals", given.proposals,
                 "Also store the positions that the solver proposed, which are tested first");
    app.add_flag("--vtp", given.vtp,
                 "Also write a series for ParaView: frames, with contacts of the proposed steps");
    app.add_option("--threads", given.threads, "Maximum number of threads; 0: one per core")
        ->check(natural);
    app.add_option("--seed", given.seed, "Move the start by up to 1e-5 m at random; 0: do not")
        ->check(natural);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() != 0) throw errbound::support::usage_error(error.what());
        return app.exit(error);
    }
    return simulate(given);
}

}  // namespace
}  // namespace simulation

int main(int argc, char** argv) {
    return errbound::support::run_program("simulate",
                                          [&] { return simulation::run_command_line(argc, argv); });
}
