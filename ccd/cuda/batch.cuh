// What steps use of batches. Internal.
#pragma once

#include <string>

#include "ccd/cuda/launch.cuh"

namespace ccd::cuda::detail {

/// What is wrong with asking a device for that method, as status tells it; empty if nothing.
std::string fault_of_method(method m);

/// The same of asking for times until t_max.
std::string fault_of_t_max(double t_max);

/// Whether no pointer to coordinates is null.
bool has_coordinates(const positions& at);

/// Queues options.method, which is not `exact`. `memory` is for a method_memory.
template <class Pair>
void queue_float_method(device_launcher& launcher, const positions& at,
                        const candidates<Pair>& candidates, outcome* answers, arena memory,
                        const batch_options& options);

}  // namespace ccd::cuda::detail
