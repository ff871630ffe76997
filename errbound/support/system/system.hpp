// Operating system calls: posix.cpp and windows.cpp. Failures leave the reason in errno.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace errbound::support::system {

/// Opens the standard descriptors in binary mode, makes writes beyond a file size limit fail, and
/// grows the main thread's stack. Throws std::bad_alloc.
void start_program();

bool is_terminal(int descriptor);  ///< one that supports ANSI control sequences

std::size_t peak_memory_bytes();
/// The machine's memory, and the runnable threads, averaged over a minute (0 if unknown).
double memory_bytes();
double load();
std::filesystem::path program_file();  ///< empty if unknown
int process_number();
/// Runs a program with one argument. Returns its exit status; 127 if it cannot run or is killed.
int run(const char* program, const std::string& argument);

/// The separators in a path; and true if devices have names like /dev/stdin.
extern const std::string_view separators;
extern const bool has_device_files;
/// Returns the name in the system's bytes, or in UTF-8 if its names are not bytes. The functions
/// below take such names, since std::filesystem::path hangs in libstdc++ 12 if memory runs out.
std::string native_name(const std::filesystem::path& path);
std::string real_name(const std::string& name);  ///< without links; empty if there is no such file
/// True if two absolute names without links are the same for the system.
bool are_one_name(const std::string& a, const std::string& b);
bool exists(const std::string& name);
bool may_write(const std::string& file);
bool may_write_in(const std::string& folder);
bool replace(const std::string& from, const std::string& to);  ///< renames
bool remove(const std::string& file);

/// These three return a descriptor, or -1. `create` makes a file that must not exist, with rights
/// by the user's mask. `open_to_write` opens an existing one.
int create(const std::string& file);
int open_to_write(const std::string& file);
int create_named(std::string& pattern);  ///< replaces the name's last six letters
int close(int descriptor);
/// Bytes written or read, or -1.
std::ptrdiff_t write(int descriptor, const char* from, std::size_t size);
std::ptrdiff_t read_at(int descriptor, std::uint64_t offset, char* to, std::size_t size);
void copy_rights(int descriptor, const std::string& other);

/// A descriptor that locks the folder against other processes until it is closed. -1 with
/// EWOULDBLOCK if it is locked, with another errno if there are no locks.
int lock(const std::string& folder);

/// While it lives, writing to a closed pipe fails and does not end the program.
class failing_pipes {
  public:
    failing_pipes();
    failing_pipes(const failing_pipes&) = delete;
    failing_pipes& operator=(const failing_pipes&) = delete;
    ~failing_pipes();

  private:
    void (*before_)(int);
};

}  // namespace errbound::support::system
