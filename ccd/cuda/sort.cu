#include <cub/device/device_radix_sort.cuh>

#include "ccd/cuda/cub.cuh"

namespace ccd::cuda::detail {

void device_launcher::sort(std::uint32_t* keys, std::uint32_t* values, std::size_t n) {
    spare_.resize(*this, 2 * n);
    if (!ok()) return;
    cub::DoubleBuffer<std::uint32_t> k(keys, spare_.data()), v(values, spare_.data() + n);
    with_temporary([&](void* memory, std::size_t& bytes) {
        return cub::DeviceRadixSort::SortPairs(memory, bytes, k, v, static_cast<std::int64_t>(n), 0,
                                               32, stream_);
    });
    const auto bring_back = [&](std::uint32_t* to, const std::uint32_t* from) {
        if (ok() && to != from)
            check(cudaMemcpyAsync(to, from, n * sizeof *to, cudaMemcpyDeviceToDevice, stream_));
    };
    bring_back(keys, k.Current());
    bring_back(values, v.Current());
}

}  // namespace ccd::cuda::detail
