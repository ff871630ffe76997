// MPSolve's files: a kind of three letters, the precision, the degree, then coefficients.
#include <algorithm>
#include <cmath>
#include <errbound/integers/decimal_number.hpp>
#include <errbound/polynomial.hpp>
#include <optional>
#include <span>
#include <string_view>

#include "errbound/program/published/compared_rules.hpp"
#include "errbound/program/published/text.hpp"

namespace errbound::validation {
namespace {

const std::string set = "MPSolve";
constexpr std::uint64_t most_work = 20'000'000'000;  // about 20 s a polynomial

struct fraction {
    integer above = 0, below = 1;
};

integer power_of_ten(std::size_t n) {
    integer p = 1;
    for (; n > 0; --n) p *= 10;
    return p;
}

/// A decimal, exactly; nothing if it is none, or has an exponent beyond 10,000.
std::optional<fraction> fraction_in(std::string_view text) {
    const integers::decimal_text decimal(text);
    if (!decimal.well_formed() || std::abs(decimal.exponent()) > 10'000) return std::nullopt;
    integer all = 0;
    decimal.for_digits(decimal.digits(), [&](integers::word digit) { all = 10 * all + digit; });
    if (decimal.negative()) all = -all;
    const integer ten = power_of_ten(static_cast<std::size_t>(std::abs(decimal.exponent())));
    return decimal.exponent() < 0 ? fraction{all, ten} : fraction{all * ten, 1};
}

/// Integer coefficients, ascending, of a multiple; empty with the reason if there are none.
std::vector<integer> coefficients_in(const std::string& text, std::string& reason) {
    std::string plain;
    for (const std::string_view line : split(text, '\n'))
        plain.append(line.substr(0, line.find('!'))).append(" ");
    const std::vector<std::string_view> words = words_of(plain);
    const auto refuse = [&](const char* why) {
        reason = why;
        return std::vector<integer>();
    };
    if (words.size() < 3 || words[0].size() != 3)
        return refuse("a file does not start with MPSolve's three letters");
    const char density = words[0][0], ring = words[0][1], kind = words[0][2];
    if (density == 'u') return refuse("the polynomial is given by a program");
    if (ring != 'r') return refuse("coefficients are complex");
    std::size_t next = 2;
    const auto whole = [&]() -> std::size_t {
        const auto x = next < words.size() ? number_in(words[next++]) : std::nullopt;
        return x && *x >= 0 && *x < 1e6 ? static_cast<std::size_t>(*x) : 1'000'000;
    };
    const std::size_t degree = whole(), count = density == 's' ? whole() : degree + 1;
    if (degree > 1000) return refuse("the degree is above 1000");
    std::vector<fraction> all(degree + 1);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t k = density == 's' ? whole() : i;
        const std::size_t parts = kind == 'q' ? 2 : 1;
        if (k > degree || next + parts > words.size()) return refuse("a file ends too early");
        const auto c = fraction_in(words[next]), d = fraction_in(words[next + parts - 1]);
        next += parts;
        if (!c || !d || (kind == 'q' && d->above == 0))
            return refuse("a coefficient is no decimal");
        all[k] = kind == 'q' ? fraction{c->above * d->below, c->below * d->above} : *c;
    }
    integer common = 1;
    for (const fraction& c : all) common = common / gcd(common, c.below) * c.below;
    std::vector<integer> scaled;
    for (const fraction& c : all) scaled.push_back(c.above * (common / c.below));
    return scaled;
}

/// The real roots among lines (real part, imaginary part), ascending.
std::vector<double> real_roots_in(const std::string& text) {
    std::vector<double> all;
    for (const std::string_view line : split(text, '\n')) {
        const std::size_t open = line.find('('), comma = line.find(','), close = line.find(')');
        if (open >= comma || comma >= close || close == line.npos) continue;
        const auto real = number_in(line.substr(open + 1, comma - open - 1)),
                   imaginary = number_in(line.substr(comma + 1, close - comma - 1));
        if (real && imaginary && *imaginary == 0) all.push_back(*real);
    }
    std::ranges::sort(all);
    return all;
}

/// Σ c_i x^i by Horner's scheme.
std::size_t recorded_horner(const std::vector<integer>& c) {
    const recorded x(recording::node{.kind = recording::leaf::input});
    recorded sum = recorded::constant(to_string(c.back()));
    for (std::size_t i = c.size() - 1; i-- > 0;) {
        sum *= x;
        if (c[i] != 0) sum += recorded::constant(to_string(c[i]));
    }
    return sum.index();
}

}  // namespace

void compare_polynomial(const published_file& file, const std::string& results, conformance& to) {
    std::string reason;
    const std::vector<integer> c = coefficients_in(file.text, reason);
    if (c.empty()) return to.skip(set, reason);
    const double infinity = HUGE_VAL;
    auto roots = isolate_roots(polynomial(c), -infinity, infinity, {.operations = most_work});
    if (!roots) return to.skip(set, "isolating the roots takes too long");
    recording f(number_type::double_type, {{0, 0}}, {});
    f.result = recorded_horner(c);
    compared_rules rules(f, to.options.rules, set, "value next to a root", to);
    std::vector<std::pair<double, double>> found;  // with multiplicity
    for (std::size_t k = 0; k < roots->size(); ++k) {
        const auto neighbours = roots->neighbouring_doubles(k);
        found.insert(found.end(), static_cast<std::size_t>((*roots)[k].multiplicity), neighbours);
        for (const double x : {neighbours.first, neighbours.second})
            if (std::isfinite(x)) rules.at({x}, file.path.string());
    }
    if (results.empty()) return to.skip(set, "the folder has no results of the polynomial");
    const std::vector<double> published = real_roots_in(results);
    bool agrees = published.size() == found.size();
    for (std::size_t i = 0; i < found.size() && agrees; ++i)
        agrees = std::nextafter(found[i].first, -infinity) <= published[i] &&
                 published[i] <= std::nextafter(found[i].second, infinity);
    to.count(to.row(set, "real roots", "exact"), file.path.string(), agrees ? "" : "list");
}

}  // namespace errbound::validation
