// Compares decisions in integers, of fixed width and to the end, and their components with the
// proofs' definitions on the same queries and forms (proofs/tie/tie_integers.ml).
#include <algorithm>
#include <array>
#include <ccd/methods/forms.hpp>
#include <ccd/query.hpp>
#include <cstddef>
#include <cstdint>
#include <errbound/bernstein.hpp>
#include <errbound/integers/fixed_integer.hpp>
#include <errbound/integers/long_integer.hpp>
#include <errbound/sign.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "ccd/exact/axis_units.hpp"
#include "ccd/exact/bounded_integer.hpp"
#include "ccd/exact/close_contact.hpp"
#include "ccd/exact/common_roots.hpp"
#include "ccd/exact/cubic_roots.hpp"
#include "ccd/exact/features.hpp"
#include "ccd/exact/integer_decision.hpp"
#include "ccd/exact/integers.hpp"
#include "ccd/exact/interior_contact.hpp"
#include "ccd/exact/vertex_edge_contact.hpp"
#include "tests/proofs/table.hpp"
#include "tests/proofs/whole_forms.hpp"
#include "tests/proofs/whole_query.hpp"

namespace {

using ccd::detail::decide_in_words;
using ccd::detail::extent_limit;
using ccd::detail::integer_units;
using errbound::integers::fixed_integer;
using tie::drawn_query;
using tie::hash;

void put(hash& h, ccd::outcome o) {
    h.put(static_cast<std::uint32_t>(o));
}

/// In the least number of words.
template <class Query>
ccd::outcome in_words(const Query& query) {
    const integer_units units(query);
    if (units.bits() <= extent_limit(1)) return decide_in_words<1>(query, units);
    if (units.bits() <= extent_limit(2)) return decide_in_words<2>(query, units);
    return decide_in_words<4>(query, units);
}
template <class Query>
void put_decision(hash& h, const Query& query) {
    h.put(static_cast<std::uint32_t>(integer_units(query).bits()));
    put(h, in_words(query));
    put(h, ccd::detail::decide_in_integers(query).outcome);
}
void put_decision(hash& h, const drawn_query& q) {
    tie::with_query(q, [&h](const auto& query) { put_decision(h, query); });
    tie::with_smaller_queries(q, [&h](const auto& query) { put(h, in_words(query)); });
}

/// Decisions that only few queries need, since roots nearly coincide.
template <class Query>
void put_close(hash& h, const Query& query) {
    put(h, ccd::detail::decide_close<4>(forms_of(integer_units(query).converted<4>(query))));
}
void put_close(hash& h, const drawn_query& q) {
    tie::with_query(q, [&h](const auto& query) { put_close(h, query); });
}

/// For all extents, also infinite ones: units, separation by coordinates, and the verdict.
template <class Query>
void put_wide(hash& h, const Query& query) {
    const integer_units units(query);
    h.put(units.finite());
    if (units.finite())
        for (const auto& axis : {units.x, units.y, units.z}) {
            h.put(static_cast<std::uint32_t>(axis.unit));
            h.put(static_cast<std::uint32_t>(axis.bits));
        }
    h.put(units.finite() && ccd::detail::separated_by_coordinates(query));
    const auto verdict = ccd::detail::decide_in_integers(query);
    put(h, verdict.outcome);
    h.put(static_cast<std::uint32_t>(verdict.cause));
}
void put_wide(hash& h, const drawn_query& q) {
    const auto put_one = [&h](const auto& query) { put_wide(h, query); };
    tie::with_query(q, put_one);
    tie::with_smaller_queries(q, put_one);
}

template <class Integer>
void put_number(hash& h, const Integer& x) {
    h.put(static_cast<std::uint32_t>(sign_of(x)));
    h.put(static_cast<std::uint32_t>(x.bit_length()));
    h.put_both(static_cast<std::uint64_t>(x.word_from_bit(0)));
}

/// Makes protected members of the interior decision accessible.
template <int Words, template <class, int> class Forms>
struct opened_contact : ccd::detail::interior_contact<Words, Forms> {
    using base = ccd::detail::interior_contact<Words, Forms>;
    using base::base, base::multiple_root, base::without_halving, base::near, base::throughout,
        base::normal_vanishes, base::three_real_roots_;
    using typename base::part;
};
/// Makes protected members of the decision to the end accessible.
template <template <class, int> class Forms>
struct opened_close_contact : ccd::detail::close_contact<Forms> {
    using base = ccd::detail::close_contact<Forms>;
    using base::base, base::whole_step, base::by_narrowing, base::any_root, base::narrowed,
        base::inside_from, base::contact_in_middle, base::normal_vanishes;
    using typename base::part, typename base::place_number;
    static errbound::integers::long_integer<base::coordinate_words> converted(
        const tie::whole_number& x) {
        return x;
    }
};

/// The subinterval after `level` halvings: that with a sign change of Y, else that of `path`.
template <class Part, int Words>
Part part_of(const ccd::detail::cubic_form<Words>& y, int level, std::uint64_t path) {
    Part p{{}, ccd::detail::inner_sign_changes(y), 0, 0};
    for (int i = 0; i <= 3; ++i) p.y[i] = y[i];
    for (; p.level < level; ++p.level, path >>= 1) {
        const auto left = left_half(p.y), right = reversed(left_half(reversed(p.y)));
        const ccd::detail::inner_sign_changes on_left(left), on_right(right);
        const bool to_right = !on_left.opposite && (on_right.opposite || path % 2 == 1);
        p.y = to_right ? right : left;
        p.roots = to_right ? on_right : on_left;
        p.index = 2 * p.index + to_right;
    }
    return p;
}

void put_if_any(hash& h, std::optional<ccd::outcome> found) {
    h.put(found.has_value());
    if (found) put(h, *found);
}
/// In T words, at the root.
template <int T, class Contact>
void put_throughout(hash& h, const Contact& contact, const tie::drawn_forms& f) {
    const int bits = std::clamp(64 * T - 4 - f.bits(0) + f.cut, 1, 64 * T - 2);
    for (int width_bits = 0; width_bits < 40; ++width_bits)
        put(h, contact.template throughout<T>(f.place(bits).from_bit<T>(0), bits, width_bits));
}

/// Subintervals around the root, with more than one root, at the limit of halvings.
template <class Contact>
void put_last_halves(hash& h, Contact contact, const tie::drawn_forms& f) {
    using part = typename Contact::part;
    contact.three_real_roots_ = true;
    part last{};
    last.level = part::max_halvings;
    last.roots.count = 2;
    for (int i = 0; i < part::max_halvings; ++i) {
        last.index = f.place(last.level).low_word() ^ std::int64_t{1} << i;
        put_if_any(h, contact.without_halving(last));
    }
}

template <class Part>
void put_part(hash& h, const Part& p) {
    for (const auto& y : p.y.h) put_number(h, y);
    put_number(h, p.low);
    for (const int n : {p.roots.count, p.unit_bits, p.width_bits, p.test_from, p.bits()})
        h.put(static_cast<std::uint32_t>(n));
    h.put(p.can_be_narrowed());
}
/// The subintervals of a decision to the end, one after the other, and its result from the last
/// one.
template <template <class, int> class Forms>
void put_parts(hash& h, const tie::drawn_forms& f) {
    using contact_type = opened_close_contact<Forms>;
    const contact_type contact(f.as<Forms>(contact_type::converted));
    auto p = contact.whole_step();
    std::uint64_t path = f.path;
    for (; contact.any_root(p.roots) && p.can_be_narrowed(); path >>= 1) {
        put_part(h, p);
        put(h, contact.inside_from(p.low, p.unit_bits, p.width_bits));
        h.put(contact.contact_in_middle(p));
        h.put(contact.normal_vanishes(p));
        auto before = p;
        before.low = p.low - typename contact_type::place_number(1, p.width_bits, false);
        h.put(contact.normal_vanishes(before));
        const auto narrow = contact.narrowed(p);
        h.put(narrow.has_value());
        const auto half = p.sub_part(1, path % 2, 0);
        p = narrow ? *narrow : contact.any_root(half.roots) ? half : p.sub_part(1, 1 - path % 2, 0);
    }
    put_part(h, p);
    p.test_from = p.bits() + static_cast<int>(path % 2);
    put(h, contact.by_narrowing(p));
}
/// Roots that appear late, and sizes near the most bits.
template <template <class, int> class Forms>
void put_deep(hash& h, const tie::drawn_deep& d) {
    using contact_type = opened_close_contact<Forms>;
    using part = typename contact_type::part;
    using number = std::decay_t<decltype(part().y[0])>;
    const contact_type contact(d.forms.as<Forms>(contact_type::converted));
    part deep;
    deep.y = {{number(-1), number(1, d.root_bits, false), number(0), number(1)}};
    deep.roots = ccd::detail::inner_sign_changes(deep.y);
    deep.unit_bits = d.unit_bits;
    deep.test_from = d.test_from;
    put(h, contact.by_narrowing(deep));
    part limit;
    limit.unit_bits = d.limit_unit_bits;
    limit.y[d.limit_index] = number(1, d.limit_bits, d.limit_negative);
    h.put(limit.can_be_narrowed());
    part pair;
    for (int i = 0; i <= 3; ++i) pair.y[i] = d.pair[static_cast<std::size_t>(i)];
    pair.roots = ccd::detail::inner_sign_changes(pair.y);
    if (pair.roots.count != 2) return;
    const auto narrow = contact.narrowed(pair);
    h.put(narrow.has_value());
    if (narrow) put_part(h, *narrow);
}
void put_deep(hash& h, const tie::drawn_deep& d) {
    d.forms.with_kind([&]<template <class, int> class Forms>() { put_deep<Forms>(h, d); });
}

template <int Words, template <class, int> class Forms>
void put_forms(hash& h, const tie::drawn_forms& f) {
    const auto forms = f.as<Forms>([](const auto& x) { return x.template from_bit<Words>(0); });
    const auto y = forms.y();
    integer_units units(ccd::vertex_vertex<double>{});
    units.x.bits = f.bits(0), units.y.bits = f.bits(1), units.z.bits = f.bits(2);
    opened_contact<Words, Forms> contact(forms, y, units);
    put(h, ccd::detail::interior_contact(forms, y, units).decide());
    put(h, ccd::detail::decide_close<Words>(forms));
    const auto multiple = contact.multiple_root();
    h.put(multiple.has_value());
    if (multiple) put_number(h, (*multiple)[0]), put_number(h, (*multiple)[1]);

    using part = typename opened_contact<Words, Forms>::part;
    const auto some = part_of<part>(y, f.level, f.path);
    put_if_any(h, contact.without_halving(some));
    put_last_halves(h, contact, f);
    if (f.words == 1) put_throughout<1>(h, contact, f);
    if (f.words == 2) put_throughout<2>(h, contact, f);
    if (f.words == 3) put_throughout<3>(h, contact, f);
    if (f.words == 4) put_throughout<4>(h, contact, f);
    if (!some.roots.opposite) return;
    auto place = ccd::detail::estimated_place(some);
    place.numerator = place.numerator + fixed_integer<1>(f.off);
    put_if_any(h, contact.near(some, place));
    const auto bracket = ccd::detail::bracket_near(y, some, place);
    h.put(bracket.has_value());
    if (!bracket) return;
    put_number(h, bracket->low), put_number(h, bracket->high);
    if (!bracket->is_root()) h.put(contact.normal_vanishes(*bracket));
}
template <int Words>
void put_forms(hash& h, const tie::drawn_forms& f) {
    f.with_kind([&]<template <class, int> class Forms>() { put_forms<Words, Forms>(h, f); });
}
void put_forms(hash& h, const tie::drawn_forms& f) {
    if (f.bits() <= extent_limit(1)) return put_forms<1>(h, f);
    if (f.bits() <= extent_limit(2)) return put_forms<2>(h, f);
    put_forms<4>(h, f);
}
void put_parts(hash& h, const tie::drawn_forms& f) {
    f.with_kind([&]<template <class, int> class Forms>() { put_parts<Forms>(h, f); });
}

/// Tests at roots of quadratics, and at common roots of three.
void put_roots(hash& h, const tie::drawn_quadratics& q) {
    using errbound::sign_of;
    const auto& f = q.forms[0];
    if (sign_inside(f) == errbound::sign_type::uncertain)
        h.put(ccd::detail::nonpositive_at_a_root(f, q.other));
    const ccd::detail::common_roots roots(q.forms);
    h.put(static_cast<std::uint32_t>(roots.kind));
    using kind = decltype(roots)::kind_type;
    if (roots.kind == kind::one)
        for (const auto& square : roots.squares.h) put_number(h, square);
    if (roots.kind == kind::of_quadratic)
        for (const auto& c : roots.quadratic->h) put_number(h, c);
}

/// Integers with error bounds.
void put_bounded(hash& h, const tie::drawn_bounded& drawn) {
    using bounded = ccd::detail::bounded_integer<fixed_integer<2>>;
    const bounded a{drawn.a, drawn.a_bits}, b{drawn.b, drawn.b_bits};
    const auto put_one = [&h](const auto& x) {
        put_number(h, x.value);
        h.put(static_cast<std::uint32_t>(x.error_bits));
        h.put(static_cast<std::uint32_t>(sign_of(x)));
    };
    put_one(a), put_one(a + b), put_one(a - b), put_one(a * b);
}

std::vector<tie::line> all_lines() {
    static std::vector<std::vector<drawn_query>> queries;
    tie::sequence numbers;
    std::vector<tie::line> lines;
    queries.reserve(20);
    for (int i = 0; i < 20; ++i) {
        auto& some = queries.emplace_back();
        for (int k = 0; k < 4000; ++k) some.push_back(tie::whole_query_maker(numbers).query());
        lines.push_back({"integers decide." + std::to_string(i), some.size(),
                         [&some](hash& h, std::uint64_t k) { put_decision(h, some[k]); }});
        lines.push_back({"integers close." + std::to_string(i), 1000,
                         [&some](hash& h, std::uint64_t k) { put_close(h, some[k]); }});
    }
    using tie::line_of, tie::sequence;
    lines.push_back(line_of(
        "integers wide", 4000, numbers,
        [](sequence& s) { return tie::whole_query_maker(s).wide_query(); },
        [](hash& h, const drawn_query& q, int) { put_wide(h, q); }));
    lines.push_back(line_of(
        "integers forms", 4000, numbers,
        [](sequence& s) { return tie::whole_forms_maker(s).forms(); },
        [](hash& h, const tie::drawn_forms& f, int) { put_forms(h, f); }));
    lines.push_back(line_of(
        "integers parts", 1000, numbers,
        [](sequence& s) { return tie::whole_forms_maker(s).forms(); },
        [](hash& h, const tie::drawn_forms& f, int) { put_parts(h, f); }));
    lines.push_back(line_of("integers deep", 2000, numbers, tie::draw_deep,
                            [](hash& h, const tie::drawn_deep& d, int) { put_deep(h, d); }));
    lines.push_back(line_of("integers roots", 4000, numbers, tie::draw_quadratics,
                            [](hash& h, const tie::drawn_quadratics& q, int) { put_roots(h, q); }));
    lines.push_back(line_of("integers bounded", 4000, numbers, tie::draw_bounded,
                            [](hash& h, const tie::drawn_bounded& b, int) { put_bounded(h, b); }));
    return lines;
}

}  // namespace

int main(int argc, char**) {
    return tie::compare(all_lines(), argc);
}
