// ./run soak over the ranks of MPI: mpirun -n N errbound_soak_mpi ...
#include <mpi.h>

#include <cstdio>
#include <numeric>

#include "tests/soak/program/command_line.hpp"

namespace {

std::vector<std::string> gathered(const std::string& text, std::size_t size, bool is_root) {
    const int own = static_cast<int>(text.size());
    std::vector<int> lengths(size), starts(size);
    MPI_Gather(&own, 1, MPI_INT, lengths.data(), 1, MPI_INT, 0, MPI_COMM_WORLD);
    std::exclusive_scan(lengths.begin(), lengths.end(), starts.begin(), 0);
    std::string all(is_root ? static_cast<std::size_t>(starts.back() + lengths.back()) : 0, '\0');
    MPI_Gatherv(text.data(), own, MPI_CHAR, all.data(), lengths.data(), starts.data(), MPI_CHAR, 0,
                MPI_COMM_WORLD);
    std::vector<std::string> texts;
    for (std::size_t r = 0; is_root && r < size; ++r)
        texts.push_back(
            all.substr(static_cast<std::size_t>(starts[r]), static_cast<std::size_t>(lengths[r])));
    return texts;
}

std::string shared(std::string text) {
    int length = static_cast<int>(text.size());
    MPI_Bcast(&length, 1, MPI_INT, 0, MPI_COMM_WORLD);
    text.resize(static_cast<std::size_t>(length));
    MPI_Bcast(text.data(), length, MPI_CHAR, 0, MPI_COMM_WORLD);
    return text;
}

}  // namespace

int main(int argc, char** argv) {
    int provided = 0, rank = 0, size = 1;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    if (rank != 0 && std::freopen("/dev/null", "w", stdout) == nullptr) return 1;
    const auto ranks = static_cast<std::size_t>(size);
    const soak::team who{static_cast<std::size_t>(rank), ranks,
                         [=](const std::string& text) { return gathered(text, ranks, rank == 0); },
                         shared};
    const int status = soak::run_program(argc, argv, who);
    MPI_Finalize();
    return status;
}
