// Stores of queries return the same bits; damaged and hostile ones are refused or harmless.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <bit>
#include <ccd/io/query_store.hpp>
#include <cmath>
#include <cstdint>
#include <errbound/support/error.hpp>
#include <filesystem>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "ccd/io/query_ranges.hpp"
#include "ccd/io/store/hdf5.hpp"
#include "errbound/support/output_file.hpp"
#include "tests/ccd/io/content.hpp"
#include "tests/support/files.hpp"

namespace {

using namespace ccd;
using namespace ccd::io;
using errbound::support::read_whole;
using hdf5::handle;
using test_files::message_of;
using test_files::temporary_directory;
using test_files::write;
using test_queries::content;

/// Queries of any finite doubles. Points are shared, as in a mesh, or all different.
template <class Query>
query_file random_queries(std::size_t n, bool shared, bool with_truth, unsigned seed) {
    std::mt19937_64 random(seed);
    const auto number = [&] {
        for (;;) {
            const auto x = std::bit_cast<double>(random());
            if (std::isfinite(x)) return random() % 8 == 0 ? std::copysign(0.0, x) : x;
        }
    };
    const auto new_point = [&] {
        moving_point<double> p;
        p.t0 = {number(), number(), number()};
        p.t1 = {number(), number(), number()};
        return p;
    };
    std::vector<moving_point<double>> mesh(1000);
    for (auto& p : mesh) p = new_point();
    const auto next = [&] { return shared ? mesh[random() % mesh.size()] : new_point(); };
    std::vector<Query> all;
    query_file file;
    if (with_truth) file.truth.emplace();
    for (std::size_t i = 0; i < n; ++i) {
        all.push_back({next(), next(), next(), next()});
        if (with_truth) file.truth->push_back(random() % 2 == 0);
    }
    file.queries = std::move(all);
    return file;
}

std::string packed(const query_file& file) {
    const auto packer = make_query_packer(file.kind(), file.truth.has_value());
    packer->add(file);
    return read_whole(packer->finish());
}

query_file read_packed(const std::string& bytes) {
    return parse_stored_queries(bytes, "s.h5", std::nullopt, false);
}

TEST(Store, KeepsEveryBit) {
    const auto expect_same = [](const query_file& file) {
        const std::string bytes = packed(file);
        EXPECT_EQ(packed(file), bytes);
        const query_file again = read_packed(bytes);
        EXPECT_EQ(again.kind(), file.kind());
        EXPECT_EQ(again.truth.has_value(), file.truth.has_value());
        EXPECT_EQ(content(again), content(file));
    };
    for (const unsigned n : {1, 2, 1000, 65536, 65537, 140000})
        for (const bool shared : {true, false}) {
            expect_same(random_queries<vertex_face<double>>(n, shared, n % 2 == 0, n));
            expect_same(random_queries<edge_edge<double>>(n, shared, n % 2 == 1, n));
        }
}

TEST(Store, DoesNotDependOnHowQueriesAreAdded) {
    // The first chunk's indices fit 16 bits, the second chunk's do not.
    const query_file few_points = random_queries<edge_edge<double>>(70000, true, true, 5);
    const query_file many_points = random_queries<edge_edge<double>>(65536, false, true, 6);
    const auto whole = make_query_packer(kind::edge_edge, true);
    const auto parts = make_query_packer(kind::edge_edge, true);
    content expected;
    for (const query_file& file : {few_points, many_points}) {
        whole->add(file);
        expected.add(file);
        for (std::size_t begin = 0, n = 1; begin < file.size(); begin += n, n = 3 * n % 1001 + 1) {
            const auto cut = [begin, end = std::min(begin + n, file.size())](const auto& list) {
                using difference = std::iter_difference_t<decltype(list.begin())>;
                return std::vector(list.begin() + static_cast<difference>(begin),
                                   list.begin() + static_cast<difference>(end));
            };
            parts->add({cut(std::get<1>(file.queries)), cut(*file.truth)});
        }
    }
    EXPECT_EQ(parts->size(), expected.truth.size());
    const std::string bytes = read_whole(whole->finish());
    EXPECT_EQ(read_whole(parts->finish()), bytes);
    EXPECT_EQ(content(read_packed(bytes)), expected);
}

TEST(Store, RemovesItsFile) {
    auto packer = make_query_packer(kind::edge_edge, false);
    packer->add(random_queries<edge_edge<double>>(10, true, false, 1));
    const std::filesystem::path made = packer->finish();
    EXPECT_TRUE(std::filesystem::exists(made));
    packer.reset();
    EXPECT_FALSE(std::filesystem::exists(made));
}

TEST(Store, IsReadInRanges) {
    const temporary_directory folder;
    const query_file file = random_queries<edge_edge<double>>(70000, true, true, 7);
    const auto path = folder.path / "queries.h5";
    write(path, packed(file));
    for (const std::size_t size : {1000, 65536, 100000}) {
        range_reader reader(path, std::nullopt, false, size);
        content all;
        while (const auto part = reader.next()) {
            EXPECT_LE(part->size(), size);
            all.add(*part);
        }
        EXPECT_EQ(all, content(file));
    }
    content all;
    for (const file_range range :
         {file_range{0, 65000}, file_range{65000, 1000}, file_range{66000}})
        all.add(read_queries(path, kind::edge_edge, false, range));
    EXPECT_EQ(all, content(file));
    const auto as_faces = [&] { read_queries(path, kind::vertex_face, false); };
    EXPECT_EQ(message_of(as_faces),
              path.string() + ": kind of queries is edge_edge; expected vertex_face");
}

TEST(Store, RefusesWhatItCannotHold) {
    const query_file one = random_queries<edge_edge<double>>(1, true, true, 1);
    EXPECT_THROW(make_query_packer(kind::vertex_face, true)->add(one), std::invalid_argument);
    const auto without = make_query_packer(kind::edge_edge, false);
    EXPECT_THROW(without->add(one), std::invalid_argument);
    EXPECT_THROW(without->finish(), std::runtime_error);
    query_file wrong = random_queries<edge_edge<double>>(1, true, false, 1);
    std::get<1>(wrong.queries)[0].b1.t1.z = std::numeric_limits<double>::infinity();
    EXPECT_THROW(without->add(wrong), std::invalid_argument);
}

TEST(Store, DamageIsReportedOrHarmless) {
    for (const bool with_truth : {true, false})
        for (const std::size_t n : {3, 5000}) {
            const query_file file = random_queries<vertex_face<double>>(n, true, with_truth, 3);
            const std::string bytes = packed(file);
            const auto expect_no_harm = [&](const std::string& damaged, std::size_t at) {
                const std::string message = message_of(
                    [&] { EXPECT_EQ(content(read_packed(damaged)), content(file)) << at; });
                EXPECT_TRUE(message == "no error" || message.starts_with("s.h5")) << message;
            };
            const std::size_t stride = std::max<std::size_t>(1, bytes.size() / 1000);
            for (std::size_t i = 8; i < bytes.size(); i += stride) {
                for (const unsigned flip : {0x01u, 0x80u, 0xffu}) {
                    std::string damaged = bytes;
                    damaged[i] = static_cast<char>(static_cast<unsigned char>(damaged[i]) ^ flip);
                    expect_no_harm(damaged, i);
                }
                expect_no_harm(bytes.substr(0, i), i);
            }
        }
}

// Forged stores: HDF5 files with the right names and other content.

using forge = std::function<void(hid_t file)>;

void require(herr_t status) {
    if (status < 0) throw std::logic_error("HDF5: " + hdf5::reason());
}

constexpr hsize_t queries_in_it = 3, points_in_it = 4;

/// A dataset that holds `data`, if any, in one chunk unless `chunk` or `layout` differs.
struct forged_set {
    const char* name;
    hid_t stored;
    std::vector<hsize_t> size;
    std::vector<double> data{};
    std::vector<hsize_t> chunk{};
    std::function<void(hid_t)> layout{};
};

/// Replaces the dataset of this name.
forge replace(const forged_set& set) {
    return [set](hid_t file) {
        require(H5Ldelete(file, set.name, H5P_DEFAULT));
        const auto rank = static_cast<int>(set.size.size());
        const std::vector<hsize_t> most(set.size.size(), H5S_UNLIMITED);
        const handle space(
            H5Screate_simple(rank, set.size.data(), set.layout ? nullptr : most.data()), H5Sclose,
            set.name);
        const handle how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, set.name);
        if (set.layout)
            set.layout(how);
        else
            require(H5Pset_chunk(how, rank, (set.chunk.empty() ? set.size : set.chunk).data()));
        const handle made(
            H5Dcreate2(file, set.name, set.stored, space, H5P_DEFAULT, how, H5P_DEFAULT), H5Dclose,
            set.name);
        if (!set.data.empty())
            require(
                H5Dwrite(made, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, set.data.data()));
    };
}

