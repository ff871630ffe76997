// Stores of queries: what is in them is checked before it is believed.
#include "ccd/io/store/store_reader.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "ccd/io/store/hdf5.hpp"

namespace ccd::io {
namespace {

using errbound::support::file_error;
using hdf5::checked;
using hdf5::handle;

using moving = std::array<double, 6>;

/// A type of numbers, as it is stored, and its name for people.
struct stored_type {
    hid_t type;
    const char* name;
};

/// Opens a dataset of the file itself. A link to elsewhere is refused before it is followed: it may
/// lead to any file, or to a pipe that blocks.
handle opened_set(hid_t file, const char* of, const std::string& what) {
    H5L_info_t link;
    checked(H5Lget_info(file, of, &link, H5P_DEFAULT), what);
    if (link.type != H5L_TYPE_HARD)
        throw file_error(what + ": found a link to another place, expected it in this file");
    return {H5Dopen2(file, of, H5P_DEFAULT), H5Dclose, what};
}

/// A dataset of rows of numbers.
class rows_on_disk {
  public:
    rows_on_disk(hid_t file, const std::string& name, const char* of,
                 std::initializer_list<stored_type> types, hsize_t columns)
        : what_(name + ": dataset " + of), set_(opened_set(file, of, what_)), columns_(columns) {
        // First of all: virtual datasets and external storage lead to other files.
        const handle how(H5Dget_create_plist(set_), H5Pclose, what_);
        if (H5Pget_layout(how) != H5D_CHUNKED)
            throw file_error(what_ + ": found no chunks, expected rows that are stored in chunks");
        require_type(types);
        require_shape();
        require_chunks(how);
        // Deflate makes at most 1032 bytes of one, so that more than this is not there to be read.
        const hsize_t most = 1100 * H5Dget_storage_size(set_) / bytes_ / columns;
        if (rows_ > most)
            throw file_error(what_ + ": found " + std::to_string(rows_) +
                             " rows, more than the file can hold");
    }

    std::uint64_t rows() const { return rows_; }
    /// Of a number.
    std::size_t bytes() const { return bytes_; }

    /// Rows [begin, end).
    template <class Row>
    std::vector<Row> read(hid_t number, std::uint64_t begin, std::uint64_t end) const {
        std::vector<Row> all(end - begin);
        if (all.empty()) return all;
        const hsize_t start[] = {begin, 0}, count[] = {end - begin, columns_};
        const handle from(H5Dget_space(set_), H5Sclose, what_);
        checked(H5Sselect_hyperslab(from, H5S_SELECT_SET, start, nullptr, count, nullptr), what_);
        const handle to(H5Screate_simple(rank(), count, nullptr), H5Sclose, what_);
        if (H5Dread(set_, number, to, from, H5P_DEFAULT, all.data()) < 0)
            throw file_error(what_ + ": rows " + std::to_string(begin) + " to " +
                             std::to_string(end - 1) + " cannot be read (HDF5: " + hdf5::reason() +
                             ")");
        return all;
    }
    [[noreturn]] void refuse(const std::string& said) const {
        throw file_error(what_ + ": " + said);
    }
    [[noreturn]] void refuse(std::uint64_t row, const std::string& said) const {
        refuse("row " + std::to_string(row) + ": " + said);
    }

  private:
    int rank() const { return columns_ == 1 ? 1 : 2; }

    void require_type(std::initializer_list<stored_type> types) {
        const handle stored(H5Dget_type(set_), H5Tclose, what_);
        bytes_ = H5Tget_size(stored);
        std::string expected;
        bool is_one = false;
        for (const stored_type& t : types) {
            expected += (expected.empty() ? "" : " or ") + std::string(t.name);
            is_one = is_one || checked(H5Tequal(stored, t.type), what_) > 0;
        }
        if (!is_one)
            throw file_error(what_ + ": found numbers of another type, expected " + expected +
                             ", least significant byte first");
    }

