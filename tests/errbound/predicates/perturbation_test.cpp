// Perturbed predicates, compared with a concrete small epsilon in integers, on degenerate points.
#include <errbound/predicates/constructed_points.hpp>
#include <errbound/predicates/perturbation.hpp>
#include <numeric>
#include <optional>
#include <vector>

#include "tests/errbound/predicates/predicate_check.hpp"

namespace {

using namespace predicate_check;

/// Points that are degenerate: on the predicate's surface, or with hardly any different
/// coordinates.
template <std::size_t D, std::size_t N>
predicate_inputs::points<double, D, N> degenerate(predicate_inputs::generator& random, surface s) {
    if (random() % 4 == 0) return predicate_inputs::deep<double, D, N>(random, s);
    if (random() % 2 == 0) return predicate_inputs::grid<double, D, N>(random, s);
    predicate_inputs::points<double, D, N> p;
    const int most = predicate_inputs::between(random, 0, 2);
    for (auto& point : p)
        for (double& x : point)
            x = std::ldexp(predicate_inputs::between(random, 0, most), 3 - most);
    return p;
}
template <std::size_t N>
std::array<std::size_t, N> distinct_indices(predicate_inputs::generator& random) {
    std::array<std::size_t, N> indices;
    std::iota(indices.begin(), indices.end(), random() % 1000);
    std::shuffle(indices.begin(), indices.end(), random);
    if (random() % 2 == 0) indices[0] = ~std::size_t{0};
    return indices;
}

/// (point, coordinate) from the largest infinitesimal to the smallest. `only`: that coordinate.
template <std::size_t D, std::size_t N>
std::vector<std::array<std::size_t, 2>> descending(const std::array<std::size_t, N>& indices,
                                                   int only) {
    std::array<std::size_t, N> order;
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return indices[a] < indices[b]; });
    std::vector<std::array<std::size_t, 2>> list;
    for (const std::size_t i : order)
        for (std::size_t k = D; k-- > 0;)
            if (only < 0 || only == static_cast<int>(k)) list.push_back({i, k});
    return list;
}

/// The oracle's sign for infinitesimal j = 2^-E_j, with E_j = E·3^j. No coordinate has a greater
/// power than 2. All coefficients are below 2^E in size, so the first term decides. The first of
/// the infinitesimals for which the sign is not zero decide too. Returns nothing if it takes too
/// many.
template <class Entry, class Points>
std::optional<int> sign_by_epsilon(const Entry& e, const Points& p,
                                   const std::vector<std::array<std::size_t, 2>>& infinitesimals) {
    constexpr int longest = 40'000;
    const int unit = std::min(predicate_oracle::common_unit(p), 0);
    int end = 1;
    for (const auto& point : p)
        for (const double x : point)
            if (x != 0) end = std::max(end, std::ilogb(x) + 1);
    const int first = (e.predicate.counts.degree + 1) * (end - unit + 3) + 16;
    for (std::size_t count = 0, last = 0; count <= infinitesimals.size(); ++count) {
        last = count == 0 ? 0 : count == 1 ? static_cast<std::size_t>(first) : 3 * last;
        if (last > longest) return std::nullopt;
        const int fine = unit - static_cast<int>(last);
        auto q = predicate_oracle::scaled_points(p, fine);
        for (std::size_t j = 0, exponent = static_cast<std::size_t>(first); j < count;
             ++j, exponent *= 3) {
            auto& x = q[infinitesimals[j][0]][infinitesimals[j][1]];
            x = x + big_integer(1.0, static_cast<int>(exponent) - static_cast<int>(last));
        }
        const int s = e.oracle(q, big_integer(1.0, fine));
        if (s != 0) return s;
    }
    return 0;
}

