// Formats: NumPy's format.py (versions 1 to 3), and PKWARE's APPNOTE.TXT for members stored without
// compression, in archives below 4 GiB.
#include "ccd/io/frame_sequence.hpp"

#include <algorithm>
#include <bit>
#include <boost/crc.hpp>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <errbound/support/error.hpp>
#include <fstream>
#include <limits>
#include <map>
#include <string_view>
#include <utility>

#include "ccd/io/text.hpp"

namespace ccd::io {
namespace {

using errbound::support::file_error;

/// Bytes of a file at any offset.
class byte_file {
  public:
    explicit byte_file(const std::filesystem::path& path) : name_(path.string()) {
        std::error_code failed;
        if (!std::filesystem::is_regular_file(path, failed))
            fail(std::filesystem::exists(path, failed) ? "path is not a regular file; expected one"
                                                       : "file does not exist; expected a file");
        stream_.open(path, std::ios::binary);
        size_ = std::filesystem::file_size(path, failed);
        if (!stream_ || failed) fail("cannot be read");
    }
    std::uint64_t size() const { return size_; }
    std::string read(std::uint64_t offset, std::uint64_t size) {
        if (offset > size_ || size > size_ - offset)
            fail("file ends at byte " + std::to_string(size_) + "; expected " +
                 std::to_string(size) + " bytes from byte " + std::to_string(offset));
        std::string bytes(static_cast<std::size_t>(size), '\0');
        stream_.seekg(static_cast<std::streamoff>(offset));
        stream_.read(bytes.data(), static_cast<std::streamsize>(size));
        if (!stream_) fail("reading failed");
        return bytes;
    }
    [[noreturn]] void fail(const std::string& what) const { throw file_error(name_ + ": " + what); }

