// Real roots of polynomials, exactly.
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <cstdint>
#include <errbound/integers/integer.hpp>
#include <errbound/polynomial.hpp>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "interruptible.hpp"

namespace errbound::python {
namespace {

/// Coefficients that ascend: doubles, or whole numbers in hexadecimal digits.
using coefficients = std::variant<input<double, -1>, std::vector<std::string>>;
using roots_type = real_roots<integer>;

integer integer_of(const std::string& hexadecimal) {
    return integer::from_string(hexadecimal, 16);
}
std::string text_of(const integer& x) {
    return to_string(x, 16);
}

polynomial<double> polynomial_of(const input<double, -1>& c) {
    const auto all = items_of<double>(c);
    return polynomial<double>(std::vector<double>(all.begin(), all.end()));
}
polynomial<integer> polynomial_of(const std::vector<std::string>& c) {
    std::vector<integer> all;
    for (const std::string& digits : c) all.push_back(integer_of(digits));
    return polynomial<integer>(std::move(all));
}
roots::staged_polynomial<integer> staged_of(const coefficients& c) {
    return std::visit([](const auto& x) { return roots::staged<integer>(polynomial_of(x)); }, c);
}

/// One row of coefficients a polynomial; -1 for one that is zero.
nb::object count_of_rows(const input<double, -1, -1>& rows, double a, double b) {
    std::vector<std::int64_t> counts(rows.shape(0));
    const std::size_t length = rows.shape(1);
    in_parts(counts.size(), 256, [&](std::size_t first, std::size_t size) {
        for (std::size_t i = first; i < first + size; ++i) {
            const double* row = rows.data() + i * length;
            const std::size_t found = count_roots<integer>(
                polynomial<double>(std::vector<double>(row, row + length)), a, b);
            counts[i] = found == infinitely_many ? -1 : static_cast<std::int64_t>(found);
        }
    });
    return numbers_of<std::int64_t>(std::move(counts));
}

/// Numerator in hexadecimal digits, and exponent of two.
using exact_point = std::pair<std::string, int>;
exact_point exact_of(const roots_type::point& x) {
    return {text_of(x.numerator()), x.exponent()};
}

std::vector<std::string> common_factor_of(const coefficients& p, const coefficients& q) {
    std::vector<std::string> texts;
    const auto factor = common_factor(polynomial<integer>(staged_of(p).exact()),
                                      polynomial<integer>(staged_of(q).exact()));
    for (const integer& c : factor.coefficients()) texts.push_back(text_of(c));
    return texts;
}

}  // namespace

void bind_roots(nb::module_& m) {
    nb::class_<roots_type>(m, "Roots")
        .def("__init__", [](roots_type* self, const coefficients& p, double a,
                            double b) { new (self) roots_type(staged_of(p), a, b); })
        .def("__len__", &roots_type::size)
        .def("everywhere", &roots_type::everywhere)
        .def("neighbouring_doubles", &roots_type::neighbouring_doubles)
        .def("multiplicity", [](const roots_type& r, std::size_t k) { return r[k].multiplicity; })
        .def("interval",
             [](const roots_type& r, std::size_t k) {
                 return std::pair(exact_of(r[k].low), exact_of(r[k].high));
             })
        .def("refine", [](roots_type& r, std::size_t k, double width) { r.refine(k, width); })
        .def("sign_at",
             [](roots_type& r, const coefficients& g, std::size_t k) {
                 auto staged = staged_of(g);
                 return static_cast<int>(r.sign_at(staged, k)) - 1;
             })
        .def("signs_on", [](roots_type& r, double a, double b) {
            const occurring_signs s = r.signs_on(a, b);
            return std::tuple(s.negative, s.zero, s.positive);
        });
    m.def("count_of_rows", count_of_rows);
    m.def("common_factor", common_factor_of);
}

}  // namespace errbound::python
