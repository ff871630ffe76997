#include "tests/bench/worst_cases/stack.hpp"

#include <pthread.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <stdexcept>

namespace worst_cases {
namespace {

constexpr std::size_t size = std::size_t(4) << 20;

void* call(void* work) {
    (*static_cast<const std::function<void()>*>(work))();
    return nullptr;
}

/// The stack is painted first; what has lost its paint was used.
std::size_t used_by(std::function<void()> work) {
    constexpr unsigned char paint = 0xA5;
    const std::unique_ptr<void, void (*)(void*)> memory(std::aligned_alloc(4096, size), std::free);
    auto* const lowest = static_cast<unsigned char*>(memory.get());
    if (lowest == nullptr) throw std::runtime_error("found no memory for a stack");
    std::fill_n(lowest, size, paint);
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstack(&attributes, lowest, size);
    pthread_t thread;
    const bool failed = pthread_create(&thread, &attributes, call, &work) != 0;
    pthread_attr_destroy(&attributes);
    if (failed) throw std::runtime_error("found no thread to measure a stack on");
    pthread_join(thread, nullptr);
    return size - static_cast<std::size_t>(
                      std::find_if(lowest, lowest + size, [](auto byte) { return byte != paint; }) -
                      lowest);
}

}  // namespace

std::size_t stack_of(const std::function<void()>& work) {
    const std::size_t nothing = used_by([] {});
    return std::max(used_by(work), nothing) - nothing;
}

}  // namespace worst_cases
