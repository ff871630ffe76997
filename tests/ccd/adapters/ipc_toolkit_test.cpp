// `exact` as a narrow phase of ipc-toolkit, in cases made by hand, and compared with the oracle on
// all families of queries and distances. Uses only the interface.
#include <gtest/gtest.h>

#include <algorithm>
#include <ccd/adapters/ipc_toolkit.hpp>
#include <ccd/methods/transform.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "tests/ccd/adapters/adapter_faults.hpp"
#include "tests/support/distance_families.hpp"
#include "tests/support/query_families.hpp"
#include "tests/support/scaled.hpp"

namespace {

using ccd::adapters::exact_narrow_phase;
using query_families::points;

constexpr double least = std::numeric_limits<double>::denorm_min();

using support::across, support::at, support::infinity, support::never, support::onto_face,
    support::still;
using answer = support::answer<double>;

/// Positions in space, or in the plane, which only points and edges have.
template <class Query>
answer ask(const ipc::NarrowPhaseCCD& ccd, const Query& query, double d = 0, double tmax = 1,
           int dimensions = 3) {
    const auto points = ccd::points_of(query);
    const auto in_space = [](const ccd::point<double>& p) {
        return Eigen::Vector3d(p.x, p.y, p.z);
    };
    answer a{};
    const auto call = [&](auto function, auto... i) {
        return (ccd.*function)(in_space(points[i].t0)..., in_space(points[i].t1)..., a.toi, d,
                               tmax);
    };
    const auto call_in = [&](auto function, auto... i) {
        const auto in = [&](const auto& p) {
            return ipc::VectorMax3d(in_space(p).head(dimensions));
        };
        return (ccd.*function)(in(points[i].t0)..., in(points[i].t1)..., a.toi, d, tmax);
    };
    using phase = ipc::NarrowPhaseCCD;
    constexpr ccd::kind kind = ccd::kind_of<Query>;
    if constexpr (kind == ccd::kind::vertex_vertex)
        a.collides = call_in(&phase::point_point_ccd, 0u, 1u);
    else if constexpr (kind == ccd::kind::vertex_edge)
        a.collides = call_in(&phase::point_edge_ccd, 0u, 1u, 2u);
    else if constexpr (kind == ccd::kind::vertex_face)
        a.collides = call(&phase::point_triangle_ccd, 0u, 1u, 2u, 3u);
    else
        a.collides = call(&phase::edge_edge_ccd, 0u, 1u, 2u, 3u);
    return a;
}

const ccd::vertex_vertex<double> meeting{{{0, 0, 0}, {6, 8, 0}}, still({3, 4, 0})};
const ccd::vertex_edge<double> onto_edge{
    {{0.5, 1, 0}, {0.5, -3, 0}}, still({0, 0, 0}), still({1, 0, 0})};

TEST(narrow_phase, finds_first_contacts) {
    const exact_narrow_phase exact;
    EXPECT_EQ(ask(exact, onto_face), at(0.25));
    EXPECT_EQ(ask(exact, across), at(0.25));
    EXPECT_EQ(ask(exact, meeting), at(0.5));
    EXPECT_EQ(ask(exact, onto_edge), at(0.25));
}
TEST(narrow_phase, takes_the_defaults_of_the_interface) {
    const exact_narrow_phase exact;
    double toi = 2;
    const ipc::VectorMax3d p = Eigen::Vector2d(0, 0), q = Eigen::Vector2d(1, 0);
    EXPECT_TRUE(exact.point_point_ccd(p, q, q, p, toi));
    EXPECT_EQ(toi, 0.5);
}
TEST(narrow_phase, finds_no_contact_before_the_start_and_after_the_end) {
    const exact_narrow_phase exact;
    EXPECT_EQ(ask(exact, onto_face, 0, -1), never);
    EXPECT_EQ(ask(exact, onto_face, 0, infinity), at(0.25));
    const ccd::vertex_face<double> missed{still({2, 2, 1}), onto_face.f0, onto_face.f1,
                                          onto_face.f2};
    EXPECT_EQ(ask(exact, missed, 0, infinity), never);
}
TEST(narrow_phase, keeps_a_distance) {
    const exact_narrow_phase exact;
    EXPECT_EQ(ask(exact, onto_edge, 0.5, 0.125), at(0.125));
    EXPECT_EQ(ask(exact, onto_edge, 0.5, 0.1), never);
}
TEST(narrow_phase, returns_0_within_the_distance_at_the_start) {
    const exact_narrow_phase exact;
    EXPECT_EQ(ask(exact, onto_face, 1), at(0));
    EXPECT_EQ(ask(exact, onto_face, 1, 0), at(0));
    EXPECT_EQ(ask(exact, onto_face, 2), at(0));
    EXPECT_EQ(ask(exact, onto_face, std::nextafter(1.0, 0)), at(0x1p-55));
    const ccd::vertex_vertex<double> same{still({1, 2, 3}), still({1, 2, 3})};
    EXPECT_EQ(ask(exact, same), at(0));
    // At rest, or moving apart: the start counts.
    const ccd::vertex_vertex<double> leaving{{{1, 2, 3}, {1, 2, 4}}, still({1, 2, 3})};
    EXPECT_EQ(ask(exact, leaving), at(0));
}
TEST(narrow_phase, returns_0_without_a_double_between_start_and_contact) {
    const exact_narrow_phase exact;
    const ccd::vertex_vertex<double> fast{{{0x1p-1000, 0, 0}, {-0x1p1000, 0, 0}}, still({0, 0, 0})};
    EXPECT_EQ(ask(exact, fast), at(0));
    EXPECT_EQ(ask(exact, fast, 0, 0), never) << "at the start itself there is none";
    EXPECT_EQ(ask(exact, fast, 0, least), at(0));
    const ccd::vertex_vertex<double> at_least{still({0x1p-537, 0, 0}),
                                              {{0, 0, 0}, {0x1p537, 0, 0}}};
    EXPECT_EQ(ask(exact, at_least), at(least));
}
TEST(narrow_phase, returns_0_for_invalid_numbers) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const exact_narrow_phase exact;
    EXPECT_EQ(ask(exact, meeting, nan), at(0));
    EXPECT_EQ(ask(exact, meeting, -1), at(0));
    EXPECT_EQ(ask(exact, meeting, infinity), at(0));
    EXPECT_EQ(ask(exact, meeting, 0, nan), at(0));
    for (const double x : {nan, infinity}) {
        const ccd::vertex_vertex<double> query{still({x, 0, 0}), still({1, 1, 1})};
        EXPECT_EQ(ask(exact, query), at(0));
        EXPECT_EQ(ask(exact_narrow_phase(0.5), query, 0, 0.25), at(0));
    }
}
TEST(conservative_rescaling, is_1_unless_given) {
    EXPECT_EQ(exact_narrow_phase().conservative_rescaling, 1);
    EXPECT_EQ(exact_narrow_phase(0.8).conservative_rescaling, 0.8);
}
TEST(conservative_rescaling, keeps_a_fraction_of_the_distance_at_the_start) {
    exact_narrow_phase exact(0.5);
    EXPECT_EQ(ask(exact, onto_face), at(0.125));
    EXPECT_EQ(ask(exact, across), at(0.125));
    EXPECT_EQ(ask(exact, meeting), at(0.25));
    EXPECT_EQ(ask(exact, onto_edge), at(0.125));
    EXPECT_EQ(ask(exact, onto_face, 0.5), at(0.0625));
    EXPECT_EQ(ask(exact, onto_face, 0.5, 0.0625), at(0.0625));
    EXPECT_EQ(ask(exact, onto_face, 0.5, std::nextafter(0.0625, 0)), never);
    EXPECT_EQ(ask(exact, onto_face, 0, -1), never);
    exact.conservative_rescaling = 0.75;
    EXPECT_EQ(ask(exact, onto_face), at(0.1875));
}
// The point falls from 1 to -3. It keeps a quarter of its distance, or the cap if that is less.
TEST(max_gap, caps_the_gap_that_is_kept) {
    EXPECT_EQ(ask(exact_narrow_phase(0.75, 0.125), onto_face), at(0.21875));
    EXPECT_EQ(ask(exact_narrow_phase(0.75, 0.5), onto_face), at(0.1875));
    EXPECT_EQ(ask(exact_narrow_phase(0.75, 0.125), onto_face, 0.5), at(0.09375));
    EXPECT_EQ(ask(exact_narrow_phase(0.75, 0.125), onto_face, 0, std::nextafter(0.21875, 0)),
              never);
    EXPECT_EQ(ask(exact_narrow_phase(1, 0.125), onto_face), at(0.25));
    EXPECT_EQ(ask(exact_narrow_phase(0.75, least), onto_face), at(std::nextafter(0.25, 0)));
    exact_narrow_phase exact(0.75);
    exact.max_gap = 0.125;
    EXPECT_EQ(ask(exact, onto_face), at(0.21875));
}
// The point stops at a distance of 1 from the other, a quarter of the initial gap, 4.
TEST(max_gap, does_not_report_pairs_that_stay_above_it) {
    const ccd::vertex_vertex<double> nearer{{{0, 0, 0}, {3, 0, 0}}, still({4, 0, 0})};
    EXPECT_EQ(ask(exact_narrow_phase(0.75, 1), nearer), at(1));
    EXPECT_EQ(ask(exact_narrow_phase(0.75, 0.5), nearer), never);
}
TEST(conservative_rescaling, reports_pairs_that_get_nearer_without_contact) {
    const ccd::vertex_vertex<double> nearer{{{0, 0, 0}, {3, 0, 0}}, still({4, 0, 0})};
    EXPECT_EQ(ask(exact_narrow_phase(), nearer), never);
    EXPECT_EQ(ask(exact_narrow_phase(0.75), nearer), at(1));
    EXPECT_EQ(ask(exact_narrow_phase(0.875), nearer), never);
}
TEST(conservative_rescaling, returns_0_only_within_the_distance_at_the_start) {
    EXPECT_EQ(ask(exact_narrow_phase(0.5), onto_face, 1), at(0));
    EXPECT_EQ(ask(exact_narrow_phase(0.5), onto_face, 1, 0), at(0));
    EXPECT_EQ(ask(exact_narrow_phase(0.5), onto_face, 1, -1), never);
    // 0.9 of a gap of one last place rounds to the whole gap, and half of the least double to zero.
    const double below = std::nextafter(1.0, 0);
    EXPECT_EQ(ask(exact_narrow_phase(0x1p-60), onto_face, below), at(0x1p-115));
    const ccd::vertex_vertex<double> touching{still({1, 2, 3}), still({1, 2, 3})};
    EXPECT_EQ(ask(exact_narrow_phase(0.5), touching), at(0));
    const ccd::vertex_vertex<double> subnormal{{{least, 0, 0}, {-least, 0, 0}}, still({0, 0, 0})};
    EXPECT_EQ(ask(exact_narrow_phase(0.75), subnormal), at(0.375));
    EXPECT_EQ(ask(exact_narrow_phase(0.75), subnormal, 0, 0.375), at(0.375));
    EXPECT_EQ(ask(exact_narrow_phase(0.75), subnormal, 0, 0.374), never);
    const ccd::vertex_vertex<double> huge{{{0x1p1000, 0, 0}, {-0x1p1000, 0, 0}}, still({0, 0, 0})};
    EXPECT_EQ(ask(exact_narrow_phase(0.75), huge), at(0.375));
}

