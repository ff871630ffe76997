// Values and bounds of random sequences of operations, for every rule.
#include <array>
#include <cstddef>
#include <errbound/functions.hpp>
#include <errbound/tracked.hpp>
#include <errbound/validation/rule_list.hpp>
#include <string>

#include "tests/everywhere/numbers.hpp"
#include "tests/everywhere/sections.hpp"

namespace everywhere {
namespace {

using ccd::lab::source;

template <class Number>
Number any_result(source& random, const Number& a, const Number& b, const Number& c) {
    switch (random.between(0, 9)) {
        case 0:
        case 1:
            return a + b;
        case 2:
        case 3:
            return a - b;
        case 4:
        case 5:
            return a * b;
        case 6:
            if constexpr (errbound::has_division<typename Number::rule_type>) return a / b;
            return -a;
        case 7:
            return scale(a, random.between(-40, 40));
        case 8:
            return sqrt(a * a);
        default:
            return fma(a, b, c);
    }
}

template <class T, class Rule>
void record_program(recorder& to, source& random, bool of_any_size) {
    using number = errbound::tracked<T, Rule>;
    std::array<number, 12> x;
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (i < 4) {
            x[i] = any_number<T>(random, of_any_size);
            if (random.one_in(4)) x[i] = number::within(x[i].value(), T(1) / 1024);
        } else {
            const auto earlier = [&]() -> const number& {
                return x[static_cast<std::size_t>(random.between(0, static_cast<int>(i) - 1))];
            };
            const number &a = earlier(), &b = earlier(), &c = earlier();
            x[i] = any_result(random, a, b, c);
        }
        to.add(double(x[i].value()));
        to.add(double(x[i].error()));
        to.add(sign_of(x[i]));
    }
}

template <class T, class... Rules>
void record_rules(recorder& to, errbound::rule_types<Rules...> rules) {
    for (const bool of_any_size : {false, true})
        errbound::for_each_rule(rules, [&]<class Rule>() {
            source random(17);
            for (int i = 0; i < 1500; ++i) {
                record_program<T, Rule>(to, random, of_any_size);
                to.end_item(std::string(Rule::name) + (sizeof(T) == 4 ? ", float " : ", double ") +
                            std::to_string(i));
            }
        });
}

}  // namespace

void record_bounds(recorder& to) {
    using namespace errbound;
    using rules = rule_types<none, safe, tight, sharp, interval, residual>;
    record_rules<double>(to, rules());
    record_rules<float>(to, rules());
}

}  // namespace everywhere
