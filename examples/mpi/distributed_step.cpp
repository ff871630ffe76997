// A step and a free step of a mesh that a simulation distributes over MPI ranks: layers of cloth,
// with a strip of each on every rank. Run: mpirun -n 4 example_distributed_step.
#include <ccd/mpi.hpp>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <vector>

namespace {

constexpr std::size_t width = 60, layers = 4;  // width: squares along a strip

/// This rank's squares, rows [first, last), of layers that fall onto each other.
struct strips {
    std::vector<ccd::mpi::vertex_number> numbers;
    std::vector<ccd::point<double>> before, after;
    std::vector<ccd::face> faces;

    strips(std::size_t first, std::size_t last) {
        for (std::size_t layer = 0; layer < layers; ++layer) {
            const auto start = static_cast<ccd::vertex_index>(numbers.size());
            for (std::size_t row = first; row <= last; ++row)
                for (std::size_t column = 0; column <= width; ++column) add(layer, row, column);
            for (std::size_t row = 0; row < last - first; ++row)
                for (std::size_t column = 0; column < width; ++column) {
                    const auto at = [&](std::size_t r, std::size_t c) {
                        return start +
                               static_cast<ccd::vertex_index>((row + r) * (width + 1) + column + c);
                    };
                    faces.push_back({at(0, 0), at(0, 1), at(1, 0)});
                    faces.push_back({at(1, 1), at(1, 0), at(0, 1)});
                }
        }
    }

  private:
    void add(std::size_t layer, std::size_t row, std::size_t column) {
        // The vertex's number in the whole mesh.
        numbers.push_back((layer * (width + 1) + row) * (width + 1) + column);
        const double x = static_cast<double>(column), y = static_cast<double>(row),
                     z = 2 * static_cast<double>(layer), bump = 0.4 * std::sin(3 * x + y + z);
        before.push_back({x, y, z + bump});
        after.push_back({x + 0.2, y, 0.3 * z + bump});
    }
};

}  // namespace

int main(int argc, char** argv) {
    MPI_Init(&argc, &argv);
    int rank = 0, size = 1;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    const auto row = [&](int r) {
        return width * static_cast<std::size_t>(r) / static_cast<std::size_t>(size);
    };
    const strips own(row(rank), row(rank + 1));

    const ccd::mpi::mesh_part part{own.numbers, {own.before, own.after}, own.faces};
    const ccd::mpi::step_result found = ccd::mpi::step(MPI_COMM_WORLD, part, {.times = true});

    const auto& [given, held, bytes, seconds] = found.work;
    std::printf(
        "rank %d: %zu vertex/face and %zu edge/edge pairs; %zu elements given, %zu held, "
        "%zu bytes sent\n",
        rank, found.pairs.vertex_face.size(), found.pairs.edge_edge.size(),
        static_cast<std::size_t>(given), static_cast<std::size_t>(held),
        static_cast<std::size_t>(bytes));
    const ccd::mpi::advance_result free = ccd::mpi::advance(MPI_COMM_WORLD, part);
    if (rank == 0)
        std::printf("the first contact: t = %.6f; all may move by %.6f of their ways\n",
                    found.first_contact.low, free.fraction);
    MPI_Finalize();
    return found.first_contact.outcome == ccd::outcome::collides ? 0 : 1;
}
