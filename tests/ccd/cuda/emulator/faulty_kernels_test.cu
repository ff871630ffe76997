// Kernels that the emulator must reject, and similar valid ones. Each runs in a separate process,
// since an error disables the device.
#include <cuda_runtime.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>

namespace {

__global__ void store_at(int* p, int index) {
    p[index] = 1;
}
__global__ void copy_one(const int* from, int* to) {
    *to = *from;
}
__global__ void store_double(char* p) {
    *reinterpret_cast<double*>(p) = 1;
}
__global__ void shuffle(int* p, unsigned mask, int from) {
    if (threadIdx.x < 16) p[threadIdx.x] = __shfl_sync(mask, threadIdx.x, from);
}
__global__ void wait_for(unsigned mask) {
    if (threadIdx.x == 0) __syncwarp(mask);
}
__global__ void load_shared(int* p, int index) {
    __shared__ int s[32];
    s[threadIdx.x] = 1;
    __syncthreads();
    p[threadIdx.x % 16] = s[index];
}
__global__ void two_barriers(int* p) {
    if (threadIdx.x < 32)
        __syncthreads();
    else {
        p[0] = 1;
        __syncthreads();
        p[1] = 1;
    }
}
__global__ void overrun_stack(int* p, int depth) {
    volatile int local[64];
    for (int i = 0; i < 64; ++i) local[i] = i;
    p[0] = local[depth];
}

int* memory = nullptr;

bool finishes() {
    return cudaGetLastError() == cudaSuccess && cudaDeviceSynchronize() == cudaSuccess;
}
/// Runs `run` in a separate process, which returns false after a reported error. True if the result
/// is as expected.
template <class Run>
bool reported(const char* name, bool expected, const Run& run) {
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child == 0) {
        cudaMalloc(&memory, 64);
        _exit(run() ? 0 : 1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    const bool found = !WIFEXITED(status) || WEXITSTATUS(status) != 0;
    if (found != expected) std::printf("%s: %s\n", name, found ? "rejected" : "not rejected");
    return found == expected;
}

}  // namespace

int main() {
    int host[64] = {};
    bool right = true;
#define EXPECT(rejected, ...) \
    right &= reported(#__VA_ARGS__, rejected, [&] { return __VA_ARGS__, finishes(); })
    EXPECT(false, store_at<<<1, 1>>>(memory, 15));
    EXPECT(true, store_at<<<1, 1>>>(memory, 16));
    EXPECT(true, store_at<<<1, 1>>>(memory, -1));
    EXPECT(true, store_at<<<1, 1>>>(nullptr, 0));
    EXPECT(true, cudaFree(memory), store_at<<<1, 1>>>(memory, 0));
    EXPECT(true, copy_one<<<1, 1>>>(host, memory));
    EXPECT(true, host[0] = *memory);
    EXPECT(false, store_double<<<1, 1>>>(reinterpret_cast<char*>(memory)));
    EXPECT(true, store_double<<<1, 1>>>(reinterpret_cast<char*>(memory) + 4));
    EXPECT(false, shuffle<<<1, 32>>>(memory, 0x0000ffffu, 2));
    EXPECT(true, shuffle<<<1, 32>>>(memory, 0x0000ffffu, 20));
    EXPECT(true, shuffle<<<1, 32>>>(memory, 0xffff0000u, 2));
    EXPECT(false, shuffle<<<1, 32>>>(memory, 0x0001ffffu, 2));  // lane 16 has exited
    EXPECT(false, wait_for<<<1, 32>>>(1));
    EXPECT(true, wait_for<<<1, 32>>>(2));
    EXPECT(false, load_shared<<<1, 32>>>(memory, 31));
    EXPECT(true, load_shared<<<1, 32>>>(memory, 32));
    EXPECT(true, two_barriers<<<1, 64>>>(memory));
    EXPECT(false, overrun_stack<<<1, 1>>>(memory, 63));
    EXPECT(true, overrun_stack<<<1, 1>>>(memory, 64));
    EXPECT(true, store_at<<<1, 2048>>>(memory, 0));
    EXPECT(true, cudaMemcpy(host, memory, 128, cudaMemcpyDeviceToHost));
    EXPECT(true, cudaMemcpy(host, memory, 64, cudaMemcpyHostToDevice));
    std::printf("%s\n", right ? "faulty kernels are rejected" : "FAILED");
    return right ? 0 : 1;
}
