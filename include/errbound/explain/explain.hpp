// Where the error of a result comes from. Includes everything needed; tutorial: docs/how-wrong.md.
//   using number = errbound::tracked<double, errbound::explained<>>;
//   number mean(std::span<const number> x) {
//       const errbound::scope s("mean");
//       number sum = 0;
//       for (const number& y : x) sum += y;
//       return sum / static_cast<int>(x.size());
//   }
//   std::cout << text_of(errbound::explain(mean(x), "mean of x"));
#pragma once

#include <algorithm>
#include <errbound/explain/elementary.hpp>
#include <errbound/explain/explained.hpp>
#include <errbound/explain/explanation.hpp>
#include <errbound/explain/functions.hpp>
#include <errbound/explain/scope.hpp>
#include <string>
#include <tuple>
#include <utility>

namespace errbound {

/// The error of x, called `name`, by its sources, as doubles. Cost: a look-up for each source.
template <class T, class Rule, std::size_t Limit>
explanation explain(const tracked<T, explained<Rule, Limit>>& x, std::string name = "result") {
    explanation e{std::move(name),
                  Rule::name,
                  static_cast<double>(x.value()),
                  static_cast<double>(x.error()),
                  {}};
    const auto& all = detail::all_sources::instance();
    for (const auto& entry : x.bound().contributions.entries())
        e.contributions.push_back({all.scopes_of(entry.from), all.operation_of(entry.from),
                                   static_cast<double>(entry.size()),
                                   static_cast<double>(entry.known)});
    const auto names = [](const contribution& c) {
        std::string path;
        for (const place& s : c.scopes) path += s.name + '\n';
        return path + c.operation;
    };
    std::stable_sort(e.contributions.begin(), e.contributions.end(),
                     [&](const contribution& c, const contribution& d) {
                         return c.amount > d.amount ||
                                (c.amount == d.amount && names(c) < names(d));
                     });
    return e;
}

}  // namespace errbound
