// The list of rules, and merging of reports.

#include <algorithm>
#include <errbound/validation/validation.hpp>
#include <utility>

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
        set_tiny_checks(r);
        set_boost_checks(r);
        return r;
    }();
    return all;
}

std::uint64_t report::violation_count() const {
    std::uint64_t sum = 0;
    for (const rule_counts& entry : counts) sum += entry.violations;
    for (const function_errors& entry : functions) sum += entry.violations;
    return sum;
}

namespace {

class order_of {
  public:
    explicit order_of(const std::vector<rule_counts>& counts) : counts_(counts) {}

    /// The entries with the same rule and number.
    template <class Entry>
    auto places(std::vector<Entry>& entries, const Entry& one) const {
        const auto less = [this](const Entry& a, const Entry& b) { return place(a) < place(b); };
        return std::equal_range(entries.begin(), entries.end(), one, less);
    }

  private:
    template <class Entry>
    std::size_t place(const Entry& e) const {
        std::size_t i = 0;
        while (i < counts_.size() && (counts_[i].rule != e.rule || counts_[i].number != e.number))
            ++i;
        return i;
    }
    const std::vector<rule_counts>& counts_;
};

void add(std::vector<rule_counts>& all, rule_counts one) {
    const auto known = std::ranges::find_if(all, [&one](const rule_counts& other) {
        return other.rule == one.rule && other.number == one.number;
    });
    if (known == all.end()) {
        all.push_back(std::move(one));
        return;
    }
    known->cases += one.cases;
    known->values += one.values;
    known->violations += one.violations;
    known->undetermined += one.undetermined;
}

void add(std::vector<function_errors>& all, function_errors one) {
    const auto known = std::ranges::find_if(all, [&one](const function_errors& other) {
        return other.function == one.function && other.number == one.number;
    });
    if (known == all.end()) {
        all.push_back(std::move(one));
        return;
    }
    known->arguments += one.arguments;
    known->violations += one.violations;
    if (!(one.largest > known->largest)) return;
    known->largest = one.largest;
    known->at = std::move(one.at);
}

}  // namespace

void report::merge(report later) {
    for (function_errors& one : later.functions) add(functions, std::move(one));
    for (rule_counts& one : later.counts) add(counts, std::move(one));
    const order_of order(counts);
    for (violation& one : later.violations) {
        const auto [first, end] = order.places(violations, one);
        if (static_cast<std::size_t>(end - first) < kept_violations)
            violations.insert(end, std::move(one));
    }
    for (tightness& one : later.distributions) {
        const auto [first, end] = order.places(distributions, one);
        const auto known = std::find_if(first, end, [&one](const tightness& other) {
            return other.quantity == one.quantity && other.measure == one.measure;
        });
        if (known != end)
            known->log10.merge(one.log10);
        else
            distributions.insert(end, std::move(one));
    }
}

}  // namespace errbound::validation
