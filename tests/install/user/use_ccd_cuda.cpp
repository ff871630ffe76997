// The installed library for devices: prints the status of the device.
#include <ccd/cuda.hpp>
#include <cstdio>

int main() {
    const ccd::cuda::status s = ccd::cuda::device_status();
    std::printf("device: %s\n", s ? "yes" : s.error.c_str());
    return ccd::cuda::device_methods().size() == 6 ? 0 : 1;
}
