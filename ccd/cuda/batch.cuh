// What steps use of batches. Internal.
#pragma once

#include "ccd/cuda/launch.cuh"

namespace ccd::cuda {

/// Whether no pointer to coordinates is null.
bool has_coordinates(const positions& at);

/// Queues options.method, which is not `exact`. `memory` is for a method_memory.
template <class Indices>
void queue_float_method(device_launcher& launcher, const positions& at,
                        const candidates<Indices>& candidates, outcome* answers, arena memory,
                        const batch_options& options);

}  // namespace ccd::cuda