/// Expects the answers for several tmax that follow from the query's first time.
void expect_right_around(const exact_narrow_phase& exact, const auto& query, double d,
                         const std::string& text) {
    const ccd::first_time time = ccd::time_within(query, {d});
    const bool some = time.outcome == ccd::outcome::collides;
    for (const double tmax : {0.0, std::nextafter(time.low, -1.0), time.low, time.high,
                              std::nextafter(time.high, 2.0), 0.5}) {
        const bool until = some && (time.low == time.high ? tmax >= time.low : tmax > time.low);
        EXPECT_EQ(ask(exact, query, d, tmax), until ? at(time.low) : never) << tmax << " " << text;
    }
}

TEST(families, agree_with_the_oracle) {
    const exact_narrow_phase exact;
    std::size_t queries = 0, true_answers = 0;
    std::uint64_t seed = 0;
    query_families::for_some_queries(
        support::scaled(16U), 18, [&](const auto& query, const std::string& text) {
            query_families::source random(++seed);
            for (const double d : {0.0, support::some_distance(random, query)}) {
                for (const double tmax : {1.0, random.unit()}) {
                    const answer a = ask(exact, query, d, tmax);
                    EXPECT_EQ(support::answer_fault(query, {d}, a.collides, a.toi, tmax), "")
                        << "distance " << d << ", tmax " << tmax << ", " << text;
                    true_answers += a.collides;
                    ++queries;
                }
                expect_right_around(exact, query, d, text);
            }
        });
    std::printf("%zu answers, %zu true\n", queries, true_answers);
}

