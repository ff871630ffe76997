// Stores that somebody made by hand: HDF5 files with the right names, and something else in them.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <boost/crc.hpp>
#include <ccd/io/query_file.hpp>
#include <ccd/io/query_store.hpp>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "ccd/io/store/hdf5.hpp"
#include "tests/support/files.hpp"

namespace {

using namespace ccd;
using namespace ccd::io;
using hdf5::handle;
using test_files::message_of;
using test_files::temporary_directory;

constexpr hsize_t queries_in_it = 3, points_in_it = 4;

/// Four points, of which every query has all.
query_file good_queries() {
    using point = moving_point<double>;
    const point a{{1, 2, 3}, {4, 5, 6}}, b{{7, 8, 9}, {1, 0, 1}}, c{{2, 2, 2}, {3, 3, 3}},
        d{{5, 4, 3}, {2, 1, 0}};
    query_file file;
    file.queries = std::vector<edge_edge<double>>{{a, b, c, d}, {b, a, d, c}, {d, c, b, a}};
    file.truth = std::vector<bool>{true, false, true};
    return file;
}

void require(herr_t status) {
    if (status < 0) throw std::logic_error("HDF5: " + hdf5::reason());
}

using change_plist = std::function<void(hid_t)>;

/// Writes a dataset in the place of that of this name.
void replace(hid_t file, const char* name, hid_t stored, hid_t given, std::vector<hsize_t> size,
             const void* data, const change_plist& change = {}) {
    require(H5Ldelete(file, name, H5P_DEFAULT));
    const auto rank = static_cast<int>(size.size());
    const handle space(H5Screate_simple(rank, size.data(), nullptr), H5Sclose, name);
    const handle how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, name);
    std::vector<hsize_t> chunk;
    for (const hsize_t rows : size) chunk.push_back(std::min<hsize_t>(rows, 65536));
    require(H5Pset_chunk(how, rank, chunk.data()));
    if (change) change(how);
    const handle set(H5Dcreate2(file, name, stored, space, H5P_DEFAULT, how, H5P_DEFAULT), H5Dclose,
                     name);
    if (data != nullptr) require(H5Dwrite(set, given, H5S_ALL, H5S_ALL, H5P_DEFAULT, data));
}

using point_rows = std::array<std::array<double, 6>, points_in_it>;
using query_rows = std::array<std::array<std::uint16_t, 4>, queries_in_it>;
using truths = std::array<std::uint8_t, queries_in_it>;

/// What a good store has in it.
struct content {
    point_rows points{};
    query_rows queries{};
    truths truth{};

    content() = default;
    explicit content(hid_t file) {
        read(file, "points", H5T_NATIVE_DOUBLE, points.data());
        read(file, "queries", H5T_NATIVE_UINT16, queries.data());
        read(file, "truth", H5T_NATIVE_UINT8, truth.data());
    }
    /// With the checksum that belongs to it.
    void write(hid_t file) const {
        boost::crc_32_type sum;
        sum.process_bytes(points.data(), sizeof points);
        sum.process_bytes(queries.data(), sizeof queries);
        sum.process_bytes(truth.data(), sizeof truth);
        const std::uint32_t checksum = sum.checksum();
        replace(file, "points", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {points_in_it, 6},
                points.data());
        replace(file, "queries", H5T_STD_U16LE, H5T_NATIVE_UINT16, {queries_in_it, 4},
                queries.data());
        replace(file, "truth", H5T_STD_U8LE, H5T_NATIVE_UINT8, {queries_in_it}, truth.data());
        replace(file, "checksums", H5T_STD_U32LE, H5T_NATIVE_UINT32, {1}, &checksum);
    }

    static void read(hid_t file, const char* name, hid_t type, void* to) {
        const handle set(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose, name);
        require(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, to));
    }
};

class ForgedStore : public testing::Test {
  protected:
    ForgedStore() {
        query_packer packer(kind::edge_edge, true);
        packer.add(good_queries());
        std::filesystem::copy_file(packer.finish(), good_);
    }

