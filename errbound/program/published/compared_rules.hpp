// A computation under bound rules, compared with MPFR at given inputs. Internal.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "errbound/program/published/sets.hpp"
#include "errbound/validation/worst_case/evaluation.hpp"

namespace errbound::validation {

class compared_rules {
  public:
    compared_rules(const recording& f, std::span<const rule> rules, std::string set,
                   std::string subject, conformance& to)
        : check_(f), rules_(rules), set_(std::move(set)), subject_(std::move(subject)), to_(to) {}

    void at(const std::vector<double>& inputs, const std::string& place) {
        const std::vector<double> exact(inputs.size(), 0);
        for (const rule& r : rules_) {
            if (!check_.applies(r)) continue;
            conformance_row& row = to_.row(set_, subject_, std::string(r.name), r.promises());
            const claim c = check_.evaluate(r, inputs);
            const finding f = check_.compare(r, c, inputs, exact, &row.log10);
            row.uncertain += !certain(c.sign) || !c.error.is_finite();
            to_.count(row, place,
                      !is_violation(f)             ? ""
                      : f == finding::bound_broken ? "bound"
                                                   : "sign");
        }
    }

  private:
    rule_check check_;
    std::span<const rule> rules_;
    std::string set_, subject_;
    conformance& to_;
};

}  // namespace errbound::validation
