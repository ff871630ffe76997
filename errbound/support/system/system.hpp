// What each operating system does in its own way, for programs and their files: posix.cpp and
// windows.cpp. Functions that return what the system says leave its reason in errno.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace errbound::support::system {

/// At the start of a program: standard descriptors are open and take bytes as they are, writing
/// beyond a limit on files' sizes fails, and the first thread has its stack. Throws std::bad_alloc.
void start_program();

/// A terminal that obeys ANSI's control sequences.
bool is_terminal(int descriptor);

std::size_t peak_memory_bytes();
/// Of the machine: its memory, and how many threads want to run, on average over a minute (0 where
/// the system does not count them).
double memory_bytes();
double load();
/// The program's file, or nothing where the system does not tell.
std::filesystem::path program_file();
int process_number();
/// Runs a program with one argument: its exit status; 127 if it cannot be run.
int run(const char* program, const std::string& argument);

/// What may part folders in a path, and whether devices have names: /dev/stdin.
extern const std::string_view separators;
extern const bool has_device_files;
/// The bytes that the system has, or, where it has none of bytes, UTF-8: so are the names of all
/// that follow. (Strings, since a path of libstdc++ 12 that finds no memory never returns.)
std::string native_name(const std::filesystem::path& path);
/// Without links; empty if there is no such file.
std::string real_name(const std::string& name);
/// Whether two names, absolute and without links, are one to the system.
bool are_one_name(const std::string& a, const std::string& b);
bool exists(const std::string& name);
bool may_write(const std::string& file);
bool may_write_in(const std::string& folder);
/// Renames; whatever is at `to` is replaced.
bool replace(const std::string& from, const std::string& to);
bool remove(const std::string& file);

/// Descriptors, or -1. A new file, for the rights of which the user's mask stands; it must not be
/// there.
int create(const std::string& file);
int open_to_write(const std::string& file);
/// A new file to write and to read, whose name's last six letters are replaced.
int create_named(std::string& pattern);
int close(int descriptor);
/// How many bytes were written or read, or -1.
std::ptrdiff_t write(int descriptor, const char* from, std::size_t size);
std::ptrdiff_t read_at(int descriptor, std::uint64_t offset, char* to, std::size_t size);
/// The file's rights become those of another.
void copy_rights(int descriptor, const std::string& other);

/// A descriptor: until it is closed, no other process gets one of the same folder. -1, and
/// EWOULDBLOCK in errno, if one has it; another errno where there are no locks.
int lock(const std::string& folder);

/// While one of these lives, writing to a pipe that nobody reads fails, and ends no program.
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