    void require_shape() {
        const handle space(H5Dget_space(set_), H5Sclose, what_);
        hsize_t size[2] = {0, 1};
        if (H5Sget_simple_extent_ndims(space) != rank() ||
            H5Sget_simple_extent_dims(space, size, nullptr) != rank() || size[1] != columns_)
            throw file_error(what_ + ": found another shape, expected rows of " +
                             std::to_string(columns_));
        rows_ = size[0];
    }

    /// HDF5 reads whole chunks, whose columns may be more than the dataset's.
    void require_chunks(hid_t how) const {
        hsize_t chunk[2] = {0, 1};
        checked(H5Pget_chunk(how, 2, chunk), what_);
        constexpr double most = 1 << 26;
        const double bytes = double(bytes_) * double(chunk[0]) * double(chunk[1]);
        if (bytes > most)
            throw file_error(what_ + ": found chunks of " + std::to_string(chunk[0]) + " x " +
                             std::to_string(chunk[1]) + " numbers, expected at most 64 MiB each");
    }

    std::string what_;
    handle set_;
    hsize_t columns_;
    std::uint64_t rows_ = 0;
    std::size_t bytes_ = 0;
};

std::string text_attribute(hid_t file, const std::string& name, const char* of) {
    const std::string what = name + ": attribute " + of;
    const handle attribute(H5Aopen(file, of, H5P_DEFAULT), H5Aclose, what);
    const handle type(H5Aget_type(attribute), H5Tclose, what);
    const handle space(H5Aget_space(attribute), H5Sclose, what);
    constexpr std::size_t longest = 64;
    if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0 ||
        H5Tget_size(type) > longest || H5Sget_simple_extent_npoints(space) != 1)
        throw file_error(what + ": expected one string of at most 64 bytes, of fixed length");
    std::string text(H5Tget_size(type), '\0');
    checked(H5Aread(attribute, type, text.data()), what);
    return text.substr(0, text.find('\0'));
}

std::uint32_t version_of(hid_t file, const std::string& name) {
    const std::string what = name + ": attribute version";
    const handle attribute(H5Aopen(file, "version", H5P_DEFAULT), H5Aclose, what);
    const handle type(H5Aget_type(attribute), H5Tclose, what);
    const handle space(H5Aget_space(attribute), H5Sclose, what);
    if (H5Tget_class(type) != H5T_INTEGER || H5Sget_simple_extent_npoints(space) != 1)
        throw file_error(what + ": expected one whole number");
    std::uint32_t version = 0;
    checked(H5Aread(attribute, H5T_NATIVE_UINT32, &version), what);
    return version;
}

ccd::kind kind_of_store(hid_t file, const std::string& name) {
    if (const std::string format = text_attribute(file, name, "format");
        format != "errbound queries")
        throw file_error(name + ": attribute format: found another, expected errbound queries");
    if (const std::uint32_t version = version_of(file, name); version != 1)
        throw file_error(name + ": attribute version: found " + std::to_string(version) +
                         ", expected 1");
    const std::string kind = text_attribute(file, name, "kind");
    for (const ccd::kind k : stored_kinds)
        if (kind == ccd::name(k)) return k;
    throw file_error(name + ": attribute kind: expected vertex_face or edge_edge");
}

handle opened_image(std::string_view bytes, const std::string& name) {
    const handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, name);
    checked(H5Pset_fapl_core(access, std::size_t{1} << 20, false), name);
    // Copied by the library, which leaves what is given as it is.
    checked(H5Pset_file_image(access, const_cast<char*>(bytes.data()), bytes.size()), name);
    // A name that no file has: images of files that are there are refused.
    return {H5Fopen("/dev/null/store", H5F_ACC_RDONLY, access), H5Fclose, name};
}

}  // namespace

void leave_stores_at_exit() {
    H5dont_atexit();
}

