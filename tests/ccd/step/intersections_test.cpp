// Intersections of meshes at rest, compared with the relation of every two elements.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <ccd/advance.hpp>
#include <ccd/intersections.hpp>
#include <ccd/io/mesh_file.hpp>
#include <ccd/step.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <errbound/simplices/relation.hpp>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "ccd/step/search_kernels.hpp"
#include "tests/support/files.hpp"

namespace {

using ccd::edge;
using ccd::face;
using ccd::intersection_options;
using ccd::vertex_index;
using errbound::relation;

using vertex_set = std::set<vertex_index>;
struct element {
    ccd::mesh_element reported;
    vertex_set vertices;
};
template <std::size_t N>
element element_of(std::array<vertex_index, N> v) {
    std::ranges::sort(v);
    element e{{N, {}}, {v.begin(), v.end()}};
    std::ranges::copy(v, e.reported.indices.begin());
    return e;
}

/// The definition in ccd/intersections.hpp, without a search.
struct all_elements {
    std::vector<element> elements, edges, faces;

    explicit all_elements(const ccd::mesh& mesh, bool skip_unused) {
        std::set<ccd::mesh_element> seen;
        vertex_set on_element, in_list;
        const auto add = [&](const element& e, std::vector<element>& to) {
            if (seen.insert(e.reported).second) to.push_back(e);
            on_element.insert(e.vertices.begin(), e.vertices.end());
        };
        for (const face& f : mesh.faces) add(element_of(f), faces);
        elements = faces;
        for (const face& f : mesh.faces)
            for (std::size_t k = 0; k < 3; ++k)
                if (f[k] != f[(k + 1) % 3]) add(element_of(edge{f[k], f[(k + 1) % 3]}), edges);
        for (const edge& e : mesh.edges) {
            in_list.insert(e.begin(), e.end());
            if (e[0] == e[1]) continue;
            const std::size_t before = edges.size();
            add(element_of(e), edges);
            if (edges.size() > before) elements.push_back(edges.back());
        }
        for (vertex_index v = 0; v < mesh.vertices.size(); ++v)
            if (!on_element.contains(v) && !(skip_unused && !in_list.contains(v)))
                elements.push_back(element_of(std::array{v}));
    }
};

template <std::size_t D, std::size_t K>
std::array<std::array<double, D>, K> points_of(const ccd::mesh& mesh,
                                               const std::vector<vertex_index>& order) {
    std::array<std::array<double, D>, K> points{};
    for (std::size_t i = 0; i < K; ++i) {
        const auto& p = mesh.vertices[order[i]];
        points[i][0] = p.x, points[i][1] = p.y;
        if constexpr (D == 3) points[i][2] = p.z;
    }
    return points;
}

template <std::size_t D>
relation relation_of(const ccd::mesh& mesh, const vertex_set& a, const vertex_set& b) {
    std::vector<vertex_index> common, x, y;
    std::ranges::set_intersection(a, b, std::back_inserter(common));
    if (common.size() == std::min(a.size(), b.size())) return relation::disjoint;
    x = y = common;
    std::ranges::set_difference(a, b, std::back_inserter(x));
    std::ranges::set_difference(b, a, std::back_inserter(y));
    const auto with_sizes = [&]<std::size_t K, std::size_t L>() {
        return errbound::relation_of(points_of<D, K>(mesh, x), points_of<D, L>(mesh, y),
                                     common.size());
    };
    const auto with_size = [&]<std::size_t K>() {
        return y.size() == 1   ? with_sizes.template operator()<K, 1>()
               : y.size() == 2 ? with_sizes.template operator()<K, 2>()
                               : with_sizes.template operator()<K, 3>();
    };
    return x.size() == 1   ? with_size.template operator()<1>()
           : x.size() == 2 ? with_size.template operator()<2>()
                           : with_size.template operator()<3>();
}

bool may_meet(const ccd::mesh& mesh, const ccd::pair_filter& filter, const vertex_set& a,
              const vertex_set& b) {
    const auto may_collide = [&](vertex_index v, vertex_index w) {
        if (!filter.pinned.empty() && filter.pinned[v] && filter.pinned[w]) return false;
        if (!filter.groups.empty() &&
            (filter.groups[v] == filter.groups[w]) !=
                (filter.rule == ccd::pair_filter::group_rule::within_groups))
            return false;
        return !filter.can_collide || filter.can_collide(v, w);
    };
    bool may = false;
    for (const vertex_index v : a)
        for (const vertex_index w : b) may |= v != w && may_collide(v, w);
    if (!may || !filter.region) return may;
    const auto low = [&](const vertex_set& s, double ccd::point<double>::*x) {
        double least = std::numeric_limits<double>::infinity();
        for (const vertex_index v : s) least = std::min(least, mesh.vertices[v].*x);
        return least;
    };
    const auto corner = [&](double ccd::point<double>::*x) {
        return std::max(low(a, x), low(b, x));
    };
    using point = ccd::point<double>;
    return filter.region->has({corner(&point::x), corner(&point::y), corner(&point::z)});
}

using found_pairs =
    std::vector<std::tuple<ccd::intersection_kind, ccd::mesh_element, ccd::mesh_element, relation>>;

found_pairs listed(const std::vector<ccd::intersection>& pairs) {
    found_pairs list;
    for (const auto& pair : pairs) list.push_back({pair.kind(), pair.a, pair.b, pair.relation});
    return list;
}

template <std::size_t D = 3>
found_pairs expected_pairs(const ccd::mesh& mesh, const ccd::pair_filter& filter = {}) {
    const all_elements all(mesh, filter.skip_unused);
    found_pairs list;
    for (std::size_t i = 0; i < all.elements.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const element *a = &all.elements[i], *b = &all.elements[j];
            if (!may_meet(mesh, filter, a->vertices, b->vertices)) continue;
            const relation r = relation_of<D>(mesh, a->vertices, b->vertices);
            if (r == relation::disjoint) continue;
            if (std::tuple(b->reported.size, b->reported.indices) <
                std::tuple(a->reported.size, a->reported.indices))
                std::swap(a, b);
            list.push_back({ccd::intersection{a->reported, b->reported, r}.kind(), a->reported,
                            b->reported, r});
        }
    std::ranges::sort(list);
    return list;
}

std::vector<ccd::edge_face_pair> expected_edge_faces(const ccd::mesh& mesh,
                                                     const ccd::pair_filter& filter) {
    const all_elements all(mesh, filter.skip_unused);
    std::vector<ccd::edge_face_pair> list;
    for (const element& e : all.edges)
        for (const element& f : all.faces) {
            vertex_set both = e.vertices;
            both.insert(f.vertices.begin(), f.vertices.end());
            if (both.size() == e.vertices.size() + f.vertices.size() &&
                may_meet(mesh, filter, e.vertices, f.vertices) &&
                relation_of<3>(mesh, e.vertices, f.vertices) != relation::disjoint)
                list.push_back(
                    {{e.reported.indices[0], e.reported.indices[1]}, f.reported.indices});
        }
    std::ranges::sort(list);
    return list;
}

class mesh_maker {
  public:
    explicit mesh_maker(std::uint64_t seed) : random(seed) {}

