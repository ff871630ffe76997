// The emulated device: its memory, the program's PTX modules, and the execution of a grid.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/ccd/cuda/emulator/ptx.hpp"

namespace ptx {

/// For each byte, whether it is memory and was written. For each granule of 2^granule bytes, its
/// last read, write, strong read and strong write.
struct shadow {
    char* bytes;
    struct last_access* accesses;
    u32 granule;
};

/// Allocations at addresses that the host cannot read. Their contents are elsewhere. No address is
/// used twice.
class device_memory {
  public:
    device_memory();
    void* allocate(u64 bytes);
    bool free(void* p);  ///< false if p is not an allocation
    bool contains(const void* p) const;
    /// The content of `bytes` bytes at p, which the host writes or reads. Null if not all of them
    /// are in one allocation, or if it reads bytes that were never written.
    char* content(const void* p, u64 bytes, u32 access) const;
    /// Checks an access of a thread, and returns its content.
    static char* access(lane& l, u64 address, u32 bytes, u32 access, int line);

  private:
    u64 begin_, end_;
    char* content_;
    shadow shadow_;
    std::map<u64, u64> allocations_;
    u64 next_ = 4096;
};
device_memory& memory();

/// Increases when a grid or a block begins and when threads meet. Returns the time before.
u32 advance_time();
/// Sets the functions of a block that check accesses, and its shared memory, all of it unwritten.
void set_memory(thread_block& b, u32 shared_bytes);

/// The byte that fresh registers and stacks are filled with (PTXEMU_FILL).
int fill_byte();
/// Returns a number from the environment, 0 if it is not set.
long setting(const char* name);
[[noreturn]] void stop(const char* format, ...);

class module {
  public:
    explicit module(const unsigned char* fatbinary);
    const kernel& find_kernel(const std::string& name);
    void* find_function(const std::string& name);
    std::string file() const { return folder_ + "/module.ptx"; }

  private:
    /// A symbol of the shared object that translate.py makes of a kernel or a function.
    void* load(const std::string& name);

    std::string ptx_, folder_;
    std::map<std::string, const kernel*> kernels_;
    std::map<std::string, void*> functions_;
    std::map<std::string, u64> variables_;
};

struct registered_kernel {
    module* of;
    std::string name;
};

struct launch {
    module* of;
    const kernel* code;
    u32 grid[3], block[3], dynamic_shared_bytes;
    std::vector<char> parameters;
};
/// Returns an empty string, or the error of a thread.
std::string run(launch& l);

long runtime_calls();

}  // namespace ptx