class store_reader::opened {
  public:
    opened(handle file, const std::string& name)
        : name_(name),
          file_(std::move(file)),
          kind_(kind_of_store(file_, name)),
          points_(file_, name, "points", {{H5T_IEEE_F64LE, "float64"}}, 6),
          queries_(file_, name, "queries", {{H5T_STD_U16LE, "uint16"}, {H5T_STD_U32LE, "uint32"}},
                   4),
          first_point_(file_, name, "first_point", {{H5T_STD_U64LE, "uint64"}}, 1),
          checksums_(file_, name, "checksums", {{H5T_STD_U32LE, "uint32"}}, 1) {
        if (checked(H5Lexists(file_, "truth", H5P_DEFAULT), name) > 0)
            truth_.emplace(file_, name, "truth",
                           std::initializer_list<stored_type>{{H5T_STD_U8LE, "uint8"}}, 1);
        if (size() == 0) throw file_error(name + ": dataset queries: found none");
        if (truth_) require_rows(*truth_, size());
        const std::uint64_t chunks = (size() + queries_of_a_chunk - 1) / queries_of_a_chunk;
        require_rows(first_point_, chunks + 1);
        require_rows(checksums_, chunks);
        begins_ = first_point_.read<std::uint64_t>(H5T_NATIVE_UINT64, 0, chunks + 1);
        sums_ = checksums_.read<std::uint32_t>(H5T_NATIVE_UINT32, 0, chunks);
        const auto are_apart = [](std::uint64_t begin, std::uint64_t end) {
            return begin < end && end - begin <= 4 * queries_of_a_chunk;
        };
        if (begins_.front() != 0 || begins_.back() != points_.rows() ||
            std::ranges::adjacent_find(begins_, std::not_fn(are_apart)) != begins_.end())
            first_point_.refuse("expected rows that ascend from 0 to " +
                                std::to_string(points_.rows()) + ", each by at most " +
                                std::to_string(4 * queries_of_a_chunk));
    }

    ccd::kind kind() const { return kind_; }
    std::uint64_t size() const { return queries_.rows(); }

    query_file read(std::uint64_t begin, std::uint64_t end) {
        query_file found;
        if (truth_) found.truth.emplace();
        if (kind_ == kind::edge_edge)
            found.queries = queries_of<edge_edge<double>>(begin, end, found.truth);
        else
            found.queries = queries_of<vertex_face<double>>(begin, end, found.truth);
        return found;
    }

  private:
    static void require_rows(const rows_on_disk& set, std::uint64_t expected) {
        if (set.rows() != expected)
            set.refuse("found " + std::to_string(set.rows()) + " rows, expected " +
                       std::to_string(expected));
    }

    /// A chunk as it is stored, found to be what was written.
    struct stored_chunk {
        std::uint64_t number = 0;
        std::vector<moving> points;
        std::vector<std::array<std::uint16_t, 4>> narrow;  // this or the next, as the file has them
        std::vector<std::array<std::uint32_t, 4>> wide;
        std::vector<std::uint8_t> truth;
    };

    template <class Query>
    std::vector<Query> queries_of(std::uint64_t begin, std::uint64_t end,
                                  std::optional<std::vector<bool>>& truth) {
        static_assert(sizeof(Query) == 4 * sizeof(moving) && std::is_trivially_copyable_v<Query>);
        std::vector<Query> all;
        all.reserve(end - begin);
        for (std::uint64_t at = begin; at < end;) {
            const std::uint64_t number = at / queries_of_a_chunk;
            const std::uint64_t first = number * queries_of_a_chunk;
            const std::uint64_t next = std::min(end, first + queries_of_a_chunk);
            const stored_chunk& chunk = chunk_of(number);
            if (queries_.bytes() == 2)
                append(chunk.points, chunk.narrow, at, next, all);
            else
                append(chunk.points, chunk.wide, at, next, all);
            for (std::uint64_t i = at; truth && i < next; ++i) truth->push_back(truth_of(chunk, i));
            at = next;
        }
        return all;
    }

