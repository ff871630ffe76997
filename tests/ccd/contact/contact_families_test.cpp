// Contact data of random, degenerate and badly scaled queries, compared with those of their images.
// (The soak test compares them with rationals.)
#include <gtest/gtest.h>

#include <array>
#include <ccd/contact.hpp>
#include <ccd/methods/transform.hpp>
#include <cmath>
#include <cstddef>
#include <string>

#include "tests/support/query_families.hpp"
#include "tests/support/scaled.hpp"

namespace {

using ccd::first_contact;
using point = ccd::point<double>;

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
    const point n = turned(found.normal), m = image.normal;
    const double normal_error = found.normal_error + image.normal_error;
    if (std::hypot(n.x - m.x, n.y - m.y, n.z - m.z) > normal_error + 1e-18) return "normal";
    return std::abs(found.normal_velocity - image.normal_velocity) >
                   (found.normal_velocity_error + image.normal_velocity_error) * (1 + 1e-15)
               ? "velocity"
               : "";
}

/// Calls expect(query, found, text) for queries that collide and their contacts.
template <class Expect>
void for_some_contacts(const Expect& expect) {
    query_families::for_some_queries(support::scaled(30), 11,
                                     [&](const auto& query, const std::string& text) {
                                         const first_contact found = ccd::find_first_contact(query);
                                         EXPECT_EQ(found.time, ccd::time_of_impact(query)) << text;
                                         if (found.time.outcome == ccd::outcome::collides)
                                             expect(query, found, text);
                                     });
}

TEST(contact_families, of_turned_and_mirrored_queries_are_turned_and_mirrored) {
    constexpr std::array<std::size_t, 4> same{0, 1, 2, 3};
    for_some_contacts([&](const auto& query, const auto& found, const std::string& text) {
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
    for_some_contacts([]<class Query>(const Query& query, const auto& found, const auto& text) {
        const auto expect = [&](const Query& image, std::array<std::size_t, 4> of_point, int sign) {
            const auto turned = [sign](const point& p) {
                return point{sign * p.x, sign * p.y, sign * p.z};
            };
            EXPECT_EQ(image_faults(found, ccd::find_first_contact(image), of_point, turned), "")
                << text;
        };
        if constexpr (ccd::kind_of<Query> == ccd::kind::vertex_face)
            expect({query.v, query.f1, query.f2, query.f0}, {0, 2, 3, 1}, 1);
        else if constexpr (ccd::kind_of<Query> == ccd::kind::edge_edge)
            expect({query.b0, query.b1, query.a0, query.a1}, {2, 3, 0, 1}, -1);
    });
}

}  // namespace