    /// Whether reading what `forge` makes of the good store says so, and where.
    void expect(const std::string& said, const std::function<void(hid_t)>& forge) {
        const auto path = folder_.path / "forged.h5";
        std::filesystem::copy_file(good_, path, std::filesystem::copy_options::overwrite_existing);
        {
            const handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose, "forged");
            forge(file);
        }
        const std::string message = message_of([&] { read_queries(path, std::nullopt, false); });
        EXPECT_EQ(message.substr(0, path.string().size()), path.string()) << message;
        EXPECT_NE(message.find(said), std::string::npos) << message << "\nexpected: " << said;
    }
    void expect_of_content(const std::string& said, const std::function<void(content&)>& change) {
        expect(said, [&](hid_t file) {
            content all(file);
            change(all);
            all.write(file);
        });
    }

    temporary_directory folder_;
    std::filesystem::path good_ = folder_.path / "good.h5";
};

TEST_F(ForgedStore, WrittenByHandIsRead) {
    const auto path = folder_.path / "by-hand.h5";
    std::filesystem::copy_file(good_, path);
    {
        const handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose, "by hand");
        content(file).write(file);
    }
    const query_file found = read_queries(path, std::nullopt, false);
    const query_file expected = good_queries();
    EXPECT_EQ(found.truth, expected.truth);
    ASSERT_EQ(found.size(), expected.size());
    const auto &of_found = std::get<1>(found.queries), &of_expected = std::get<1>(expected.queries);
    EXPECT_EQ(std::memcmp(of_found.data(), of_expected.data(), sizeof of_expected[0] * 3), 0);
}

