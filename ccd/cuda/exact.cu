// `exact` for the device, compiled once for each kind (ERRBOUND_PAIR).
#include "ccd/cuda/device_methods.cuh"
#include "ccd/cuda/exact_stages.hpp"

namespace ccd::cuda::detail {

void queue_exact(device_launcher& launcher, const positions& at,
                 const candidates<ERRBOUND_PAIR>& candidates, outcome* answers,
                 const exact_memory& memory, precision p) {
    run_exact_stages(launcher, at, candidates, answers, memory, p);
}

}  // namespace ccd::cuda::detail
