// CUDA's runtime on the emulated device. Work runs as late as CUDA allows: when a call waits for
// its stream.
#include <cuda_runtime_api.h>

#include <algorithm>
#include <cstdio>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>

#include "tests/ccd/cuda/emulator/device.hpp"

using namespace ptx;

namespace {

constexpr int processors = 2, blocks_per_processor = 2;

std::recursive_mutex mutex;
cudaError_t last_error = cudaSuccess;
cudaError_t device_error = cudaSuccess;  // a kernel's error, which every later call returns
long call_count = 0;
const bool trace = setting("PTXEMU_TRACE") != 0;

cudaError_t noted(cudaError_t error) {
    if (error != cudaSuccess) last_error = error;
    return error;
}

/// Runs a call of the runtime, unless a kernel has failed or PTXEMU_FAIL_CALL selects this call.
template <class Call>
cudaError_t run_call(const char* name, cudaError_t failure, const Call& call) {
    const std::lock_guard guard(mutex);
    ++call_count;
    if (trace) std::fprintf(stderr, "emulator: call %ld: %s\n", call_count, name);
    if (device_error != cudaSuccess) return noted(device_error);
    if (call_count == setting("PTXEMU_FAIL_CALL")) return noted(failure);
    return noted(call());
}

auto& kernels() {
    static auto& all = *new std::map<const void*, registered_kernel>;  // filled before main starts
    return all;
}

struct work {
    u64 number;
    std::function<cudaError_t()> run;
};
struct stream_queue {
    std::deque<work> queue;
    bool waits_for_default = true;
};
u64 work_count = 0;
stream_queue default_stream;
std::map<cudaStream_t, std::unique_ptr<stream_queue>> streams;

stream_queue* find(cudaStream_t s) {
    if (s == nullptr || s == cudaStreamLegacy || s == cudaStreamPerThread) return &default_stream;
    const auto found = streams.find(s);
    return found == streams.end() ? nullptr : found->second.get();
}

/// Runs the work of a stream up to a number, after the work that it has to wait for.
void drain(stream_queue& s, u64 number) {
    while (!s.queue.empty() && s.queue.front().number <= number) {
        const u64 before = s.queue.front().number - 1;
        if (&s == &default_stream) {
            for (auto& [_, other] : streams)
                if (other->waits_for_default) drain(*other, before);
        } else if (s.waits_for_default) {
            drain(default_stream, before);
        }
        if (s.queue.empty() || s.queue.front().number != before + 1) continue;
        const work first = std::move(s.queue.front());
        s.queue.pop_front();
        if (device_error == cudaSuccess) device_error = first.run();
    }
}
cudaError_t drain_all() {
    drain(default_stream, work_count);
    for (auto& [_, s] : streams) drain(*s, work_count);
    return device_error;
}
cudaError_t enqueue(cudaStream_t to, std::function<cudaError_t()> run) {
    stream_queue* const s = find(to);
    if (s == nullptr) return cudaErrorInvalidResourceHandle;
    s->queue.push_back({++work_count, std::move(run)});
    return cudaSuccess;
}

cudaError_t fault_found(const std::string& what) {
    std::fprintf(stderr, "emulator: %s\n", what.c_str());
    return cudaErrorIllegalAddress;
}

cudaError_t enqueue_launch(const void* host_function, dim3 grid, dim3 block, void** arguments,
                           std::size_t dynamic_bytes, cudaStream_t stream) {
    const auto found = kernels().find(host_function);
    if (found == kernels().end()) return cudaErrorInvalidDeviceFunction;
    const kernel& code = found->second.of->find_kernel(found->second.name);
    const u64 threads = u64(block.x) * block.y * block.z, blocks = u64(grid.x) * grid.y * grid.z;
    if (threads == 0 || threads > code.max_threads || blocks == 0 || blocks > 0x7fffffff)
        return cudaErrorInvalidConfiguration;
    if (code.shared_bytes + dynamic_bytes > 48 * 1024) return cudaErrorInvalidValue;
    const auto l = std::make_shared<launch>();
    *l = {found->second.of,   &code, {grid.x, grid.y, grid.z}, {block.x, block.y, block.z},
          u32(dynamic_bytes), {}};
    l->parameters.resize(code.parameter_bytes);
    for (int i = 0; i < code.parameter_count; ++i)
        std::memcpy(l->parameters.data() + code.parameters[i].offset, arguments[i],
                    code.parameters[i].bytes);
    return enqueue(stream, [l] {
        if (trace) std::fprintf(stderr, "emulator: %u blocks of %s\n", l->grid[0], l->code->name);
        const std::string fault = run(*l);
        return fault.empty() ? cudaSuccess : fault_found(fault);
    });
}

cudaError_t enqueue_copy(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind,
                         cudaStream_t stream) {
    if (bytes == 0) return cudaSuccess;
    const bool to_device = kind == cudaMemcpyHostToDevice || kind == cudaMemcpyDeviceToDevice;
    const bool from_device = kind == cudaMemcpyDeviceToHost || kind == cudaMemcpyDeviceToDevice;
    if (memory().contains(to) != to_device || memory().contains(from) != from_device ||
        to == nullptr || from == nullptr)
        return cudaErrorInvalidValue;
    return enqueue(stream, [=] {
        const void* const source = from_device ? memory().content(from, bytes, reads) : from;
        void* const target = to_device ? memory().content(to, bytes, writes) : to;
        if (target == nullptr || source == nullptr)
            return fault_found("copy of memory that is not allocated or was never written");
        std::memmove(target, source, bytes);
        return cudaSuccess;
    });
}

cudaError_t attribute(int& value, cudaDeviceAttr name) {
    static const std::map<cudaDeviceAttr, int> values{
        {cudaDevAttrMultiProcessorCount, processors},
        {cudaDevAttrComputeCapabilityMajor, 7},
        {cudaDevAttrComputeCapabilityMinor, 5},
        {cudaDevAttrMaxGridDimX, 0x7fffffff},
        {cudaDevAttrMaxSharedMemoryPerBlock, 48 * 1024}};
    if (values.count(name) == 0) stop("attribute %d is not implemented", int(name));
    value = values.at(name);
    return cudaSuccess;
}

thread_local std::tuple<dim3, dim3, std::size_t, void*>
    configuration;  // for the next kernel<<<...>>>

}  // namespace

