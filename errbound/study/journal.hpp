// The results of a study so far, in a file that a killed run leaves good.
//
// A text file. Its first line says which study's it is, each other has a chunk's number and result;
// every line begins with a checksum of the rest.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace errbound::study {

/// A chunk's number and its result.
using chunk_result = std::pair<std::uint64_t, std::string>;

class journal {
  public:
    /// Makes the file, or reads what it has of this study. A line that is not whole, and what comes
    /// after it, counts as never written, and is cut off. `identity` says in one line all that
    /// results depend on. Throws errbound::support::file_error: no regular file, or one that is no
    /// journal, that of another study or in use by another run, or that cannot be read or written.
    journal(std::filesystem::path path, const std::string& identity);
    ~journal();
    journal(const journal&) = delete;
    journal& operator=(const journal&) = delete;

    /// What it had when it was opened; no longer afterwards.
    std::vector<chunk_result> take_results() { return std::move(results_); }

    /// Adds results, each of one line, and returns once they are on the disk. Throws
    /// errbound::support::file_error.
    void append(const std::vector<chunk_result>& results);

    /// Takes the file away: the study is over.
    void remove();

  private:
    void read(const std::string& text, const std::string& first_line);

    std::filesystem::path path_;
    int descriptor_ = -1;
    std::vector<chunk_result> results_;
};

}  // namespace errbound::study
