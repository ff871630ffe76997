// The writer of stores. A chunk holds each of its points once; every dataset has HDF5's checksums.
#include <algorithm>
#include <array>
#include <bit>
#include <boost/functional/hash.hpp>
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
#include <vector>

#include "ccd/io/store/hdf5.hpp"
#include "ccd/io/store/store_reader.hpp"
#include "errbound/support/scratch_file.hpp"

namespace ccd::io {
namespace {

using hdf5::checked;
using hdf5::handle;

const std::string where = "a store of queries";

using point_row = std::array<std::uint64_t, 6>;  // bits of a point at t = 0 and t = 1
using query_row = std::array<std::uint32_t, 4>;

handle new_file(const std::string& path) {
    const handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, where);
    // From version 1.10 on, the library keeps checksums of all its own structures.
    checked(H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110), where);
    const handle how(H5Pcreate(H5P_FILE_CREATE), H5Pclose, where);
    checked(H5Pset_obj_track_times(how, false), where);  // equal queries give equal bytes
    return {H5Fcreate(path.c_str(), H5F_ACC_TRUNC, how, access), H5Fclose, path};
}

struct row_format {
    hsize_t columns, rows_of_a_chunk;
    bool compressed;
};

/// A dataset to which rows are added. `given` is the numbers' type in memory.
class growing_rows {
  public:
    growing_rows(hid_t file, const char* name, hid_t stored, hid_t given, const row_format& format)
        : given_(given),
          columns_(format.columns),
          rank_(format.columns == 1 ? 1 : 2),
          set_(new_set(file, name, stored, format)) {}

    void add(const void* data, hsize_t rows) {
        const hsize_t first[] = {rows_, 0}, more[] = {rows, columns_};
        const hsize_t size[] = {rows_ += rows, columns_};
        checked(H5Dset_extent(set_, size), where);
        const handle to(H5Dget_space(set_), H5Sclose, where);
        checked(H5Sselect_hyperslab(to, H5S_SELECT_SET, first, nullptr, more, nullptr), where);
        const handle from(H5Screate_simple(rank_, more, nullptr), H5Sclose, where);
        checked(H5Dwrite(set_, given_, from, to, H5P_DEFAULT, data), where);
    }
    hsize_t rows() const { return rows_; }
    void close() { set_.close(where); }

  private:
    handle new_set(hid_t file, const char* name, hid_t stored, const row_format& format) const {
        const hsize_t none[] = {0, columns_}, most[] = {H5S_UNLIMITED, columns_};
        const hsize_t chunk[] = {format.rows_of_a_chunk, columns_};
        const handle space(H5Screate_simple(rank_, none, most), H5Sclose, where);
        const handle how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, where);
        checked(H5Pset_chunk(how, rank_, chunk), where);
        checked(H5Pset_obj_track_times(how, false), where);
        if (format.compressed) {
            checked(H5Pset_shuffle(how), where);
            checked(H5Pset_deflate(how, 1), where);
        }
        checked(H5Pset_fletcher32(how), where);
        return {H5Dcreate2(file, name, stored, space, H5P_DEFAULT, how, H5P_DEFAULT), H5Dclose,
                where};
    }

    hid_t given_;
    hsize_t columns_, rows_ = 0;
    int rank_;
    handle set_;
};

