// A store of queries as an HDF5 file, each chunk of queries with a checksum.
#include "ccd/io/store/store_writer.hpp"

#include <algorithm>
#include <ccd/io/query_store.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "ccd/io/store/chunk_checksum.hpp"
#include "ccd/io/store/hdf5.hpp"
#include "ccd/io/store/store_reader.hpp"
#include "errbound/support/scratch_file.hpp"

namespace ccd::io {
namespace {

using hdf5::checked;
using hdf5::handle;

const std::string place = "a store of queries";

/// (Images of files in memory, H5Fget_file_image, have a wrong checksum in their first block up to
/// HDF5 1.10.8: it is a file from the start.)
handle new_file(const std::string& path) {
    const handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, place);
    // From version 1.10 on the library checks all that it keeps of a file itself.
    checked(H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110), place);
    const handle how(H5Pcreate(H5P_FILE_CREATE), H5Pclose, place);
    checked(H5Pset_obj_track_times(how, false), place);  // the same bytes for the same queries
    return {H5Fcreate(path.c_str(), H5F_ACC_TRUNC, how, access), H5Fclose, path};
}

struct dataset {
    const char* name;
    hid_t stored, given;  ///< types
    hsize_t columns, rows_of_a_chunk;
    bool compressed;
};

/// Rows of numbers, to which more are added.
class growing_rows {
  public:
    /// The chunks of a dataset whose first rows are all are no larger than it.
    growing_rows(hid_t file, const dataset& what, hsize_t first_rows, bool are_all)
        : given_(what.given), columns_(what.columns), rank_(what.columns == 1 ? 1 : 2) {
        const hsize_t none[] = {0, columns_}, most[] = {H5S_UNLIMITED, columns_};
        const hsize_t chunk[] = {
            are_all ? std::min(first_rows, what.rows_of_a_chunk) : what.rows_of_a_chunk, columns_};
        const handle space(H5Screate_simple(rank_, none, most), H5Sclose, place);
        const handle how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, place);
        checked(H5Pset_chunk(how, rank_, chunk), place);
        checked(H5Pset_obj_track_times(how, false), place);
        if (what.compressed) {
            checked(H5Pset_shuffle(how), place);
            checked(H5Pset_deflate(how, 1), place);
        }
        checked(H5Pset_fletcher32(how), place);
        set_ =
            handle(H5Dcreate2(file, what.name, what.stored, space, H5P_DEFAULT, how, H5P_DEFAULT),
                   H5Dclose, place);
    }

    void add(const void* data, hsize_t rows) {
        const hsize_t first[] = {rows_, 0}, more[] = {rows, columns_};
        const hsize_t size[] = {rows_ += rows, columns_};
        checked(H5Dset_extent(set_, size), place);
        const handle to(H5Dget_space(set_), H5Sclose, place);
        checked(H5Sselect_hyperslab(to, H5S_SELECT_SET, first, nullptr, more, nullptr), place);
        const handle from(H5Screate_simple(rank_, more, nullptr), H5Sclose, place);
        checked(H5Dwrite(set_, given_, from, to, H5P_DEFAULT, data), place);
    }
    hsize_t rows() const { return rows_; }
    void close() { set_.close(place); }

  private:
    hid_t given_;
    hsize_t columns_, rows_ = 0;
    int rank_;
    handle set_;
};

/// Rows that are all there.
template <class Row>
void write(hid_t file, const dataset& what, const std::vector<Row>& rows) {
    growing_rows set(file, what, rows.size(), true);
    set.add(rows.data(), rows.size());
    set.close();
}