/// Changes one number of a dataset of `numbers` numbers.
forge set_number(const char* name, std::size_t numbers, std::size_t at, double value) {
    return [=](hid_t file) {
        const handle set(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose, name);
        std::vector<double> all(numbers);
        require(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()));
        all[at] = value;
        require(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()));
    };
}

forge link_to(const char* name, const std::filesystem::path& other) {
    return [=](hid_t file) {
        require(H5Ldelete(file, name, H5P_DEFAULT));
        require(H5Lcreate_external(other.c_str(), name, file, name, H5P_DEFAULT, H5P_DEFAULT));
    };
}

class ForgedStore : public testing::Test {
  protected:
    ForgedStore() {
        query_file file = random_queries<edge_edge<double>>(1, true, false, 1);
        auto& all = std::get<1>(file.queries);
        const auto [a, b, c, d] = all[0];
        all = {{a, b, c, d}, {b, a, d, c}, {d, c, b, a}};
        file.truth = {true, false, true};
        good_ = packed(file);
    }

    /// Expects that the message for a forged store contains `part`.
    void expect(const std::string& part, const forge& change) {
        const auto path = folder_.path / "forged.h5";
        write(path, good_);
        {
            const handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose, "forged");
            change(file);
        }
        const std::string message = message_of([&] { read_queries(path, std::nullopt, false); });
        EXPECT_NE(message.find(part), std::string::npos) << message << "\nexpected: " << part;
        EXPECT_TRUE(part == "no error" || message.starts_with(path.string())) << message;
    }

    temporary_directory folder_;
    std::string good_;
};