/// The checksum of a store without truth is that of points and queries.
TEST_F(ForgedStore, ChecksumsAreAsTheFormatSays) {
    query_file file = good_queries();
    file.truth.reset();
    query_packer packer(kind::edge_edge, false);
    packer.add(file);
    const handle store(H5Fopen(packer.finish().c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose,
                       "store");
    content all;
    std::uint32_t checksum = 0;
    content::read(store, "points", H5T_NATIVE_DOUBLE, all.points.data());
    content::read(store, "queries", H5T_NATIVE_UINT16, all.queries.data());
    content::read(store, "checksums", H5T_NATIVE_UINT32, &checksum);
    boost::crc_32_type sum;
    sum.process_bytes(all.points.data(), sizeof all.points);
    sum.process_bytes(all.queries.data(), sizeof all.queries);
    EXPECT_EQ(checksum, sum.checksum());
}

TEST_F(ForgedStore, TypesAreThoseOfTheFormat) {
    const std::vector<double> numbers(6 * points_in_it, 1.0);
    for (const hid_t type : {H5T_IEEE_F64BE, H5T_IEEE_F32LE, H5T_STD_I64LE})
        expect("dataset points: found numbers of another type, expected float64", [&](hid_t file) {
            replace(file, "points", type, H5T_NATIVE_DOUBLE, {points_in_it, 6}, numbers.data());
        });
    const std::vector<std::int16_t> indices(4 * queries_in_it, -1);
    for (const hid_t type : {H5T_STD_I16LE, H5T_STD_U16BE, H5T_STD_U8LE, H5T_STD_I64LE})
        expect("dataset queries: found numbers of another type, expected uint16 or uint32",
               [&](hid_t file) {
                   replace(file, "queries", type, H5T_NATIVE_INT16, {queries_in_it, 4},
                           indices.data());
               });
}

TEST_F(ForgedStore, ShapesAreThoseOfTheFormat) {
    const std::vector<double> numbers(100, 1.0);
    for (const std::vector<hsize_t>& size :
         {std::vector<hsize_t>{24}, {4, 5}, {4, 7}, {2, 2, 6}, {6, 4}})
        expect("dataset points: found another shape, expected rows of 6", [&](hid_t file) {
            replace(file, "points", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, size, numbers.data());
        });
    const std::vector<std::uint8_t> truth(10, 1);
    expect("dataset truth: found 2 rows, expected 3", [&](hid_t file) {
        replace(file, "truth", H5T_STD_U8LE, H5T_NATIVE_UINT8, {2}, truth.data());
    });
    const std::vector<std::uint32_t> sums(10, 1);
    expect("dataset checksums: found 2 rows, expected 1", [&](hid_t file) {
        replace(file, "checksums", H5T_STD_U32LE, H5T_NATIVE_UINT32, {2}, sums.data());
    });
    expect("dataset points", [](hid_t file) { require(H5Ldelete(file, "points", H5P_DEFAULT)); });
    expect("dataset points", [](hid_t file) {
        require(H5Ldelete(file, "points", H5P_DEFAULT));
        const handle group(H5Gcreate2(file, "points", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                           H5Gclose, "group");
    });
}

/// Nothing else is opened: a pipe that nobody writes to would block for ever.
TEST_F(ForgedStore, WhatItHasIsInIt) {
    const auto pipe = folder_.path / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    const std::string link = "dataset points: found a link to another place";
    for (const auto& other : {good_, pipe, folder_.path / "none"})
        expect(link, [&](hid_t file) {
            require(H5Ldelete(file, "points", H5P_DEFAULT));
            require(H5Lcreate_external(other.c_str(), "points", file, "points", H5P_DEFAULT,
                                       H5P_DEFAULT));
        });
    expect("dataset truth: found a link to another place", [&](hid_t file) {
        require(H5Ldelete(file, "truth", H5P_DEFAULT));
        require(H5Lcreate_external(pipe.c_str(), "truth", file, "truth", H5P_DEFAULT, H5P_DEFAULT));
    });
    expect(link, [](hid_t file) {
        require(H5Lmove(file, "points", file, "elsewhere", H5P_DEFAULT, H5P_DEFAULT));
        require(H5Lcreate_soft("/elsewhere", file, "points", H5P_DEFAULT, H5P_DEFAULT));
    });
    const std::string chunks = "dataset points: found no chunks";
    const auto raw = folder_.path / "raw";
    test_files::write(raw, std::string(48 * points_in_it, '\0'));
    for (const auto& other : {good_, raw, pipe}) {
        expect(chunks, [&](hid_t file) {
            replace(file, "points", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {points_in_it, 6}, nullptr,
                    [&](hid_t how) {
                        const hsize_t size[] = {points_in_it, 6};
                        const handle space(H5Screate_simple(2, size, nullptr), H5Sclose, "space");
                        require(H5Pset_layout(how, H5D_VIRTUAL));
                        require(H5Pset_virtual(how, space, other.c_str(), "points", space));
                    });
        });
        expect(chunks, [&](hid_t file) {
            replace(file, "points", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {points_in_it, 6}, nullptr,
                    [&](hid_t how) {
                        require(H5Pset_layout(how, H5D_CONTIGUOUS));
                        require(H5Pset_external(how, other.c_str(), 0, 48 * points_in_it));
                    });
        });
    }
}

TEST_F(ForgedStore, WhatWasNeverWrittenIsNotRead) {
    expect("dataset points: found 4 rows, more than the file can hold", [](hid_t file) {
        replace(file, "points", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {points_in_it, 6}, nullptr);
    });
    expect("queries 0 to 2: found another checksum", [](hid_t file) {
        const content all(file);
        replace(file, "points", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {points_in_it, 6}, nullptr,
                [](hid_t how) {
                    const hsize_t one_row[] = {1, 6};
                    require(H5Pset_chunk(how, 2, one_row));
                });
        const handle set(H5Dopen2(file, "points", H5P_DEFAULT), H5Dclose, "points");
        const handle to(H5Dget_space(set), H5Sclose, "space");
        const hsize_t first[] = {0, 0}, rows[] = {2, 6};
        require(H5Sselect_hyperslab(to, H5S_SELECT_SET, first, nullptr, rows, nullptr));
        require(H5Dwrite(set, H5T_NATIVE_DOUBLE, to, to, H5P_DEFAULT, all.points.data()));
    });
    expect("more than the file can hold", [](hid_t file) {
        const hsize_t many = std::uint64_t{1} << 50;
        replace(file, "truth", H5T_STD_U8LE, H5T_NATIVE_UINT8, {many}, nullptr, [](hid_t how) {
            const hsize_t chunk[] = {65536};
            require(H5Pset_chunk(how, 1, chunk));
            require(H5Pset_alloc_time(how, H5D_ALLOC_TIME_INCR));
        });
    });
}

// 40 rows of 6 in a chunk of 2^20 x 100 numbers: the file has 831 KB, and a read took 838 MB.
TEST_F(ForgedStore, ChunksFitInMemory) {
    const auto with_chunks = [](const char* name, hid_t type, std::vector<hsize_t> size,
                                std::vector<hsize_t> chunk) {
        return [=](hid_t file) {
            require(H5Ldelete(file, name, H5P_DEFAULT));
            const auto rank = static_cast<int>(size.size());
            const std::vector<hsize_t> most(size.size(), H5S_UNLIMITED);
            const handle space(H5Screate_simple(rank, size.data(), most.data()), H5Sclose, "space");
            const handle how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "how");
            require(H5Pset_chunk(how, rank, chunk.data()));
            const handle set(H5Dcreate2(file, name, type, space, H5P_DEFAULT, how, H5P_DEFAULT),
                             H5Dclose, name);
        };
    };
    expect("dataset points: found chunks of 1048576 x 100 numbers, expected at most 64 MiB each",
           with_chunks("points", H5T_IEEE_F64LE, {40, 6}, {1 << 20, 100}));
    expect("dataset points: found chunks of 1048576 x 9 numbers",
           with_chunks("points", H5T_IEEE_F64LE, {40, 6}, {1 << 20, 9}));
    expect("dataset points: found 40 rows, more than the file can hold",
           with_chunks("points", H5T_IEEE_F64LE, {40, 6}, {1 << 20, 8}));
    expect("dataset truth: found chunks of 67108865 x 1 numbers",
           with_chunks("truth", H5T_STD_U8LE, {queries_in_it}, {(1 << 26) + 1}));
}

TEST_F(ForgedStore, NumbersMakeSenseWhateverTheChecksumSays) {
    expect_of_content("dataset truth: row 1: found 2, expected 0 or 1",
                      [](content& all) { all.truth[1] = 2; });
    expect_of_content("dataset queries: row 2: found point 4, expected one of the chunk's 4",
                      [](content& all) { all.queries[2][3] = 4; });
    expect_of_content("dataset points: row 3: found a number that is not finite", [](content& all) {
        all.points[3][5] = std::numeric_limits<double>::quiet_NaN();
    });
    using begins = std::array<std::uint64_t, 2>;
    for (const begins& b : {begins{1, 4}, begins{0, 3}, begins{4, 0}, begins{4, 4}})
        expect("dataset first_point: expected rows that ascend from 0 to 4", [&](hid_t file) {
            replace(file, "first_point", H5T_STD_U64LE, H5T_NATIVE_UINT64, {2}, b.data());
        });
}

TEST_F(ForgedStore, AttributesAreThoseOfTheFormat) {
    expect("attribute kind", [](hid_t file) { require(H5Adelete(file, "kind")); });
    expect("attribute version: found 7, expected 1", [](hid_t file) {
        require(H5Adelete(file, "version"));
        const handle space(H5Screate(H5S_SCALAR), H5Sclose, "space");
        const handle made(
            H5Acreate2(file, "version", H5T_STD_U32LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
            "version");
        const std::uint32_t seven = 7;
        require(H5Awrite(made, H5T_NATIVE_UINT32, &seven));
    });
}

}  // namespace
