#include "tests/bench/heap.hpp"

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<bool> counting = false;
std::atomic<std::ptrdiff_t> in_use = 0;  // below zero where memory from before start() is freed
std::atomic<std::ptrdiff_t> peak = 0;

void add(void* p) {
    if (!counting.load(std::memory_order_relaxed)) return;
    const auto size = static_cast<std::ptrdiff_t>(malloc_usable_size(p));
    const std::ptrdiff_t now = in_use.fetch_add(size, std::memory_order_relaxed) + size;
    std::ptrdiff_t highest = peak.load(std::memory_order_relaxed);
    while (now > highest && !peak.compare_exchange_weak(highest, now, std::memory_order_relaxed)) {
    }
}

void* counted(void* p) {
    if (p == nullptr) throw std::bad_alloc();
    add(p);
    return p;
}

void release(void* p) noexcept {
    if (p != nullptr && counting.load(std::memory_order_relaxed)) {
        in_use.fetch_sub(static_cast<std::ptrdiff_t>(malloc_usable_size(p)),
                         std::memory_order_relaxed);
    }
    std::free(p);
}

}  // namespace

// The forms for arrays and without exceptions call these.
void* operator new(std::size_t size) {
    return counted(std::malloc(std::max<std::size_t>(size, 1)));
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    const auto to = static_cast<std::size_t>(alignment);
    return counted(std::aligned_alloc(to, (std::max<std::size_t>(size, 1) + to - 1) / to * to));
}
void operator delete(void* p) noexcept {
    release(p);
}
void operator delete(void* p, std::size_t) noexcept {
    release(p);
}
void operator delete(void* p, std::align_val_t) noexcept {
    release(p);
}
void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
    release(p);
}

namespace bench::heap {

void start() {
    in_use = 0;
    peak = 0;
    counting = true;
}

std::size_t stop() {
    counting = false;
    return static_cast<std::size_t>(peak.load());
}

}  // namespace bench::heap
