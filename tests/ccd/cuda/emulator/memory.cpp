#include <sys/mman.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>

#include "tests/ccd/cuda/emulator/device.hpp"

namespace ptx {
namespace {

template <class T>
T* reserve(u64 bytes, int access) {
    void* const p =
        mmap(nullptr, bytes, access, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (p == MAP_FAILED) stop("address space is exhausted");
    return static_cast<T*>(p);
}

}  // namespace

device_memory::device_memory() {
    constexpr u64 bytes = u64(1) << 36;
    map_.begin = reinterpret_cast<u64>(reserve<char>(bytes, PROT_NONE));
    map_.end = map_.begin + bytes;
    map_.content = reserve<char>(bytes, PROT_READ | PROT_WRITE);
    map_.valid = reserve<u16>(bytes / memory_map::granule * sizeof(u16), PROT_READ | PROT_WRITE);
}

void device_memory::set_valid(u64 offset, u64 bytes, bool valid) {
    for (u64 done = 0; done < bytes; done += memory_map::granule)
        map_.valid[(offset + done) / memory_map::granule] =
            valid ? static_cast<u16>(std::min(memory_map::granule, bytes - done)) : u16(0);
}

void* device_memory::allocate(u64 bytes) {
    const u64 offset = next_;
    next_ += (bytes + 8191) / 4096 * 4096;  // a page between allocations catches overruns
    if (next_ > map_.end - map_.begin) stop("device addresses are exhausted");
    set_valid(offset, bytes, true);
    std::memset(map_.content + offset, fill_byte(), bytes);
    allocations_[offset] = bytes;
    return reinterpret_cast<void*>(map_.begin + offset);
}

bool device_memory::free(void* p) {
    const auto found = allocations_.find(reinterpret_cast<u64>(p) - map_.begin);
    if (found == allocations_.end()) return false;
    set_valid(found->first, found->second, false);
    madvise(map_.content + found->first, found->second, MADV_DONTNEED);
    allocations_.erase(found);
    return true;
}

bool device_memory::contains(const void* p) const {
    return reinterpret_cast<u64>(p) >= map_.begin && reinterpret_cast<u64>(p) < map_.end;
}

char* device_memory::content(const void* p, u64 bytes) const {
    const u64 offset = reinterpret_cast<u64>(p) - map_.begin;
    const auto after = allocations_.upper_bound(offset);
    if (after == allocations_.begin()) return nullptr;
    const auto& [start, size] = *std::prev(after);
    return offset + bytes <= start + size ? map_.content + offset : nullptr;
}

device_memory& memory() {
    static device_memory& all = *new device_memory;  // destructors of static objects free memory
    return all;
}

int fill_byte() {
    static const int byte = std::getenv("PTXEMU_FILL") ? int(setting("PTXEMU_FILL")) : 0xCB;
    return byte;
}

long setting(const char* name) {
    const char* const value = std::getenv(name);
    return value == nullptr ? 0 : std::atol(value);
}

void stop(const char* format, ...) {
    std::va_list arguments;
    va_start(arguments, format);
    std::fputs("emulator: ", stderr);
    std::vfprintf(stderr, format, arguments);
    std::fputs("\n", stderr);
    va_end(arguments);
    std::abort();
}

}  // namespace ptx
