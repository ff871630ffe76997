// The journal's file: made, read, cut off where it is torn, appended to.
#include "errbound/study/journal.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <boost/crc.hpp>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <errbound/support/error.hpp>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "errbound/support/descriptor.hpp"
#include "errbound/support/output_file.hpp"

namespace errbound::study {
namespace {

using errbound::support::file_error;

constexpr std::string_view title = "errbound study 1 ";
constexpr std::size_t checksum_digits = 8;

std::string line_of(const std::string& text) {
    if (text.find('\n') != std::string::npos)
        throw std::logic_error("a study's results are lines: found one with a line end");
    boost::crc_32_type crc;
    crc.process_bytes(text.data(), text.size());
    char checksum[16];
    std::snprintf(checksum, sizeof checksum, "%08x ", static_cast<unsigned>(crc.checksum()));
    return checksum + text + '\n';
}

/// The chunk and result of a line without its end; nothing if it is not what was written.
std::optional<chunk_result> entry_of(std::string_view line) {
    if (line.size() <= checksum_digits) return std::nullopt;
    const std::string text(line.substr(checksum_digits + 1));
    if (std::string_view(line_of(text)).substr(0, line.size()) != line) return std::nullopt;
    chunk_result entry;
    const char* const end = text.data() + text.size();
    const auto number = std::from_chars(text.data(), end, entry.first);
    if (number.ec != std::errc{} || number.ptr == end || *number.ptr != ' ') return std::nullopt;
    entry.second.assign(number.ptr + 1, end);
    return entry;
}

/// Where two identities differ first: from the comma before to the comma after.
std::pair<std::string_view, std::string_view> differing_parts(std::string_view a,
                                                              std::string_view b) {
    const auto same = static_cast<std::size_t>(std::ranges::mismatch(a, b).in1 - a.begin());
    const std::size_t comma = a.substr(0, same).rfind(',');
    const std::size_t begin = comma == std::string_view::npos ? 0 : comma + 1;
    const auto part = [&](std::string_view of) {
        of = of.substr(begin, std::min(of.find_first_of(",\n", same), of.size()) - begin);
        return of.substr(std::min(of.find_first_not_of(' '), of.size()));
    };
    return {part(a), part(b)};
}

void write_to_disk(int descriptor, std::string_view text, const std::filesystem::path& path) {
    support::write_all(descriptor, text, path);
    if (fsync(descriptor) != 0)
        throw file_error(path.string() + ": writing failed (" + std::strerror(errno) + ")");
}

}  // namespace

journal::journal(std::filesystem::path path, const std::string& identity) : path_(std::move(path)) {
    const auto fail = [this](const std::string& what) {
        throw file_error(path_.string() + ": " + what + " (" + std::strerror(errno) + ")");
    };
    // Others, streams and devices, may make one wait for ever.
    std::error_code error;
    const auto type = std::filesystem::status(path_, error).type();
    if (type != std::filesystem::file_type::regular &&
        type != std::filesystem::file_type::not_found)
        throw file_error(path_.string() + ": found no regular file, expected a journal or no file");
    constexpr mode_t all = 0666;  // less what the umask takes
    descriptor_ =
        ::open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NONBLOCK, all);
    try {
        if (descriptor_ < 0) fail("cannot be written");
        if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
            throw file_error(path_.string() + ": found the journal of a run that has not ended");
        path_ = std::filesystem::canonical(path_);  // a link is not what remove() takes away
        const std::string first_line = std::string(title) + line_of(identity);
        const std::string text = support::read_whole(path_);
        if (first_line.starts_with(text)) {  // new, or ended before there was a line
            if (ftruncate(descriptor_, 0) != 0) fail("cannot be cut off");
            write_to_disk(descriptor_, first_line, path_);
        } else {
            read(text, first_line);
        }
    } catch (...) {
        if (descriptor_ >= 0) ::close(descriptor_);
        throw;
    }
}

journal::~journal() {
    ::close(descriptor_);
}

void journal::read(const std::string& text, const std::string& first_line) {
    if (!text.starts_with(title))
        throw file_error(path_.string() +
                         ":1: found no journal of a study, expected one or no file");
    if (text.find('\n') == std::string::npos ||
        text.find('\n') < title.size() + checksum_digits + 1)
        throw file_error(path_.string() + ":1: found a journal that is cut off in its first line");
    if (!text.starts_with(first_line)) {
        const std::size_t begin = title.size() + checksum_digits + 1;
        const auto [found, expected] =
            differing_parts(std::string_view(text).substr(0, text.find('\n')).substr(begin),
                            std::string_view(first_line).substr(begin));
        throw file_error(path_.string() + ":1: found the journal of another study, " +
                         std::string(found) + ", expected " + std::string(expected) +
                         "; remove it or name another");
    }
    std::size_t good = first_line.size();
    for (;;) {
        const std::size_t end = text.find('\n', good);
        if (end == std::string::npos) break;
        auto entry = entry_of(std::string_view(text).substr(good, end - good));
        if (!entry) break;
        results_.push_back(std::move(*entry));
        good = end + 1;
    }
    if (good < text.size() && ftruncate(descriptor_, static_cast<off_t>(good)) != 0)
        throw file_error(path_.string() + ": cannot be cut off (" + std::strerror(errno) + ")");
}

void journal::append(const std::vector<chunk_result>& results) {
    std::string lines;
    for (const auto& [chunk, result] : results)
        lines += line_of(std::to_string(chunk) + ' ' + result);
    write_to_disk(descriptor_, lines, path_);
}

void journal::remove() {
    std::filesystem::remove(path_);
}

}  // namespace errbound::study
