// Runs kernel bodies on a device (ccd/cuda/launch.hpp). Internal; requires nvcc.
#pragma once

#include <cuda_runtime.h>

#include <algorithm>
#include <ccd/cuda.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "ccd/cuda/launch.hpp"

namespace ccd::cuda::detail {

inline constexpr unsigned block_threads = 128;

template <class Body>
__global__ void __launch_bounds__(block_threads) run_for_each(const Body body, std::size_t n) {
    const std::size_t i = std::size_t(blockIdx.x) * blockDim.x + threadIdx.x;
    if (i < n) body(static_cast<std::uint32_t>(i));
}

template <class Body>
__global__ void __launch_bounds__(block_threads)
    run_for_each_packet(const Body body, std::size_t n) {
    const std::size_t i = (std::size_t(blockIdx.x) * blockDim.x + threadIdx.x) / warp::lanes;
    if (i < n) body(static_cast<std::uint32_t>(i));
}

/// The resident blocks process the items in a loop, since the host has not read their number.
template <class Body>
__global__ void __launch_bounds__(block_threads) run_for_each_queued(const Body body, queue items) {
    const std::size_t n = *items.size;
    for (std::size_t i = std::size_t(blockIdx.x) * blockDim.x + threadIdx.x; i < n;
         i += std::size_t(gridDim.x) * blockDim.x)
        body(items.items[i]);
}

template <class T>
__global__ void set_value(T* p, const T value) {
    *p = value;
}

/// Runs bodies on the current device, in order on one stream. Does nothing after the first error.
class device_launcher {
  public:
    explicit device_launcher(stream s, std::optional<arena> temporary = {})
        : stream_(s), temporary_(temporary) {}

    template <class T>
    class buffer {
      public:
        buffer() = default;
        buffer(const buffer&) = delete;
        buffer& operator=(const buffer&) = delete;
        ~buffer() {
            if (data_ != nullptr) (void)cudaFree(data_);
        }

        void resize(device_launcher& launcher, std::size_t n) { make_room(launcher, n, 0); }
        void extend(device_launcher& launcher, std::size_t n) { make_room(launcher, n, size_); }
        T* data() { return data_; }
        std::size_t size() const { return size_; }

      private:
        void make_room(device_launcher& launcher, std::size_t n, std::size_t kept) {
            if (!launcher.ok()) return;
            if (n > capacity_) {
                const std::size_t capacity = std::max(n, 2 * kept);
                T* larger = nullptr;
                if (!launcher.check(cudaMalloc(&larger, capacity * sizeof(T)))) return;
                if (kept > 0)
                    launcher.check(cudaMemcpyAsync(larger, data_, kept * sizeof(T),
                                                   cudaMemcpyDeviceToDevice, launcher.stream_));
                launcher.wait();  // queued work may use the old memory
                if (data_ != nullptr) launcher.check(cudaFree(data_));
                data_ = larger;
                capacity_ = capacity;
            }
            size_ = n;
        }

        T* data_ = nullptr;
        std::size_t size_ = 0, capacity_ = 0;
    };

    template <class Body>
    void for_each(std::size_t n, const Body& body) {
        for_each_thread(n, run_for_each<Body>, body, n);
    }
    template <class Body>
    void for_each_packet(std::size_t n, const Body& body) {
        for_each_thread(warp::lanes * n, run_for_each_packet<Body>, body, n);
    }
    template <class Body>
    void for_each_queued(const queue& items, const Body& body) {
        if (!ok()) return;
        int device = 0, processors = 0, resident = 0;
        check(cudaGetDevice(&device));
        check(cudaDeviceGetAttribute(&processors, cudaDevAttrMultiProcessorCount, device));
        check(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&resident, run_for_each_queued<Body>,
                                                            block_threads, 0));
        if (!ok()) return;
        const auto blocks = static_cast<unsigned>(processors * std::max(resident, 1));
        launch(run_for_each_queued<Body>, blocks, block_threads, body, items);
    }
    template <class T>
    void set(T* p, const T& value) {
        launch(set_value<T>, 1, 1, p, value);
    }
    // Defined in ccd/cuda/cub.cuh, as CUB's headers take half of the time to compile.
    template <class T, class Of, class Combine>
    void reduce(std::size_t n, const Of& of, const Combine& combine, const T& start, T* r);
    template <class In, class Out>
    void exclusive_scan(const In& in, Out* out, std::size_t n);
    /// Defined in ccd/cuda/sort.cu, since it is slow to compile.
    void sort(std::uint32_t* keys, std::uint32_t* values, std::size_t n);
    template <class T>
    void read(const T* p, std::size_t n, T* to) {
        if (!ok() || n == 0) return;
        check(cudaMemcpyAsync(to, p, n * sizeof(T), cudaMemcpyDeviceToHost, stream_));
        wait();
    }
    template <class T>
    void write(T* p, std::size_t n, const T* from) {
        if (!ok() || n == 0) return;
        check(cudaMemcpyAsync(p, from, n * sizeof(T), cudaMemcpyHostToDevice, stream_));
        wait();  // `from` may be pageable memory that the caller frees
    }

    bool ok() const { return status_.error.empty(); }
    const status& result() const { return status_; }
    /// Stores the first error and clears CUDA's own state. True if there is no error.
    bool check(cudaError_t e) {
        if (e != cudaSuccess) {
            if (ok()) status_.error = std::string("CUDA: ") + cudaGetErrorString(e);
            (void)cudaGetLastError();
        }
        return ok();
    }
    void begin(stream s) {
        stream_ = s;
        status_.error.clear();
    }
    void wait() {
        if (ok()) check(cudaStreamSynchronize(stream_));
    }
    void fail(std::string text) {
        if (ok()) status_.error = std::move(text);
    }

  private:
    template <class Body>
    void for_each_thread(std::size_t threads, void (*kernel)(Body, std::size_t), const Body& body,
                         std::size_t n) {
        const auto blocks = static_cast<unsigned>((threads + block_threads - 1) / block_threads);
        if (n > 0) launch(kernel, blocks, block_threads, body, n);
    }
    template <class... Parameters, class... Arguments>
    void launch(void (*kernel)(Parameters...), unsigned blocks, unsigned threads,
                const Arguments&... arguments) {
        if (!ok()) return;
        cudaLaunchConfig_t configuration{};
        configuration.gridDim = dim3(blocks);
        configuration.blockDim = dim3(threads);
        configuration.stream = stream_;
        check(cudaLaunchKernelEx(&configuration, kernel, arguments...));
    }

    template <class Call>
    void with_temporary(const Call& call);
    template <class Call>
    bool check_cub(const Call& call, void* memory, std::size_t& bytes);

    stream stream_;
    std::optional<arena> temporary_;
    status status_;
    buffer<std::byte> own_;
    buffer<std::uint32_t> spare_;
};

}  // namespace ccd::cuda::detail