  private:
    std::string name_;
    std::ifstream stream_;
    std::uint64_t size_ = 0;
};

/// The unsigned integer of `size` bytes, the least significant first.
std::uint64_t number_at(std::string_view bytes, std::size_t at, std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t i = size; i-- > 0;)
        value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

struct member {
    std::string name;
    bool stored = false;
    std::uint64_t offset = 0, size = 0, checksum = 0;
};

/// The CRC-32 of ZIP archives.
std::uint32_t checksum_of(byte_file& file, std::uint64_t offset, std::uint64_t size) {
    boost::crc_32_type sum;
    for (constexpr std::uint64_t block = 1 << 20; size > 0;) {
        const std::string bytes = file.read(offset, std::min(size, block));
        sum.process_bytes(bytes.data(), bytes.size());
        offset += bytes.size();
        size -= bytes.size();
    }
    return sum.checksum();
}

std::vector<member> members_of(byte_file& file) {
    using namespace std::string_view_literals;
    constexpr std::uint64_t end_size = 22, longest_comment = 0xffff, none = 0xffffffff;
    const std::uint64_t tail = std::min(file.size(), end_size + longest_comment);
    const std::string last = file.read(file.size() - tail, tail);
    const std::size_t end = last.rfind("PK\5\6"sv);
    if (end == last.npos || last.size() - end < end_size)
        file.fail("content is not a ZIP archive; expected one of numpy.savez");
    const std::uint64_t count = number_at(last, end + 10, 2), size = number_at(last, end + 12, 4),
                        offset = number_at(last, end + 16, 4);
    if (count == 0xffff || size == none || offset == none)
        file.fail("archive has 4 GiB or more; expected less, or .npy files");
    const std::string directory = file.read(offset, size);
    std::vector<member> members;
    for (std::size_t at = 0; members.size() < count;) {
        constexpr std::size_t fixed = 46;
        const auto fail = [&] { file.fail("archive has a damaged directory"); };
        if (directory.size() - at < fixed || directory.compare(at, 4, "PK\1\2"sv) != 0) fail();
        const auto field = [&](std::size_t from, std::size_t bytes) {
            return number_at(directory, at + from, bytes);
        };
        const std::size_t name = field(28, 2), extra = field(30, 2), comment = field(32, 2);
        if (directory.size() - at - fixed < name + extra + comment) fail();
        const std::uint64_t packed = field(20, 4), unpacked = field(24, 4), header = field(42, 4);
        if (packed == none || unpacked == none || header == none)
            file.fail("archive has 4 GiB or more; expected less, or .npy files");
        const std::string local = file.read(header, 30);
        if (!local.starts_with("PK\3\4"sv)) fail();
        constexpr std::uint64_t encrypted = 1;
        members.push_back(
            {directory.substr(at + fixed, name),
             field(10, 2) == 0 && (field(8, 2) & encrypted) == 0 && packed == unpacked,
             header + 30 + number_at(local, 26, 2) + number_at(local, 28, 2), unpacked,
             field(16, 4)});
        at += fixed + name + extra + comment;
    }
    return members;
}

/// The entries of a header, a dictionary in Python's notation, without blanks; empty if it is
/// damaged or has a key twice.
std::map<std::string, std::string> entries_of(std::string_view header) {
    std::string text;
    bool blank = false;
    const auto is_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
    for (const char c : header) {
        const bool was_blank = std::exchange(blank, c == ' ' || c == '\t' || c == '\n');
        if (blank) continue;
        if (was_blank && is_word(c) && !text.empty() && is_word(text.back())) return {};
        text += c == '"' ? '\'' : c;
    }
    if (!text.starts_with('{') || !text.ends_with('}')) return {};
    std::map<std::string, std::string> entries;
    for (std::size_t at = 1; at + 1 < text.size(); ++at) {
        const std::size_t colon = text.find("':", at + 1), begin = colon + 2;
        if (text[at] != '\'' || colon == text.npos) return {};
        const bool is_tuple = text[begin] == '(';
        const std::size_t end =
            is_tuple ? text.find(')', begin) + 1 : text.find_first_of(",}", begin);
        if (end <= begin || end >= text.size() || (text[end] != ',' && text[end] != '}')) return {};
        if (!entries.emplace(text.substr(at + 1, colon - at - 1), text.substr(begin, end - begin))
                 .second)
            return {};
        at = end;
    }
    return entries;
}

/// The numbers of a tuple, "(5,20,3)"; empty if it is damaged.
std::vector<std::uint64_t> sizes_in(std::string_view tuple) {
    std::vector<std::uint64_t> sizes;
    if (!tuple.starts_with('(')) return {};
    for (tuple.remove_prefix(1); tuple != ")";) {
        std::uint64_t n = 0;
        const auto [end, error] = std::from_chars(tuple.data(), tuple.data() + tuple.size(), n);
        if (error != std::errc() || (*end != ',' && *end != ')')) return {};
        sizes.push_back(n);
        tuple.remove_prefix(static_cast<std::size_t>(end - tuple.data()) + (*end == ',' ? 1 : 0));
    }
    return sizes;
}

stored_positions array_at(byte_file& file, std::uint64_t offset, std::uint64_t size) {
    using namespace std::string_view_literals;
    constexpr std::uint64_t longest_header = 1 << 16;
    const std::string start = size < 12 ? "" : file.read(offset, 12);
    const auto version = start.empty() ? 0 : static_cast<unsigned char>(start[6]);
    if (!start.starts_with("\x93NUMPY"sv) || version < 1 || version > 3)
        file.fail("content is not an array of NumPy; expected one of numpy.save");
    const std::uint64_t length = number_at(start, 8, version == 1 ? 2 : 4),
                        begin = version == 1 ? 10 : 12;
    if (length > longest_header || length > size - begin) file.fail("header is damaged");
    const std::string header = file.read(offset + begin, length);
    const std::string expected = "; expected float32 or float64 of shape (n, 3) or (frames, n, 3)";
    auto entries = entries_of(header);
    const std::string &type = entries["descr"], &order = entries["fortran_order"];
    const std::vector<std::uint64_t> shape = sizes_in(entries["shape"]);
    if (entries.size() != 3 || !type.starts_with('\'') || (order != "False" && order != "True") ||
        shape.size() < 2 || shape.size() > 3 || shape.back() != 3 ||
        std::ranges::max(shape) >= 1'000'000'000'000'000)
        file.fail("header is " + excerpt(header) + expected);
    if (order == "True")
        file.fail("array is in Fortran's order; expected C's (numpy.ascontiguousarray)");
    const std::string kind(type.substr(1, type.find('\'', 1) - 1));
    if (kind != "<f4" && kind != "<f8" && kind != ">f4" && kind != ">f8")
        file.fail("type of numbers is " + excerpt(kind) + expected);
    const std::uint64_t frames = shape.size() == 3 ? shape[0] : 1;
    stored_positions found{static_cast<std::size_t>(frames),
                           static_cast<std::size_t>(shape[shape.size() - 2]), kind[2] == '4',
                           kind[0] == '>', offset + begin + length};
    const std::uint64_t bytes = size - begin - length;
    const std::uint64_t of_frame = found.bytes_per_frame();
    const bool fits = of_frame > 0 && bytes / of_frame == frames && bytes % of_frame == 0;
    if (!fits)
        file.fail("array has " + std::to_string(bytes) + " bytes; expected those of " +
                  std::to_string(frames) + " x " + std::to_string(found.vertices) + " x 3 numbers");
    return found;
}

stored_positions positions_in_archive(byte_file& file) {
    const std::vector<member> members = members_of(file);
    const auto named = std::ranges::find(members, "positions.npy", &member::name);
    if (named == members.end() && members.size() != 1)
        file.fail("number of arrays is " + std::to_string(members.size()) +
                  ", none of them positions; expected one array, or one named positions");
    const member& chosen = named == members.end() ? members.front() : *named;
    if (!chosen.stored)
        file.fail(
            "array is compressed; expected one that numpy.savez wrote, not "
            "numpy.savez_compressed");
    if (chosen.offset > file.size() || chosen.size > file.size() - chosen.offset)
        file.fail("archive is truncated");
    if (checksum_of(file, chosen.offset, chosen.size) != chosen.checksum)
        file.fail("checksum of the array differs; expected that of the archive's directory");
    return array_at(file, chosen.offset, chosen.size);
}

std::optional<stored_positions> stored_in(const std::filesystem::path& path) {
    const std::string extension = path.extension().string();
    if (extension != ".npy" && extension != ".npz") return std::nullopt;
    byte_file file(path);
    return extension == ".npz" ? positions_in_archive(file) : array_at(file, 0, file.size());
}

template <class Float, class Bits>
double number_in(const char* at, bool reversed) {
    static_assert(sizeof(Float) == sizeof(Bits) && std::numeric_limits<Float>::is_iec559);
    char bytes[sizeof(Bits)];
    std::memcpy(bytes, at, sizeof bytes);
    if (reversed) std::ranges::reverse(bytes);
    return std::bit_cast<Float>(bytes);
}

}  // namespace

frame_sequence::frame_sequence(const std::vector<std::filesystem::path>& files,
                               const std::optional<std::filesystem::path>& mesh,
                               const mesh_options& options)
    : options_(options) {
    for (const std::filesystem::path& path : files) {
        files_.push_back({path, stored_in(path)});
        const std::size_t frames = files_.back().stored ? files_.back().stored->frames : 1;
        for (std::size_t i = 0; i < frames; ++i) frames_.push_back({files_.size() - 1, i});
    }
    const std::filesystem::path& source = mesh ? *mesh : files.front();
    topology_name_ = source.string();
    if (!mesh && files_.front().stored)
        throw file_error(topology_name_ +
                         ": file has no faces; expected --mesh with a PLY or OBJ file");
    topology_ = read_mesh(source, options);
    for (const frame_file& file : files_)
        if (file.stored && file.stored->vertices != topology_.vertices.size())
            throw file_error(file.path.string() + ": number of vertices is " +
                             std::to_string(file.stored->vertices) + "; expected " +
                             std::to_string(topology_.vertices.size()) + " as in " +
                             topology_name_);
}

std::string frame_sequence::name(std::size_t frame) const {
    const auto& [file, index] = frames_.at(frame);
    const std::string path = files_[file].path.string();
    const bool several = files_[file].stored && files_[file].stored->frames > 1;
    return several ? path + '[' + std::to_string(index) + ']' : path;
}

std::vector<point<double>> frame_sequence::positions(std::size_t frame) const {
    const frame_file& file = files_[frames_.at(frame).file];
    if (!file.stored) {
        mesh read = read_mesh(file.path, options_);
        require_same_topology(topology_, topology_name_, read, file.path.string());
        return std::move(read.vertices);
    }
    const stored_positions& stored = *file.stored;
    const std::string bytes = byte_file(file.path).read(
        stored.offset + frames_[frame].index * stored.bytes_per_frame(), stored.bytes_per_frame());
    const bool reversed = stored.big_endian != (std::endian::native == std::endian::big);
    std::vector<point<double>> positions(stored.vertices);
    const char* at = bytes.data();
    for (std::size_t v = 0; v < positions.size(); ++v)
        for (double* x : {&positions[v].x, &positions[v].y, &positions[v].z}) {
            *x = stored.in_floats ? number_in<float, std::uint32_t>(at, reversed)
                                  : number_in<double, std::uint64_t>(at, reversed);
            at += stored.in_floats ? sizeof(float) : sizeof(double);
            if (!std::isfinite(*x))
                throw file_error(name(frame) + ": coordinate of vertex " + std::to_string(v) +
                                 " is " + std::to_string(*x) + "; expected a finite number");
        }
    return positions;
}

}  // namespace ccd::io
