// The measured peak rates of the device.
#pragma once

#include <cuda_runtime_api.h>

namespace bench {

/// Throws std::runtime_error, in CUDA's words, unless all is well.
void check(cudaError_t e);

struct device_peaks {
    double bytes_per_second = 0;  ///< read and written
    double float_operations = 0;  ///< a second; products and sums, not fused
    double double_operations = 0;
};

/// Throws as check does.
device_peaks measured_peaks();

}  // namespace bench
