// The reader of stores. Checks bound the memory and time that a damaged or hostile file can take;
// HDF5's own checksums find damage.
#include "ccd/io/store/store_reader.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "ccd/io/store/hdf5.hpp"
#include "errbound/support/table.hpp"

namespace ccd::io {
namespace {

using errbound::support::file_error;
using hdf5::checked;
using hdf5::handle;

using moving = std::array<double, 6>;

/// Refuses links, which may lead to any file, or to a pipe that blocks.
handle opened_set(hid_t file, const char* name, const std::string& where) {
    H5L_info_t link;
    checked(H5Lget_info(file, name, &link, H5P_DEFAULT), where);
    if (link.type != H5L_TYPE_HARD)
        throw file_error(where + ": link leads to another place; expected a dataset of this file");
    return {H5Dopen2(file, name, H5P_DEFAULT), H5Dclose, where};
}

struct number_types {
    std::initializer_list<hid_t> stored;
    const char* names;
};

class rows_on_disk {
  public:
    rows_on_disk(hid_t file, const std::string& store, const char* name, const number_types& types,
                 hsize_t columns)
        : where_(store + ": dataset " + name),
          set_(opened_set(file, name, where_)),
          columns_(columns) {
        // This check comes first, because virtual datasets and external storage lead to other
        // files.
        const handle how(H5Dget_create_plist(set_), H5Pclose, where_);
        if (H5Pget_layout(how) != H5D_CHUNKED) refuse("layout is not chunked; expected chunks");
        const handle type(H5Dget_type(set_), H5Tclose, where_);
        if (std::ranges::none_of(types.stored, [&](hid_t t) { return H5Tequal(type, t) > 0; }))
            refuse("type of numbers is another one; expected " + std::string(types.names) +
                   ", least significant byte first");
        const handle space(H5Dget_space(set_), H5Sclose, where_);
        hsize_t size[2] = {0, 1}, chunk[2] = {0, 1};
        if (H5Sget_simple_extent_ndims(space) != rank() ||
            H5Sget_simple_extent_dims(space, size, nullptr) != rank() || size[1] != columns_)
            refuse("shape is another one; expected rows of " + std::to_string(columns_));
        checked(H5Pget_chunk(how, 2, chunk), where_);
        rows_ = size[0];
        require_bounded(H5Tget_size(type), chunk);
    }

    std::uint64_t rows() const { return rows_; }

    template <class Row>
    std::vector<Row> read(hid_t number, std::uint64_t begin, std::uint64_t end) const {
        std::vector<Row> all(end - begin);
        if (all.empty()) return all;
        const hsize_t start[] = {begin, 0}, count[] = {end - begin, columns_};
        const handle from(H5Dget_space(set_), H5Sclose, where_);
        checked(H5Sselect_hyperslab(from, H5S_SELECT_SET, start, nullptr, count, nullptr), where_);
        const handle to(H5Screate_simple(rank(), count, nullptr), H5Sclose, where_);
        checked(H5Dread(set_, number, to, from, H5P_DEFAULT, all.data()),
                where_ + ": rows " + std::to_string(begin) + " to " + std::to_string(end - 1));
        return all;
    }

    void require_rows(std::uint64_t expected) const {
        if (rows_ != expected)
            refuse("number of rows is " + std::to_string(rows_) + "; expected " +
                   std::to_string(expected));
    }
    [[noreturn]] void refuse(const std::string& what) const {
        throw file_error(where_ + ": " + what);
    }
    [[noreturn]] void refuse(std::uint64_t row, const std::string& what) const {
        refuse("row " + std::to_string(row) + ": " + what);
    }

  private:
    int rank() const { return columns_ == 1 ? 1 : 2; }

    /// HDF5 reads whole chunks, which may have more columns than the dataset.
    void require_bounded(std::size_t bytes_of_number, const hsize_t* chunk) const {
        const auto bytes = static_cast<double>(bytes_of_number);
        if (bytes * static_cast<double>(chunk[0]) * static_cast<double>(chunk[1]) > 1 << 26)
            refuse("size of chunks is " + std::to_string(chunk[0]) + " x " +
                   std::to_string(chunk[1]) + " numbers; expected at most 64 MiB each");
        // Deflate expands a byte to at most 1032 bytes.
        if (rows_ > 1100 * H5Dget_storage_size(set_) / bytes_of_number / columns_)
            refuse("number of rows is " + std::to_string(rows_) +
                   "; expected at most as many as the file can hold");
    }