void write_attribute(hid_t file, const char* name, hid_t stored, hid_t given, const void* data) {
    const handle space(H5Screate(H5S_SCALAR), H5Sclose, where);
    const handle made(H5Acreate2(file, name, stored, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                      where);
    checked(H5Awrite(made, given, data), where);
}

void write_text(hid_t file, const char* name, std::string_view text) {
    const handle type(H5Tcopy(H5T_C_S1), H5Tclose, where);
    checked(H5Tset_size(type, text.size()), where);
    write_attribute(file, name, type, type, text.data());
}

/// Collects a chunk at a time. The width of point indices is known only at the end; until then
/// their rows are in a separate file.
class packer final : public query_packer {
  public:
    packer(ccd::kind kind, bool with_truth)
        : kind_(kind), with_truth_(with_truth), file_(new_file(whole_.path().string())) {
        const std::uint32_t version = 1;
        write_text(file_, "format", "errbound queries");
        write_attribute(file_, "version", H5T_STD_U32LE, H5T_NATIVE_UINT32, &version);
        write_text(file_, "kind", name(kind));
    }

    void add(const query_file& queries) override {
        if (queries.kind() != kind_)
            throw std::invalid_argument("kind of queries is " + std::string(name(queries.kind())) +
                                        "; expected " + std::string(name(kind_)));
        if (queries.truth.has_value() != with_truth_)
            throw std::invalid_argument(with_truth_ ? "truth is missing; expected truth values"
                                                    : "truth is given; expected none");
        const auto add_all = [&](const auto& all) {
            for (std::size_t i = 0; i < all.size(); ++i) {
                using query = std::remove_cvref_t<decltype(all[i])>;
                static_assert(sizeof(query) == 4 * sizeof(point_row) &&
                              std::is_trivially_copyable_v<query>);
                add_query(std::bit_cast<std::array<point_row, 4>>(all[i]));
                if (with_truth_) truth_.push_back((*queries.truth)[i] ? 1 : 0);
            }
        };
        std::visit(add_all, queries.queries);
    }
    std::uint64_t size() const override { return size_; }

    const std::filesystem::path& finish() override {
        if (size_ == 0) throw std::runtime_error("number of queries is 0; expected at least 1");
        if (!queries_.empty()) {
            const hdf5::quiet_use use;
            write_chunk(true);
            stored_points_->close();
            if (stored_truth_) stored_truth_->close();
            write_queries();
            growing_rows firsts(file_, "first_point", H5T_STD_U64LE, H5T_NATIVE_UINT64,
                                {1, std::min<hsize_t>(first_point_.size(), 65536), true});
            firsts.add(first_point_.data(), first_point_.size());
            firsts.close();
            file_.close(whole_.path().string());
        }
        return whole_.path();
    }

  private:
    void add_query(const std::array<point_row, 4>& points) {
        // A full chunk is written once it is known not to be the last.
        if (queries_.size() == queries_of_a_chunk) write_chunk(false);
        query_row query;
        for (std::size_t i = 0; i < 4; ++i) {
            for (const std::uint64_t bits : points[i])
                if (!std::isfinite(std::bit_cast<double>(bits)))
                    throw std::invalid_argument("coordinate of query " + std::to_string(size_) +
                                                " is not finite; expected finite numbers");
            const auto next = static_cast<std::uint32_t>(points_.size());
            const auto [place, is_new] = indices_.try_emplace(points[i], next);
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
        is_narrow_ = is_narrow_ && points_.size() <= 65536;
        const auto bytes = std::as_bytes(std::span(queries_));
        rows_.append({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
        first_point_.push_back(stored_points_->rows());
        points_.clear();
        queries_.clear();
        truth_.clear();
        indices_.clear();
    }

    void begin(bool is_last) {
        const auto rows_of_a_chunk = [is_last](hsize_t rows, hsize_t most) {
            return is_last ? std::min(rows, most) : most;
        };
        query_chunk_ = rows_of_a_chunk(queries_.size(), queries_of_a_chunk);
        // Larger stores take longer to decompress than to read.
        compressed_ = is_last && queries_.size() <= 4096;
        stored_points_.emplace(file_, "points", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE,
                               row_format{6, rows_of_a_chunk(points_.size(), 16384), compressed_});
        if (with_truth_)
            stored_truth_.emplace(file_, "truth", H5T_STD_U8LE, H5T_NATIVE_UINT8,
                                  row_format{1, query_chunk_, true});
    }

    void write_queries() {
        growing_rows set(file_, "queries", is_narrow_ ? H5T_STD_U16LE : H5T_STD_U32LE,
                         H5T_NATIVE_UINT32, {4, query_chunk_, compressed_});
        std::vector<query_row> rows;
        for (std::uint64_t at = 0; at < size_; at += rows.size()) {
            rows.resize(std::min(size_ - at, queries_of_a_chunk));
            rows_.read(at * sizeof rows[0], rows.size() * sizeof rows[0], rows.data());
            set.add(rows.data(), rows.size());
        }
        set.close();
    }

    ccd::kind kind_;
    bool with_truth_, compressed_ = false, is_narrow_ = true;
    errbound::support::scratch_file whole_, rows_;
    handle file_;
    std::optional<growing_rows> stored_points_, stored_truth_;
    hsize_t query_chunk_ = 0;  ///< rows of a chunk of queries and truth
    std::uint64_t size_ = 0;
    std::vector<std::uint64_t> first_point_{0};  ///< of each chunk, then the number of points
    // State of the chunk that is being collected:
    std::vector<point_row> points_;
    std::vector<query_row> queries_;
    std::vector<std::uint8_t> truth_;
    std::unordered_map<point_row, std::uint32_t, boost::hash<point_row>> indices_;
};

}  // namespace

bool has_query_stores() {
    return true;
}

std::unique_ptr<query_packer> make_query_packer(ccd::kind kind, bool with_truth) {
    const hdf5::quiet_use use;
    return std::make_unique<packer>(kind, with_truth);
}

}  // namespace ccd::io
