// Contact data of random, degenerate and badly scaled queries, compared with rationals.
#include <gtest/gtest.h>

#include <array>
#include <ccd/contact.hpp>
#include <ccd/methods/transform.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <map>
#include <string>
#include <type_traits>

#include "tests/support/contact_data_faults.hpp"
#include "tests/support/query_families.hpp"
#include "tests/support/scaled.hpp"

namespace {

using ccd::first_contact;
using query_families::families;
using query_families::kind;
using query_families::points;

TEST(contact_families, agree_with_rationals) {
    std::map<ccd::normal_source, std::size_t> sources;
    std::size_t contacts = 0, poor = 0;
    query_families::for_some_queries(
        support::scaled(60), 11, [&](const auto& query, const std::string& text) {
            const first_contact found = ccd::find_first_contact(query);
            EXPECT_EQ(found.time, ccd::time_of_impact(query));
            if (found.time.outcome != ccd::outcome::collides) return;
            ++contacts;
            ++sources[found.normal_from];
            poor += found.weight_error > 1e-12;
            EXPECT_EQ(support::contact_data::check(query, found).faults(), "") << text;
        });
    std::printf(
        "%zu contacts, %zu with weights off by more than 1e-12; normals: cross product %zu, "
        "nearest points %zu, relative velocity %zu, none %zu\n",
        contacts, poor, sources[ccd::normal_source::cross_product],
        sources[ccd::normal_source::nearest_points], sources[ccd::normal_source::relative_velocity],
        sources[ccd::normal_source::none]);
}

/// Compares the contact of a query's image with the query's contact; returns the difference, or "".
/// Point i of the image is point of_point[i] of the query, and vectors are `turned`. Returns "" if
/// other features of the same size meet, since they are not comparable.
template <class Turn>
std::string image_faults(const first_contact& found, const first_contact& image,
                         std::array<std::size_t, 4> of_point, const Turn& turned) {
    if (image.time != found.time) return "time";
    if (image.features.kind != found.features.kind) return "kind of the features";
    std::array<bool, 4> takes_part{};
    for (std::size_t i = 0; i < 4; ++i) takes_part[of_point[i]] = image.weights[i] > 0;
    for (std::size_t i = 0; i < 4; ++i)
        if (takes_part[i] != (found.weights[i] > 0)) return "";
    const double weight_error = found.weight_error + image.weight_error;
    for (std::size_t i = 0; i < 4; ++i)
        if (std::abs(image.weights[i] - found.weights[of_point[i]]) > weight_error)
            return "weights";
    if (image.normal_from != found.normal_from || image.sided != found.sided) {
        const auto is_poor = [](const first_contact& c) { return c.normal_error > 0.01; };
        return is_poor(found) || is_poor(image) ? "" : "source of the normal";
    }
    const ccd::point<double> n = turned(found.normal), m = image.normal;
    const double normal_error = found.normal_error + image.normal_error;
    if (std::hypot(n.x - m.x, n.y - m.y, n.z - m.z) > normal_error + 1e-18) return "normal";
    return std::abs(found.normal_velocity - image.normal_velocity) >
                   (found.normal_velocity_error + image.normal_velocity_error) * (1 + 1e-15)
               ? "velocity"
               : "";
}

TEST(contact_families, of_turned_and_mirrored_queries_are_turned_and_mirrored) {
    using point = ccd::point<double>;
    constexpr std::array<std::size_t, 4> same{0, 1, 2, 3};
    query_families::for_some_queries(
        support::scaled(30), 11, [&](const auto& query, const std::string& text) {
            const first_contact found = ccd::find_first_contact(query);
            if (found.time.outcome != ccd::outcome::collides) return;
            const auto turn = [](const point& p) { return point{p.y, p.z, p.x}; };
            const auto turned = ccd::transformed_points(query, turn);
            EXPECT_EQ(image_faults(found, ccd::find_first_contact(turned), same, turn), "") << text;
            const auto mirrored = ccd::transformed_points(query, [](const point& p) {
                return point{-p.x, p.y, p.z};
            });
            // A cross product without a side changes its direction when mirrored.
            const double sign =
                found.normal_from == ccd::normal_source::cross_product && !found.sided ? -1 : 1;
            const auto mirror = [sign](const point& p) {
                return point{-sign * p.x, sign * p.y, sign * p.z};
            };
            first_contact image = ccd::find_first_contact(mirrored);
            image.normal_velocity *= sign;
            EXPECT_EQ(image_faults(found, image, same, mirror), "") << text;
        });
}

TEST(contact_families, do_not_depend_on_the_order_of_points) {
    using point = ccd::point<double>;
    query_families::for_some_queries(
        support::scaled(30), 11, [&](const auto& query, const std::string& text) {
            using query_type = std::remove_cvref_t<decltype(query)>;
            const first_contact found = ccd::find_first_contact(query);
            if (found.time.outcome != ccd::outcome::collides) return;
            if constexpr (ccd::kind_of<query_type> == kind::vertex_face) {
                const query_type turned{query.v, query.f1, query.f2, query.f0};
                EXPECT_EQ(image_faults(found, ccd::find_first_contact(turned), {0, 2, 3, 1},
                                       [](const point& p) { return p; }),
                          "")
                    << text;
            } else if constexpr (ccd::kind_of<query_type> == kind::edge_edge) {
                const query_type swapped{query.b0, query.b1, query.a0, query.a1};
                EXPECT_EQ(image_faults(found, ccd::find_first_contact(swapped), {2, 3, 0, 1},
                                       [](const point& p) {
                                           return point{-p.x, -p.y, -p.z};
                                       }),
                          "")
                    << text;
            }
        });
}

}  // namespace