TEST(families, of_the_plane_are_those_of_the_plane_z_0) {
    const exact_narrow_phase exact;
    query_families::for_some_queries(
        support::scaled(16U), 18, [&]<class Query>(const Query& query, const std::string& text) {
            constexpr ccd::kind kind = ccd::kind_of<Query>;
            if constexpr (kind == ccd::kind::vertex_edge || kind == ccd::kind::vertex_vertex) {
                const auto flat = ccd::transformed_points(query, [](const ccd::point<double>& p) {
                    return ccd::point<double>{p.x, p.y, 0};
                });
                for (const double d : {0.0, 0.25})
                    EXPECT_EQ(ask(exact, query, d, 1, 2), ask(exact, flat, d)) << text;
            }
        });
}

double norm(const ccd::point<double>& p) {
    return std::hypot(p.x, p.y, p.z);
}

/// The fraction `part` of the initial gap above d, less the error of doubles; 0 if products of
/// coordinates overflow or underflow.
double gap_of(const auto& query, double part, double d) {
    points p{};
    std::ranges::copy(ccd::points_of(query), p.begin());
    double size = 0;
    for (const auto& m : p) size = std::max({size, norm(m.t0), norm(m.t1)});
    if (size > 0x1p100 || size < 0x1p-100 || d > 0x1p100) return 0;
    const auto which = ccd::kind_of<std::remove_cvref_t<decltype(query)>>;
    const double start = double(distance_families::detail::distance_at(which, p, 0));
    const double computed = ccd::adapters::detail::start_distance(query);
    if (computed > (1 + 0x1p-20) * start ||
        oracle::within(query, (1 - 0x1p-20) * start, 0, oracle::shortcuts::on,
                       oracle::interval::instant(0)))
        return 0;
    return std::max((1 - 0x1p-20) * part * (start - d) - 0x1p-40 * size, 0.0);
}

