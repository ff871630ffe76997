// Stacks of blocks exactly at rest, a thickness apart. Every other block is 1e8 times as stiff. A
// sheet lies on one of the stacks.
// Resolution: cells along a side of a block.
#include "examples/simulation/bodies/shapes.hpp"
#include "examples/simulation/scenes/scene.hpp"

namespace simulation {

scene stiff(int resolution) {
    constexpr double soft = 1e6, side = 0.25, thickness = 0x1p-10;
    scene s;
    s.frames = 300;
    s.solver.time_step = 0.01;
    s.collision.thickness = thickness;
    s.eye = {1.5, -2.2, 1.2};
    s.target = {0.25, 0, 0.4};
    const surface_shape floor = square(4, 3, 0);
    s.bodies.add_obstacle(floor.points, floor.faces);
    for (int stack = 0; stack < 2; ++stack) {
        double z = 0;
        for (int level = 0; level < 4; ++level) {
            z += thickness;
            const vec3 from(0.5 * stack, 0, z);
            const solid_shape cube =
                block({resolution, resolution, resolution}, from, from + vec3(side, side, side));
            const bool hard = (level + stack) % 2 == 0;
            s.bodies.add_solid(cube.points, cube.tetrahedra,
                               {.density = 100, .stiffness = hard ? 1e8 * soft : soft});
            z += side;
        }
        if (stack == 0) {
            surface_shape sheet = square(2 * resolution + 1, 0.4, z + thickness);
            translate(sheet.points, {side / 2, side / 2, 0});
            s.bodies.add_cloth(sheet.points, sheet.faces, {});
        }
    }
    return s;
}

}  // namespace simulation