    std::string where_;
    handle set_;
    hsize_t columns_;
    std::uint64_t rows_ = 0;
};

void read_attribute(hid_t file, const std::string& store, const char* name, hid_t type, void* to) {
    const std::string where = store + ": attribute " + name;
    const handle id(H5Aopen(file, name, H5P_DEFAULT), H5Aclose, where);
    const handle space(H5Aget_space(id), H5Sclose, where);
    if (H5Sget_simple_extent_npoints(space) != 1)
        throw file_error(where + ": number of values is not 1; expected 1");
    checked(H5Aread(id, type, to), where);
}

ccd::kind kind_of_store(hid_t file, const std::string& store) {
    std::array<char, 64> format{}, kind{};
    std::uint32_t version = 0;
    const handle text(H5Tcopy(H5T_C_S1), H5Tclose, store);
    checked(H5Tset_size(text, format.size()), store);
    read_attribute(file, store, "format", text, format.data());
    read_attribute(file, store, "version", H5T_NATIVE_UINT32, &version);
    read_attribute(file, store, "kind", text, kind.data());
    if (std::string_view(format.data()) != "errbound queries")
        throw file_error(store + ": attribute format is '" +
                         errbound::support::printable(format.data()) +
                         "'; expected 'errbound queries'");
    if (version != 1)
        throw file_error(store + ": attribute version is " + std::to_string(version) +
                         "; expected 1");
    for (const ccd::kind k : stored_kinds)
        if (std::string_view(kind.data()) == ccd::name(k)) return k;
    throw file_error(store + ": attribute kind is '" + errbound::support::printable(kind.data()) +
                     "'; expected vertex_face or edge_edge");
}

class open_file final : public store_reader {
  public:
    open_file(handle file, const std::string& name)
        : file_(std::move(file)),
          kind_(kind_of_store(file_, name)),
          points_(file_, name, "points", {{H5T_IEEE_F64LE}, "float64"}, 6),
          queries_(file_, name, "queries", {{H5T_STD_U16LE, H5T_STD_U32LE}, "uint16 or uint32"},
                   4) {
        if (size() == 0) queries_.refuse("number of rows is 0; expected at least 1");
        if (checked(H5Lexists(file_, "truth", H5P_DEFAULT), name) > 0) {
            truth_.emplace(file_, name, "truth", number_types{{H5T_STD_U8LE}, "uint8"}, 1);
            truth_->require_rows(size());
        }
        const std::uint64_t chunks = (size() + queries_of_a_chunk - 1) / queries_of_a_chunk;
        const rows_on_disk first_point(file_, name, "first_point", {{H5T_STD_U64LE}, "uint64"}, 1);
        first_point.require_rows(chunks + 1);
        begins_ = first_point.read<std::uint64_t>(H5T_NATIVE_UINT64, 0, chunks + 1);
        constexpr std::uint64_t most = 4 * queries_of_a_chunk;
        const auto is_no_chunk = [](std::uint64_t begin, std::uint64_t end) {
            return begin >= end || end - begin > most;
        };
        if (begins_.front() != 0 || begins_.back() != points_.rows() ||
            std::ranges::adjacent_find(begins_, is_no_chunk) != begins_.end())
            first_point.refuse("rows are out of order; expected rows that ascend from 0 to " +
                               std::to_string(points_.rows()) + ", each by at most " +
                               std::to_string(most));
    }

    ccd::kind kind() const override { return kind_; }
    std::uint64_t size() const override { return queries_.rows(); }

    query_file read(std::uint64_t begin, std::uint64_t end) const override {
        const hdf5::quiet_use use;
        query_file found;
        if (kind_ == kind::edge_edge)
            found.queries = queries_of<edge_edge<double>>(begin, end);
        else
            found.queries = queries_of<vertex_face<double>>(begin, end);
        if (truth_) found.truth = truth_of(begin, end);
        return found;
    }

  private:
    template <class Query>
    std::vector<Query> queries_of(std::uint64_t begin, std::uint64_t end) const {
        static_assert(sizeof(Query) == 4 * sizeof(moving) && std::is_trivially_copyable_v<Query>);
        std::vector<Query> all;
        all.reserve(end - begin);
        for (std::uint64_t at = begin; at < end;) {
            const std::uint64_t chunk = at / queries_of_a_chunk;
            const std::uint64_t next = std::min(end, (chunk + 1) * queries_of_a_chunk);
            const std::vector<moving> points = points_of(chunk);
            using row = std::array<std::uint32_t, 4>;
            for (const row& r : queries_.read<row>(H5T_NATIVE_UINT32, at, next)) {
                if (const auto most = std::ranges::max(r); most >= points.size())
                    queries_.refuse(at, "point index is " + std::to_string(most) +
                                            "; expected less than " +
                                            std::to_string(points.size()));
                all.push_back(std::bit_cast<Query>(
                    std::array{points[r[0]], points[r[1]], points[r[2]], points[r[3]]}));
                ++at;
            }
        }
        return all;
    }

    std::vector<moving> points_of(std::uint64_t chunk) const {
        const std::uint64_t first = begins_[chunk];
        auto points = points_.read<moving>(H5T_NATIVE_DOUBLE, first, begins_[chunk + 1]);
        for (std::size_t i = 0; i < points.size(); ++i)
            if (!std::ranges::all_of(points[i], [](double x) { return std::isfinite(x); }))
                points_.refuse(first + i, "a number is not finite; expected finite numbers");
        return points;
    }

    std::vector<bool> truth_of(std::uint64_t begin, std::uint64_t end) const {
        std::vector<bool> truth;
        for (const auto value : truth_->read<std::uint8_t>(H5T_NATIVE_UINT8, begin, end)) {
            if (value > 1)
                truth_->refuse(begin + truth.size(),
                               "value is " + std::to_string(value) + "; expected 0 or 1");
            truth.push_back(value == 1);
        }
        return truth;
    }

    handle file_;
    ccd::kind kind_;
    rows_on_disk points_, queries_;
    std::optional<rows_on_disk> truth_;
    std::vector<std::uint64_t> begins_;  ///< of each chunk's points, and their end
};

}  // namespace

void leave_stores_at_exit() {
    H5dont_atexit();
}

std::unique_ptr<store_reader> open_store(const std::filesystem::path& path) {
    const hdf5::quiet_use use;
    const std::string name = path.string();
    return std::make_unique<open_file>(
        handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, name), name);
}

std::unique_ptr<store_reader> open_store(std::string_view bytes, const std::string& name) {
    const hdf5::quiet_use use;
    const handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, name);
    checked(H5Pset_fapl_core(access, std::size_t{1} << 20, false), name);
    // The library copies the bytes. An image's path must not exist.
    checked(H5Pset_file_image(access, const_cast<char*>(bytes.data()), bytes.size()), name);
    return std::make_unique<open_file>(
        handle(H5Fopen("/dev/null/store", H5F_ACC_RDONLY, access), H5Fclose, name), name);
}

}  // namespace ccd::io
