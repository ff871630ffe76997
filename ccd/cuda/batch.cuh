// Functions of batches for steps. Internal.
#pragma once

#include <string>

#include "ccd/cuda/launch.cuh"

namespace ccd::cuda::detail {

/// These return a message, or an empty text if there is no fault.
std::string fault_of_method(method m);

std::string fault_of_t_max(double t_max);

bool has_coordinates(const positions& at);

/// Queues the stages of options.method, except `exact`. `memory` must suffice for a method_memory.
template <class Pair>
void queue_float_method(device_launcher& launcher, const positions& at,
                        const candidates<Pair>& candidates, outcome* answers, arena memory,
                        const batch_options& options);

}  // namespace ccd::cuda::detail
