// The measured peak rates of the device.
#pragma once

#include <cuda_runtime_api.h>

namespace bench {

/// Throws std::runtime_error with CUDA's message unless the call succeeded.
void check(cudaError_t e);

struct device_peaks {
    double bytes_per_second = 0;  ///< read and written
    double float_operations = 0;  ///< a second; products and sums, not fused
    double double_operations = 0;
};

/// Throws the same exception as check.
device_peaks measured_peaks();

}  // namespace bench
