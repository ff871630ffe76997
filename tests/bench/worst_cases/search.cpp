#include "tests/bench/worst_cases/search.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "ccd/report/measuring/timing.hpp"
#include "tests/support/query_families.hpp"

namespace worst_cases {
namespace {

using query_families::source;
using row = std::vector<double>;

int drawn_family(source& random) {
    return random.between(0, static_cast<int>(std::size(query_families::families)) - 1);
}

/// The first numbers of a query of that family.
row drawn(source& random, int which_family, std::size_t numbers) {
    const auto& family = query_families::families[which_family];
    const auto kind = random.one_in(2) ? ccd::kind::vertex_face : ccd::kind::edge_edge;
    const auto all = std::bit_cast<std::array<double, 24>>(family.make(random, kind));
    return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(numbers)};
}

void change(row& x, source& random) {
    const int last = static_cast<int>(x.size()) - 1;
    double& one = x[static_cast<std::size_t>(random.between(0, last))];
    const double other = x[static_cast<std::size_t>(random.between(0, last))];
    constexpr double infinity = std::numeric_limits<double>::infinity();
    switch (random.between(0, 7)) {
        case 0:
            one = std::nextafter(one, infinity);
            break;
        case 1:
            one = std::nextafter(one, -infinity);
            break;
        case 2:
            one = other;
            break;
        case 3:
            one = -one;
            break;
        case 4:
            one = random.between(-3, 3);
            break;
        case 5:
            one = std::ldexp(one, random.between(-60, 60));
            break;
        case 6:
            one = std::ldexp(one, random.between(-1000, 1000));
            break;
        case 7:
            one += std::ldexp(one, -random.between(1, 53));
            break;
    }
}

}  // namespace

bool holds(const range& within, const row& numbers) {
    return std::ranges::all_of(numbers, [&](double x) {
        return x == 0 || (within.low <= std::abs(x) && std::abs(x) <= within.high);
    });
}

double seconds_of(const subject& asked, const row& numbers, int times) {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < times; ++i) {
        const auto start = ccd::report::clock::now();
        asked.call(numbers.data());
        least = std::min(least, ccd::report::seconds_since(start));
    }
    return least / asked.calls;
}

row slowest(const subject& asked, const range& within, const std::vector<row>& known,
            double seconds, std::uint64_t seed) {
    double longest = 0;
    row found;
    const auto look_at = [&](row next) {
        if (!holds(within, next) || seconds_of(asked, next, 2) <= longest) return false;
        const double surely = seconds_of(asked, next, 7);
        if (surely <= longest) return false;
        longest = surely;
        found = std::move(next);
        return true;
    };
    for (const row& numbers : known)
        if (numbers.size() >= asked.numbers)
            look_at({numbers.data(), numbers.data() + asked.numbers});
    source random(seed);
    int slow_family = drawn_family(random);
    const auto begun = ccd::report::clock::now();
    for (double now = 0; now < seconds; now = ccd::report::seconds_since(begun)) {
        if (found.empty() || now < seconds / 2) {
            const int family = random.one_in(2) ? drawn_family(random) : slow_family;
            if (look_at(drawn(random, family, asked.numbers))) slow_family = family;
            continue;
        }
        row next = found;
        for (int changes = random.between(1, 3); changes > 0; --changes) change(next, random);
        look_at(std::move(next));
    }
    return found;
}

}  // namespace worst_cases
