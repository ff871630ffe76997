// Steps of small meshes of faces, rods and points, with one thread and with two, compared with the
// reference on every pair.
#include <ccd/reference.hpp>
#include <ccd/step.hpp>
#include <string>

#include "tests/ccd/step/brute_force.hpp"
#include "tests/support/fuzz_numbers.hpp"

namespace {

brute_force::two_frames mesh_from(fuzz::numbers& from) {
    brute_force::two_frames at;
    const std::size_t vertices = 3 + from.below(8);
    const auto vertex = [&] { return static_cast<ccd::vertex_index>(from.below(vertices)); };
    ccd::mesh& mesh = at.first;
    for (std::size_t left = from.below(5); left > 0; --left)
        mesh.faces.push_back({vertex(), vertex(), vertex()});
    for (std::size_t left = from.below(5); left > 0; --left)
        mesh.edges.push_back({vertex(), vertex()});
    at.second = mesh;
    const auto position = [&] {
        const double x = from.next(), y = from.next();
        return ccd::point<double>{x, y, from.next()};
    };
    for (std::size_t i = 0; i < vertices; ++i) {
        mesh.vertices.push_back(position());
        at.second.vertices.push_back(position());
    }
    return at;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::numbers from(data, size);
    const auto at = mesh_from(from);
    const auto expected =
        brute_force::step(at, [](const auto& query) { return ccd::decide_reference(query); });
    for (const int number : {0, 1, 2, 3}) {
        const int threads = 1 + number / 2;
        const bool counted = number % 2 == 1;
        const auto found =
            ccd::step(at.first, at.second,
                      {.threads = threads, .count_candidates = counted, .initial_contact = true});
        if (counted && found.candidates != expected.candidates) fuzz::fail("other candidates");
        if (found.pairs != expected.pairs) fuzz::fail("other pairs");
        if (found.touching_at_start != expected.touching_at_start)
            fuzz::fail("other pairs that touch at the start");
    }
    return 0;
}