void write_attribute(hid_t file, const char* name, hid_t stored, hid_t given, const void* data) {
    const handle space(H5Screate(H5S_SCALAR), H5Sclose, place);
    const handle made(H5Acreate2(file, name, stored, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                      place);
    checked(H5Awrite(made, given, data), place);
}

void write_text(hid_t file, const char* name, std::string_view text) {
    const handle type(H5Tcopy(H5T_C_S1), H5Tclose, place);
    checked(H5Tset_size(type, text.size()), place);
    write_attribute(file, name, type, type, text.data());
}

template <class Index>
using index_rows = std::vector<std::array<Index, 4>>;

index_rows<std::uint16_t> narrow(std::span<const std::array<std::uint32_t, 4>> rows) {
    index_rows<std::uint16_t> narrowed(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
        std::ranges::transform(rows[i], narrowed[i].begin(),
                               [](std::uint32_t x) { return static_cast<std::uint16_t>(x); });
    return narrowed;
}

}  // namespace

/// The width of all indices is known once the last one is: until then their rows are kept apart,
/// and each chunk's checksum is that of both widths.
class store_writer::unfinished {
  public:
    unfinished(std::string_view kind, bool with_truth)
        : file_(new_file(whole_.path().string())), with_truth_(with_truth) {
        const std::uint32_t version = 1;
        write_text(file_, "format", "errbound queries");
        write_attribute(file_, "version", H5T_STD_U32LE, H5T_NATIVE_UINT32, &version);
        write_text(file_, "kind", kind);
    }

    void add(const store_chunk& chunk, bool is_last) {
        if (!points_) begin(chunk, is_last);
        points_->add(chunk.points.data(), chunk.points.size());
        if (truth_) truth_->add(chunk.truth.data(), chunk.truth.size());
        const auto sum = [&](const auto& rows) {
            return checksum(std::as_bytes(chunk.points), std::as_bytes(std::span(rows)),
                            std::as_bytes(chunk.truth));
        };
        sums_.push_back({sum(narrow(chunk.queries)), sum(chunk.queries)});
        is_narrow_ = is_narrow_ && chunk.points.size() <= 65536;
        const auto bytes = std::as_bytes(chunk.queries);
        queries_.append({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
        query_count_ += chunk.queries.size();
        first_point_.push_back(points_->rows());
        if (is_last) finish();
    }
    const std::filesystem::path& path() const { return whole_.path(); }

  private:
    void begin(const store_chunk& first, bool is_last) {
        // What is larger takes longer to decompress than to read.
        compressed_ = is_last && first.queries.size() <= 4096;
        points_.emplace(file_,
                        dataset{"points", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 6, 16384, compressed_},
                        first.points.size(), is_last);
        if (with_truth_)
            truth_.emplace(
                file_,
                dataset{"truth", H5T_STD_U8LE, H5T_NATIVE_UINT8, 1, queries_of_a_chunk, true},
                first.truth.size(), is_last);
    }

    void finish() {
        points_->close();
        if (truth_) truth_->close();
        if (is_narrow_)
            write_queries<std::uint16_t>(H5T_STD_U16LE, H5T_NATIVE_UINT16);
        else
            write_queries<std::uint32_t>(H5T_STD_U32LE, H5T_NATIVE_UINT32);
        std::vector<std::uint32_t> sums;
        for (const auto& [of_narrow, of_wide] : sums_)
            sums.push_back(is_narrow_ ? of_narrow : of_wide);
        write(file_, {"checksums", H5T_STD_U32LE, H5T_NATIVE_UINT32, 1, 65536, true}, sums);
        write(file_, {"first_point", H5T_STD_U64LE, H5T_NATIVE_UINT64, 1, 65536, true},
              first_point_);
        file_.close(whole_.path().string());
    }

    template <class Index>
    void write_queries(hid_t stored, hid_t given) {
        growing_rows set(file_, {"queries", stored, given, 4, queries_of_a_chunk, compressed_},
                         query_count_, sums_.size() == 1);
        index_rows<std::uint32_t> rows;
        for (std::uint64_t at = 0; at < query_count_; at += rows.size()) {
            rows.resize(std::min(query_count_ - at, queries_of_a_chunk));
            queries_.read(at * sizeof rows[0], rows.size() * sizeof rows[0], rows.data());
            if constexpr (std::is_same_v<Index, std::uint16_t>)
                set.add(narrow(rows).data(), rows.size());
            else
                set.add(rows.data(), rows.size());
        }
        set.close();
    }

    errbound::support::scratch_file whole_, queries_;
    handle file_;
    bool with_truth_, compressed_ = false, is_narrow_ = true;
    std::optional<growing_rows> points_, truth_;
    std::uint64_t query_count_ = 0;
    std::vector<std::uint64_t> first_point_{0};  // of each chunk, and their number
    std::vector<std::pair<std::uint32_t, std::uint32_t>> sums_;
};

bool has_query_stores() {
    return true;
}

store_writer::store_writer(std::string_view kind, bool with_truth) {
    const hdf5::quiet_use use;
    store_ = std::make_unique<unfinished>(kind, with_truth);
}
store_writer::~store_writer() {
    const hdf5::quiet_use use;
    store_.reset();
}
store_writer::store_writer(store_writer&&) noexcept = default;
store_writer& store_writer::operator=(store_writer&& other) noexcept {
    std::swap(store_, other.store_);
    return *this;
}
void store_writer::add(const store_chunk& chunk, bool is_last) {
    const hdf5::quiet_use use;
    store_->add(chunk, is_last);
}
const std::filesystem::path& store_writer::path() const {
    return store_->path();
}

}  // namespace ccd::io