    /// The last one is kept: ranges may be parts of it.
    const stored_chunk& chunk_of(std::uint64_t number) {
        if (last_ && last_->number == number) return *last_;
        last_.reset();
        const std::uint64_t begin = number * queries_of_a_chunk;
        const std::uint64_t end = std::min(size(), begin + queries_of_a_chunk);
        stored_chunk chunk;
        chunk.number = number;
        chunk.points =
            points_.read<moving>(H5T_NATIVE_DOUBLE, begins_[number], begins_[number + 1]);
        if (queries_.bytes() == 2)
            chunk.narrow =
                queries_.read<std::array<std::uint16_t, 4>>(H5T_NATIVE_UINT16, begin, end);
        else
            chunk.wide = queries_.read<std::array<std::uint32_t, 4>>(H5T_NATIVE_UINT32, begin, end);
        if (truth_) chunk.truth = truth_->read<std::uint8_t>(H5T_NATIVE_UINT8, begin, end);
        const auto bytes = [](const auto& rows) { return std::as_bytes(std::span(rows)); };
        const auto rows = queries_.bytes() == 2 ? bytes(chunk.narrow) : bytes(chunk.wide);
        if (checksum(bytes(chunk.points), rows, bytes(chunk.truth)) != sums_[number])
            throw file_error(name_ + ": queries " + std::to_string(begin) + " to " +
                             std::to_string(end - 1) +
                             ": found another checksum, expected what was written");
        for (std::size_t i = 0; i < chunk.points.size(); ++i)
            if (!std::ranges::all_of(chunk.points[i], [](double x) { return std::isfinite(x); }))
                points_.refuse(begins_[number] + i, "found a number that is not finite");
        return last_.emplace(std::move(chunk));
    }

    /// Queries [begin, end), of the chunk with these points and rows.
    template <class Query, class Rows>
    void append(const std::vector<moving>& points, const Rows& rows, std::uint64_t begin,
                std::uint64_t end, std::vector<Query>& all) const {
        for (std::uint64_t q = begin; q < end; ++q) {
            const auto& row = rows[q % queries_of_a_chunk];
            for (const auto point : row)
                if (point >= points.size())
                    queries_.refuse(q, "found point " + std::to_string(point) +
                                           ", expected one of the chunk's " +
                                           std::to_string(points.size()));
            all.push_back(std::bit_cast<Query>(
                std::array{points[row[0]], points[row[1]], points[row[2]], points[row[3]]}));
        }
    }

    bool truth_of(const stored_chunk& chunk, std::uint64_t query) const {
        const std::uint8_t truth = chunk.truth[query % queries_of_a_chunk];
        if (truth > 1)
            truth_->refuse(query, "found " + std::to_string(truth) + ", expected 0 or 1");
        return truth == 1;
    }

    std::string name_;
    handle file_;
    ccd::kind kind_;
    rows_on_disk points_, queries_, first_point_, checksums_;
    std::optional<rows_on_disk> truth_;
    std::vector<std::uint64_t> begins_;  // of each chunk's points, and their end
    std::vector<std::uint32_t> sums_;
    std::optional<stored_chunk> last_;
};

store_reader::store_reader(std::string_view bytes, const std::string& name) {
    const hdf5::quiet_use use;
    opened_ = std::make_unique<opened>(opened_image(bytes, name), name);
}

store_reader::store_reader(const std::filesystem::path& path) {
    const hdf5::quiet_use use;
    const std::string name = path.string();
    opened_ = std::make_unique<opened>(
        handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, name), name);
}

store_reader::~store_reader() {
    const hdf5::quiet_use use;
    opened_.reset();
}
store_reader::store_reader(store_reader&&) noexcept = default;
store_reader& store_reader::operator=(store_reader&& other) noexcept {
    std::swap(opened_, other.opened_);
    return *this;
}

ccd::kind store_reader::kind() const {
    return opened_->kind();
}
std::uint64_t store_reader::size() const {
    return opened_->size();
}
query_file store_reader::read(std::uint64_t begin, std::uint64_t end) const {
    const hdf5::quiet_use use;
    return opened_->read(begin, end);
}

}  // namespace ccd::io
