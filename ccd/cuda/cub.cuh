// Sums and scans of device_launcher, by CUB. Internal; requires nvcc.
#pragma once

#include <thrust/iterator/counting_iterator.h>
#include <thrust/iterator/transform_iterator.h>

#include <cstddef>
#include <cstdint>
#include <cub/device/device_reduce.cuh>
#include <cub/device/device_scan.cuh>
#include <stdexcept>
#include <string>

#include "ccd/cuda/launch.cuh"

namespace ccd::cuda::detail {

/// The input of a scan, followed by a zero for the total.
template <class In, class Out>
struct padded {
    In in;
    std::size_t n;
    constexpr Out operator()(std::uint64_t i) const {
        return i < n ? static_cast<Out>(in(static_cast<std::uint32_t>(i))) : Out{};
    }
};

template <class T, class Of, class Combine>
void device_launcher::reduce(std::size_t n, const Of& of, const Combine& combine, const T& start,
                             T* r) {
    const auto items = thrust::make_counting_iterator(std::uint32_t(0));
    with_temporary([&](void* memory, std::size_t& bytes) {
        return cub::DeviceReduce::TransformReduce(
            memory, bytes, items, r, static_cast<std::int64_t>(n), combine, of, start, stream_);
    });
}

template <class In, class Out>
void device_launcher::exclusive_scan(const In& in, Out* out, std::size_t n) {
    const padded<In, Out> of{in, n};
    const auto items =
        thrust::make_transform_iterator(thrust::make_counting_iterator(std::uint64_t(0)), of);
    with_temporary([&](void* memory, std::size_t& bytes) {
        return cub::DeviceScan::ExclusiveSum(memory, bytes, items, out,
                                             static_cast<std::int64_t>(n) + 1, stream_);
    });
}

/// Calls a CUB function twice: for the size of its memory, then with memory from `temporary`, or
/// from a buffer if there is none.
template <class Call>
void device_launcher::with_temporary(const Call& call) {
    if (!ok()) return;
    std::size_t bytes = 0;
    if (!check_cub(call, nullptr, bytes)) return;
    void* memory = nullptr;
    if (temporary_) {
        memory = arena(*temporary_).template take<std::byte>(bytes);
        if (memory == nullptr) {
            fail("CUDA: scratch memory is too small; expected " + std::to_string(bytes) +
                 " more bytes");
            return;
        }
    } else {
        own_.resize(*this, std::max<std::size_t>(bytes, 1));
        memory = own_.data();
    }
    if (ok()) check_cub(call, memory, bytes);
}

/// CUB returns most errors, but throws if cudaGetDevice or cudaSetDevice fails.
template <class Call>
bool device_launcher::check_cub(const Call& call, void* memory, std::size_t& bytes) {
    try {
        return check(call(memory, bytes));
    } catch (const std::runtime_error& e) {
        (void)cudaGetLastError();
        fail(std::string("CUDA: ") + e.what());
        return false;
    }
}

}  // namespace ccd::cuda::detail
