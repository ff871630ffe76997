#include "examples/simulation/scenes/scene.hpp"

namespace simulation {

std::span<const scene_maker> scenes() {
    static const std::vector<scene_maker> all{
        {"funnel1", "a sheet of cloth pressed through a funnel", 30, 110,
         [](int resolution) { return funnel(1, resolution); }},
        {"funnel2", "two sheets of cloth pressed through a funnel", 24, 110,
         [](int resolution) { return funnel(2, resolution); }},
        {"funnel3", "three sheets of cloth pressed through a funnel", 20, 110,
         [](int resolution) { return funnel(3, resolution); }},
        {"clothes", "a skirt on a body that walks and turns", 60, 240, clothes},
        {"twist", "a sheet whose ends are turned until it knots", 40, 140, twist},
        {"car-post", "an elastic car body against a post", 16, 48, car_against_post},
        {"car-ramp", "an elastic car body onto a ramp of rods", 16, 48, car_on_ramp},
        {"needles", "needles pressed into a sheet that is held at its border", 40, 140, needles},
        {"stiff", "stacks of blocks, a hundred million times as stiff as others, at rest", 3, 8,
         stiff},
    };
    return all;
}

}  // namespace simulation