const std::vector<double> ones(24, 1.0), zeros(12, 0.0);

TEST_F(ForgedStore, WithOtherTypesShapesOrNumbersIsRefused) {
    expect("no error", replace({"points", H5T_IEEE_F64LE, {points_in_it, 6}, ones}));
    for (const hid_t type : {H5T_IEEE_F64BE, H5T_IEEE_F32LE, H5T_STD_I64LE})
        expect("dataset points: type of numbers is another one; expected float64",
               replace({"points", type, {points_in_it, 6}, ones}));
    for (const hid_t type : {H5T_STD_I16LE, H5T_STD_U16BE, H5T_STD_U8LE, H5T_STD_I64LE})
        expect("dataset queries: type of numbers is another one; expected uint16 or uint32",
               replace({"queries", type, {queries_in_it, 4}, zeros}));
    for (const std::vector<hsize_t>& size :
         {std::vector<hsize_t>{24}, {4, 5}, {3, 7}, {2, 2, 6}, {6, 4}})
        expect("dataset points: shape is another one; expected rows of 6",
               replace({"points", H5T_IEEE_F64LE, size, ones}));
    expect("dataset truth: number of rows is 2; expected 3",
           replace({"truth", H5T_STD_U8LE, {2}, ones}));
    expect("dataset points", [](hid_t file) { require(H5Ldelete(file, "points", H5P_DEFAULT)); });
    expect("dataset points", [](hid_t file) {
        require(H5Ldelete(file, "points", H5P_DEFAULT));
        const handle group(H5Gcreate2(file, "points", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                           H5Gclose, "group");
    });
    expect("dataset truth: row 1: value is 2; expected 0 or 1", set_number("truth", 3, 1, 2));
    expect("dataset queries: row 2: point index is 4; expected less than 4",
           set_number("queries", 12, 11, 4));
    expect("dataset points: row 3: a number is not finite",
           set_number("points", 24, 23, std::numeric_limits<double>::quiet_NaN()));
    for (const auto& [first, last] : {std::pair(1, 4), {0, 3}, {4, 0}, {4, 4}})
        expect("dataset first_point: rows are out of order; expected rows that ascend from 0 to 4",
               replace({"first_point", H5T_STD_U64LE, {2}, {double(first), double(last)}}));
    expect("attribute kind", [](hid_t file) { require(H5Adelete(file, "kind")); });
    expect("attribute version is 7; expected 1", [](hid_t file) {
        const handle version(H5Aopen(file, "version", H5P_DEFAULT), H5Aclose, "version");
        const std::uint32_t seven = 7;
        require(H5Awrite(version, H5T_NATIVE_UINT32, &seven));
    });
}

/// No other file is opened: opening a pipe without a writer would block for ever.
TEST_F(ForgedStore, WithDatasetsInOtherFilesIsRefused) {
    const auto pipe = folder_.path / "pipe", good = folder_.path / "good.h5",
               raw = folder_.path / "raw";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    write(good, good_);
    write(raw, std::string(48 * points_in_it, '\0'));
    const std::string link = ": link leads to another place";
    for (const auto& other : {good, pipe, folder_.path / "none"})
        expect("dataset points" + link, link_to("points", other));
    expect("dataset truth" + link, link_to("truth", pipe));
    expect("dataset points" + link, [](hid_t file) {
        require(H5Lmove(file, "points", file, "elsewhere", H5P_DEFAULT, H5P_DEFAULT));
        require(H5Lcreate_soft("/elsewhere", file, "points", H5P_DEFAULT, H5P_DEFAULT));
    });
    for (const auto& other : {good, raw, pipe}) {
        const auto make_virtual = [&](hid_t how) {
            const hsize_t size[] = {points_in_it, 6};
            const handle space(H5Screate_simple(2, size, nullptr), H5Sclose, "space");
            require(H5Pset_layout(how, H5D_VIRTUAL));
            require(H5Pset_virtual(how, space, other.c_str(), "points", space));
        };
        const auto make_external = [&](hid_t how) {
            require(H5Pset_layout(how, H5D_CONTIGUOUS));
            require(H5Pset_external(how, other.c_str(), 0, 48 * points_in_it));
        };
        const std::string chunks = "dataset points: layout is not chunked";
        expect(chunks,
               replace({"points", H5T_IEEE_F64LE, {points_in_it, 6}, {}, {}, make_virtual}));
        expect(chunks,
               replace({"points", H5T_IEEE_F64LE, {points_in_it, 6}, {}, {}, make_external}));
    }
}

// 40 rows of 6 in a chunk of 2^20 x 100 numbers: the file had 831 KB, and a read took 838 MB.
TEST_F(ForgedStore, ThatWouldExhaustMemoryIsRefused) {
    const hid_t number = H5T_IEEE_F64LE, byte = H5T_STD_U8LE;
    const std::vector<std::pair<std::string, forged_set>> cases{
        {"dataset points: size of chunks is 1048576 x 100 numbers; expected at most 64 MiB each",
         {"points", number, {40, 6}, {}, {1 << 20, 100}}},
        {"dataset points: size of chunks is 1048576 x 9 numbers",
         {"points", number, {40, 6}, {}, {1 << 20, 9}}},
        {"dataset points: number of rows is 40; expected at most as many",
         {"points", number, {40, 6}, {}, {1 << 20, 8}}},
        {"dataset points: number of rows is 4; expected at most as many",
         {"points", number, {points_in_it, 6}}},
        {"dataset truth: size of chunks is 67108865 x 1 numbers",
         {"truth", byte, {queries_in_it}, {}, {(1 << 26) + 1}}},
        {"as many as the file can hold", {"truth", byte, {hsize_t{1} << 50}, {}, {65536}}}};
    for (const auto& [message, set] : cases) expect(message, replace(set));
}

}  // namespace