    std::mt19937_64 random;

    std::size_t below(std::size_t n) { return random() % n; }
    vertex_index index(std::size_t n) { return static_cast<vertex_index>(below(n)); }
    double on_grid(std::size_t side) { return static_cast<double>(below(side)); }
    double between(double low, double high) {
        return std::uniform_real_distribution(low, high)(random);
    }

    /// Faces, rods, points and repeated indices of few vertices on a grid.
    ccd::mesh soup(bool flat) {
        const std::size_t side = 2 + below(5), n = 4 + below(12);
        ccd::mesh mesh;
        for (std::size_t i = 0; i < n; ++i)
            mesh.vertices.push_back({on_grid(side), on_grid(side), flat ? 0 : on_grid(side)});
        if (!flat)
            for (std::size_t i = below(12); i > 0; --i)
                mesh.faces.push_back({index(n), index(n), index(n)});
        for (std::size_t i = below(flat ? 12 : 5); i > 0; --i)
            mesh.edges.push_back({index(n), index(n)});
        return mesh;
    }
    /// A sheet with folds. Its fans are closed and, at the border, open.
    ccd::mesh sheet() {
        const std::size_t side = 3 + below(4);
        const double noise = below(2) ? 0 : between(0, 1.2), height = between(0, 1.5);
        const bool whole = below(3) == 0;
        ccd::mesh mesh;
        for (std::size_t y = 0; y < side; ++y)
            for (std::size_t x = 0; x < side; ++x) {
                ccd::point<double> p{double(x) + between(-noise, noise),
                                     double(y) + between(-noise, noise), between(0, height)};
                if (whole) p = {std::round(p.x), std::round(p.y), std::round(p.z)};
                mesh.vertices.push_back(p);
                if (x == 0 || y == 0) continue;
                const auto v = static_cast<vertex_index>(y * side + x), s = vertex_index(side);
                mesh.faces.push_back({v - s - 1, v - s, v});
                mesh.faces.push_back({v - s - 1, v, v - 1});
                if (below(12) == 0) std::swap(mesh.faces.back()[0], mesh.faces.back()[1]);
                if (below(12) == 0) mesh.faces.pop_back();
            }
        turn(mesh);
        return mesh;
    }
    /// Faces around one vertex, which may turn more than once or overlap.
    ccd::mesh fan() {
        const std::size_t n = 2 + below(9);
        const bool closed = below(2);
        const double angle = between(0.5, 14), radius = between(0.1, 2);
        ccd::mesh mesh;
        mesh.vertices.push_back({0, 0, between(-1, 1)});
        for (std::size_t i = 0; i <= n; ++i) {
            const double turn = below(2) ? angle : 2 * 3.14159265358979 * double(n) / double(n + 1);
            const double phi = turn * double(i) / double(n) + between(-0.2, 0.2);
            mesh.vertices.push_back({radius * std::cos(phi), radius * std::sin(phi), 0});
            if (below(3) == 0) mesh.vertices.back() = {on_grid(3) - 1, on_grid(3) - 1, on_grid(2)};
            if (i > 0) mesh.faces.push_back({0, vertex_index(i), vertex_index(i + 1)});
        }
        if (closed) mesh.faces.push_back({vertex_index(n + 1), 1, 0});
        turn(mesh);
        return mesh;
    }

