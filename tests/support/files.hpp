// Files of a test: contents, and messages of errors.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <errbound/support/error.hpp>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <system_error>

namespace test_files {

/// A directory that is removed with this object.
class temporary_directory {
  public:
    temporary_directory() {
        const std::string name = std::string("errbound-") +
                                 ::testing::UnitTest::GetInstance()->current_test_info()->name() +
                                 "-" + std::to_string(getpid());
        path = std::filesystem::temp_directory_path() / name;
        std::filesystem::create_directories(path);
    }
    temporary_directory(const temporary_directory&) = delete;
    temporary_directory& operator=(const temporary_directory&) = delete;
    ~temporary_directory() { std::filesystem::remove_all(path); }

    std::filesystem::path path;
};

inline void write(const std::filesystem::path& path, const std::string& text) {
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
}

/// The message of the error that `call` throws.
template <class Error = errbound::support::file_error>
std::string message_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

/// Returns false if the system or the user cannot make links, as on many Windows systems.
inline bool link(const std::filesystem::path& to, const std::filesystem::path& link) {
    std::error_code error;
    std::filesystem::create_symlink(to, link, error);
    return !error;
}

/// The number of files in a folder.
inline std::ptrdiff_t files_in(const std::filesystem::path& folder) {
    return std::distance(std::filesystem::directory_iterator(folder),
                         std::filesystem::directory_iterator{});
}

inline std::string repeated(const std::string& text, int times) {
    std::string result;
    for (int i = 0; i < times; ++i) result += text;
    return result;
}

}  // namespace test_files
