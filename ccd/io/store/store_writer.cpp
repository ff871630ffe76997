// A store of queries as an HDF5 file, each chunk of queries with a checksum.
#include "ccd/io/store/store_writer.hpp"

#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <vector>

#include "ccd/io/store/chunk_checksum.hpp"
#include "ccd/io/store/hdf5.hpp"
#include "ccd/io/store/store_reader.hpp"
#include "errbound/support/output_file.hpp"

namespace ccd::io {
namespace {

using hdf5::checked;
using hdf5::handle;

const std::string place = "a store of queries";

/// A new file's name in the folder for temporary files, where it is until the end. (Images of files
/// in memory, H5Fget_file_image, have a wrong checksum in their first block up to HDF5 1.10.8.)
class temporary_file {
  public:
    temporary_file()
        : path_((std::filesystem::temp_directory_path() / "errbound-store-XXXXXX").string()) {
        const int descriptor = mkstemp(path_.data());
        if (descriptor < 0)
            throw errbound::support::file_error(path_ + ": cannot be made (" +
                                                std::strerror(errno) + ")");
        close(descriptor);
    }
    ~temporary_file() { unlink(path_.c_str()); }
    temporary_file(const temporary_file&) = delete;
    temporary_file& operator=(const temporary_file&) = delete;
    const std::string& path() const { return path_; }

  private:
    std::string path_;
};

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
    hsize_t rows, columns, rows_of_a_chunk;
    bool compressed;
};

void write(hid_t file, const dataset& what, const void* data) {
    const int rank = what.columns == 1 ? 1 : 2;
    const hsize_t size[] = {what.rows, what.columns};
    const hsize_t chunk[] = {std::min(what.rows, what.rows_of_a_chunk), what.columns};
    const handle space(H5Screate_simple(rank, size, nullptr), H5Sclose, place);
    const handle how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, place);
    checked(H5Pset_chunk(how, rank, chunk), place);
    checked(H5Pset_obj_track_times(how, false), place);
    if (what.compressed) {
        checked(H5Pset_shuffle(how), place);
        checked(H5Pset_deflate(how, 1), place);
    }
    checked(H5Pset_fletcher32(how), place);
    const handle made(
        H5Dcreate2(file, what.name, what.stored, space, H5P_DEFAULT, how, H5P_DEFAULT), H5Dclose,
        place);
    checked(H5Dwrite(made, what.given, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), place);
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

/// Of each chunk, with indices as they are stored.
template <class Index>
std::vector<std::uint32_t> checksums_of(const store_parts& parts, const Index* queries) {
    std::vector<std::uint32_t> sums;
    for (std::size_t c = 0; c + 1 < parts.first_point.size(); ++c) {
        const std::size_t begin = c * queries_of_a_chunk;
        const std::size_t end = std::min(parts.query_count, begin + queries_of_a_chunk);
        const std::span points(parts.points + 6 * parts.first_point[c],
                               parts.points + 6 * parts.first_point[c + 1]);
        sums.push_back(checksum(
            std::as_bytes(points), std::as_bytes(std::span(queries + 4 * begin, queries + 4 * end)),
            std::as_bytes(parts.truth.empty() ? parts.truth
                                              : parts.truth.subspan(begin, end - begin))));
    }
    return sums;
}

template <class Index>
void write_queries(hid_t file, const store_parts& parts, const Index* queries, hid_t stored,
                   hid_t given, bool compressed) {
    write(file, {"queries", stored, given, parts.query_count, 4, queries_of_a_chunk, compressed},
          queries);
    const std::vector<std::uint32_t> sums = checksums_of(parts, queries);
    write(file, {"checksums", H5T_STD_U32LE, H5T_NATIVE_UINT32, sums.size(), 1, 65536, true},
          sums.data());
}

}  // namespace

bool has_query_stores() {
    return true;
}

std::string store_of(const store_parts& parts) {
    const hdf5::quiet_use use;
    const temporary_file whole;
    handle file = new_file(whole.path());
    const std::uint32_t version = 1;
    write_text(file, "format", "errbound queries");
    write_attribute(file, "version", H5T_STD_U32LE, H5T_NATIVE_UINT32, &version);
    write_text(file, "kind", parts.kind);
    // What is larger takes longer to decompress than to read.
    const bool compressed = parts.query_count <= 4096;
    const std::span all(parts.queries, 4 * parts.query_count);
    write(file,
          {"points", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, parts.point_count, 6, 16384, compressed},
          parts.points);
    if (*std::ranges::max_element(all) < 65536) {
        const std::vector<std::uint16_t> narrow(all.begin(), all.end());
        write_queries(file, parts, narrow.data(), H5T_STD_U16LE, H5T_NATIVE_UINT16, compressed);
    } else {
        write_queries(file, parts, parts.queries, H5T_STD_U32LE, H5T_NATIVE_UINT32, compressed);
    }
    write(
        file,
        {"first_point", H5T_STD_U64LE, H5T_NATIVE_UINT64, parts.first_point.size(), 1, 65536, true},
        parts.first_point.data());
    if (!parts.truth.empty())
        write(file,
              {"truth", H5T_STD_U8LE, H5T_NATIVE_UINT8, parts.query_count, 1, queries_of_a_chunk,
               true},
              parts.truth.data());
    file.close(whole.path());
    return errbound::support::read_whole(whole.path());
}

}  // namespace ccd::io
