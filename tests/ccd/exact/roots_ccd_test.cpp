// Collision detection expressed by polynomials: root_where_nonnegative compared with `exact`.
//
// A contact is a t in [0, 1] with Y(t) = 0, N(t) ≠ 0 and all G_i(t) >= 0, or a contact of a vertex
// and an edge. There, three quadratics vanish and a fourth is not positive (the reason:
// ccd/exact/reference.cpp).
#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_int.hpp>
#include <ccd/exact.hpp>
#include <ccd/methods/forms.hpp>
#include <ccd/methods/transform.hpp>
#include <cstddef>
#include <errbound/multiprecision.hpp>
#include <errbound/polynomial.hpp>
#include <random>
#include <string>
#include <vector>

#include "ccd/exact/features.hpp"

namespace {

using integer = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<>,
                                              boost::multiprecision::et_off>;
using form = errbound::roots::integer_form<integer>;
using errbound::polynomial;

/// Σ h_i (1 − t)^(N − i) t^i in the power basis.
template <int N>
form power_basis(const errbound::bernstein<integer, N>& p) {
    form sum(N + 1);
    for (int i = 0; i <= N; ++i) {
        integer binomial = p[i];  // times (−1)^k C(N − i, k)
        for (int k = 0; i + k <= N; ++k) {
            sum[static_cast<std::size_t>(i + k)] += binomial;
            binomial = -binomial * (N - i - k) / (k + 1);
        }
    }
    errbound::roots::trim(sum);
    return sum;
}

form product(const form& a, const form& b) {
    if (a.empty() || b.empty()) return {};
    form r(a.size() + b.size() - 1);
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = 0; j < b.size(); ++j) r[i + j] += a[i] * b[j];
    return r;
}

/// All three vanish if and only if the sum of their squares does.
bool meets(const ccd::vertex_edge<integer>& query) {
    const auto w = difference(query.v, query.e0);
    const auto off_line = cross(w, difference(query.e1, query.e0));
    form squares;
    for (const auto* f : {&off_line.x, &off_line.y, &off_line.z}) {
        const form q = power_basis(*f), square = product(q, q);
        if (squares.size() < square.size()) squares.resize(square.size());
        for (std::size_t i = 0; i < square.size(); ++i) squares[i] += square[i];
    }
    form between = power_basis(dot(w, difference(query.v, query.e1)));
    for (integer& c : between) c = -c;
    return root_where_nonnegative(polynomial<integer>(squares), {polynomial<integer>(between)}, 0,
                                  1);
}

/// The result from polynomials: `possible` if there may be a contact at a root without a normal.
enum class answer { no, possible, yes };

template <class Query>
answer ask(const Query& query) {
    for (const auto& q : vertex_edge_queries(query))
        if (meets(q)) return answer::yes;
    const auto forms = ccd::forms_of(query);
    form y = power_basis(forms.y());
    const form n2 = power_basis(forms.normal_squared());
    if (n2.empty()) return answer::no;
    // Removes the roots of Y at which the normal vanishes.
    for (form common; !y.empty(); y = errbound::roots::divided(y, common)) {
        common = errbound::roots::common_factor(y, n2);
        if (common.size() < 2) break;
    }
    std::vector<polynomial<integer>> g;
    for (const auto& f : forms.inside()) g.emplace_back(power_basis(f));
    if (!root_where_nonnegative(polynomial<integer>(y), g, 0, 1)) return answer::no;
    const bool normal_vanishes = count_roots(polynomial<integer>(n2), 0, 1) > 0;
    return y.empty() && normal_vanishes ? answer::possible : answer::yes;
}

struct tally {
    int no = 0, possible = 0, yes = 0;
};

/// Vertices on a grid; smaller grids have more degenerate queries.
template <template <class> class Query>
tally compare(int places, unsigned seed) {
    std::mt19937_64 random(seed);
    tally found;
    for (int k = 0; k < 1500; ++k) {
        auto query = ccd::transformed(Query<double>{}, [&](double) {
            return static_cast<double>(random() % static_cast<unsigned>(places)) - places / 2;
        });
        // Motion in a plane, where Y is zero throughout.
        if (k % 5 == 0)
            query = ccd::transformed_points(query, [](const ccd::point<double>& p) {
                return ccd::point<double>{p.x, p.y, 0};
            });
        const answer said =
            ask(ccd::transformed(query, [](double x) { return integer(static_cast<long>(x)); }));
        const bool collides = ccd::decide_exact(query).outcome == ccd::outcome::collides;
        if (said == answer::possible)
            ++found.possible;
        else
            EXPECT_EQ(said == answer::yes, collides) << "query " << k << " of " << places;
        ++(collides ? found.yes : found.no);
    }
    return found;
}

class Grids : public testing::TestWithParam<int> {};

TEST_P(Grids, AgreeWithExact) {
    for (const tally& found :
         {compare<ccd::vertex_face>(GetParam(), 1), compare<ccd::edge_edge>(GetParam(), 2)}) {
        EXPECT_GT(found.yes, 20);
        EXPECT_GT(found.no, 20);
        EXPECT_LT(found.possible, 150);
    }
}

INSTANTIATE_TEST_SUITE_P(Polynomials, Grids, testing::Values(3, 5, 9, 1 << 20),
                         [](const auto& info) { return std::to_string(info.param) + "_places"; });

}  // namespace
