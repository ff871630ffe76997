// What the device can do at most, as measured.
#pragma once

namespace bench {

struct device_peaks {
    double bytes_per_second = 0;  ///< read and written
    double float_operations = 0;  ///< a second; products and sums, not fused
    double double_operations = 0;
};

/// Throws std::runtime_error on CUDA's errors.
device_peaks measured_peaks();

}  // namespace bench