    /// Two sheets in one plane, perhaps with vertices at the same positions.
    ccd::mesh coplanar_sheets() {
        ccd::mesh mesh;
        for (const double z : {0., below(8) ? 0. : 1.}) {
            const std::size_t side = 2 + below(3);
            const auto first = static_cast<vertex_index>(mesh.vertices.size());
            const double size = below(2) ? 1 : between(0.3, 2),
                         shift = below(2) ? 0 : between(0, 1);
            const bool bent = below(3) == 0;
            for (std::size_t y = 0; y < side; ++y)
                for (std::size_t x = 0; x < side; ++x)
                    mesh.vertices.push_back(
                        {size * double(x) + shift, size * double(bent ? x * x + y : y) + shift, z});
            for (std::size_t y = 1; y < side; ++y)
                for (std::size_t x = 1; x < side; ++x) {
                    const auto v = static_cast<vertex_index>(first + y * side + x),
                               s = vertex_index(side);
                    mesh.faces.push_back({v - s - 1, v - s, v});
                    mesh.faces.push_back({v - 1, v - s - 1, v});
                }
        }
        turn(mesh);
        return mesh;
    }

  private:
    void turn(ccd::mesh& mesh) {
        const auto turns = below(3);
        for (auto& p : mesh.vertices)
            for (std::size_t i = 0; i < turns; ++i) p = {p.z, p.x, p.y};
    }
};

ccd::mesh any_mesh(std::uint64_t seed) {
    mesh_maker maker(seed);
    ccd::mesh mesh = seed % 7 == 0   ? maker.coplanar_sheets()
                     : seed % 3 == 0 ? maker.soup(false)
                     : seed % 3 == 1 ? maker.sheet()
                                     : maker.fan();
    if (seed % 5 == 0)  // rods and points among the faces
        for (std::size_t i = 0; i < 4; ++i) {
            const std::size_t n = mesh.vertices.size();
            mesh.edges.push_back({maker.index(n), maker.index(n)});
            mesh.vertices.push_back(maker.below(2) ? mesh.vertices[maker.index(n)]
                                                   : ccd::point<double>{0.5, 0.5, 0.25});
        }
    if (seed % 11 == 0) {  // a sheet so far away that floats do not separate its elements
        const auto first = static_cast<vertex_index>(mesh.vertices.size());
        const ccd::mesh far = maker.sheet();
        for (const auto& p : far.vertices) mesh.vertices.push_back({p.x + 0x1p40, p.y, p.z});
        for (const face& f : far.faces)
            mesh.faces.push_back({f[0] + first, f[1] + first, f[2] + first});
    }
    constexpr double scales[] = {1, 1, 1, 0x1p-500, 0x1p500, 0x1p-1060};
    const double scale = scales[seed % 6];
    for (auto& p : mesh.vertices) p = {p.x * scale, p.y * scale, p.z * scale};
    return mesh;
}

TEST(Intersections, AreThoseOfEveryTwoElements) {
    std::map<std::pair<ccd::intersection_kind, relation>, std::size_t> numbers;
    std::size_t free = 0;
    for (std::uint64_t seed = 1; seed <= 10'000; ++seed) {
        const ccd::mesh mesh = any_mesh(seed);
        const found_pairs expected = expected_pairs(mesh);
        const auto found = ccd::intersections(mesh, {.edge_faces = true, .threads = 1});
        ASSERT_EQ(listed(found.pairs), expected) << seed;
        ASSERT_EQ(found.edge_faces, expected_edge_faces(mesh, {})) << seed;
        ASSERT_EQ(found.counts.total(), expected.size());
        const auto set = ccd::instruction_sets()[seed % ccd::instruction_sets().size()];
        ASSERT_EQ(listed(ccd::intersections(mesh, {.threads = 1, .set = set}).pairs), expected)
            << seed << ' ' << name(set);
        ASSERT_EQ(ccd::is_free_of_intersections(mesh), expected.empty()) << seed;
        free += expected.empty();
        for (const auto& [kind, a, b, r] : expected) ++numbers[{kind, r}];
    }
    EXPECT_GT(free, 1500U);
    for (const auto k :
         {ccd::intersection_kind::face_face, ccd::intersection_kind::edge_face,
          ccd::intersection_kind::vertex_face, ccd::intersection_kind::edge_edge,
          ccd::intersection_kind::vertex_edge, ccd::intersection_kind::vertex_vertex})
        EXPECT_GT((numbers[{k, relation::touching}]), 50U) << name(k);
    EXPECT_GT((numbers[{ccd::intersection_kind::face_face, relation::overlapping}]), 1000U);
    EXPECT_GT((numbers[{ccd::intersection_kind::face_face, relation::crossing}]), 1000U);
    EXPECT_GT((numbers[{ccd::intersection_kind::edge_face, relation::crossing}]), 100U);
    EXPECT_GT((numbers[{ccd::intersection_kind::edge_edge, relation::overlapping}]), 10U);
}

/// Two triangles on a grid or in any position, some almost or exactly in one plane, of any size.
std::array<ccd::point<double>, 6> two_triangles(std::uint64_t seed) {
    mesh_maker maker(seed);
    std::array<ccd::point<double>, 6> p;
    const std::size_t side = 2 + maker.below(8);
    const bool on_grid = maker.below(2), flat = maker.below(4) == 0;
    for (auto& x : p) {
        x = {maker.on_grid(side), maker.on_grid(side), maker.on_grid(side)};
        if (!on_grid) x = {maker.between(-1, 1), maker.between(-1, 1), maker.between(-1, 1)};
        if (flat) x.z = x.x + 2 * x.y;
    }
    if (maker.below(4) == 0) {
        auto& x = p[maker.below(6)].z;
        x = std::nextafter(x, maker.between(-8, 8));
    }
    constexpr int exponents[] = {0, 0, 0, -300, 199, 201, 600, -1074};
    const int exponent = exponents[maker.below(std::size(exponents))];
    for (auto& x : p)
        x = {std::ldexp(x.x, exponent), std::ldexp(x.y, exponent), std::ldexp(x.z, exponent)};
    return p;
}

TEST(Intersections, HaveAFilterThatIsNeverWrong) {
    constexpr std::size_t pairs = 200'000;
    std::vector<double> positions;
    std::vector<vertex_index> elements;
    std::vector<ccd::detail::element_pair> queries;
    std::vector<relation> right;
    for (std::size_t i = 0; i < pairs; ++i) {
        ccd::mesh mesh;
        for (const auto& p : two_triangles(i)) {
            elements.push_back(static_cast<vertex_index>(positions.size() / 3));
            positions.insert(positions.end(), {p.x, p.y, p.z});
            mesh.vertices.push_back(p);
        }
        queries.push_back({static_cast<unsigned>(2 * i), static_cast<unsigned>(2 * i + 1)});
        right.push_back(relation_of<3>(mesh, {0, 1, 2}, {3, 4, 5}));
    }
    for (const auto set : ccd::instruction_sets()) {
        std::vector<errbound::sign_type> signs(pairs);
        ccd::detail::search_kernels_for(set).triangle_signs(positions.data(), elements.data(),
                                                            queries.data(), pairs, signs.data());
        std::size_t disjoint = 0, crossing = 0;
        for (std::size_t i = 0; i < pairs; ++i) {
            if (!certain(signs[i])) continue;
            ++(signs[i] == errbound::sign_type::negative ? disjoint : crossing);
            ASSERT_EQ(right[i], signs[i] == errbound::sign_type::negative ? relation::disjoint
                                                                          : relation::crossing)
                << i << ' ' << name(set);
        }
        EXPECT_GT(disjoint, pairs / 6);
        EXPECT_GT(crossing, pairs / 50);
    }
}

TEST(Intersections, InThePlane) {
    std::size_t crossing = 0;
    for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
        const ccd::mesh mesh = mesh_maker(seed).soup(true);
        auto steps = ccd::mesh_steps::in_plane(mesh.edges, mesh.vertices.size());
        const found_pairs expected = expected_pairs<2>(mesh);
        const auto found = steps.intersections({mesh, mesh});
        ASSERT_EQ(listed(found.pairs), expected) << seed;
        for (const ccd::intersection& pair : found.pairs) {
            crossing += pair.relation == relation::crossing;
            ASSERT_EQ(pair.segment.has_value(), pair.relation == relation::crossing);
        }
        ccd::step_options options;
        options.check_start = true;
        ASSERT_EQ(listed(steps.run({mesh, mesh}, options).intersections_at_start), expected);
    }
    EXPECT_GT(crossing, 1000U);
}

