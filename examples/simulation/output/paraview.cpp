#include "examples/simulation/output/paraview.hpp"

#include <algorithm>
#include <ccd/io/step_view.hpp>
#include <ccd/step.hpp>
#include <cstdio>
#include <string>
#include <vector>

#include "errbound/support/output_file.hpp"

namespace simulation {

void write_vtp(const std::filesystem::path& folder, const scene& scene, int frame,
               const rows& before, const rows& proposed) {
    const model& bodies = scene.bodies;
    const ccd::vertex_rows way(before, proposed);
    ccd::step_options options{.threads = scene.collision.threads};
    options.times = true;
    const ccd::step_result step = ccd::step(bodies.faces, bodies.edges, way, options);
    char name[16];
    std::snprintf(name, sizeof name, "%05d.vtp", frame);
    std::filesystem::create_directories(folder / "paraview");
    errbound::support::write_whole(
        folder / "paraview" / name,
        ccd::io::vtp_of({way, bodies.faces, bodies.edges, step.pairs, step.times},
                        ccd::io::frame::before));
}

void write_series(const std::filesystem::path& folder, const scene& scene) {
    std::vector<ccd::io::series_entry> series;
    std::filesystem::create_directories(folder / "paraview");  // there may be no frame
    for (const auto& file : std::filesystem::directory_iterator(folder / "paraview")) {
        const std::string name = file.path().filename().string();
        int frame = 0, length = 0;
        if (std::sscanf(name.c_str(), "%d.vtp%n", &frame, &length) == 1 &&
            std::size_t(length) == name.size())
            series.push_back({frame * scene.solver.time_step, name});
    }
    std::ranges::sort(series, {}, &ccd::io::series_entry::time);
    errbound::support::write_whole(folder / "paraview" / "series.pvd", ccd::io::pvd_of(series));
}

}  // namespace simulation
