// A batch of queries: candidate pairs of a simulation, as indices into its positions.
#include <ccd/batch.hpp>
#include <cstddef>
#include <cstdio>
#include <vector>

int main() {
    // Vertex 3 falls through the triangle 0 1 2, vertex 4 stops exactly on its edge 0 1, vertex 5
    // stops short of it.
    const std::vector<double> before{0,    0,    0, 1,   0, 0, 0,    1,    0,  //
                                     0.25, 0.25, 1, 0.5, 0, 1, 0.25, 0.25, 1};
    const std::vector<double> after{0,    0,    0,  1,   0, 0, 0,    1,    0,  //
                                    0.25, 0.25, -1, 0.5, 0, 0, 0.25, 0.25, 0x1p-40};
    const ccd::vertex_rows positions(before.data(), after.data(), before.size() / 3);

    const std::vector<ccd::vertex_face_pair> candidates{
        {.v = 3, .f0 = 0, .f1 = 1, .f2 = 2},
        {.v = 4, .f0 = 0, .f1 = 1, .f2 = 2},
        {.v = 5, .f0 = 0, .f1 = 1, .f2 = 2},
    };
    const auto [answers, stages] = ccd::decide_batch(positions, candidates, {.explain = true});
    // Contact at t = 0 can be distinguished from a later impact.
    const auto at_start = ccd::touches_at_start_batch(positions, candidates).answers;

    const ccd::outcome expected[] = {ccd::outcome::collides, ccd::outcome::collides,
                                     ccd::outcome::separate};
    int wrong = 0;
    for (std::size_t i = 0; i < answers.size(); ++i) {
        std::printf("vertex %u: %s\n", candidates[i].v, ccd::name(answers[i]).data());
        wrong += answers[i] != expected[i] || at_start[i] != ccd::outcome::separate;
    }
    for (const ccd::stage_info& stage : ccd::exact_stages) {
        const auto& entry = stages[stage.stage];
        std::printf("%-12s decided %d\n", stage.name.data(),
                    static_cast<int>(entry.separate + entry.collides));
    }
    return wrong;
}