TEST(Intersections, FollowTheFilter) {
    for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
        const ccd::mesh mesh = any_mesh(seed);
        std::mt19937_64 random(seed);
        std::vector<int> groups(mesh.vertices.size());
        std::vector<std::uint8_t> pinned(groups.size());
        for (int& g : groups) g = static_cast<int>(random() % 3);
        for (std::uint8_t& p : pinned) p = random() % 2;
        ccd::pair_filter filter;
        if (seed % 2) filter.groups = groups;
        if (seed % 7 == 0) filter.rule = ccd::pair_filter::group_rule::within_groups;
        if (seed % 3) filter.pinned = pinned;
        if (seed % 4 == 0)
            filter.can_collide = [](vertex_index v, vertex_index w) { return (v + w) % 5 != 0; };
        filter.skip_unused = seed % 2;
        if (seed % 5 < 2) {
            filter.region.emplace();
            filter.region->low[seed % 3] = mesh.vertices[0].x;
        }
        const auto found = ccd::intersections(mesh, {.edge_faces = true, .filter = filter});
        ASSERT_EQ(listed(found.pairs), expected_pairs(mesh, filter)) << seed;
        ASSERT_EQ(found.edge_faces, expected_edge_faces(mesh, filter)) << seed;
    }
}

/// Also with distances, other methods and moving meshes: only the start counts.
TEST(Intersections, AreReportedByStepsAndAdvances) {
    for (std::uint64_t seed = 1; seed <= 600; ++seed) {
        const ccd::mesh mesh = any_mesh(seed);
        mesh_maker maker(seed);
        ccd::mesh after = mesh;
        for (auto& p : after.vertices)
            p = {p.x * maker.between(0.5, 1.5), p.y * maker.between(0.9, 1.2), p.z};
        ccd::mesh_steps steps(mesh);
        ccd::step_options options;
        options.check_start = true;
        options.threads = 1 + seed % 2;
        options.filter.skip_unused = seed % 3 == 0;
        if (seed % 4 == 1) options.method = ccd::method::tight;
        if (seed % 4 == 2) options.distances.all = 1e-3;
        if (seed % 4 == 3) options.count_candidates = true;
        const found_pairs expected = expected_pairs(mesh, options.filter);
        for (int repeat = 0; repeat < 2; ++repeat) {
            const auto found = steps.run({mesh, after}, options);
            ASSERT_EQ(listed(found.intersections_at_start), expected) << seed;
            options.check_start = false;
            const auto without = steps.run({mesh, after}, options);
            EXPECT_EQ(found.pairs, without.pairs);
            EXPECT_TRUE(without.intersections_at_start.empty());
            options.check_start = true;
        }
        EXPECT_EQ(listed(steps
                             .intersections({&mesh.vertices[0].x, nullptr, mesh.vertices.size()},
                                            {.filter = options.filter})
                             .pairs),
                  expected);
        if (seed % 10 != 0) continue;
        const ccd::advance_options advance{.filter = options.filter, .check_start = true};
        EXPECT_EQ(listed(ccd::advance(mesh, after, advance).intersections_at_start), expected);
    }
}

