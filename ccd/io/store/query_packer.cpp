// Stores of queries as HDF5 files: each point once in a chunk, each chunk with a checksum.
#include <algorithm>
#include <array>
#include <bit>
#include <ccd/io/query_store.hpp>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "ccd/io/store/hdf5.hpp"
#include "ccd/io/store/store_reader.hpp"
#include "errbound/support/scratch_file.hpp"

namespace ccd::io {
namespace {

using hdf5::checked;
using hdf5::handle;

const std::string place = "a store of queries";

using row = std::array<std::uint64_t, 6>;  // bits of a point at t = 0 and t = 1

struct row_hash {
    std::size_t operator()(const row& r) const {
        std::uint64_t sum = 0;
        for (const std::uint64_t word : r) {
            sum =
                (sum ^ word) * 0x9e3779b97f4a7c15u;  // Fibonacci hashing: 2^64 by the golden ratio
            sum ^= sum >> 32;
        }
        return static_cast<std::size_t>(sum);
    }
};

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

/// The chunk that is being made, and those written before it. The width of all indices is known
/// once the last one is: until then their rows are kept apart, and each chunk's checksum is that of
/// both widths.
class query_packer::chunks {
  public:
    chunks(ccd::kind kind, bool with_truth)
        : kind_(kind), with_truth_(with_truth), file_(new_file(whole_.path().string())) {
        const std::uint32_t version = 1;
        write_text(file_, "format", "errbound queries");
        write_attribute(file_, "version", H5T_STD_U32LE, H5T_NATIVE_UINT32, &version);
        write_text(file_, "kind", name(kind));
    }

    void add(const query_file& queries) {
        if (queries.kind() != kind_)
            throw std::invalid_argument("found queries of kind " +
                                        std::string(name(queries.kind())) + ", expected " +
                                        std::string(name(kind_)));
        if (queries.truth.has_value() != with_truth_)
            throw std::invalid_argument(with_truth_
                                            ? "found queries without truth, expected some with"
                                            : "found queries with truth, expected some without");
        std::visit(
            [&](const auto& all) {
                for (std::size_t i = 0; i < all.size(); ++i) {
                    using type = std::remove_cvref_t<decltype(all[i])>;
                    static_assert(sizeof(type) == 4 * sizeof(row) &&
                                  std::is_trivially_copyable_v<type>);
                    row points[4];
                    std::memcpy(points, &all[i], sizeof points);
                    add(points);
                    if (with_truth_) truth_.push_back((*queries.truth)[i] ? 1 : 0);
                }
            },
            queries.queries);
    }
    std::uint64_t size() const { return size_; }

    const std::filesystem::path& finish() {
        if (size_ == 0) throw std::runtime_error("found no queries, expected at least one");
        if (!queries_.empty()) {
            write_chunk(true);
            close();
        }
        return whole_.path();
    }

  private:
    void add(const row* points) {
        // A chunk that is full is written when it is known not to be the last.
        if (queries_.size() == queries_of_a_chunk) write_chunk(false);
        std::array<std::uint32_t, 4> query;
        for (std::size_t i = 0; i < 4; ++i) {
            for (const std::uint64_t bits : points[i])
                if (!std::isfinite(std::bit_cast<double>(bits)))
                    throw std::invalid_argument("found a coordinate that is not finite in query " +
                                                std::to_string(size_));
            const auto next = static_cast<std::uint32_t>(points_.size());
            const auto [place, is_new] = places_.try_emplace(points[i], next);
            if (is_new) points_.push_back(points[i]);
            query[i] = place->second;
        }
        queries_.push_back(query);
        ++size_;
    }

    void write_chunk(bool is_last) {
        const hdf5::quiet_use use;
        if (!stored_points_) begin(is_last);
        stored_points_->add(points_.data(), points_.size());
        if (stored_truth_) stored_truth_->add(truth_.data(), truth_.size());
        const auto sum = [&](const auto& rows) {
            return checksum(std::as_bytes(std::span(points_)), std::as_bytes(std::span(rows)),
                            std::as_bytes(std::span(truth_)));
        };
        sums_.push_back({sum(narrow(queries_)), sum(queries_)});
        is_narrow_ = is_narrow_ && points_.size() <= 65536;
        const auto bytes = std::as_bytes(std::span(queries_));
        rows_.append({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
        first_point_.push_back(stored_points_->rows());
        points_.clear();
        queries_.clear();
        truth_.clear();
        places_.clear();
    }

    void begin(bool is_last) {
        // Larger stores take longer to decompress than to read.
        compressed_ = is_last && queries_.size() <= 4096;
        stored_points_.emplace(
            file_, dataset{"points", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 6, 16384, compressed_},
            points_.size(), is_last);
        if (with_truth_)
            stored_truth_.emplace(
                file_,
                dataset{"truth", H5T_STD_U8LE, H5T_NATIVE_UINT8, 1, queries_of_a_chunk, true},
                truth_.size(), is_last);
    }

    void close() {
        const hdf5::quiet_use use;
        stored_points_->close();
        if (stored_truth_) stored_truth_->close();
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
                         size_, sums_.size() == 1);
        index_rows<std::uint32_t> rows;
        for (std::uint64_t at = 0; at < size_; at += rows.size()) {
            rows.resize(std::min(size_ - at, queries_of_a_chunk));
            rows_.read(at * sizeof rows[0], rows.size() * sizeof rows[0], rows.data());
            if constexpr (std::is_same_v<Index, std::uint16_t>)
                set.add(narrow(rows).data(), rows.size());
            else
                set.add(rows.data(), rows.size());
        }
        set.close();
    }

    ccd::kind kind_;
    bool with_truth_, compressed_ = false, is_narrow_ = true;
    errbound::support::scratch_file whole_, rows_;
    handle file_;
    std::optional<growing_rows> stored_points_, stored_truth_;
    std::uint64_t size_ = 0;
    std::vector<std::uint64_t> first_point_{0};  // of each chunk, and their number
    std::vector<std::pair<std::uint32_t, std::uint32_t>> sums_;
    std::vector<row> points_;  // this and all below: of the chunk
    std::vector<std::array<std::uint32_t, 4>> queries_;
    std::vector<std::uint8_t> truth_;
    std::unordered_map<row, std::uint32_t, row_hash> places_;
};

bool has_query_stores() {
    return true;
}

query_packer::query_packer(ccd::kind kind, bool with_truth) {
    const hdf5::quiet_use use;
    chunks_ = std::make_unique<chunks>(kind, with_truth);
}
query_packer::~query_packer() {
    const hdf5::quiet_use use;
    chunks_.reset();
}
query_packer::query_packer(query_packer&&) noexcept = default;
query_packer& query_packer::operator=(query_packer&& other) noexcept {
    std::swap(chunks_, other.chunks_);
    return *this;
}

void query_packer::add(const query_file& queries) {
    chunks_->add(queries);
}
std::uint64_t query_packer::size() const {
    return chunks_->size();
}
const std::filesystem::path& query_packer::finish() {
    return chunks_->finish();
}

}  // namespace ccd::io
