// Nearest features, points, distances and normals: made by hand, and compared with fractions.
#include <gtest/gtest.h>

#include <array>
#include <ccd/contact.hpp>
#include <ccd/nearness.hpp>
#include <ccd/plane.hpp>
#include <cmath>
#include <cstdint>
#include <string>

#include "tests/ccd/contact/by_hand.hpp"
#include "tests/support/nearness_faults.hpp"
#include "tests/support/query_families.hpp"
#include "tests/support/scaled.hpp"

namespace {

using ccd::kind;
using ccd::nearness;
using support::nearness_data::faults_of;
using namespace by_hand;

TEST(nearness_families, are_exact_at_all_times) {
    query_families::for_some_queries(
        support::scaled(200), 17, [](const auto& query, const std::string& text) {
            for (const double t : {0.0, 1.0, 0.375, 0x1.8p-40})
                EXPECT_EQ(faults_of(query, t, ccd::nearness_of(query, t)), "")
                    << text << "at " << t;
        });
}

}  // namespace
