// Kernels that the emulator must reject, and similar valid ones. Each runs in a separate process,
// since an error disables the device.
#include <cuda_runtime.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <vector>

namespace {

constexpr int written = 128;  // elements of `memory`, all zeros; the rest of it is never written
int* memory = nullptr;

struct test_case {
    const char* text;
    bool rejected;
    void (*launch)();
};
std::vector<test_case> cases;

// clang-format off
// REJECTED(blocks, threads, code) and VALID: thread t of block b runs the code with the memory p
// and 128 elements s of shared memory.
#define REJECTED(...) NUMBERED_CASE(__COUNTER__, true, __VA_ARGS__)
#define VALID(...) NUMBERED_CASE(__COUNTER__, false, __VA_ARGS__)
#define NUMBERED_CASE(...) EXPANDED_CASE(__VA_ARGS__)
#define EXPANDED_CASE(n, rejected, blocks, threads, ...)                                \
    __global__ void case##n([[maybe_unused]] int* p) {                                  \
        [[maybe_unused]] __shared__ __align__(8) int s[128];                            \
        [[maybe_unused]] const int t = int(threadIdx.x), b = int(blockIdx.x);           \
        __VA_ARGS__;                                                                    \
    }                                                                                   \
    const bool listed##n = (cases.push_back({#__VA_ARGS__, rejected,                    \
                            [] { case##n<<<blocks, threads>>>(memory); }}), true)
#define BYTES(pointer) reinterpret_cast<volatile signed char*>(pointer)
#define WIDE(pointer) reinterpret_cast<long long*>(pointer)
#define VOLATILE(pointer) static_cast<volatile int*>(pointer)

// Addresses.
VALID(1, 1, p[15] = 1);
REJECTED(1, 1, p[2 * written] = 1);
REJECTED(1, 1, p[-1] = 1);
VALID(1, 1, *WIDE(p) = 1);
REJECTED(1, 1, *WIDE(p + 1) = 1);
VALID(1, 128, s[t] = t; __syncthreads(); p[t] = s[127 - t]);
REJECTED(1, 128, s[t] = t; __syncthreads(); p[t] = s[128 - t]);
VALID(1, 32, volatile int local[64]; for (int i = 0; i < 64; ++i) local[i] = i; p[t] = local[t + 32]);
REJECTED(1, 32, volatile int local[64]; for (int i = 0; i < 64; ++i) local[i] = i; p[t] = local[t + 33]);
REJECTED(1, 2048, if (t == 0) p[0] = 1);

// Memory that was never written.
REJECTED(1, 1, p[0] = p[written]);
REJECTED(1, 1, atomicAdd(p + written, 1));
REJECTED(1, 1, *BYTES(p + written) = 1; p[0] = *VOLATILE(p + written));
REJECTED(1, 1, BYTES(p + written)[1] = 1; *WIDE(p) = *WIDE(p + written));
VALID(1, 1, BYTES(p + written)[0] = 1; *WIDE(p) = *WIDE(p + written));
REJECTED(2, 1, if (b == 1) p[0] = p[written]; else p[written + 1] = 1);
VALID(1, 1, p[written] = 1; p[0] = *VOLATILE(p + written));
REJECTED(1, 32, p[t] = s[t]);
REJECTED(1, 32, atomicAdd(s, t));
REJECTED(1, 32, if (t < 31) s[t] = t; __syncthreads(); p[t] = s[31 - t]);
REJECTED(1, 32, s[2 * t] = t; __syncwarp(); WIDE(p)[t] = WIDE(s)[t]);
REJECTED(2, 1, if (b == 0) s[0] = 1; __syncthreads(); p[b] = *VOLATILE(s));
VALID(1, 32, if (t < 20) s[t] = t; __syncthreads(); if (t < 20) p[t] = s[19 - t]);

// Races between lanes of a warp.
REJECTED(1, 32, s[t] = t; p[t] = s[t ^ 1]);
REJECTED(1, 32, VOLATILE(s)[0] = t);
REJECTED(1, 32, if (t == 0) s[0] = 1; __syncwarp(); p[t] = s[0]; if (t == 31) VOLATILE(s)[0] = 2);
REJECTED(1, 32, if (t == 0) s[0] = 1; __syncwarp(); p[t] = s[0]; if (t == 31) __syncwarp(1u << 31), VOLATILE(s)[0] = 2);
REJECTED(1, 32, s[t] = t; p[t] = __shfl_sync(~0u, t, 0) + s[t ^ 1]);
REJECTED(1, 32, s[t] = t; p[t] = __any_sync(~0u, t == 3) + s[t ^ 1]);
REJECTED(1, 32, s[t] = t; __syncwarp(); p[t] = s[t ^ 1]; s[t] = 0);
REJECTED(1, 32, s[t] = t; __syncwarp(t < 16 ? 0xffff : 0xffff0000); p[t] = s[t ^ 16]);
REJECTED(1, 32, s[t] = t; __syncwarp(); for (int d = 16; d > 0; d /= 2) if (t < d) VOLATILE(s)[t] = VOLATILE(s)[t] + VOLATILE(s)[t + d]);
REJECTED(1, 32, BYTES(s)[t / 2] = 1);
REJECTED(1, 32, s[t] = t; if (t < 16) WIDE(p)[t] = WIDE(s)[t]);
VALID(1, 32, s[t] = t; __syncwarp(); p[t] = s[t ^ 1]; __syncwarp(); s[t] = 0);
VALID(1, 32, if (t == 0) s[0] = 1; __syncwarp(); p[t] = s[0]; __syncwarp(); if (t == 31) VOLATILE(s)[0] = 2);
VALID(1, 32, s[t] = t; __syncwarp(t < 16 ? 0xffff : 0xffff0000); p[t] = s[t ^ 1]);
VALID(1, 32, s[t] = t; for (int d = 16; d > 0; d /= 2) { __syncwarp(); if (t < d) s[t] += s[t + d]; });
VALID(1, 32, BYTES(s)[t] = 1; __syncwarp(); p[t] = BYTES(s)[t ^ 1]);
VALID(1, 32, s[t] = t; __syncwarp(); if (t < 16) WIDE(p)[t] = WIDE(s)[t]);
VALID(1, 32, p[t] = __popc(__ballot_sync(~0u, t % 3 == 0)) + __shfl_sync(~0u, t, 7) + __all_sync(~0u, t < 32));
VALID(1, 3, s[t] = t; if (t < 2) __syncwarp(3); if (t != 1) __syncwarp(5); if (t == 0) p[0] = s[1] + s[2]);
VALID(1, 3, if (t == 0) s[0] = 1; __syncwarp(7); if (t != 0) p[t] = s[0]; if (t < 2) __syncwarp(3); if (t != 1) __syncwarp(5); if (t == 0) VOLATILE(s)[0] = 2);
REJECTED(1, 3, if (t == 0) s[0] = 1; __syncwarp(7); if (t != 0) p[t] = s[0]; if (t < 2) __syncwarp(3); if (t == 0) VOLATILE(s)[0] = 2);

// Races between warps.
REJECTED(1, 64, s[t] = t; p[t] = s[t ^ 32]);
REJECTED(1, 64, s[t] = t; __syncthreads(); s[t] = 1; __syncwarp(); p[t] = s[t ^ 32]);
REJECTED(1, 64, s[t] = t; __syncthreads(); if (t < 32) p[t] = s[t + 32]; else s[t] = 0);
REJECTED(1, 64, if (t % 32 == 0) VOLATILE(s)[0] = t);
REJECTED(1, 64, s[t] = t; __syncthreads(); for (int d = 32; d > 0; d /= 2) if (t < d) s[t] += s[t + d]);
REJECTED(1, 64, for (int i = 0; i < 4; ++i) { s[t] = i; __syncthreads(); p[t] += s[t ^ 32]; });
REJECTED(1, 64, if (t == 0) s[0] = 0; atomicAdd(s, t));
REJECTED(1, 64, if (t == 0) s[0] = 0; __syncthreads(); if (t < 32) atomicAdd(s, t); else p[t] = s[0]);
REJECTED(1, 64, if (t == 0) s[0] = 0; __syncthreads(); if (t < 32) p[t] = s[0]; else atomicAdd(s, t));
REJECTED(1, 64, if (t == 0) s[0] = 0; __syncthreads(); if (t < 32) atomicAdd(s, t); else if (t == 32) VOLATILE(s)[0] = 0);
REJECTED(1, 64, if (t == 0) s[0] = 0; __syncthreads(); if (t % 32 == 0) p[t] = s[0]; __syncwarp(); if (t == 33) VOLATILE(s)[0] = 1);
REJECTED(1, 64, if (t < 32) p[t + 1] = *VOLATILE(p); else if (t == 32) p[0] = 1);
REJECTED(1, 64, if (t == 0) p[0] = 1; else if (t >= 32) p[t] = *VOLATILE(p));
REJECTED(1, 64, p[t] = t; p[64 + t] = p[t ^ 32]);
REJECTED(1, 64, p[0] = t);
VALID(1, 64, s[t] = t; __syncthreads(); for (int d = 32; d > 0; d /= 2) { if (t < d) s[t] += s[t + d]; __syncthreads(); });
VALID(1, 64, for (int i = 0; i < 4; ++i) { s[i % 2 * 64 + t] = i; __syncthreads(); p[t] += s[i % 2 * 64 + (t ^ 32)]; });
VALID(1, 64, if (t == 0) s[0] = 0; __syncthreads(); atomicAdd(s, t); __syncthreads(); p[t] = s[0]);
VALID(1, 64, s[t] = __syncthreads_or(t == 5); p[t] = s[t]; p[t] += __syncthreads_or(1) + s[t ^ 32]);
VALID(1, 64, p[t] = t; __syncthreads(); p[64 + t] = p[t ^ 32]);
VALID(1, 64, if (t < 32) { s[t] = t; __syncwarp(); p[t] = s[t ^ 1]; });

// Races between blocks.
REJECTED(2, 1, p[0] = b);
REJECTED(2, 1, p[b] = 1; p[b + 2] = *VOLATILE(p + 1 - b));
REJECTED(2, 1, if (b == 0) p[1] = p[0]; else p[0] = 1);
REJECTED(2, 1, p[1 + b] = p[0]; if (b == 1) p[0] = 1);
REJECTED(2, 1, p[1 + b] = p[0]; __syncthreads(); p[3 + b] = p[0]; __syncthreads(); if (b == 1) p[0] = 1);
REJECTED(2, 1, atomicAdd(p, 1); p[1 + b] = p[0]);
REJECTED(2, 1, atomicAdd(p, 1); __syncthreads(); if (b == 0) p[0] = 0);
VALID(2, 32, p[b * 32 + t] = p[127] + 1);
VALID(2, 64, p[b * 64 + t] = t; __syncthreads(); p[b * 64 + t] += 1);
VALID(4, 64, atomicAdd(p, t));
VALID(4, 64, reinterpret_cast<char*>(p)[b * 64 + t] = 1);
VALID(2, 32, s[t] = t; __syncwarp(); p[32 * b + t] = s[t ^ 1]);
VALID(4, 64, if (t == 5) *VOLATILE(p) = 1);

// Barriers and masks.
VALID(1, 64, if (t < 32) return; p[t] = __shfl_sync(~0u, t, 3));
VALID(1, 64, if (t % 4 != 0) return; p[t] = __ballot_sync(0x11111111u, t > 40));
VALID(1, 20, __syncwarp(); p[t] = __ballot_sync(~0u, 1); __syncthreads());
VALID(1, 32, if (t < 16) p[t] = __shfl_sync(0xffffu, t, 2));
VALID(1, 32, if (t < 16) p[t] = __shfl_sync(0x1ffffu, t, 2));  // lane 16 has exited
REJECTED(1, 32, if (t < 16) p[t] = __shfl_sync(0x1ffffu, t, 16));
REJECTED(1, 32, if (t < 16) p[t] = __shfl_sync(0xffffu, t, 20));
REJECTED(1, 32, if (t < 16) p[t] = __shfl_sync(0xffff0000u, t, 2));
REJECTED(1, 32, p[t] = __ballot_sync(t < 16 ? ~0u : 0xffff0000u, t > 5));
REJECTED(1, 32, if (t < 16) p[t] = __ballot_sync(~0u, t > 5); __syncthreads());
REJECTED(1, 32, if (t < 16) __syncwarp(); __syncthreads());
REJECTED(1, 32, __syncwarp(0));
REJECTED(1, 32, if (t == 0) __syncwarp(2));
VALID(1, 32, if (t == 0) __syncwarp(1));
REJECTED(1, 64, if (t < 32) __syncthreads(); else { p[t] = 1; __syncthreads(); p[t] = 2; });
REJECTED(1, 64, if (t < 32) asm volatile("bar.sync 0;"); else asm volatile("bar.sync 1;"));
REJECTED(1, 64, if (t < 32) __syncthreads(); p[t] = 1);
REJECTED(1, 64, if (t >= 40) return; p[t] = 1; __syncthreads());
REJECTED(1, 64, for (int i = 0; i <= t / 32; ++i) __syncthreads());
REJECTED(1, 64, if (t < 32) asm volatile("bar.sync 0, 32;"));
REJECTED(1, 64, asm volatile("barrier.sync 0;"));
REJECTED(1, 64, asm volatile("bar.arrive 0, 64;"));
// clang-format on

/// Runs `run` in a separate process, which fails after a reported error. True if the result is as
/// expected.
template <class Run>
bool reported(const char* text, bool expected, const Run& run) {
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child == 0) {
        cudaMalloc(&memory, 2 * written * sizeof(int));
        cudaMemsetAsync(memory, 0, written * sizeof(int), nullptr);
        run();
        _exit(cudaGetLastError() != cudaSuccess || cudaDeviceSynchronize() != cudaSuccess);
    }
    int status = 0;
    waitpid(child, &status, 0);
    const bool found = !WIFEXITED(status) || WEXITSTATUS(status) != 0;
    if (found != expected) std::printf("%s: %s\n", text, found ? "rejected" : "not rejected");
    return found == expected;
}

}  // namespace

int main() {
    int host[2 * written] = {};
    bool right = true;
    for (const test_case& c : cases) right &= reported(c.text, c.rejected, c.launch);
#define EXPECT(rejected, ...) right &= reported(#__VA_ARGS__, rejected, [&] { __VA_ARGS__; })
    EXPECT(true, cudaFree(memory), cases[0].launch());
    EXPECT(true, memory = host, cases[0].launch());
    EXPECT(true, memory = nullptr, cases[0].launch());
    EXPECT(true, host[0] = *memory);
    EXPECT(false, cudaMemcpy(host, memory, sizeof host / 2, cudaMemcpyDeviceToHost));
    EXPECT(true, cudaMemcpy(host, memory, sizeof host, cudaMemcpyDeviceToHost));
    EXPECT(false, cudaMemcpy(memory, host, sizeof host, cudaMemcpyHostToDevice));
    EXPECT(true, cudaMemcpy(memory, host, 2 * sizeof host, cudaMemcpyHostToDevice));
    std::printf("%s\n", right ? "faulty kernels are rejected" : "FAILED");
    return right ? 0 : 1;
}