/// Exchanges of two points from index `rows` on change the sign.
template <int... Only, class Entry>
void compare_with_epsilon(const Entry& e, std::size_t rows = 0) {
    constexpr std::size_t D = Entry::dimension, N = Entry::count;
    constexpr int only = sizeof...(Only) == 0 ? -1 : (Only + ... + 0);
    const auto perturbed = errbound::perturbed<Only...>(e.predicate);
    predicate_inputs::generator random(3);
    int zeros = 0, compared = 0;
    for (int i = 0; i < support::scaled(2000); ++i) {
        const auto p = degenerate<D, N>(random, e.surfaces[0]);
        const auto indices = distinct_indices<N>(random);
        const auto sign = [&](const auto& q, const auto& of) {
            return std::apply([&](const auto&... r) { return perturbed(of, r...); }, q);
        };
        const sign_type exact = std::apply(e.predicate, p), s = sign(p, indices);
        zeros += exact == sign_type::zero;
        if (exact != sign_type::zero) {
            ASSERT_EQ(s, exact);
        }
        if (only < 0) {
            ASSERT_NE(s, sign_type::zero) << e.name << predicate_inputs::text_of(p);
        }
        // Determinants with one row for each of these points.
        auto q = p;
        auto swapped = indices;
        const std::size_t count = N - rows, from = random() % count;
        const std::size_t a = rows + from, b = rows + (from + 1 + random() % (count - 1)) % count;
        std::swap(q[a], q[b]);
        std::swap(swapped[a], swapped[b]);
        ASSERT_EQ(sign(q, swapped), -s) << e.name << predicate_inputs::text_of(p);
        const auto right = sign_by_epsilon(e, p, descending<D>(indices, only));
        if (!right) continue;
        ++compared;
        ASSERT_EQ(static_cast<int>(s) - 1, *right) << e.name << predicate_inputs::text_of(p);
    }
    std::printf("%s: %d degenerate, %d compared\n", std::string(e.name).c_str(), zeros, compared);
    EXPECT_GT(zeros, 0);
    EXPECT_GT(compared, zeros / 2);
}

TEST(Perturbation, AgreesWithASmallEpsilon) {
    compare_with_epsilon(std::get<0>(predicate_list::all));
    compare_with_epsilon(std::get<1>(predicate_list::all));
    compare_with_epsilon(std::get<2>(predicate_list::all));
    compare_with_epsilon(std::get<3>(predicate_list::all));
}
TEST(Perturbation, OfWeightedPoints) {
    compare_with_epsilon(std::get<4>(predicate_list::all));
    compare_with_epsilon(std::get<5>(predicate_list::all));
    compare_with_epsilon<2>(std::get<4>(predicate_list::all));
    compare_with_epsilon<3>(std::get<5>(predicate_list::all));
}

TEST(Perturbation, OfConstructedPoints) {
    using namespace errbound;
    const auto with_oracle = [](const auto& entry, const auto& predicate) {
        using type = std::remove_cvref_t<decltype(entry)>;
        return predicate_list::make_entry<type::dimension, type::count>(
            entry.name, predicate, entry.oracle, entry.surfaces);
    };
    compare_with_epsilon(with_oracle(std::get<10>(predicate_list::all),
                                     with_constructed<line_line, given, given>(orient2d)),
                         4);
    compare_with_epsilon(with_oracle(std::get<11>(predicate_list::all),
                                     with_constructed<line_plane, given, given, given>(orient3d)),
                         5);
}

// A predicate of two constructed points, and of one at another: the same points, the same signs.
TEST(Perturbation, OfConstructedPointsInTurn) {
    using namespace errbound;
    constexpr auto turn = predicate<points<2, 2>>(
        [](const auto& p, const auto& q) { return p[0] * q[1] - p[1] * q[0]; });
    constexpr auto both = with_constructed<line_line, line_line>(turn);
    constexpr auto in_turn = with_constructed<given, given, given, given, line_line>(
        with_constructed<line_line, given>(turn));
    predicate_inputs::generator random(5);
    int zeros = 0;
    for (int i = 0; i < support::scaled(1000); ++i) {
        std::array<point2, 8> p;
        for (auto& point : p) point = {double(random() % 3), double(random() % 2)};
        const auto indices = distinct_indices<8>(random);
        const auto sign = [&](const auto& of) {
            return std::apply([&](const auto&... q) { return of(indices, q...); }, p);
        };
        const sign_type s = sign(perturbed(both));
        zeros += std::apply(both, p) == sign_type::zero;
        ASSERT_EQ(std::apply(in_turn, p), std::apply(both, p));
        ASSERT_EQ(sign(perturbed(in_turn)), s);
        ASSERT_NE(s, sign_type::zero);
    }
    EXPECT_GT(zeros, 0);
}