/// The same mesh in which each vertex is the first of its position.
TEST(Intersections, WithEqualPositionsMerged) {
    for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
        const ccd::mesh mesh = any_mesh(3 * seed);
        ccd::mesh merged{mesh.vertices, {}, {}};
        const auto first = [&](vertex_index v) {
            vertex_index w = 0;
            while (!(mesh.vertices[w] == mesh.vertices[v])) ++w;
            return w;
        };
        for (const auto& f : mesh.faces)
            merged.faces.push_back({first(f[0]), first(f[1]), first(f[2])});
        for (const auto& e : mesh.edges) merged.edges.push_back({first(e[0]), first(e[1])});
        for (const vertex_index v :
             ccd::unused_vertices(mesh.faces, mesh.edges, mesh.vertices.size()))
            merged.edges.push_back({first(v), first(v)});
        const found_pairs expected = expected_pairs(merged, {.skip_unused = true});
        const auto found = ccd::intersections(mesh, {.merge_equal_positions = true});
        ASSERT_EQ(listed(found.pairs), expected) << seed;
        for (const auto& [kind, a, b, r] : expected)
            ASSERT_NE(kind, ccd::intersection_kind::vertex_vertex);
        ASSERT_EQ(listed(ccd::mesh_steps(mesh)
                             .intersections({mesh, mesh}, {.merge_equal_positions = true})
                             .pairs),
                  expected);
    }
}

