// A square cloth falls onto another; vertices and colliding pairs stay on the device. Exit status
// 77 if there is no device.
#include <ccd/cuda.hpp>
#include <cstdio>
#include <utility>
#include <vector>

namespace {

constexpr int side = 64, count = 2 * side * side;

__global__ void place(double* rows) {
    const int v = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
    if (v >= count) return;
    const int sheet = v / (side * side), i = v % (side * side) / side, j = v % side;
    rows[3 * v] = i + 0.3 * sheet;
    rows[3 * v + 1] = j + 0.4 * sheet;
    rows[3 * v + 2] = sheet == 0 ? 0.0 : 1.5 + sin(0.4 * i) * cos(0.3 * j);
}

__global__ void move(const double* from, double* to) {
    const int v = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
    if (v >= count) return;
    for (int k = 0; k < 3; ++k) to[3 * v + k] = from[3 * v + k];
    if (v >= side * side) to[3 * v + 2] -= 0.125;
}

std::vector<ccd::face> faces_of_sheets() {
    std::vector<ccd::face> faces;
    for (ccd::vertex_index sheet = 0; sheet < 2; ++sheet)
        for (ccd::vertex_index i = 0; i + 1 < side; ++i)
            for (ccd::vertex_index j = 0; j + 1 < side; ++j) {
                const ccd::vertex_index v = sheet * side * side + i * side + j;
                faces.push_back({v, v + 1, v + side});
                faces.push_back({v + 1, v + side + 1, v + side});
            }
    return faces;
}

}  // namespace

int main() {
    if (const auto s = ccd::cuda::device_status(); !s) {
        std::printf("no CUDA device: %s\n", s.error.c_str());
        return 77;
    }
    double *before = nullptr, *after = nullptr;
    if (cudaMalloc(&before, 3 * count * sizeof(double)) != cudaSuccess ||
        cudaMalloc(&after, 3 * count * sizeof(double)) != cudaSuccess) {
        std::fprintf(stderr, "out of device memory\n");
        return 1;
    }
    constexpr int threads = 128, blocks = (count + threads - 1) / threads;
    place<<<blocks, threads>>>(before);

    ccd::cuda::mesh_steps steps(faces_of_sheets(), count);
    for (int step = 0; step < 10; ++step) {
        move<<<blocks, threads>>>(before, after);
        const ccd::cuda::positions at(ccd::cuda::coordinates<double>::rows(before),
                                      ccd::cuda::coordinates<double>::rows(after), count);
        const auto found = steps.run(at, {.method = ccd::method::exact});
        if (!found) {
            std::fprintf(stderr, "%s\n", found.error.c_str());
            return 1;
        }
        // found.pairs has lists in device memory, for the next kernel.
        std::printf("step %d: %zu vertex/face and %zu edge/edge pairs of %zu candidates\n", step,
                    found.pairs.vertex_face.size(), found.pairs.edge_edge.size(),
                    found.candidates.vertex_face + found.candidates.edge_edge);
        std::swap(before, after);
    }
    (void)cudaFree(before);
    (void)cudaFree(after);
    return 0;
}
