#include "examples/simulation/scenes/scene.hpp"

namespace simulation {

std::span<const scene_maker> scenes() {
    static const std::vector<scene_maker> all{
        {"funnel1", "a sheet of cloth pressed through a funnel", 30, 110,
         [](int resolution) { return funnel(1, resolution); }},
        {"funnel2", "two sheets of cloth pressed through a funnel", 30, 110,
         [](int resolution) { return funnel(2, resolution); }},
        {"funnel3", "three sheets of cloth pressed through a funnel", 30, 110,
         [](int resolution) { return funnel(3, resolution); }},
    };
    return all;
}

}  // namespace simulation