const ccd::mesh pierced{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {1.5, 1, 1}},
                        {{0, 1, 2}, {3, 4, 5}}};

TEST(Intersections, HaveTheEndsOfTheCommonSegment) {
    const auto found = ccd::intersections(pierced, {.edge_faces = true});
    ASSERT_EQ(found.pairs.size(), 1U);
    const auto [from, to] = found.pairs[0].segment.value();
    EXPECT_EQ(from.position, (std::array<double, 3>{1, 1, 0}));
    EXPECT_EQ(to.position, (std::array<double, 3>{1.25, 1, 0}));
    EXPECT_LE(to.error, 0x1p-44);
    EXPECT_EQ(found.edge_faces,
              (std::vector<ccd::edge_face_pair>{{{3, 4}, {0, 1, 2}}, {{3, 5}, {0, 1, 2}}}));
    EXPECT_FALSE(ccd::intersections(pierced, {.segments = false}).pairs[0].segment);
    EXPECT_TRUE(
        ccd::intersections(pierced, {.wanted = intersection_options::amount::count}).pairs.empty());
}

TEST(Intersections, DoNotDependOnThreadsOrInstructionSets) {
    ccd::mesh mesh;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        const ccd::mesh part = mesh_maker(seed).sheet();
        const auto first = static_cast<vertex_index>(mesh.vertices.size());
        for (const auto& p : part.vertices)
            mesh.vertices.push_back({p.x + double(seed % 4), p.y + double(seed % 5), p.z});
        for (const face& f : part.faces)
            mesh.faces.push_back({f[0] + first, f[1] + first, f[2] + first});
    }
    const found_pairs expected = expected_pairs(mesh);
    EXPECT_GT(expected.size(), 1000U);
    for (const int threads : {1, 2, 4})
        for (const auto set : ccd::instruction_sets())
            EXPECT_EQ(listed(ccd::intersections(mesh, {.threads = threads, .set = set}).pairs),
                      expected);
}