// Signs of one configuration: the orientations of the triples of five points in the plane satisfy
// the Grassmann-Plücker relation, here for many equal points.
TEST(Perturbation, SignsDoNotContradictEachOther) {
    const auto turn = errbound::perturbed(errbound::orient2d);
    predicate_inputs::generator random(4);
    for (int i = 0; i < support::scaled(20'000); ++i) {
        std::array<point2, 5> p;
        for (auto& point : p) point = {double(random() % 3), double(random() % 2)};
        const auto s = [&](std::size_t a, std::size_t b, std::size_t c) {
            return turn({a, b, c}, p[a], p[b], p[c]);
        };
        // (0 1 2)(0 3 4) - (0 1 3)(0 2 4) + (0 1 4)(0 2 3) = 0
        const std::array terms{s(0, 1, 2) * s(0, 3, 4), -(s(0, 1, 3) * s(0, 2, 4)),
                               s(0, 1, 4) * s(0, 2, 3)};
        ASSERT_FALSE(terms[0] == terms[1] && terms[1] == terms[2]);
    }
}

TEST(Perturbation, OfCustomPredicates) {
    // Mixed degrees, constants, plain numbers.
    constexpr auto above = errbound::perturbed(errbound::predicate<errbound::points<2, 0>>(
        [](const auto& p, const auto& r) { return -(r * (p[0] * p[0] - 1) + (2 - p[1]) * 3); }));
    EXPECT_EQ(above({0, 1}, point2{1, 2}, 5.0), sign_type::positive);  // 3 e of y
    EXPECT_EQ(above({7, 1}, point2{1, 2}, 5.0), sign_type::positive);  // r does not matter at x = 1
    EXPECT_EQ(above({7, 1}, point2{3, 2}, 0.0), sign_type::negative);  // -8 e of r
    EXPECT_EQ(above({1, 7}, point2{3, 2}, 0.0), sign_type::positive);  // 3 e of y
    EXPECT_EQ(above({1, 7}, point2{3, 1}, 0.0), sign_type::negative);
}

TEST(Perturbation, OfSomeCoordinatesMovesNoOthers) {
    // Ten of 15 coordinates move. Their number is no power of two.
    const auto height =
        errbound::perturbed<0, 1>(errbound::predicate<errbound::points<3, 3, 3, 3, 3>>(
            [](const auto& a, const auto& b, const auto& c, const auto& d, const auto& e) {
                return a[2] + (b[2] - c[2]) * (d[0] - e[1]);
            }));
    const std::array<double, 3> low{1, 1, 0}, high{1, 1, 2};
    EXPECT_EQ(height({0, 1, 2, 3, 4}, low, low, low, low, high), sign_type::zero);
    EXPECT_EQ(height({0, 1, 2, 3, 4}, low, high, low, low, high), sign_type::positive);
    EXPECT_EQ(height({4, 1, 2, 3, 0}, low, high, low, low, high), sign_type::negative);
}

TEST(Perturbation, IsZeroForEqualIndicesOnly) {
    const auto turn = errbound::perturbed(errbound::orient2d);
    const point2 a{1, 2}, b{3, 4};
    EXPECT_EQ(turn({0, 1, 0}, a, b, a), sign_type::zero);
    EXPECT_NE(turn({0, 1, 2}, a, b, a), sign_type::zero);
    EXPECT_NE(turn({0, 1, 2}, a, a, a), sign_type::zero);
    EXPECT_EQ(turn({0, 1, 2}, a, b, point2{0, std::numeric_limits<double>::infinity()}),
              sign_type::uncertain);
    // Five coplanar points have no volume, whatever their weights.
    const auto weighted = errbound::perturbed<3>(errbound::power_insphere);
    const auto at = [](double x, double y, double z) { return std::array<double, 4>{x, y, z, 0}; };
    EXPECT_EQ(
        weighted({0, 1, 2, 3, 4}, at(0, 0, 0), at(1, 0, 0), at(0, 1, 0), at(1, 1, 0), at(2, 2, 0)),
        sign_type::zero);
    EXPECT_NE(
        weighted({0, 1, 2, 3, 4}, at(0, 0, 0), at(1, 0, 0), at(0, 1, 0), at(1, 1, 0), at(0, 0, 1)),
        sign_type::zero);
}

}  // namespace
