// ./run soak in one process.
#include "tests/soak/program/command_line.hpp"

int main(int argc, char** argv) {
    return soak::run_program(argc, argv, {});
}