TEST(Intersections, OfNothing) {
    EXPECT_TRUE(ccd::is_free_of_intersections({}));
    EXPECT_TRUE(ccd::is_free_of_intersections({{{0, 0, 0}}, {}, {}}));
    EXPECT_TRUE(
        ccd::is_free_of_intersections({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}}));
    // Unused vertices are points.
    const ccd::mesh points{{{0, 0, 0}, {0, 0, 0}}, {}, {}};
    EXPECT_FALSE(ccd::is_free_of_intersections(points));
    EXPECT_TRUE(ccd::is_free_of_intersections(points, {.filter = {.skip_unused = true}}));
    // A face given twice is no pair; a coplanar one on the same side of a common edge is.
    EXPECT_TRUE(ccd::is_free_of_intersections(
        {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {2, 1, 0}}, {}}));
    EXPECT_FALSE(ccd::is_free_of_intersections(
        {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {0, 1, 3}}, {}}));
}

TEST(Intersections, StopAndThrow) {
    const ccd::mesh mesh = mesh_maker(4).sheet();
    EXPECT_THROW(ccd::intersections(mesh, {.stop = [] { return true; }}), ccd::stopped);
    const auto refusal = [](const ccd::mesh& m, const intersection_options& options = {}) {
        return test_files::message_of<std::invalid_argument>(
            [&] { ccd::intersections(m, options); });
    };
    EXPECT_EQ(refusal({{{0, 0, 0}}, {{0, 0, 1}}, {}}),
              "ccd::intersections: vertex index of face 0 is 1; expected less than 1");
    EXPECT_EQ(refusal({{{0, 0, 0}, {0, std::nan(""), 0}}, {}, {}}),
              "ccd::intersections: y of vertex 1 is nan; expected a finite number");
    const std::vector<int> groups(2);
    EXPECT_EQ(refusal({{{0, 0, 0}}, {}, {}}, {.filter = {.groups = groups}}),
              "ccd::intersections: number of groups is 2; expected 1, one for each vertex");
    EXPECT_EQ(refusal({{{0, 0, 0}}, {}, {}}, {.threads = -1}),
              "ccd: number of threads is -1; expected 0 (one per core) or more");
    auto plane = ccd::mesh_steps::in_plane({}, 1);
    const double z[] = {0, 0, 1};
    EXPECT_EQ(test_files::message_of<std::invalid_argument>([&] {
                  plane.intersections({z, nullptr, 1});
              }),
              "ccd::intersections: z of vertex 0 is not 0; expected positions in the plane z = 0");
}

struct counted_frame {
    std::filesystem::path path;
    std::size_t edge_faces;
};
class StoredFrame : public testing::TestWithParam<counted_frame> {};

/// Numbers of two independent exact programs.
TEST_P(StoredFrame, HasTheKnownNumberOfEdgesInFaces) {
    const auto& [path, edge_faces] = GetParam();
    if (!exists(path)) GTEST_SKIP() << path << " is missing";
    const ccd::mesh mesh = ccd::io::read_mesh(path);
    const auto found = ccd::intersections(mesh, {.edge_faces = true});
    EXPECT_EQ(found.edge_faces.size(), edge_faces);
    ccd::step_options options;
    options.check_start = true;
    EXPECT_EQ(listed(ccd::step(mesh, mesh, options).intersections_at_start), listed(found.pairs));
}

const std::filesystem::path stored = ERRBOUND_SHARED_DATA "/scenes", bundled = ERRBOUND_SCENES;
INSTANTIATE_TEST_SUITE_P(
    Scenes, StoredFrame,
    testing::Values(counted_frame{bundled / "cloth-over-ball/frame0.ply", 57},
                    counted_frame{bundled / "cloth-over-ball/frame1.ply", 399},
                    counted_frame{stored / "cloth-funnel/frames/227.ply", 285},
                    counted_frame{stored / "cloth-ball/frames/cloth_ball92.ply", 62655},
                    counted_frame{stored / "cloth-ball/frames/cloth_ball93.ply", 98728}),
    [](const auto& frame) {
        std::string name = frame.param.path.parent_path().filename().string() + "_" +
                           frame.param.path.stem().string();
        std::ranges::replace_if(
            name, [](char c) { return !std::isalnum(c); }, '_');
        return name;
    });

}  // namespace
