// One stored query in shadowed arithmetic: its forms, the deciding quantities, and BSC.
#pragma once

#include <ccd/methods/bsc.hpp>
#include <ccd/methods/forms.hpp>
#include <errbound/validation/shadowed.hpp>
#include <string_view>

namespace ccd::lab {

using errbound::bernstein;
using errbound::validation::shadow_session, errbound::validation::shadowed;

template <class Rule>
void note(shadow_session& session, std::string_view quantity, const shadowed<Rule>& x) {
    session.note(quantity, x.claimed(), x.exact(), errbound::meaning_of_error<Rule>);
}

/// Notes the form's value at the root of l in (0, 1), if any, as BSC evaluates it.
template <class S, int N>
void note_at_root(shadow_session& session, std::string_view quantity, const bernstein<S, N>& form,
                  const bernstein<S, 1>& l) {
    if (!errbound::bsc::linear_signs(l).opposite()) return;
    const errbound::bsc::linear_root<S> root(l);
    note(session, quantity, value_at(form, root.s, root.t));
}

/// Notes BSC's reduction of the quartic g: J, then M and R of its decomposition, and Y at their
/// roots.
template <class S>
void note_reduction(shadow_session& session, const bernstein<S, 3>& y, const bernstein<S, 4>& g) {
    for (int i = 0; i <= 4; ++i) note(session, "G", g[i]);
    if (certain(sign_inside(g))) return;
    const bernstein<S, 2> j = errbound::bsc::reduced(y, g);
    for (int i = 0; i <= 2; ++i) note(session, "J", j[i]);
    if (certain(sign_inside(j))) return;
    const errbound::bsc::decomposition<S> parts(y, j);
    for (int i = 0; i <= 1; ++i) {
        note(session, "M", parts.m[i]);
        note(session, "R", parts.r[i]);
    }
    note_at_root(session, "Y(t_M)", y, parts.m);
    note_at_root(session, "Y(t_R)", y, parts.r);
}

/// Checks every operation of the deciding quantities, and of BSC as in decide_bsc.
template <class Rule, template <class> class Query>
void check_query(const Query<double>& query, shadow_session& session) {
    using scalar = shadowed<Rule>;
    const auto [scaled, finite] = tracked_query<Rule, double, Query, scalar>(query);
    if (!finite) return;
    const auto forms = forms_of(scaled);
    const bernstein<scalar, 3> y = normalized(forms.y());
    constexpr std::string_view k[] = {"k0", "3 k1", "3 k2", "k3"};
    for (int i = 0; i <= 3; ++i) note(session, k[i], y[i]);
    const bernstein<scalar, 2> slope = derivative(y);
    note(session, "Y'(0)", slope[0]);
    note(session, "Y'(1)", slope[2]);
    const bernstein<scalar, 1> second = derivative(slope);
    note(session, "Y''(0)", second[0]);
    note(session, "Y''(1)", second[1]);
    if (certainly_rootless(y)) return;
    auto inside = forms.inside();
    for (auto& g : inside) {
        g = normalized(g);
        note_reduction(session, y, g);
    }
    // BSC normalises again, which keeps normalised forms.
    (void)root_with_nonnegative(y, [&] { return inside; });
}

}  // namespace ccd::lab
