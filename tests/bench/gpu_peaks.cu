// Measured peaks of the device: copies, and unfused products and sums.
#include <cuda_runtime.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "tests/bench/gpu_peaks.hpp"

namespace bench {

void check(cudaError_t e) {
    if (e != cudaSuccess) throw std::runtime_error(std::string("CUDA: ") + cudaGetErrorString(e));
}

namespace {

constexpr int rounds = 2048, chains = 8, threads = 256, blocks = 4096;

template <class T>
__global__ void multiply_and_add(T* result, T factor) {
    T x[chains];
    for (int c = 0; c < chains; ++c) x[c] = T(threadIdx.x + c);
    for (int i = 0; i < rounds; ++i)
        for (int c = 0; c < chains; ++c)
            x[c] = x[c] * factor + factor;  // two operations: -fmad=false
    T sum = 0;
    for (int c = 0; c < chains; ++c) sum += x[c];
    if (sum == T(-1)) *result = sum;  // never true, but the compiler cannot prove it
}

/// Returns the time of the shortest run, in seconds.
template <class Run>
double shortest(const Run& run) {
    cudaEvent_t start, stop;
    check(cudaEventCreate(&start));
    check(cudaEventCreate(&stop));
    float least = 1e30f;
    for (int i = 0; i < 10; ++i) {
        check(cudaEventRecord(start));
        run();
        check(cudaEventRecord(stop));
        check(cudaEventSynchronize(stop));
        float ms = 0;
        check(cudaEventElapsedTime(&ms, start, stop));
        least = std::min(least, ms);
    }
    check(cudaEventDestroy(start));
    check(cudaEventDestroy(stop));
    return 1e-3 * least;
}

template <class T>
double operations_per_second(T* result) {
    const double seconds = shortest([&] {
        multiply_and_add<<<blocks, threads>>>(result, T(0.5));
        check(cudaGetLastError());
    });
    return 2.0 * rounds * chains * threads * blocks / seconds;
}

}  // namespace

device_peaks measured_peaks() {
    constexpr std::size_t bytes = std::size_t(1) << 28;
    char *from = nullptr, *to = nullptr;
    check(cudaMalloc(&from, bytes));
    check(cudaMalloc(&to, bytes));
    check(cudaMemset(from, 1, bytes));
    device_peaks p;
    p.bytes_per_second = 2.0 * bytes / shortest([&] {
                             check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToDevice));
                         });
    p.float_operations = operations_per_second(reinterpret_cast<float*>(to));
    p.double_operations = operations_per_second(reinterpret_cast<double*>(to));
    check(cudaFree(from));
    check(cudaFree(to));
    return p;
}

}  // namespace bench
