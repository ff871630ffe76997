// ./run soak --ranks N: the soak over the ranks of MPI. Its state is that of one process, which
// goes on with it, and the other way round.
#include <mpi.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <iostream>
#include <numeric>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "errbound/study/program.hpp"
#include "errbound/study/rounds.hpp"
#include "errbound/support/signals.hpp"
#include "tests/soak/program/command_line.hpp"

namespace {

using namespace errbound::study;

work work_of(const soak::part& part, const soak::run_options& options, std::uint64_t seed) {
    return {[&part, seed](std::uint64_t block) {
                return soak::line_of(part.compare_block(seed, block));
            },
            static_cast<int>(options.threads)};
}

/// What rank 0 tells others first: the seed, or that there is nothing to do.
const std::string nothing_to_do;

/// As soak::run, on rank 0; saves after every round, since a rank that dies takes the others along.
soak::state run_part(soak::state from, const soak::run_options& options, const soak::part& part,
                     const std::atomic<int>& stop, const soak::progress& show, bool& has_begun) {
    save(from, part, options.folder);
    has_begun = true;
    broadcast(MPI_COMM_WORLD, std::to_string(from.seed));
    const auto start = std::chrono::steady_clock::now();
    std::vector<std::uint64_t> blocks(
        options.blocks > from.found.blocks ? options.blocks - from.found.blocks : 0);
    std::iota(blocks.begin(), blocks.end(), from.found.blocks);
    soak::collector all(from.found);
    soak::state last = from;
    const auto keep = [&](const std::vector<chunk_result>& found) {
        for (const auto& [block, line] : found) all.add(block, soak::findings_of(line));
        const std::chrono::duration<double> here = std::chrono::steady_clock::now() - start;
        last = {from.seed, all.sum(), from.seconds + here.count()};
        save(last, part, options.folder);
        show(last);
    };
    in_rounds(MPI_COMM_WORLD, std::move(blocks), work_of(part, options, from.seed), keep, stop);
    return last;
}

int run_on_root(const soak::command_line& line) {
    bool has_begun = false;
    try {
        return line.run([&](auto&&... arguments) {
            return run_part(std::forward<decltype(arguments)>(arguments)..., has_begun);
        });
    } catch (...) {
        if (!has_begun) broadcast(MPI_COMM_WORLD, nothing_to_do);
        throw;
    }
}

int help_root(const soak::command_line& line) {
    const errbound::support::awaited_signals signals;
    const std::string seed = broadcast(MPI_COMM_WORLD, {});
    if (seed != nothing_to_do)
        in_rounds(MPI_COMM_WORLD, {}, work_of(line.part(), line.options(), std::stoull(seed)), {},
                  signals.arrived());
    return 0;
}

int run_command_line(int argc, char** argv) {
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    soak::command_line line("./run soak --ranks N", 1);
    try {
        line.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        std::ostringstream silent;
        std::ostream& out = rank == 0 ? std::cout : silent;
        std::ostream& err = rank == 0 ? std::cerr : silent;
        return line.app().exit(error, out, err) == 0 ? 0 : 2;
    }
    return rank == 0 ? run_on_root(line) : help_root(line);
}

}  // namespace

int main(int argc, char** argv) {
    return errbound::study::run_over_ranks("soak", argc, argv, run_command_line);
}
