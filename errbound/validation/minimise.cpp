// Minimises greedily, by a measure that only falls.
#include "errbound/validation/minimise.hpp"

#include <cmath>
#include <vector>

#include "errbound/validation/any_number_type.hpp"

namespace errbound::validation {
namespace {

expression cut(const expression& e, std::size_t root) {
    std::array<bool, expression::max_values> used{};
    used[root] = true;
    for (std::size_t n = root + 1; n-- > e.input_count;) {
        if (!used[n]) continue;
        expression_operation o = e.operations[n - e.input_count];
        o.for_each_operand([&](expression_operation::index& v) { used[v] = true; });
    }
    expression r;
    std::array<expression_operation::index, expression::max_values> renamed{};
    for (std::size_t n = 0; n <= root; ++n) {
        if (!used[n]) continue;
        renamed[n] = static_cast<expression_operation::index>(r.size());
        if (n < e.input_count) {
            r.inputs[r.input_count++] = e.inputs[n];
        } else {
            expression_operation o = e.operations[n - e.input_count];
            o.for_each_operand([&](expression_operation::index& v) { v = renamed[v]; });
            if (!o.has_right()) o.right = 0;
            r.operations[r.operation_count++] = o;
        }
    }
    return r;
}

/// Returns exponents nearer to 0; a few hundred steps lead to 0.
std::vector<int> nearer_exponents(int e) {
    std::vector<int> r{0, e / 2, e - e / 16, e - e / 256};
    if (std::abs(e) < 4096) r.push_back(e + (e > 0 ? -1 : 1));
    return r;
}

int bits_of(double x) {
    if (x == 0 || !std::isfinite(x)) return 0;
    int e = 0, bits = 0;
    for (double m = std::frexp(x, &e); m != 0; m -= std::trunc(m), ++bits) m *= 2;
    return bits;
}

double size_of(double x) {
    return x == 0 ? 0 : bits_of(x) + std::abs(std::ilogb(x)) / 64.0 + (x < 0 ? 0.5 : 0);
}
double size_of(const exact_value& x) {
    double size = size_of(x.leading) + std::abs(x.exponent / 64.0);
    for (const double part : x.rest) size += part == 0 ? 0 : 53 + bits_of(part);
    return size;
}

/// Operations that contain left·right.
bool is_compound(operation_kind kind) {
    return kind == operation_kind::dot || kind == operation_kind::horner ||
           kind == operation_kind::interpolate;
}

bool has_exponent(operation_kind kind) {
    return kind == operation_kind::scale || kind == operation_kind::power;
}

/// A measure that falls with every accepted step: operations first, then inputs, then their digits.
double size_of(const expression& e) {
    double size =
        1e6 * static_cast<double>(e.operation_count) + 1e4 * static_cast<double>(e.input_count);
    for (std::size_t i = 0; i < e.operation_count; ++i) {
        if (has_exponent(e.operations[i].kind))
            size += std::abs(static_cast<double>(e.operations[i].exponent));
        if (is_compound(e.operations[i].kind)) size += 1e5;
    }
    for (std::size_t i = 0; i < e.input_count; ++i) {
        const expression_input& in = e.inputs[i];
        size += size_of(in.value);
        if (in.error != 0) size += 200 + size_of(in.error) + 0.01 * std::abs(4 - in.quarters);
    }
    return size;
}

/// Simpler numbers of the same format, as doubles.
std::vector<double> simpler_numbers(double x) {
    std::vector<double> r;
    if (x == 0) return r;
    const int e = std::ilogb(x), bits = bits_of(x);
    r = {0, 1, std::abs(x), std::ldexp(1.0, e)};
    for (const int fewer : {bits / 2, bits - 1}) {
        if (fewer < 1) continue;
        const double unit = std::ldexp(1.0, e - fewer + 1);
        r.push_back(std::trunc(x / unit) * unit);
    }
    for (const int nearer : {0, e / 2, e > 0 ? e - 1 : e + 1})
        r.push_back(std::ldexp(x, nearer - e));
    return r;
}

/// For numbers beyond doubles, also returns the leading part, and a smaller exponent.
std::vector<exact_value> simpler_numbers(const exact_value& x) {
    std::vector<exact_value> r;
    for (const double leading : simpler_numbers(x.leading)) {
        r.push_back(x);
        r.back().leading = leading;
    }
    if (x.is_double()) return r;
    r.push_back(x.leading);
    for (const int exponent : nearer_exponents(x.exponent)) {
        r.push_back(x);
        r.back().exponent = exponent;
    }
    r.push_back(x);
    for (double& part : r.back().rest) part = 0;
    return r;
}

std::optional<expression> with_input(const expression& e, std::size_t n,
                                     const expression_input& in) {
    expression r = cut(e, e.size() - 1);
    if (r.size() != e.size() || r.input_count == expression::max_inputs) return std::nullopt;
    const std::size_t added = r.input_count, root = r.size() - 1;
    const auto moved = [&](expression_operation::index v) {
        return static_cast<expression_operation::index>(v == n ? added : v >= added ? v + 1U : v);
    };
    for (std::size_t i = 0; i < r.operation_count; ++i)
        r.operations[i].for_each_operand([&](expression_operation::index& v) { v = moved(v); });
    r.inputs[r.input_count++] = in;
    return cut(r, n == root ? added : root + 1);
}

/// Replaces value n by value m < n.
expression with_other(const expression& e, std::size_t n, std::size_t m) {
    if (n == e.size() - 1) return cut(e, m);
    expression r = e;
    for (std::size_t i = 0; i < r.operation_count; ++i)
        r.operations[i].for_each_operand([&](expression_operation::index& v) {
            if (v == n) v = static_cast<expression_operation::index>(m);
        });
    return cut(r, r.size() - 1);
}

std::vector<expression> smaller(const expression& e, number_type type) {
    std::vector<expression> r;
    std::array<claim, expression::max_values> plain;
    with_any_number_type(type, [&]<class T>() { evaluate<none, T>(e, plain.data()); });
    for (std::size_t n = e.input_count; n < e.size(); ++n) {
        expression_operation o = e.operations[n - e.input_count];
        o.for_each_operand(
            [&](expression_operation::index& v) { r.push_back(with_other(e, n, v)); });
        if (plain[n].value.is_finite())
            if (auto with = with_input(e, n, {.value = plain[n].value})) r.push_back(*with);
        if (is_compound(o.kind)) {
            expression product = e;
            product.operations[n - e.input_count].kind = operation_kind::multiply;
            r.push_back(cut(product, e.size() - 1));
        }
        if (has_exponent(o.kind))
            for (const int exponent : nearer_exponents(o.exponent)) {
                r.push_back(e);
                r.back().operations[n - e.input_count].exponent = exponent;
            }
    }
    for (std::size_t i = 0; i < e.input_count; ++i) {
        const auto change = [&](const expression_input& in) {
            expression_input held = in;
            with_any_number_type(type, [&]<class T>() {
                held.value = exactly(number_of<T>(in.value));
                held.error = exactly(number_of<T>(in.error));
            });
            if (!held.value.is_finite() || !held.error.is_finite()) return;
            r.push_back(e);
            r.back().inputs[i] = held;
        };
        expression_input in = e.inputs[i];
        for (const exact_value& value : simpler_numbers(in.value))
            change({.value = value, .error = in.error, .quarters = in.quarters});
        for (const exact_value& error : simpler_numbers(in.error))
            change({.value = in.value, .error = error, .quarters = in.quarters});
        if (in.error != 0)
            for (const int quarters : {4, -4, 0})
                change({.value = in.value, .error = in.error, .quarters = quarters});
    }
    return r;
}

}  // namespace

expression minimised(const expression& e, number_type type, const violation_search& search) {
    expression best = cut(e, search(e).value());
    for (bool found = true; found;) {
        found = false;
        for (const expression& candidate : smaller(best, type)) {
            if (size_of(candidate) >= size_of(best)) continue;
            const std::optional<std::size_t> at = search(candidate);
            if (!at) continue;
            best = cut(candidate, *at);
            found = true;
            break;
        }
    }
    return best;
}

}  // namespace errbound::validation