TEST(families, keep_a_fraction_of_their_distance_at_the_start) {
    std::uint64_t seed = 0;
    std::size_t kept = 0;
    query_families::for_some_queries(
        support::scaled(8U), 19, [&](const auto& query, const std::string& text) {
            query_families::source random(++seed);
            const double scale = random.one_in(2) ? 0.8 : 1 - 0.999 * random.unit();
            for (const double d : {0.0, support::some_distance(random, query)}) {
                const double cap = random.one_in(2) ? infinity : std::ldexp(random.unit(), -8);
                const answer full = ask(exact_narrow_phase(), query, d);
                const answer a = ask(exact_narrow_phase(scale, cap), query, d);
                EXPECT_TRUE(a.collides || !full.collides) << text;
                EXPECT_LE(a.toi, full.toi) << text;
                EXPECT_TRUE(a.toi > 0 || full.toi == 0) << text;
                const double gap = std::min(gap_of(query, 1 - scale, d), cap);
                const oracle::interval before{.high = std::min(a.toi, 1.0),
                                              .with_high = !a.collides};
                if (gap == 0 || before.high == 0) continue;
                EXPECT_FALSE(oracle::within(query, d, gap, oracle::shortcuts::on, before))
                    << scale << ", " << d << ", " << text;
                ++kept;
            }
        });
    std::printf("%zu gaps kept\n", kept);
    EXPECT_GT(kept, support::scaled(2000U));
}

/// Computes a step's length like the toolkit: each pair gets the least time so far as tmax.
double step_length(const std::vector<ccd::vertex_face<double>>& queries,
                   const ipc::NarrowPhaseCCD& ccd) {
    double length = 1;
    for (const auto& query : queries) {
        const answer a = ask(ccd, query, 0, length);
        if (a.collides) length = std::min(length, a.toi);
    }
    return length;
}

TEST(families, have_a_least_time_that_does_not_depend_on_their_order) {
    query_families::source random(20);
    for (int i = 0; i < support::scaled(300); ++i) {
        std::vector<ccd::vertex_face<double>> queries;
        double first = 1;
        for (int j = 0; j < 6; ++j) {
            const auto family = static_cast<std::size_t>(
                random.between(0, static_cast<int>(std::size(query_families::families)) - 1));
            const points p = query_families::make(query_families::families[family],
                                                  ccd::kind::vertex_face, 20, random.bits());
            queries.push_back({p[0], p[1], p[2], p[3]});
            const answer a = ask(exact_narrow_phase(), queries.back());
            if (a.collides) first = std::min(first, a.toi);
        }
        for (const double scale : {1.0, 0.8, random.unit() / 2 + 0.5}) {
            const exact_narrow_phase exact(scale);
            const double length = step_length(queries, exact);
            std::ranges::reverse(queries);
            EXPECT_EQ(step_length(queries, exact), length);
            EXPECT_LE(length, first);
        }
    }
}

}  // namespace
