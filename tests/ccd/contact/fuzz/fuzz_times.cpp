// First contacts of queries of all kinds, and first times within a distance, compared with the
// oracle.
#include <ccd/contact.hpp>
#include <ccd/kind.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

#include "ccd/contact/integer_times.hpp"
#include "tests/support/first_time_faults.hpp"
#include "tests/support/fuzz_numbers.hpp"
#include "tests/support/query_families.hpp"

namespace {

using query_families::points;

std::string text_of(const ccd::first_time& t) {
    char text[80];
    std::snprintf(text, sizeof text, "%s [%a, %a]", std::string(ccd::name(t.outcome)).c_str(),
                  t.low, t.high);
    return text;
}

template <ccd::kind K>
void check(const points& p, ccd::separation d, double t_max) {
    const auto q =
        query_families::as_query<typename ccd::kind_traits<K>::template query<double>>(p);
    const auto expect = [&](const char* who, const ccd::first_time& said,
                            const std::string& fault) {
        if (fault.empty()) return;
        char text[120];
        std::snprintf(text, sizeof text,
                      " of %s, distance %a + %a, t_max %a: ", std::string(short_name(K)).c_str(),
                      d.first, d.second, t_max);
        fuzz::fail(who + (text + text_of(said)) + ", but " + fault + "\n" + query_families::csv(p));
    };
    const ccd::first_time first = ccd::time_of_impact(q, t_max);
    expect("time_of_impact", first, support::fault_of(q, first, t_max));
    const ccd::detail::found_time found = ccd::detail::first_contact_in_integers(q);
    if (found.outcome != ccd::outcome::uncertain) {
        const ccd::first_time in_integers{found.outcome, found.time.low, found.time.high};
        expect("integers", in_integers, support::fault_of(q, in_integers));
    }
    const ccd::first_time near = ccd::time_within(q, d, t_max);
    expect("time_within", near, support::fault_of(q, d, near, t_max));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::numbers from(data, size);
    const auto which = static_cast<ccd::kind>(from.below(4));
    // t_max is in eighths, also above 1, or any number, or 1.
    const std::size_t end = from.below(18);
    const auto p = fuzz::points_from<points>(from);
    const double first = std::abs(from.next()), second = std::abs(from.next());
    const double t_max = end < 10 ? static_cast<double>(end) / 8 : end < 14 ? from.next() : 1;
    ccd::visit_kind(which, [&]<ccd::kind K>() { check<K>(p, {first, second}, t_max); });
    return 0;
}
