// Stores of queries: what is put in comes out, bit for bit, and damage is told or does no harm.
#include <gtest/gtest.h>

#include <bit>
#include <ccd/io/query_store.hpp>
#include <cstring>
#include <errbound/support/error.hpp>
#include <filesystem>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "ccd/io/query_ranges.hpp"
#include "errbound/support/output_file.hpp"
#include "tests/support/files.hpp"

namespace {

using namespace ccd;
using namespace ccd::io;
using test_files::message_of;
using test_files::temporary_directory;
using test_files::write;

template <class Query>
query_file file_of(std::vector<Query> all, std::optional<std::vector<bool>> truth) {
    query_file file;
    file.queries = std::move(all);
    file.truth = std::move(truth);
    return file;
}

std::vector<std::uint64_t> bits_of(const query_file& file) {
    return std::visit(
        [](const auto& all) {
            std::vector<std::uint64_t> bits(24 * all.size());
            std::memcpy(bits.data(), all.data(), 8 * bits.size());
            return bits;
        },
        file.queries);
}

/// Any finite doubles; points of a mesh, shared, or all of their own.
template <class Query>
query_file random_queries(std::size_t n, bool shared, bool with_truth, unsigned seed) {
    std::mt19937_64 random(seed);
    const auto number = [&] {
        for (;;) {
            const auto x = std::bit_cast<double>(random());
            if (std::isfinite(x)) return random() % 8 == 0 ? std::copysign(0.0, x) : x;
        }
    };
    const auto point_of_now = [&] {
        moving_point<double> p;
        p.t0 = {number(), number(), number()};
        p.t1 = {number(), number(), number()};
        return p;
    };
    std::vector<moving_point<double>> mesh(1000);
    for (auto& p : mesh) p = point_of_now();
    const auto next = [&] { return shared ? mesh[random() % mesh.size()] : point_of_now(); };
    std::vector<Query> all;
    std::vector<bool> truth;
    for (std::size_t i = 0; i < n; ++i) {
        all.push_back({next(), next(), next(), next()});
        truth.push_back(random() % 2 == 0);
    }
    return file_of(std::move(all), with_truth ? std::optional(truth) : std::nullopt);
}

std::string packed(const query_file& file) {
    query_packer packer(file.kind(), file.truth.has_value());
    packer.add(file);
    return errbound::support::read_whole(packer.finish());
}

class Store : public testing::Test {
  protected:
    void SetUp() override {
        if (!has_query_stores()) GTEST_SKIP() << "built without HDF5";
    }
};

template <class Query>
void expect_same(std::size_t n, bool shared, bool with_truth) {
    const query_file file = random_queries<Query>(n, shared, with_truth, static_cast<unsigned>(n));
    const std::string bytes = packed(file);
    EXPECT_EQ(packed(file), bytes);
    const query_file again = parse_stored_queries(bytes, "s.h5", std::nullopt, false);
    EXPECT_EQ(again.kind(), file.kind());
    EXPECT_EQ(bits_of(again), bits_of(file));
    EXPECT_EQ(again.truth, file.truth);
}

TEST_F(Store, KeepsEveryBit) {
    for (const std::size_t n : {1, 2, 1000, 65536, 65537, 140000})
        for (const bool shared : {true, false}) {
            expect_same<vertex_face<double>>(n, shared, n % 2 == 0);
            expect_same<edge_edge<double>>(n, shared, n % 2 == 1);
        }
}

TEST_F(Store, IsTheSameHoweverQueriesCome) {
    // The first chunk's indices would fit in 16 bits, those of the second do not.
    const query_file few_points = random_queries<edge_edge<double>>(70000, true, true, 5);
    const query_file many_points = random_queries<edge_edge<double>>(65536, false, true, 6);
    query_packer whole(kind::edge_edge, true), parts(kind::edge_edge, true);
    std::vector<std::uint64_t> bits;
    std::vector<bool> truth;
    for (const query_file& file : {few_points, many_points}) {
        whole.add(file);
        const auto& all = std::get<1>(file.queries);
        for (std::size_t begin = 0, n = 1; begin < all.size(); begin += n, n = 3 * n % 1001 + 1) {
            const auto at = [begin, end = std::min(begin + n, all.size())](const auto& list) {
                using difference = std::iter_difference_t<decltype(list.begin())>;
                return std::vector(list.begin() + static_cast<difference>(begin),
                                   list.begin() + static_cast<difference>(end));
            };
            parts.add(file_of(at(all), at(*file.truth)));
        }
        for (const std::uint64_t b : bits_of(file)) bits.push_back(b);
        truth.insert(truth.end(), file.truth->begin(), file.truth->end());
    }
    EXPECT_EQ(parts.size(), truth.size());
    using errbound::support::read_whole;
    const std::string bytes = read_whole(whole.finish());
    EXPECT_EQ(read_whole(parts.finish()), bytes);
    const query_file again = parse_stored_queries(bytes, "s.h5", std::nullopt, false);
    EXPECT_EQ(bits_of(again), bits);
    EXPECT_EQ(again.truth, truth);
}

TEST_F(Store, LeavesNothingBehind) {
    std::filesystem::path made;
    {
        query_packer packer(kind::edge_edge, false);
        packer.add(random_queries<edge_edge<double>>(10, true, false, 1));
        made = packer.finish();
        EXPECT_TRUE(std::filesystem::exists(made));
    }
    EXPECT_FALSE(std::filesystem::exists(made));
}

TEST_F(Store, IsReadInRanges) {
    const temporary_directory folder;
    const query_file file = random_queries<edge_edge<double>>(70000, true, true, 7);
    const auto path = folder.path / "queries.h5";
    write(path, packed(file));
    for (const std::size_t size : {1000, 65536, 100000}) {
        const query_index index = index_queries(path, size);
        EXPECT_EQ(index.ranges.size(), (file.size() + size - 1) / size);
        range_reader reader(path, std::nullopt, false, index);
        std::vector<std::uint64_t> bits;
        std::vector<bool> truth;
        for (std::size_t i = 0; i < index.ranges.size(); ++i) {
            const query_file part = reader.read(i);
            for (const std::uint64_t b : bits_of(part)) bits.push_back(b);
            truth.insert(truth.end(), part.truth->begin(), part.truth->end());
        }
        EXPECT_EQ(bits, bits_of(file));
        EXPECT_EQ(truth, *file.truth);
    }
    EXPECT_EQ(bits_of(read_queries(path, kind::edge_edge, false)), bits_of(file));
    std::vector<std::uint64_t> bits;
    for (const file_range range :
         {file_range{0, 65000}, file_range{65000, 1000}, file_range{66000}})
        for (const std::uint64_t b : bits_of(read_queries(path, kind::edge_edge, false, range)))
            bits.push_back(b);
    EXPECT_EQ(bits, bits_of(file));
    EXPECT_NE(message_of([&] {
                  read_queries(path, kind::vertex_face, false);
              }).find("found queries of kind edge_edge, expected vertex_face"),
              std::string::npos);
}

TEST_F(Store, RefusesWhatItCannotHold) {
    const query_file one = random_queries<edge_edge<double>>(1, true, true, 1);
    query_packer of_faces(kind::vertex_face, true), without(kind::edge_edge, false);
    EXPECT_THROW(of_faces.add(one), std::invalid_argument);
    EXPECT_THROW(without.add(one), std::invalid_argument);
    EXPECT_THROW(without.finish(), std::runtime_error);
    query_file wrong = random_queries<edge_edge<double>>(1, true, false, 1);
    std::get<1>(wrong.queries)[0].b1.t1.z = std::numeric_limits<double>::infinity();
    EXPECT_THROW(without.add(wrong), std::invalid_argument);
}

/// Reads the same queries, or says what is wrong.
void expect_no_harm(const std::string& bytes, const query_file& file, const std::string& how) {
    try {
        const query_file again = parse_stored_queries(bytes, "s.h5", std::nullopt, false);
        EXPECT_EQ(again.kind(), file.kind()) << how;
        EXPECT_EQ(bits_of(again), bits_of(file)) << how;
        EXPECT_EQ(again.truth, file.truth) << how;
    } catch (const errbound::support::file_error& error) {
        EXPECT_EQ(std::string(error.what()).substr(0, 4), "s.h5") << how;
    }
}

TEST_F(Store, SaysWhatIsDamaged) {
    for (const auto& [n, with_truth] :
         {std::pair(3, true), {3, false}, {5000, true}, {5000, false}}) {
        const query_file file =
            random_queries<vertex_face<double>>(static_cast<std::size_t>(n), true, with_truth, 3);
        const std::string bytes = packed(file);
        const std::size_t stride = std::max<std::size_t>(1, bytes.size() / 2000);
        for (std::size_t i = 8; i < bytes.size(); i += stride)
            for (const unsigned flip : {0x01u, 0x80u, 0xffu}) {
                std::string damaged = bytes;
                damaged[i] = static_cast<char>(static_cast<unsigned char>(damaged[i]) ^ flip);
                expect_no_harm(damaged, file, "byte " + std::to_string(i));
            }
        // What sums modulo 65535, as HDF5's checksums are, do not tell apart.
        for (std::size_t i = 8, n_damaged = 0; i + 1 < bytes.size() && n_damaged < 2000; ++i) {
            const std::string word = bytes.substr(i, 2);
            if (word != std::string(2, '\0') && word != "\xff\xff") continue;
            std::string damaged = bytes;
            damaged[i] = damaged[i + 1] = word == "\xff\xff" ? '\0' : '\xff';
            expect_no_harm(damaged, file, "word at " + std::to_string(i));
            ++n_damaged;
        }
        for (std::size_t size = 8; size < bytes.size(); size += stride)
            expect_no_harm(bytes.substr(0, size), file, "first " + std::to_string(size));
    }
}

TEST_F(Store, IsOneOfItsKind) {
    EXPECT_NE(message_of([] {
                  parse_stored_queries("\x89HDF\r\n\x1a\nnothing", "s.h5", std::nullopt, false);
              }).find("s.h5: cannot be read"),
              std::string::npos);
}

}  // namespace
