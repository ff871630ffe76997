#include "ccd/contact/condition.hpp"

#include <algorithm>
#include <cstddef>
#include <errbound/roots/polynomial_stages.hpp>
#include <errbound/roots/real_roots.hpp>
#include <optional>
#include <utility>
#include <vector>

namespace ccd::detail {
namespace {

using errbound::sign_type;
using roots_in_time = errbound::real_roots<integer>;
using staged_polynomial = errbound::roots::staged_polynomial<integer>;

/// Limits under which calls that are stopped throw as stop_if_requested. Keeps a reference.
errbound::root_limits limits_of(const stop_query& stop) {
    errbound::root_limits limits;
    if (stop)
        limits.stop = [&stop] {
            stop_if_requested(stop);
            return false;
        };
    return limits;
}

std::vector<staged_polynomial> staged(const std::vector<time_polynomial>& polynomials) {
    std::vector<staged_polynomial> r;
    for (const auto& p : polynomials) r.emplace_back(p.coefficients());
    return r;
}

/// Keeps a reference to `c`.
class staged_condition {
  public:
    explicit staged_condition(const condition<time_polynomial>& c)
        : vanishing(staged(c.vanishing)), condition_(c) {}

    bool also_below() const { return condition_.also_below; }
    side_conditions<staged_polynomial>& sides() {
        if (!sides_) {
            const auto exact = condition_.sides();
            sides_ = {staged(exact.nonnegative), staged(exact.not_all_zero)};
        }
        return *sides_;
    }

    std::vector<staged_polynomial> vanishing;

  private:
    const condition<time_polynomial>& condition_;
    std::optional<side_conditions<staged_polynomial>> sides_;
};

template <class SignThere>
bool sides_hold(staged_condition& c, const SignThere& sign_there) {
    auto& [nonnegative, not_all_zero] = c.sides();
    for (auto& p : nonnegative)
        if (sign_there(p) == sign_type::negative) return false;
    const auto is_zero = [&](auto& p) { return sign_there(p) == sign_type::zero; };
    return not_all_zero.empty() || !std::all_of(not_all_zero.begin(), not_all_zero.end(), is_zero);
}

template <class SignThere>
bool holds(staged_condition& c, const SignThere& sign_there) {
    const auto is_met = [&](auto& p) {
        const sign_type s = sign_there(p);
        return s == sign_type::zero || (c.also_below() && s == sign_type::negative);
    };
    return std::all_of(c.vanishing.begin(), c.vanishing.end(), is_met) && sides_hold(c, sign_there);
}

bool holds_at_start(staged_condition& c) {
    return holds(c, [](staged_polynomial& p) {
        return p.is_zero() ? sign_type::zero : errbound::sign_of(p.exact().front());
    });
}

/// Returns polynomials, one of which has the condition's first time, if not 0, as a root.
std::vector<staged_polynomial> candidates(staged_condition& c, const stop_query& stop) {
    if (c.vanishing.empty()) return {};
    const auto is_zero = [](const staged_polynomial& p) { return p.is_zero(); };
    if (std::all_of(c.vanishing.begin(), c.vanishing.end(), is_zero)) return c.sides().nonnegative;
    if (c.vanishing.size() == 1) return c.vanishing;
    errbound::roots::integer_form<integer> common;
    errbound::roots::work_meter meter(limits_of(stop));
    for (auto& p : c.vanishing) common = errbound::roots::common_factor(common, p.exact(), meter);
    return {staged_polynomial(std::move(common))};
}

first_time at_root(roots_in_time& roots, std::size_t k) {
    const auto [low, high] = roots.neighbouring_doubles(k);
    return {outcome::collides, low, high};
}

constexpr first_time never{outcome::separate, 0, 0};

}  // namespace

first_time first_time_of(const exact_conditions& conditions, double t_max, const stop_query& stop) {
    std::vector<staged_condition> all(conditions.begin(), conditions.end());
    for (staged_condition& c : all) {
        stop_if_requested(stop);
        if (holds_at_start(c)) return {outcome::collides, 0, 0};
    }
    first_time first = never;
    double end = std::min(t_max, 1.0);
    for (staged_condition& c : all) {
        for (staged_polynomial& p : candidates(c, stop)) {
            if (p.is_zero()) continue;
            stop_if_requested(stop);
            roots_in_time roots(std::move(p), 0, end, limits_of(stop));
            for (std::size_t k = 0; k < roots.size(); ++k) {
                if (!sides_hold(c, [&](auto& side) { return roots.sign_at(side, k); })) continue;
                // If another root lies in the same bracket, the order of the two is irrelevant.
                const first_time found = at_root(roots, k);
                if (first.outcome == outcome::separate || found.low < first.low ||
                    found.high < first.high)
                    first = found;
                end = first.high;
                break;
            }
        }
    }
    return first;
}

first_time first_time_at_roots(const time_polynomial& y, const root_test& test, double t_max,
                               const stop_query& stop) {
    roots_in_time roots(staged_polynomial(y.coefficients()), 0, std::min(t_max, 1.0),
                        limits_of(stop));
    exact_conditions conditions;
    std::vector<staged_condition> all;
    const auto holds_at = [&](std::size_t k) {
        const outcome known =
            test.holds_at ? test.holds_at(roots.enclosure(k)) : outcome::uncertain;
        if (known != outcome::uncertain) return known == outcome::collides;
        if (all.empty()) {
            conditions = test.conditions();
            all = std::vector<staged_condition>(conditions.begin(), conditions.end());
        }
        return std::any_of(all.begin(), all.end(), [&](staged_condition& c) {
            stop_if_requested(stop);
            return holds(c, [&](auto& p) { return roots.sign_at(p, k); });
        });
    };
    for (std::size_t k = 0; k < roots.size(); ++k)
        if (holds_at(k)) return at_root(roots, k);
    return never;
}

first_time first_root_time(const time_polynomial& y, double low, double high,
                           const stop_query& stop) {
    roots_in_time roots(staged_polynomial(y.coefficients()), low, high, limits_of(stop));
    return at_root(roots, 0);
}

}  // namespace ccd::detail
