// First times for the device, compiled once for each kind (ERRBOUND_PAIR).
#include "ccd/cuda/device_methods.cuh"
#include "ccd/cuda/time_stages.hpp"

namespace ccd::cuda::detail {

void queue_times(device_launcher& launcher, const positions& at,
                 const candidates<ERRBOUND_PAIR>& candidates, first_time* times,
                 const time_memory& memory, const times_request& request) {
    run_time_stages(launcher, at, candidates, times, memory, request);
}

}  // namespace ccd::cuda::detail
