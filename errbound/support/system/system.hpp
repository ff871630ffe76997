// Operating-system functions for programs and files: posix.cpp and windows.cpp.
// Functions that fail leave the reason in errno.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace errbound::support::system {

/// Opens closed standard descriptors, sets them to binary, makes writes beyond the file size limit
/// fail, and allocates the first thread's stack. Call it first. Throws std::bad_alloc.
void start_program();

bool is_terminal(int descriptor);

std::size_t peak_memory_bytes();
/// The memory of the machine, and its average number of runnable threads over a minute (0 if the
/// system does not count them).
double memory_bytes();
double load();
/// The program's file, or an empty path if the system does not report it.
std::filesystem::path program_file();
int process_number();
/// Runs a program with one argument. Returns its exit status; 127 if it cannot be run.
int run(const char* program, const std::string& argument);

/// The characters that separate folders in a path; true if devices have names, such as /dev/stdin.
extern const std::string_view separators;
extern const bool has_device_files;
/// Returns the bytes of the system's name, or UTF-8 if its names are not bytes. The functions below
/// take such names (strings, since paths of libstdc++ 12 hang if memory is missing).
std::string native_name(const std::filesystem::path& path);
/// Returns the name without links; empty if there is no such file.
std::string real_name(const std::string& name);
/// True if the system does not distinguish the names. Precondition: both are absolute, without
/// links.
bool are_one_name(const std::string& a, const std::string& b);
bool exists(const std::string& name);
bool may_write(const std::string& file);
bool may_write_in(const std::string& folder);
bool replace(const std::string& from, const std::string& to);
bool remove(const std::string& file);

/// These return descriptors, or -1. create makes a new file with permissions by the user's umask,
/// and fails if it exists.
int create(const std::string& file);
int open_to_write(const std::string& file);
/// Creates a file for writing and reading. The last six letters of its name are replaced.
int create_named(std::string& pattern);
int close(int descriptor);
/// Return the number of bytes written or read, or -1.
std::ptrdiff_t write(int descriptor, const char* from, std::size_t size);
std::ptrdiff_t read_at(int descriptor, std::uint64_t offset, char* to, std::size_t size);
void copy_rights(int descriptor, const std::string& other);

/// Locks a folder until the returned descriptor is closed. Returns -1 with EWOULDBLOCK in errno if
/// another process has the lock; another errno if locks are not supported.
int lock(const std::string& folder);

/// While an object lives, writing to a pipe without a reader fails instead of ending the program.
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
