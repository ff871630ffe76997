// The methods on the device, compiled once each (ccd/cuda/method.cu). Internal.
#pragma once

#include <ccd/cuda.hpp>

#include "ccd/cuda/launch.cuh"

namespace ccd::cuda::detail {

struct exact_memory;
struct time_memory;
struct times_request;

/// Queues the stages of one method, except `exact`, for pairs of one kind.
template <class Pair>
struct queue_function {
    void (*queue)(device_launcher& launcher, const positions& at,
                  const candidates<Pair>& candidates, outcome* answers, arena memory);
};
struct device_method {
    struct functions : queue_function<vertex_face_pair>, queue_function<edge_edge_pair> {};
    functions float64, float32;
};

extern const device_method device_float, device_safe, device_tight, device_safeccd,
    device_safeccd_tight;

/// These call run_exact_stages and run_time_stages.
void queue_exact(device_launcher& launcher, const positions& at,
                 const candidates<vertex_face_pair>& candidates, outcome* answers,
                 const exact_memory& memory, precision p);
void queue_exact(device_launcher& launcher, const positions& at,
                 const candidates<edge_edge_pair>& candidates, outcome* answers,
                 const exact_memory& memory, precision p);

void queue_times(device_launcher& launcher, const positions& at,
                 const candidates<vertex_face_pair>& candidates, first_time* times,
                 const time_memory& memory, const times_request& request);
void queue_times(device_launcher& launcher, const positions& at,
                 const candidates<edge_edge_pair>& candidates, first_time* times,
                 const time_memory& memory, const times_request& request);

}  // namespace ccd::cuda::detail
