// Compiled once per method: ERRBOUND_METHOD is device_tight, and its type bsc_method<...>, say.
#include "ccd/cuda/device_methods.cuh"
#include "ccd/cuda/method_stages.hpp"

namespace ccd::cuda::detail {
namespace {

template <class T, class Pair>
void queue_method(device_launcher& launcher, const positions& at,
                  const candidates<Pair>& candidates, outcome* answers, arena memory) {
    const method_memory all(memory, candidates.count);
    run_method<ERRBOUND_METHOD_TYPE, T>(launcher, at, candidates, answers, all);
}

template <class T>
constexpr device_method::functions functions_in = {{queue_method<T, vertex_face_pair>},
                                                   {queue_method<T, edge_edge_pair>}};

}  // namespace

const device_method ERRBOUND_METHOD = {functions_in<double>, functions_in<float>};

}  // namespace ccd::cuda::detail