long ptx::runtime_calls() {
    return call_count;
}

extern "C" {

// Functions that nvcc's generated code calls.
void** __cudaRegisterFatBinary(void* wrapper) {
    struct fatbinary_wrapper {
        int magic, version;
        const unsigned char* data;
        void* unused;
    };
    return reinterpret_cast<void**>(new module(static_cast<fatbinary_wrapper*>(wrapper)->data));
}
void __cudaRegisterFatBinaryEnd(void**) {}
void __cudaUnregisterFatBinary(void**) {}
char __cudaInitModule(void**) {
    return 1;
}
void __cudaRegisterFunction(void** of, const char* host_function, char*, const char* name, int,
                            uint3*, uint3*, dim3*, dim3*, int*) {
    kernels()[host_function] = {reinterpret_cast<module*>(of), name};
}
void __cudaRegisterVar(void**, char*, char*, const char*, int, std::size_t, int, int) {}
cudaError_t __cudaGetKernel(cudaKernel_t* k, const void* host_function) {
    *k = reinterpret_cast<cudaKernel_t>(const_cast<void*>(host_function));
    return cudaSuccess;
}
unsigned __cudaPushCallConfiguration(dim3 grid, dim3 block, std::size_t bytes, void* stream) {
    configuration = {grid, block, bytes, stream};
    return 0;
}
cudaError_t __cudaPopCallConfiguration(dim3* grid, dim3* block, std::size_t* bytes, void* stream) {
    std::tie(*grid, *block, *bytes, *static_cast<void**>(stream)) = configuration;
    return cudaSuccess;
}

// The runtime's functions that are used.
cudaError_t cudaLaunchKernel(const void* f, dim3 grid, dim3 block, void** arguments,
                             std::size_t bytes, cudaStream_t s) {
    return run_call(__func__, cudaErrorLaunchOutOfResources,
                    [&] { return enqueue_launch(f, grid, block, arguments, bytes, s); });
}
cudaError_t __cudaLaunchKernel(cudaKernel_t k, dim3 grid, dim3 block, void** arguments,
                               std::size_t bytes, cudaStream_t s) {
    return cudaLaunchKernel(k, grid, block, arguments, bytes, s);
}
cudaError_t cudaLaunchKernelExC(const cudaLaunchConfig_t* c, const void* f, void** arguments) {
    return cudaLaunchKernel(f, c->gridDim, c->blockDim, arguments, c->dynamicSmemBytes, c->stream);
}
cudaError_t cudaGetDeviceCount(int* count) {
    return run_call(__func__, cudaErrorNoDevice, [&] { return *count = 1, cudaSuccess; });
}
cudaError_t cudaGetDevice(int* device) {
    return run_call(__func__, cudaErrorInitializationError,
                    [&] { return *device = 0, cudaSuccess; });
}
cudaError_t cudaSetDevice(int device) {
    return run_call(__func__, cudaErrorInitializationError,
                    [&] { return device == 0 ? cudaSuccess : cudaErrorInvalidDevice; });
}
cudaError_t cudaPointerGetAttributes(cudaPointerAttributes* attributes, const void* p) {
    return run_call(__func__, cudaErrorInvalidValue, [&] {
        *attributes = {};
        if (memory().content(p, 1, 0) != nullptr) attributes->type = cudaMemoryTypeDevice;
        return cudaSuccess;
    });
}
cudaError_t cudaDeviceGetAttribute(int* value, cudaDeviceAttr name, int) {
    return run_call(__func__, cudaErrorInvalidValue, [&] { return attribute(*value, name); });
}
cudaError_t cudaOccupancyMaxActiveBlocksPerMultiprocessorWithFlags(int* count, const void* f, int,
                                                                   std::size_t, unsigned) {
    return run_call(__func__, cudaErrorInvalidValue, [&] {
        *count = blocks_per_processor;
        return kernels().count(f) != 0 ? cudaSuccess : cudaErrorInvalidDeviceFunction;
    });
}
cudaError_t cudaFuncGetAttributes(cudaFuncAttributes* attributes, const void* f) {
    return run_call(__func__, cudaErrorInvalidValue, [&] {
        *attributes = {};
        attributes->ptxVersion = attributes->binaryVersion = 75;
        return kernels().count(f) != 0 ? cudaSuccess : cudaErrorInvalidDeviceFunction;
    });
}
cudaError_t cudaMalloc(void** p, std::size_t bytes) {
    return run_call(__func__, cudaErrorMemoryAllocation, [&] {
        *p = bytes == 0 ? nullptr : memory().allocate(bytes);
        return cudaSuccess;
    });
}
cudaError_t cudaFree(void* p) {
    return run_call(__func__, cudaErrorInvalidValue, [&] {
        if (p == nullptr) return cudaSuccess;
        drain_all();
        return memory().free(p) ? device_error : cudaErrorInvalidValue;
    });
}
cudaError_t cudaMemcpyAsync(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind,
                            cudaStream_t s) {
    return run_call(__func__, cudaErrorInvalidValue,
                    [&] { return enqueue_copy(to, from, bytes, kind, s); });
}
cudaError_t cudaMemcpy(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind) {
    return run_call(__func__, cudaErrorInvalidValue, [&] {
        if (const cudaError_t e = enqueue_copy(to, from, bytes, kind, nullptr); e != cudaSuccess)
            return e;
        drain(default_stream, work_count);
        return device_error;
    });
}
cudaError_t cudaMemsetAsync(void* to, int byte, std::size_t bytes, cudaStream_t s) {
    return run_call(__func__, cudaErrorInvalidValue, [&] {
        return enqueue(s, [=] {
            char* const content = memory().content(to, bytes, writes);
            if (content == nullptr) return fault_found("setting of memory that is not allocated");
            std::memset(content, byte, bytes);
            return cudaSuccess;
        });
    });
}
cudaError_t cudaStreamCreate(cudaStream_t* s) {
    return run_call(__func__, cudaErrorInvalidValue, [&] {
        auto queue = std::make_unique<stream_queue>();
        *s = reinterpret_cast<cudaStream_t>(queue.get());
        streams[*s] = std::move(queue);
        return cudaSuccess;
    });
}
cudaError_t cudaStreamDestroy(cudaStream_t s) {
    return run_call(__func__, cudaErrorInvalidResourceHandle, [&] {
        if (streams.count(s) == 0) return cudaErrorInvalidResourceHandle;
        drain(*find(s), work_count);
        streams.erase(s);
        return device_error;
    });
}
cudaError_t cudaStreamSynchronize(cudaStream_t s) {
    return run_call(__func__, cudaErrorUnknown, [&] {
        if (find(s) == nullptr) return cudaErrorInvalidResourceHandle;
        drain(*find(s), work_count);
        return device_error;
    });
}
cudaError_t cudaDeviceSynchronize() {
    return run_call(__func__, cudaErrorUnknown, drain_all);
}
cudaError_t cudaPeekAtLastError() {
    return device_error != cudaSuccess ? device_error : last_error;
}
cudaError_t cudaGetLastError() {
    const cudaError_t error = cudaPeekAtLastError();
    last_error = cudaSuccess;
    return error;
}
const char* cudaGetErrorString(cudaError_t error) {
    static thread_local char text[40];
    std::snprintf(text, sizeof text, error == cudaSuccess ? "no error" : "error %d", int(error));
    return text;
}
}
