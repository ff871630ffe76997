// Operating system calls for programs and files: posix.cpp and windows.cpp. Failures leave the
// reason in errno.
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

/// True for a terminal that supports ANSI control sequences.
bool is_terminal(int descriptor);

std::size_t peak_memory_bytes();
/// The machine's memory, and the average number of runnable threads over a minute (0 if unknown).
double memory_bytes();
double load();
/// The program's file; empty if unknown.
std::filesystem::path program_file();
int process_number();
/// Runs a program with one argument. Returns its exit status; 127 if it cannot run.
int run(const char* program, const std::string& argument);

/// Separators in a path; true if devices have names as /dev/stdin.
extern const std::string_view separators;
extern const bool has_device_files;
/// The system's bytes, or UTF-8 if it has none; also for the names below. (Strings, since libstdc++
/// 12's paths never return if memory runs out.)
std::string native_name(const std::filesystem::path& path);
/// Resolves links; empty if there is no such file.
std::string real_name(const std::string& name);
/// True if two absolute names without links are the same for the system.
bool are_one_name(const std::string& a, const std::string& b);
bool exists(const std::string& name);
bool may_write(const std::string& file);
bool may_write_in(const std::string& folder);
/// Renames, and replaces `to`.
bool replace(const std::string& from, const std::string& to);
bool remove(const std::string& file);

/// Return descriptors, or -1. The file must not exist; the user's mask sets its rights.
int create(const std::string& file);
int open_to_write(const std::string& file);
/// A new file to write and read; replaces the name's last six letters.
int create_named(std::string& pattern);
int close(int descriptor);
/// Bytes written or read, or -1.
std::ptrdiff_t write(int descriptor, const char* from, std::size_t size);
std::ptrdiff_t read_at(int descriptor, std::uint64_t offset, char* to, std::size_t size);
/// Sets the file's rights to those of another.
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
