// Comparisons with references, in words.

#include <algorithm>
#include <cstdio>
#include <errbound/validation/findings.hpp>
#include <errbound/validation/shadowed.hpp>

namespace errbound::validation {
namespace {

std::string decimal(mpfr_srcptr x) {
    char text[96];
    mpfr_snprintf(text, sizeof text, "%.17Rg", x);
    return text;
}

/// "0x1.8p-3", or "(0x1.8p-1 + 0x1p-60)*2^5000".
std::string number_text(const exact_value& x) {
    std::string sum = hexadecimal(x.leading);
    for (const double part : x.rest)
        if (part != 0) sum += " + " + hexadecimal(part);
    return x.is_double() ? sum : "(" + sum + ")*2^" + std::to_string(x.exponent);
}

std::string_view name_of(sign_type s) {
    switch (s) {
        case sign_type::negative:
            return "negative";
        case sign_type::zero:
            return "zero";
        case sign_type::positive:
            return "positive";
        default:
            return "uncertain";
    }
}

}  // namespace

double deviation::log10_of(mpfr_srcptr x) {
    long exponent = 0;
    const double mantissa = mpfr_get_d_2exp(&exponent, x, MPFR_RNDN);
    return std::log10(std::abs(mantissa)) + static_cast<double>(exponent) * std::log10(2.0);
}

std::string_view measure_of(error_meaning meaning) {
    switch (meaning) {
        case error_meaning::bound:
            return "bound/error";
        case error_meaning::estimate:
            return "estimate/error";
        default:
            return "error/value";
    }
}

void add_ratio(distribution& to, error_meaning meaning, const claim& c, const ball& x,
               const deviation& off) {
    const bool claims = meaning != error_meaning::nothing;
    if (!c.value.is_finite() || !x.is_defined() || (claims && !c.error.is_finite())) {
        to.add_unknown();
    } else if (off.is_negligible()) {
        to.add_exact();
    } else if (meaning == error_meaning::bound) {
        // Negative only by the rounding of logarithms.
        to.add(std::max(0.0, log10_of(c.error) - off.log10()));
    } else if (claims) {
        to.add(c.error.leading > 0 ? log10_of(c.error) - off.log10() : distribution::least_log);
    } else if (mpfr_regular_p(x.middle())) {
        to.add(off.log10() - deviation::log10_of(x.middle()));
    } else {
        to.add_unknown();
    }
}

std::string sentence(finding f, const claim& c, const ball& x, const deviation& off) {
    const std::string value = "value " + number_text(c.value) + ", bound " + number_text(c.error) +
                              ", sign " + std::string(name_of(c.sign));
    const std::string exact =
        x.is_defined() ? "exact value near " + decimal(x.middle()) : "no exact value";
    switch (f) {
        case finding::bound_broken:
            return "the bound is too small: " + value + "; " + exact + ", off by " +
                   decimal(off.upper());
        case finding::sign_wrong:
            return "the sign is wrong: " + value + "; " + exact;
        default:
            return "certain about what has no finite value: " + value + "; " + exact;
    }
}

void shadow_session::note(std::string_view quantity, const claim& c, const ball& x,
                          error_meaning meaning) {
    auto found = quantities_.find(quantity);
    if (found == quantities_.end())
        found = quantities_.emplace(std::string(quantity), distribution()).first;
    if (c.value.is_finite() && x.is_defined()) off_.compute(c.value, x);
    add_ratio(found->second, meaning, c, x, off_);
}

}  // namespace errbound::validation
