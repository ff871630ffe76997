// The C++ side of compare.py. Arguments: two frames. Reads lines "step" or "decide", runs this call
// and prints its seconds.
#include <ccd/batch.hpp>
#include <ccd/io/mesh_file.hpp>
#include <ccd/step.hpp>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <string>

int main(int, char** arguments) {
    const ccd::mesh before = ccd::io::read_mesh(arguments[1]);
    const ccd::mesh after = ccd::io::read_mesh(arguments[2]);
    const ccd::vertex_rows positions(before, after);
    ccd::mesh_steps steps(before);
    const auto pairs = steps.candidates(positions).edge_edge;
    for (std::string call; std::getline(std::cin, call);) {
        const auto start = std::chrono::steady_clock::now();
        std::size_t found = 0;
        if (call == "step")
            found = number_of(steps.run(positions).pairs);
        else
            found = ccd::decide_batch(positions, pairs).answers.size();
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        std::printf("%.9f %zu\n", seconds.count(), found);
        std::fflush(stdout);
    }
}
