// Batches of every kind compared with single queries; types of positions.
#include <gtest/gtest.h>

#include <ccd/batch.hpp>
#include <ccd/exact.hpp>
#include <limits>
#include <stdexcept>
#include <vector>

#include "tests/ccd/batch/random_batches.hpp"

namespace {

using ccd::outcome;
using random_batches::random_pairs;

/// Vertices on a small grid; two are not finite.
std::vector<ccd::point<double>> grid(std::uint64_t seed) {
    auto points = random_batches::grid(seed);
    points[7].y = std::numeric_limits<double>::infinity();
    points[11].x = std::numeric_limits<double>::quiet_NaN();
    return points;
}

template <class Pair>
class Batch : public testing::Test {};
using pair_types = testing::Types<ccd::vertex_face_pair, ccd::edge_edge_pair, ccd::vertex_edge_pair,
                                  ccd::vertex_vertex_pair>;
TYPED_TEST_SUITE(Batch, pair_types);

TYPED_TEST(Batch, AnswersAsOneByOne) {
    const auto before = grid(1), after = grid(2);
    const ccd::vertex_rows rows(before, after);
    for (const std::size_t count : {0U, 1U, 20U, 10000U}) {
        const auto pairs = random_pairs<TypeParam>(count);
        std::vector<ccd::query_of_pair<TypeParam>> queries;
        std::vector<outcome> contact, at_start;
        for (const TypeParam& pair : pairs) {
            queries.push_back(query_of(rows, pair));
            contact.push_back(decide_exact(queries.back()).outcome);
            at_start.push_back(touches_at_start(queries.back()).outcome);
        }
        for (const int threads : {0, 1, 3})
            for (const ccd::instruction_set set : ccd::instruction_sets()) {
                const ccd::batch_options options{.threads = threads, .set = set};
                EXPECT_EQ(ccd::decide_batch(rows, pairs, options).answers, contact);
                EXPECT_EQ(ccd::decide_batch(queries, options).answers, contact);
                EXPECT_EQ(ccd::touches_at_start_batch(queries, options).answers, at_start);
                EXPECT_EQ(ccd::touches_at_start_batch(rows, pairs, options).answers, at_start);
            }
    }
}

TEST(BatchOf, RefusesWrongArguments) {
    const std::vector<ccd::vertex_vertex_pair> pairs{{0, 1}}, beyond{{0, 2}};
    const std::vector<double> rows{0, 0, 0, 0, 0, 0};
    const ccd::vertex_rows at(rows.data(), rows.data(), 2);
    EXPECT_THROW(ccd::decide_batch(at, beyond), std::invalid_argument);
    std::vector<outcome> two(2);
    using span = std::span<const ccd::vertex_vertex_pair>;
    EXPECT_THROW(ccd::decide_batch(at, span(pairs), std::span(two)), std::invalid_argument);
    ccd::decide_batch(at, span(), std::span<outcome>());
    EXPECT_THROW(ccd::decide_batch(ccd::vertex_rows(nullptr, nullptr, 2), pairs),
                 std::invalid_argument);
    EXPECT_THROW(ccd::decide_batch(ccd::vertex_rows(rows.data(), nullptr, 2), pairs),
                 std::invalid_argument);
    const auto start =
        ccd::touches_at_start_batch(ccd::vertex_rows(rows.data(), nullptr, 2), pairs);
    EXPECT_EQ(start.answers[0], ccd::outcome::collides);
}

/// A matrix with the interface of Eigen's.
template <bool RowMajor>
struct matrix {
    static constexpr bool IsRowMajor = RowMajor;
    std::vector<double> numbers;
    std::ptrdiff_t columns = 3, stride = 3;

    const double* data() const { return numbers.data(); }
    std::ptrdiff_t rows() const { return static_cast<std::ptrdiff_t>(numbers.size()) / stride; }
    std::ptrdiff_t cols() const { return columns; }
    std::ptrdiff_t outerStride() const { return stride; }
    std::ptrdiff_t innerStride() const { return 1; }
};

TEST(VertexRows, AreOfMatricesWithRowsSideBySide) {
    const matrix<true> at_start{{0, 1, 2, 3, 4, 5}}, at_end{{6, 7, 8, 9, 10, 11}};
    const ccd::vertex_rows rows(at_start, at_end);
    ASSERT_EQ(rows.vertices, 2U);
    EXPECT_EQ(rows[1], (ccd::moving_point<double>{{3, 4, 5}, {9, 10, 11}}));
    const matrix<true> padded{{0, 1, 2, 0, 3, 4, 5, 0}, 3, 4}, wide{{0, 1, 2, 3}, 4, 4};
    EXPECT_THROW(ccd::vertex_rows(padded, padded), std::invalid_argument);
    EXPECT_THROW(ccd::vertex_rows(wide, wide), std::invalid_argument);
    EXPECT_THROW(ccd::vertex_rows(at_start, matrix<true>{{1, 2, 3}}), std::invalid_argument);
}

}  // namespace
