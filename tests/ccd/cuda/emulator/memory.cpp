#include <sys/mman.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>

#include "tests/ccd/cuda/emulator/device.hpp"

namespace ptx {

/// A thread of a block, plus a flag if accesses of other lanes, warps or blocks are not ordered
/// before its own.
struct last_access {
    u32 time, by;
};

namespace {

constexpr u64 most_shared = 48 * 1024;
constexpr char unwritten = 1, written = 2;  // bytes of a shadow; 0 is no memory
constexpr u32 of_lanes = 1 << 16, of_warps = 1 << 17, of_blocks = 1 << 18;
u32 now = 1;

template <class T>
T* reserve(u64 bytes, int access = PROT_READ | PROT_WRITE) {
    void* const p =
        mmap(nullptr, bytes, access, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (p == MAP_FAILED) stop("address space is exhausted");
    return static_cast<T*>(p);
}

/// True if an earlier access is not ordered before the next one of l. Accesses up to the time
/// `since` are: those of earlier grids, or to the shared memory of an earlier block.
bool is_unordered(const last_access& a, const lane& l, u32 since) {
    if (a.time <= since) return false;
    if (a.time <= l.block->started || (a.by & of_blocks) != 0) return true;
    if (a.time <= l.block->met) return false;
    if ((a.by & of_warps) != 0 || (a.by ^ l.thread) / 32 % 32 != 0) return true;
    if (a.by % 32 != l.id) return a.time > l.known[a.by % 32];
    return (a.by & of_lanes) != 0 && a.time > *std::max_element(l.known, l.known + 32);
}

/// True if bytes were written. In global memory, a word of 8 bytes was if its first byte was, since
/// copies of structures read their padding.
bool was_written(const shadow& s, u64 offset, u64 bytes) {
    const u64 step = s.granule == 0 || bytes < 8 ? 1 : 8;
    for (u64 i = offset; i < offset + bytes; i = i / step * step + step)
        if (s.bytes[i] == unwritten) return false;
    return true;
}

/// Checks an access to shared or global memory, and stores that it was made.
void check(const lane& l, const shadow& s, u64 offset, u64 address, u32 bytes, u32 access,
           u32 since, int line) {
    if ((access & reads) != 0 && !was_written(s, offset, bytes))
        fail(l, "read of memory that was never written", address, bytes, line);
    if ((access & writes) != 0) std::memset(s.bytes + offset, written, bytes);
    constexpr u32 races[] = {0b1010, 0b1111, 0b0010, 0b0011};  // bits are kinds
    const u32 kind = access / 2 % 4;
    // Only accesses to the last byte of a granule count.
    for (u64 i = offset >> s.granule; i < (offset + bytes) >> s.granule; ++i) {
        last_access* const last = s.accesses + 4 * i;
        for (u32 k = 0; k < 4; ++k) {
            if ((races[kind] >> k & 1) == 0 || !is_unordered(last[k], l, since)) continue;
            const bool other = last[k].time <= l.block->started || (last[k].by & of_blocks) != 0;
            fail(l, other ? "race with another block" : "race with another thread of the block",
                 address, bytes, line);
        }
        u32 by = l.thread;
        if (const auto [time, of] = last[kind]; is_unordered(last[kind], l, since))
            by |= (of & ~1023u) | (time <= l.block->started   ? of_blocks
                                   : (of ^ by) / 32 % 32 != 0 ? of_warps
                                                              : of_lanes);
        last[kind] = {now, by};
    }
}

char* local_at(lane& l, u64 address, u32 bytes, u32, int line) {
    if (address % bytes != 0) fail(l, "misaligned local address", address, bytes, line);
    if (address < l.stack || address + bytes > l.stack_end)
        fail(l, "illegal local address", address, bytes, line);
    return reinterpret_cast<char*>(address);
}
const shadow& shadow_of_shared() {
    static const shadow all{reserve<char>(most_shared),
                            reserve<last_access>(4 * most_shared * sizeof(last_access)), 0};
    return all;
}
char* shared_at(lane& l, u64 address, u32 bytes, u32 access, int line) {
    if (address % bytes != 0) fail(l, "misaligned shared address", address, bytes, line);
    if (address + bytes > l.block->shared_bytes || address + bytes < address)
        fail(l, "illegal shared address", address, bytes, line);
    check(l, shadow_of_shared(), address, address, bytes, access, l.block->started, line);
    return l.block->shared + address;
}
char* generic_at(lane& l, u64 address, u32 bytes, u32 access, int line) {
    const u64 in_shared = address - reinterpret_cast<u64>(l.block->shared);
    if (in_shared < l.block->shared_bytes) return shared_at(l, in_shared, bytes, access, line);
    if (address >= l.stack && address < l.stack_end)
        return local_at(l, address, bytes, access, line);
    return device_memory::access(l, address, bytes, access, line);
}

}  // namespace

device_memory::device_memory() {
    constexpr u64 bytes = u64(1) << 36;
    begin_ = reinterpret_cast<u64>(reserve<char>(bytes, PROT_NONE));
    end_ = begin_ + bytes;
    content_ = reserve<char>(bytes);
    shadow_ = {reserve<char>(bytes), reserve<last_access>(bytes * sizeof(last_access)), 2};
}

void* device_memory::allocate(u64 bytes) {
    const u64 offset = next_;
    next_ += (bytes + 8191) / 4096 * 4096;  // a page between allocations catches overruns
    if (next_ > end_ - begin_) stop("device addresses are exhausted");
    std::memset(shadow_.bytes + offset, unwritten, bytes);
    allocations_[offset] = bytes;
    return reinterpret_cast<void*>(begin_ + offset);
}

bool device_memory::free(void* p) {
    const auto found = allocations_.find(reinterpret_cast<u64>(p) - begin_);
    if (found == allocations_.end()) return false;
    madvise(content_ + found->first, found->second, MADV_DONTNEED);
    madvise(shadow_.bytes + found->first, found->second, MADV_DONTNEED);
    madvise(shadow_.accesses + found->first, (found->second + 3) / 4 * 4 * sizeof(last_access),
            MADV_DONTNEED);
    allocations_.erase(found);
    return true;
}

bool device_memory::contains(const void* p) const {
    return reinterpret_cast<u64>(p) >= begin_ && reinterpret_cast<u64>(p) < end_;
}

char* device_memory::content(const void* p, u64 bytes, u32 access) const {
    const u64 offset = reinterpret_cast<u64>(p) - begin_;
    const auto after = allocations_.upper_bound(offset);
    if (after == allocations_.begin()) return nullptr;
    const auto& [start, size] = *std::prev(after);
    if (offset + bytes > start + size) return nullptr;
    if ((access & writes) != 0) std::memset(shadow_.bytes + offset, written, bytes);
    if ((access & reads) != 0 && !was_written(shadow_, offset, bytes)) return nullptr;
    return content_ + offset;
}

char* device_memory::access(lane& l, u64 address, u32 bytes, u32 access, int line) {
    const device_memory& m = memory();
    if (address % bytes != 0) fail(l, "misaligned global address", address, bytes, line);
    const u64 offset = address - m.begin_;
    if (address < m.begin_ || address >= m.end_ ||
        std::memchr(m.shadow_.bytes + offset, 0, bytes) != nullptr)
        fail(l, "illegal global address", address, bytes, line);
    if ((access & is_volatile) != 0) access |= strong;
    check(l, m.shadow_, offset, address, bytes, access, l.block->launched, line);
    return m.content_ + offset;
}

device_memory& memory() {
    static device_memory& all = *new device_memory;  // destructors of static objects free memory
    return all;
}

u32 advance_time() {
    if (now == std::numeric_limits<u32>::max()) stop("the clock is exhausted");
    return now++;
}

void set_memory(thread_block& b, u32 shared_bytes) {
    static char* const shared = reserve<char>(most_shared);
    b.shared = shared;
    b.shared_bytes = shared_bytes;
    b.global_at = device_memory::access, b.shared_at = shared_at, b.local_at = local_at;
    b.generic_at = generic_at;
    std::memset(shadow_of_shared().bytes, unwritten, shared_bytes);
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
