// Every rule in every case of tiny formats.
#include <algorithm>
#include <cmath>
#include <errbound/validation/tiny_check.hpp>
#include <errbound/validation/validation.hpp>
#include <string>
#include <utility>
#include <vector>

#include "errbound/validation/chunks.hpp"

namespace errbound::validation {
namespace {

std::string text_of(const char* name, const tiny_account::operand& x) {
    const std::string value = hexadecimal(x.value);
    return "const number " + std::string(name) + " = " +
           (x.error == 0
                ? "format(" + value + ")"
                : "number::within(format(" + value + "), format(" + hexadecimal(x.error) + "))") +
           ";\n";
}
std::string text_of(const tiny_account& how) {
    constexpr const char* names[] = {"a", "b", "c"};
    std::string text;
    for (std::size_t i = 0; i < how.count; ++i) text += text_of(names[i], how.operands[i]);
    if (how.inner != nullptr) text += "const number d = " + std::string(how.inner) + ";\n";
    std::string operation = how.operation;
    if (operation == "scale") operation = "scale(a, " + std::to_string(how.exponent) + ")";
    return text + "const number " + (how.count == 3 ? "e" : "c") + " = " + operation + ";\n";
}

}  // namespace

void claim_checker::check(const tiny_claim& r, const exact_range& exact, const tiny_account& how) {
    ++found_.values;
    if (!std::isfinite(r.value) || !exact.defined()) {
        if (certain(r.sign) || std::isfinite(r.error))
            add(r, "certain about what has no finite value", how);
        return;
    }
    // These sums of doubles are exact or infinite.
    if (!std::isnan(r.error) &&
        !(r.value - r.error <= exact.low && exact.high <= r.value + r.error))
        add(r, "the bound is too small", how);
    check_sign(r, exact.low, exact.high, how);
}

namespace {

/// The exact sign of xy − z. Precondition: xy does not overflow or underflow; x may be infinite.
int compare_product(double x, double y, double z) {
    const double product = x * y;
    if (product != z) return product < z ? -1 : 1;
    const double off = std::fma(x, y, -product);
    return off < 0 ? -1 : off > 0 ? 1 : 0;
}

}  // namespace

void claim_checker::check_product(const tiny_claim& r, const exact_range& a, const exact_range& b,
                                  const tiny_account& how) {
    if (!a.defined() || !b.defined() || !std::isfinite(r.value)) {
        check(r, {}, how);
        return;
    }
    ++found_.values;
    const double least = r.value - r.error, most = r.value + r.error;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const double x : {a.low, a.high})
        for (const double y : {b.low, b.high}) {
            low = std::min(low, x * y);
            high = std::max(high, x * y);
            if (std::isnan(r.error) ||
                (compare_product(x, y, least) >= 0 && compare_product(x, y, most) <= 0))
                continue;
            add(r, "the bound is too small", how);
            return;
        }
    check_sign(r, low, high, how);
}

void claim_checker::check_quotient(const tiny_claim& r, const exact_range& n, const exact_range& d,
                                   const tiny_account& how) {
    if (!n.defined() || !d.defined() || !(d.low > 0 || d.high < 0) || !std::isfinite(r.value)) {
        check(r, {}, how);
        return;
    }
    ++found_.values;
    const double least = r.value - r.error, most = r.value + r.error;
    const exact_range dividends = d.low > 0 ? n : exact_range{-n.high, -n.low};
    for (const double divisor : {std::abs(d.low), std::abs(d.high)})
        if (!std::isnan(r.error) && !(compare_product(least, divisor, dividends.low) <= 0 &&
                                      compare_product(most, divisor, dividends.high) >= 0)) {
            add(r, "the bound is too small", how);
            return;
        }
    check_sign(r, dividends.low, dividends.high, how);
}

void claim_checker::check_root(const tiny_claim& r, const exact_range& x, const tiny_account& how) {
    if (!x.defined() || x.low < 0 || !std::isfinite(r.value)) {
        check(r, {}, how);
        return;
    }
    ++found_.values;
    const double least = r.value - r.error, most = r.value + r.error;  // exact, or infinite
    if (!std::isnan(r.error) && !((least <= 0 || compare_product(least, least, x.low) <= 0) &&
                                  compare_product(most, most, x.high) >= 0))
        add(r, "the bound is too small", how);
    check_sign(r, x.low, x.high, how);
}

void claim_checker::check_fused(const tiny_claim& r, std::span<const fused_value> ends,
                                const tiny_account& how) {
    const auto is_finite = [](const fused_value& v) {
        return std::isfinite(v.left) && std::isfinite(v.right) && std::isfinite(v.addend);
    };
    if (!std::ranges::all_of(ends, is_finite) || !std::isfinite(r.value)) {
        check(r, {}, how);
        return;
    }
    ++found_.values;
    // Sums of results, bounds and operands fit 53 bits.
    const double least = r.value - r.error, most = r.value + r.error;
    int low = 1, high = -1;
    for (const auto& [left, right, addend] : ends) {
        const int sign = compare_product(left, right, -addend);
        low = std::min(low, sign);
        high = std::max(high, sign);
        if (std::isnan(r.error) || (compare_product(left, right, least - addend) >= 0 &&
                                    compare_product(left, right, most - addend) <= 0))
            continue;
        add(r, "the bound is too small", how);
        return;
    }
    check_sign(r, low, high, how);
}

void claim_checker::check_sign(const tiny_claim& r, double low, double high,
                               const tiny_account& how) {
    if ((r.sign == sign_type::positive && !(low > 0)) ||
        (r.sign == sign_type::negative && !(high < 0)) ||
        (r.sign == sign_type::zero && !(low == 0 && high == 0)))
        add(r, "the sign is wrong", how);
}

void claim_checker::add(const tiny_claim& r, const char* broken, const tiny_account& how) {
    if (++found_.violations > report::kept_violations) return;
    found_.first.push_back(
        {std::string(broken) + " (rounding " + std::string(direction_) + "): value " +
             hexadecimal(r.value) + ", bound " + hexadecimal(r.error),
         "using namespace errbound;\nusing format = " + found_.cpp_name +
             ";\nusing number = tracked<format, " + std::string(rule_) + ">;\n" + text_of(how)});
}

namespace {

report report_of(const rule& r, std::size_t format, bool every_bound) {
    tiny_findings f;
    r.check_tiny(format, every_bound, f);
    report result;
    if (f.format.empty()) return result;
    const std::string name(r.name);
    result.counts.push_back({name, f.format, f.values, f.values, f.violations, 0});
    for (auto& [what, code] : f.first)
        result.violations.push_back(
            {.rule = name, .number = f.format, .what = std::move(what), .code = std::move(code)});
    return result;
}

}  // namespace

evidence evidence_of_tiny(std::span<const rule> rules, bool every_bound) {
    return with_mpfr(
        {.chunks = rules.size() * tiny_format_count,
         .report_of =
             [rules = std::vector(rules.begin(), rules.end()), every_bound](std::uint64_t chunk) {
                 return report_of(rules[chunk / tiny_format_count], chunk % tiny_format_count,
                                  every_bound);
             },
         .describe = [](report&) {}});
}

report validate_tiny(std::span<const rule> rules, int threads, const progress& show) {
    return examine(evidence_of_tiny(rules), threads, show);
}

}  // namespace errbound::validation
