// ./run soak: `exact`, one by one and in batches, on millions of queries: against the reference, or
// against itself on images of them; steps and advances of meshes against every pair; roots against
// FLINT.
#include <cstdio>
#include <exception>

#include "tests/soak/program/command_line.hpp"

int main(int argc, char** argv) try {
    soak::command_line line;
    try {
        line.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return line.app().exit(error) == 0 ? 0 : 2;
    }
    return line.run();
} catch (const std::exception& error) {
    std::fprintf(stderr, "soak: %s\n", error.what());
    return 1;
}
