// Contact data of batches compared with single queries.
#include <gtest/gtest.h>

#include <ccd/contact.hpp>
#include <cstddef>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using ccd::first_contact;
using positions = std::vector<ccd::point<double>>;

positions random_positions(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    positions all(40);
    for (auto& p : all)
        for (const auto axis :
             {&ccd::point<double>::x, &ccd::point<double>::y, &ccd::point<double>::z})
            p.*axis = static_cast<double>(random() % 7);
    return all;
}

TEST(first_contacts, are_those_of_one_by_one) {
    const positions before = random_positions(1), after = random_positions(2);
    const ccd::vertex_rows rows(before, after);
    std::vector<ccd::vertex_face_pair> pairs;
    std::vector<ccd::vertex_face<double>> queries;
    std::mt19937_64 random(3);
    const auto vertex = [&] { return static_cast<ccd::vertex_index>(random() % before.size()); };
    for (int i = 0; i < 500; ++i) {
        pairs.push_back({vertex(), vertex(), vertex(), vertex()});
        queries.push_back(query_of(rows, pairs.back()));
    }
    const auto times = ccd::first_times(rows, pairs);
    std::size_t contacts = 0;
    for (const int threads : {0, 1, 2}) {
        const auto by_index = ccd::first_contacts(rows, pairs, times, threads);
        const auto stored = ccd::first_contacts(queries, times, threads);
        ASSERT_EQ(by_index.size(), pairs.size());
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const first_contact expected = ccd::find_first_contact(queries[i]);
            EXPECT_EQ(by_index[i], expected);
            EXPECT_EQ(stored[i], expected);
            contacts += expected.time.outcome == ccd::outcome::collides;
        }
    }
    EXPECT_GT(contacts, 30);
}

TEST(first_contacts, refuse_times_of_other_queries) {
    const positions still = random_positions(1);
    const ccd::vertex_rows rows(still, still);
    const auto message = [&](const std::vector<ccd::edge_edge_pair>& pairs) {
        try {
            ccd::first_contacts(rows, pairs, std::vector<ccd::first_time>(1));
        } catch (const std::invalid_argument& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(message({{0, 1, 2, 3}, {4, 5, 6, 7}}), "ccd::first_contacts: 2 queries, but 1 times");
    EXPECT_EQ(message({{0, 1, 2, 40}}), "ccd::first_contacts: query 0 names vertex 40 of 40");
}

}  // namespace
