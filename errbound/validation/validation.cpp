// The rules that there are, and reports joined.

#include <errbound/validation/validation.hpp>
#include <iterator>

#include "errbound/validation/all_rules.hpp"

namespace errbound::validation {

std::span<const rule> rules() {
    static const std::vector<rule> all = [] {
        std::vector<rule> r;
        for_each_rule(all_rules(), [&r]<class Rule>() {
            rule one;
            set_expression_checks<Rule>(one);
            r.push_back(one);
        });
        set_query_checks(r);
        set_tiny_checks(r);
        return r;
    }();
    return all;
}

std::uint64_t report::violation_count() const {
    std::uint64_t sum = 0;
    for (const rule_counts& entry : counts) sum += entry.violations;
    return sum;
}

void report::add(report other) {
    const auto append = [](auto& to, auto& from) {
        to.insert(to.end(), std::make_move_iterator(from.begin()),
                  std::make_move_iterator(from.end()));
    };
    append(counts, other.counts);
    append(violations, other.violations);
    append(distributions, other.distributions);
}

}  // namespace errbound::validation
