// Compares the filter in doubles, and the axes in single precision, with the proofs' definitions
// (proofs/tie/tie_floats.ml), bit for bit. It compares each test, and whole decisions.
#include <algorithm>
#include <array>
#include <bit>
#include <ccd/explain.hpp>
#include <ccd/methods/forms.hpp>
#include <ccd/query.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <errbound/roots/control_values.hpp>
#include <string>
#include <vector>

#include "ccd/batch/rounded_axes.hpp"
#include "ccd/exact/stages.hpp"
#include "ccd/exact/static_filter/coefficient_signs.hpp"
#include "ccd/exact/static_filter/difference_extents.hpp"
#include "ccd/exact/static_filter/separating_axes.hpp"
#include "ccd/exact/static_filter/subdivision.hpp"
#include "ccd/exact/static_filter/whole_step.hpp"
#include "tests/proofs/drawn_query.hpp"
#include "tests/proofs/table.hpp"

namespace {

namespace static_filter = ccd::static_filter;
using errbound::roots::control_values;
using tie::drawn_query;
using tie::hash;

void put(hash& h, double x) {
    h.put_both(std::bit_cast<std::uint64_t>(x == 0 ? 0.0 : x));
}
void put(hash& h, bool b) {
    h.put(b);
}
void put(hash& h, ccd::outcome o) {
    h.put(static_cast<std::uint32_t>(o));
}
template <int N>
void put(hash& h, const control_values<double, N>& c) {
    for (const double b : c.b) put(h, b);
}

bool finite(const drawn_query& q) {
    return std::all_of(q.x.begin(), q.x.end(), [](double x) { return std::isfinite(x); });
}

/// The tests of the filter, and their operands.
template <template <class> class Forms>
void put_tests(hash& h, const Forms<double>& forms,
               const static_filter::difference_extents<double>& m) {
    put(h, m.x);
    put(h, m.y);
    put(h, m.z);
    put(h, static_filter::certainly_separated_by_coordinates<double>(forms, m));
    put(h, static_filter::separated_by_diagonals<double>(forms, m));
    put(h, static_filter::separated_by_axes<double>(forms, m));
    const double y_error = m.template error_of_y<Forms>();
    const static_filter::whole_step<double, Forms> whole(forms, m);
    put(h, y_error);
    put(h, m.template error_of_g<Forms>());
    put(h, whole.errors.y);
    put(h, whole.errors.g);
    const auto& y = whole.forms.y;
    put(h, y);
    for (const auto& g : whole.forms.g) put(h, g);
    put(h, static_filter::above(y, y_error) || static_filter::below(y, y_error));
    put(h, whole.outside());
    const auto [left, right] = errbound::roots::halves(y);
    put(h, left);
    put(h, right);
    for (const std::size_t deepest : {static_filter::max_depth, std::size_t{6}, std::size_t{0}})
        put(h, static_filter::subdivide(whole, nullptr, deepest));
}
/// The decision of one query, and for each stage whether it was entered and its answer.
template <class Query>
void put_decision(hash& h, const Query& query) {
    using ccd::stage;
    ccd::stage_report report;
    put(h, ccd::detail::decide_in_floating_point(query, &report).outcome);
    for (const stage s : {stage::axes, stage::coplanarity, stage::inside, stage::subdivision}) {
        const auto& entry = report.stages[static_cast<std::size_t>(s)];
        h.put(static_cast<std::uint32_t>(entry.entered));
        h.put(static_cast<std::uint32_t>(entry.separate));
        if (s == stage::subdivision) h.put(static_cast<std::uint32_t>(entry.collides));
    }
}
template <template <class> class Forms, class Query>
void put_filter(hash& h, const Query& query, bool finite) {
    if (finite) {
        const Forms<double> forms(query);
        const static_filter::difference_extents<double> m(forms);
        put(h, m.usable);
        if (m.usable) put_tests<Forms>(h, forms, m);
    }
    put_decision(h, query);
}
void put_filter(hash& h, const drawn_query& q) {
    if (q.edges)
        put_filter<ccd::linear_edge_edge_forms>(h, q.as<ccd::edge_edge<double>>(), finite(q));
    else
        put_filter<ccd::linear_vertex_face_forms>(h, q.as<ccd::vertex_face<double>>(), finite(q));
}

/// The constants of the forms' error counts, computed at run time.
template <template <class> class Forms>
void put_constants(hash& h) {
    namespace detail = static_filter::detail;
    for (const auto& c :
         {detail::constants_of_y<double, Forms>(), detail::constants_of_g<double, Forms>()}) {
        put(h, c.relative);
        put(h, c.absolute);
        put(h, c.halvings);
    }
}

/// Small whole control values, and errors that are equal to some of them.
template <int N>
control_values<double, N> small_values(tie::sequence& s) {
    control_values<double, N> c;
    for (double& b : c.b) b = tie::draw(s, 7) - 3;
    return c;
}
void put_signs(hash& h, tie::sequence& s) {
    const auto y = small_values<3>(s);
    const auto g = small_values<4>(s);
    const double error = tie::draw(s, 3);
    const auto put_all = [&](const auto& c) {
        put(h, static_filter::above(c, error));
        put(h, static_filter::below(c, error));
        put(h, static_filter::changes_sign(c, error));
        put(h, static_filter::within_error(c, error));
    };
    put_all(y);
    put_all(g);
    put(h, static_filter::changes_sign_once(y, error));
}

/// Subintervals with a small or a large Y, and G_i of either sign.
template <template <class> class Forms, class Query>
void put_subdivision(hash& h, tie::sequence& s) {
    const Forms<double> forms{Query{}};
    static_filter::whole_step<double, Forms> whole(
        forms, static_filter::difference_extents<double>(forms));
    const double unit = tie::draw(s, 2) == 0 ? 1 : 8;
    whole.forms.y = small_values<3>(s);
    for (double& b : whole.forms.y.b) b /= unit;
    for (auto& g : whole.forms.g)
        for (double& b : g.b) b = tie::draw(s, 40) - 25;
    whole.errors.y = tie::draw(s, 2) / 2.0;
    whole.errors.g = tie::draw(s, 2);
    const int kind = tie::draw(s, 4);
    put(h, static_filter::subdivide(whole, nullptr,
                                    kind == 0   ? 2
                                    : kind == 1 ? 5
                                                : static_filter::max_depth));
}

void put_axes(hash& h, const drawn_query& q) {
    if (!finite(q)) return;
    namespace rounded_axes = ccd::detail::rounded_axes;
    auto box = rounded_axes::extent::nothing();
    for (std::size_t k = 0; k < 3; ++k) {
        box.widen(k, q.low[k]);
        box.widen(k, q.high[k]);
    }
    const rounded_axes::frame f(box);
    // A loop beyond the last axis would find the features far apart there.
    struct {
        float x[3][2][4];
        float beyond[2][4];
    } places;
    auto& x = places.x;
    for (auto& end : places.beyond)
        for (std::size_t p = 0; p < 4; ++p) end[p] = p < (q.edges ? 2 : 1) ? 0.0F : 1e6F;
    for (std::size_t p = 0; p < 4; ++p)
        for (std::size_t e = 0; e < 2; ++e)
            for (std::size_t k = 0; k < 3; ++k) {
                x[k][e][p] = f(k, q.x[6 * p + 3 * e + k]);
                put(h, static_cast<double>(x[k][e][p]));
            }
    put(h, q.edges ? rounded_axes::separated<ccd::edge_edge_pair, float>(x)
                   : rounded_axes::separated<ccd::vertex_face_pair, float>(x));
}

std::vector<tie::line> all_lines() {
    static std::vector<std::vector<drawn_query>> queries;
    tie::sequence numbers;
    for (int i = 0; i < 10; ++i) {
        queries.emplace_back();
        for (int k = 0; k < 2000; ++k) queries.back().push_back(tie::query_maker(numbers).query());
    }
    std::vector<tie::line> lines;
    lines.push_back({"filter vertex_face_constants", 1, [](hash& h, std::uint64_t) {
                         put_constants<ccd::linear_vertex_face_forms>(h);
                     }});
    lines.push_back({"filter edge_edge_constants", 1, [](hash& h, std::uint64_t) {
                         put_constants<ccd::linear_edge_edge_forms>(h);
                     }});
    static tie::sequence signs, parts;
    lines.push_back({"filter signs", 4000, [](hash& h, std::uint64_t) { put_signs(h, signs); }});
    lines.push_back({"filter vertex_face_subdivision", 4000, [](hash& h, std::uint64_t) {
                         put_subdivision<ccd::linear_vertex_face_forms, ccd::vertex_face<double>>(
                             h, parts);
                     }});
    lines.push_back({"filter edge_edge_subdivision", 4000, [](hash& h, std::uint64_t) {
                         put_subdivision<ccd::linear_edge_edge_forms, ccd::edge_edge<double>>(
                             h, parts);
                     }});
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const auto& some = queries[i];
        lines.push_back({"filter tests." + std::to_string(i), some.size(),
                         [&some](hash& h, std::uint64_t k) { put_filter(h, some[k]); }});
        lines.push_back({"rounded_axes separated." + std::to_string(i), some.size(),
                         [&some](hash& h, std::uint64_t k) { put_axes(h, some[k]); }});
    }
    return lines;
}

}  // namespace

int main(int argc, char**) {
    return tie::compare(all_lines(), argc);
}
