// Elementary functions (errbound/elementary.hpp) of explained numbers, each one operation.
#pragma once

#include <cstddef>
#include <errbound/elementary.hpp>
#include <errbound/explain/explained.hpp>
#include <errbound/explain/functions.hpp>

namespace errbound {

template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> exp(const tracked<T, explained<Rule, Limit>>& x) {
    return as_one_operation(
        "exp", [](const auto& y) { return exp(y); }, x);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> exp2(const tracked<T, explained<Rule, Limit>>& x) {
    return as_one_operation(
        "exp2", [](const auto& y) { return exp2(y); }, x);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> expm1(const tracked<T, explained<Rule, Limit>>& x) {
    return as_one_operation(
        "expm1", [](const auto& y) { return expm1(y); }, x);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> log(const tracked<T, explained<Rule, Limit>>& x) {
    return as_one_operation(
        "log", [](const auto& y) { return log(y); }, x);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> log2(const tracked<T, explained<Rule, Limit>>& x) {
    return as_one_operation(
        "log2", [](const auto& y) { return log2(y); }, x);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> log10(const tracked<T, explained<Rule, Limit>>& x) {
    return as_one_operation(
        "log10", [](const auto& y) { return log10(y); }, x);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> log1p(const tracked<T, explained<Rule, Limit>>& x) {
    return as_one_operation(
        "log1p", [](const auto& y) { return log1p(y); }, x);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> sin(const tracked<T, explained<Rule, Limit>>& x) {
    return as_one_operation(
        "sin", [](const auto& y) { return sin(y); }, x);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> cos(const tracked<T, explained<Rule, Limit>>& x) {
    return as_one_operation(
        "cos", [](const auto& y) { return cos(y); }, x);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> tan(const tracked<T, explained<Rule, Limit>>& x) {
    return as_one_operation(
        "tan", [](const auto& y) { return tan(y); }, x);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> asin(const tracked<T, explained<Rule, Limit>>& x) {
    return as_one_operation(
        "asin", [](const auto& y) { return asin(y); }, x);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> acos(const tracked<T, explained<Rule, Limit>>& x) {
    return as_one_operation(
        "acos", [](const auto& y) { return acos(y); }, x);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> atan(const tracked<T, explained<Rule, Limit>>& x) {
    return as_one_operation(
        "atan", [](const auto& y) { return atan(y); }, x);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> sinh(const tracked<T, explained<Rule, Limit>>& x) {
    return as_one_operation(
        "sinh", [](const auto& y) { return sinh(y); }, x);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> cosh(const tracked<T, explained<Rule, Limit>>& x) {
    return as_one_operation(
        "cosh", [](const auto& y) { return cosh(y); }, x);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> tanh(const tracked<T, explained<Rule, Limit>>& x) {
    return as_one_operation(
        "tanh", [](const auto& y) { return tanh(y); }, x);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> asinh(const tracked<T, explained<Rule, Limit>>& x) {
    return as_one_operation(
        "asinh", [](const auto& y) { return asinh(y); }, x);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> acosh(const tracked<T, explained<Rule, Limit>>& x) {
    return as_one_operation(
        "acosh", [](const auto& y) { return acosh(y); }, x);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> atanh(const tracked<T, explained<Rule, Limit>>& x) {
    return as_one_operation(
        "atanh", [](const auto& y) { return atanh(y); }, x);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> cbrt(const tracked<T, explained<Rule, Limit>>& x) {
    return as_one_operation(
        "cbrt", [](const auto& y) { return cbrt(y); }, x);
}

template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> pow(const tracked<T, explained<Rule, Limit>>& x,
                                       const tracked<T, explained<Rule, Limit>>& y) {
    return as_one_operation(
        "pow", [](const auto& a, const auto& b) { return pow(a, b); }, x, y);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> atan2(const tracked<T, explained<Rule, Limit>>& y,
                                         const tracked<T, explained<Rule, Limit>>& x) {
    return as_one_operation(
        "atan2", [](const auto& a, const auto& b) { return atan2(a, b); }, y, x);
}

}  // namespace errbound
